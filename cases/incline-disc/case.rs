//! A disc released from rest on an inclined plane (2000 paper).

#[path = "elastic.rs"]
mod elastic;

use crate::exact::one_grain::OneGrain;
use crate::rows::incline::{self, Slope};
use crate::rows::programs;
use crate::rows::rigid::{self, Row};
use crate::rows::set_down::{self, Dashpots};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];

const SLOPES: &[Slope] = &[
    Slope { variant: "60deg-mu.3", sticks: false, rigid_allowed: 1e-3 },
    Slope { variant: "60deg-mu.9", sticks: true, rigid_allowed: 3e-4 },
    Slope { variant: "60deg-mu.5", sticks: false, rigid_allowed: 2.5e-3 },
    Slope { variant: "30deg-mu.5", sticks: true, rigid_allowed: 3e-4 },
];

const RIGID: &[Row] = &[
    Row { variant: "60deg-mu.3", rolls: false, x: 8e-4, v: 1e-12, omega: 5e-5 },
    Row { variant: "60deg-mu.9", rolls: true, x: 8e-4, v: 4e-4, omega: 8e-4 },
    Row { variant: "60deg-mu.5", rolls: false, x: 8e-4, v: 4e-4, omega: 8e-4 },
    Row { variant: "30deg-mu.5", rolls: true, x: 8e-4, v: 7e-5, omega: 5e-5 },
];

pub(crate) static CASE: Case = Case {
    name: "incline-disc",
    title: "A disc on an inclined plane",
    claim: "A disc released from rest rolls or slips as Coulomb friction says: displacement, velocity and spin follow \
            the rigid answer up to the compliance of the contact, and the compliant answer to the step's own error.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "One contact that never opens and whose normal never turns, started at its static overlap: nothing is \
               said about impact, about history on a turning contact, or about grains against grains. A wrong μ is \
               felt only where the disc slips, a wrong inertia mostly where it rolls: read the four together.",
    levels: LEVELS,
    default_level: LEVELS[2],
    claims: &claims,
    figures,
    home: &crate::registry::HOME,
};

fn claims() -> Vec<Claim> {
    let programs = programs::one_grain(&SLOPES.iter().map(|slope| slope.variant).collect::<Vec<_>>());
    [incline::claims(&CASE, SLOPES), set_down(), rigid::inclines(RIGID), programs, elastic::claims()].concat()
}

fn set_down() -> Vec<Claim> {
    set_down::claims("30deg-mu.5", Dashpots::OfMass)
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut figures = incline::figures(runner, SLOPES)?;
    figures.push(rigid::figure(runner, RIGID, OneGrain::rigid_incline)?);
    figures.extend(elastic::figures(runner)?);
    Ok(figures)
}
