//! Study of stability: largest stable time steps and hard cases, with figures.

use super::cost::diagonal;
use crate::distinct;
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_harness::verdict::Severity;
use serde::{Deserialize, Serialize};

/// Largest stable time step of an assembly with one solver.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Assembly, such as `square lattice of discs`.
    pub scene: String,
    /// Name of a parameter other than the time step, such as `k_s/k_n`; empty if there is none.
    pub knob: String,
    /// Value of the parameter.
    pub at: Option<f64>,
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Unit of the time steps, such as `√(m/k)`.
    pub unit: String,
    /// Largest time step that was stable.
    pub found: Option<f64>,
    /// Smallest time step that was unstable.
    pub unstable: Option<f64>,
    /// Exact stability limit, in the same unit; none if it is unknown.
    pub exact: Option<f64>,
    /// (found − exact)/exact.
    pub error: Option<f64>,
    /// Default time step of the solver.
    pub default: Option<f64>,
    /// `found` divided by `default`.
    pub margin: Option<f64>,
    /// Description of the failure above the limit, or the reason why no limit was found.
    pub detail: String,
}

/// Outcome of a hard case with one solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hardness {
    /// The required property holds at the default time step.
    Holds,
    /// The required property holds only at a smaller time step.
    HoldsAtASmallerStep,
    /// The run at the default time step ends with an error that states time, place and reason. The required property does
    /// not hold at smaller time steps either.
    TypedFailure,
    /// The run at the default time step ends without an error, but the required property does not hold. It does not hold
    /// at smaller time steps either.
    QuietlyWrong,
    /// The solver cannot represent the scene.
    Unsupported,
    /// The program is not installed.
    NotAvailable,
}

impl Hardness {
    /// Returns the symbol and the name of the outcome.
    pub(crate) const fn sign(self) -> (&'static str, &'static str) {
        match self {
            Self::Holds => ("✓", "holds"),
            Self::HoldsAtASmallerStep => ("↓", "holds at a smaller step"),
            Self::TypedFailure => ("!", "typed failure"),
            Self::QuietlyWrong => ("✗", "wrong without an error"),
            Self::Unsupported => ("–", "cannot express it"),
            Self::NotAvailable => ("–", "not installed"),
        }
    }

    pub(crate) const fn word(self) -> &'static str {
        self.sign().1
    }
}

/// Result of one solver in a hard case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HardCaseResult {
    /// Name of the case, such as `mass-ratio-1e6`.
    pub case: String,
    /// Required property.
    pub must: String,
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Outcome at the default time step and at smaller ones.
    pub standing: Hardness,
    /// Resolution at which the property holds, or the default resolution.
    pub resolution: String,
    /// Failure at the default time step, or the reason why the solver cannot run the case; empty if the property holds.
    pub detail: String,
}

/// Solvers whose wrong results in hard cases are documented errors.
pub const DOCUMENTED: [&str; 3] = ["lammps", "liggghts", "rigid"];

impl HardCaseResult {
    /// Returns the colour of the result; none if the solver cannot run the case. A wrong result without an error message is
    /// red. If the behaviour of the solver is documented, it is amber.
    pub(crate) fn severity(&self) -> Option<Severity> {
        match self.standing {
            Hardness::Holds => Some(Severity::Green),
            Hardness::QuietlyWrong if !DOCUMENTED.contains(&self.solver.as_str()) => Some(Severity::Red),
            Hardness::HoldsAtASmallerStep | Hardness::TypedFailure | Hardness::QuietlyWrong => Some(Severity::Amber),
            Hardness::Unsupported | Hardness::NotAvailable => None,
        }
    }
}

/// Returns figures of the largest stable step: against the exact limit, and for each unit against the parameter.
#[must_use]
pub fn figures(limits: &[Limit]) -> Vec<Figure> {
    let units = distinct(limits.iter().map(|limit| limit.unit.as_str()));
    let of_unit =
        |unit: &str| limits.iter().filter(|limit| limit.unit == unit && limit.at.is_some()).collect::<Vec<_>>();
    let maps = units.into_iter().filter_map(|unit| map(&of_unit(unit), unit));
    against_exact(limits).into_iter().chain(maps).collect()
}

fn map(rows: &[&Limit], unit: &str) -> Option<Figure> {
    let mut curves = Vec::new();
    let knob = rows.first()?.knob.clone();
    let exact = rows.iter().any(|row| row.exact.is_some());
    let points = |curve: &dyn Fn(&Limit) -> Option<f64>| -> Vec<(f64, f64)> {
        let mut points: Vec<_> = rows.iter().filter_map(|row| Some((row.at?, curve(row)?))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    let solvers = distinct(rows.iter().map(|row| row.solver.as_str()));
    let found = |solver: &str| points(&|row| row.found.filter(|_| row.solver == solver));
    let stroke = if exact { Stroke::Markers } else { Stroke::MarkedLine };
    // Solvers with equal curves share one curve, because equal curves would hide each other.
    for line in distinct(solvers.iter().map(|solver| found(solver))).into_iter().filter(|line| !line.is_empty()) {
        let mut equal = solvers.iter().copied().filter(|solver| found(solver) == line);
        let first = equal.next().unwrap_or_default();
        let others = equal.collect::<Vec<_>>().join(", ");
        let label = if others.is_empty() { first.to_owned() } else { format!("{first} (and {others}: equal)") };
        curves.push(Curve::new(label, stroke, line));
    }
    for scene in distinct(rows.iter().map(|row| row.scene.as_str())) {
        let first = rows.iter().find(|row| row.scene == scene).map_or("", |row| row.solver.as_str());
        let line = points(&|row| row.exact.filter(|_| row.scene == scene && row.solver == first));
        let stroke = if line.len() > 1 { Stroke::Dashed } else { Stroke::Markers };
        if !line.is_empty() {
            curves.push(Curve::new(format!("{scene}, exact"), stroke, line));
        }
    }
    let name = if exact { "stable-step-springs" } else { "stable-step-grid" };
    let scenes = if exact { "assemblies on springs" } else { "the material point method" };
    let caption = if exact {
        "The largest stable step is found by bisection on the growth of a random perturbation of all degrees of \
         freedom. Dashed lines join the exact limits. The parameter is the ratio of tangential and \
         normal stiffness, and m is the mass of a grain."
    } else {
        "Largest Courant number for which the energy of a vibrating bar grows by at most a tenth over two periods."
    };
    let x = if exact { Axis::linear(&knob) } else { Axis::log(&knob) };
    let y = if unit.starts_with('√') { format!("Δt / {unit}") } else { format!("Δt / ({unit})") };
    (!curves.is_empty()).then(|| {
        Figure::graph(name, &format!("Largest stable step of {scenes}"), caption, [x, Axis::linear(&y)], curves)
    })
}

/// Returns the figure of the largest stable time step against the exact limit.
fn against_exact(limits: &[Limit]) -> Option<Figure> {
    let limits: Vec<&Limit> = limits.iter().filter(|row| row.unit == "√(m/k)").collect();
    let curve = |solver: &str| {
        let mine = limits.iter().filter(|row| row.solver == solver);
        Curve::new(solver, Stroke::Markers, mine.filter_map(|row| Some((row.exact?, row.found?))).collect())
    };
    let mut curves: Vec<Curve> =
        distinct(limits.iter().map(|row| row.solver.as_str())).into_iter().map(curve).collect();
    curves.retain(|curve| !curve.points.is_empty());
    curves.push(diagonal("exact", &curves));
    (curves.len() > 1).then(|| {
        Figure::graph(
            "found-exact",
            "Largest stable steps against the exact limits",
            "Largest stable time step of each solver over the exact limit of central differences, for all assemblies \
             with such a limit. A solver below the line becomes unstable earlier than central differences.",
            [Axis::linear("exact limit / √(m/k)"), Axis::linear("largest stable step / √(m/k)")],
            curves,
        )
    })
}
