//! Claims of the silo cases, on elements, blocks and tracers.

use super::collapse::ComparedFlow;
use super::ensemble::{self, Flow, onset, plateau, share, steady};
use super::{ELEMENTS, flows};
use crate::rows::draws::{apart, mean_of};
use crate::rows::programs::{ENERGY, row};
use grainbench_harness::prelude::*;

/// Silo at two sizes, with the data for its expected values, tolerances and figures.
pub(crate) struct Silo {
    /// Variants at a tenth of the paper's size and at the paper's size.
    pub(crate) variants: [&'static str; 2],
    /// Tier of the run at a tenth of the size.
    pub(crate) set: Set,
    /// Mean sin φ and mean packing fraction of the flow in the prototype.
    pub(crate) means: [CitedNumber; 2],
    /// Table of all quantities of ten of our own packings, one in a row, by `examples/silo_packings.rs`.
    pub(crate) packings: &'static str,
    /// Packing fractions of the prototype in the first bins of the inertial number |I₀|.
    pub(crate) bins: &'static [CitedNumber],
    /// Label of the flow in figures.
    pub(crate) label: &'static str,
    /// Expected values of a draining silo; `None` for a pushed silo. In a pushed silo, too few elements deform for
    /// tracer paths and for curves against the inertial number.
    pub(crate) drained: Option<Drained>,
}

/// Values of the prototype for a draining silo, and the flows that are compared with it.
pub(crate) struct Drained {
    pub(crate) plateau: CitedNumber,
    pub(crate) onset: CitedNumber,
    /// Angles between the major axes of stress and strain rate (degrees), in single frames and in means over 20 frames.
    pub(crate) angles: [CitedNumber; 2],
    /// Correlation coefficients: of two measures of friction, and of shear rates from two methods.
    pub(crate) correlations: [CitedNumber; 2],
    /// Number of bins of |I₀| whose worst error is tested at the paper's size. A further bin in `bins` of [`Silo`] is
    /// tested by its mean over the whole steady flow, because it contains few elements, all above the slit.
    pub(crate) first_bins: usize,
    /// Draining silo of the paper's size whose curve of φ against |I₀| is compared. The curves of `others` against |E|
    /// are compared then.
    pub(crate) beside: Option<&'static ComparedFlow>,
    /// Other flows of the paper's size, for figures and for the curves of φ against |E|.
    pub(crate) others: &'static [ComparedFlow],
}

/// Adds to a case what all silos share.
pub(crate) const fn case(
    head: Case,
    claims: &'static (dyn Fn() -> Vec<Claim> + Send + Sync),
    figures: fn(&Runner) -> Result<Vec<Figure>, RunError>,
) -> Case {
    Case { weakness: WEAKNESS, ..head }.with(LEVELS, 0, claims).drawn_by(figures)
}

/// Levels of resolution of silos. The claims use the first.
pub(crate) const LEVELS: &[Level] = &[time_step("dt=2.5e-4 s", 2.5e-4), time_step("dt=1e-4 s", 1e-4)];

/// Limitations of these cases.
const WEAKNESS: &str = "The silo has a tenth of the published size. The claims use one of ten deposits, and the spread \
                        between the ten gives the tolerances. At full size there is one deposit of each silo. The \
                        paper does not print the friction, which is assumed to be 0.5. `run` judges stored results. \
                        The tests repeat the runs at a tenth of the size, most of them in the long tier, and the \
                        full-size runs on request.";

/// Name and unit of the number of grains that have left the silo. The next constants name further quantities.
pub(crate) const GONE: [&str; 2] = ["grains out after 14 τ", "1"];
const SINE: [&str; 2] = ["mean sin φ of the flow", "1"];
const PACKING: [&str; 2] = ["mean packing fraction of the flow", "1"];
const PLATEAU: [&str; 2] = ["packing fraction of tracers strained by more than .4", "1"];
const ONSET: [&str; 2] = ["largest sin φ of tracers before they dilate, median", "1"];

/// Reason for tolerances from the spread over packings.
const PACKINGS: &str = "a deposit is a random sample: 99 % interval of the difference of two deposits, from ten of our \
                        own";

pub(crate) fn no_springs() -> Control {
    Control::contact_law("tangential springs a millionth as stiff", |law| law.scale_tangential(1e-6))
}

fn turned_gravity() -> Control {
    Control::scene("gravity turned by 10°", |scene| {
        let (sine, cosine) = 10.0_f64.to_radians().sin_cos();
        let down = scene.gravity.z;
        (scene.gravity.x, scene.gravity.z) = (-sine * down, cosine * down);
    })
    .long()
}

fn sine(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(mean(&steady(done, "sine_of_friction")?))
}

fn packing(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(mean(&steady(done, "packing_fraction")?))
}

impl Silo {
    /// Returns the run at a tenth of the paper's size.
    pub(crate) fn run(&self) -> Run {
        Run { set: self.set, ..Run::new(self.variants[0], "dem", LEVELS[0].resolution).read_by(ELEMENTS).kept() }
    }

    pub(super) const fn flow(&self) -> Flow {
        if self.drained.is_some() { Flow::Drained } else { Flow::Pushed }
    }

    /// Returns all claims, with further claims of one silo first.
    pub(crate) fn claims(&self, own: Vec<Claim>) -> Vec<Claim> {
        let of_drains = self.drained.as_ref().map(|drained| self.of_drains(drained)).unwrap_or_default();
        [own, self.of_every(), of_drains, self.of_paper_size()].concat()
    }

    /// Returns the figures of both sizes. `others` are flows that are drawn beside the flow at a tenth of the size.
    pub(crate) fn figures(&self, runner: &Runner, others: &[ComparedFlow]) -> Result<Vec<Figure>, RunError> {
        let done = runner.run(&self.run())?;
        let mut all = super::figures::all(&done, self.bins);
        if !others.is_empty() {
            all.extend(flows::figures(&done, self.label, others));
        }
        all.extend(self.paper_size_figures(runner));
        Ok(all)
    }

    fn of_every(&self) -> Vec<Claim> {
        let [of_sine, of_packing] = self.means;
        // In pushed silos, half the friction changes sin φ by less than the difference between ten packings.
        let control = match self.flow() {
            Flow::Drained => Control::contact_law("friction .25 for .5", |law| law.friction = 0.25),
            Flow::Pushed => no_springs(),
        };
        vec![
            self.equals(SINE, of_sine, control, sine),
            self.equals(PACKING, of_packing, no_springs(), packing),
            self.range_of_friction(of_sine.source()),
            self.beginning(),
            self.beside_lammps(SINE, sine),
            self.beside_lammps(PACKING, packing),
        ]
    }

    /// Returns the claims on draining silos only. In pushed silos, too few elements deform for these claims.
    fn of_drains(&self, drained: &Drained) -> Vec<Claim> {
        let at_large_strain = vec![
            self.equals(PLATEAU, drained.plateau, no_springs(), plateau),
            self.equals(ONSET, drained.onset, no_springs(), onset),
        ];
        [
            at_large_strain,
            self.over_inertia(self.bins),
            self.correlations(drained.correlations),
            self.coaxiality(drained.angles),
            vec![self.beside_lammps(PLATEAU, plateau), self.beside_lammps(ONSET, onset)],
        ]
        .concat()
    }

    /// Returns the claim that a quantity equals the prototype's value within the spread over packings. An angle may be
    /// zero, so its error is in units of 45°, the mean angle between two independent axes in the plane.
    pub(crate) fn equals(
        &self,
        [quantity, unit]: [&'static str; 2],
        cited: CitedNumber,
        control: Control,
        read: RunReader,
    ) -> Claim {
        let (scale, in_units) = if unit == "deg" { (45.0, "of 45°") } else { (cited.value.abs(), "of the value") };
        let allowed = (apart(self.packings, quantity) + cited.uncertainty) / scale;
        let because = format!("{PACKINGS}, plus the uncertainty of the prototype's mean; in units {in_units}");
        claim(quantity, unit)
            .run(self.run())
            .equals_cited(cited, scale, move |done| read(&done[0]))
            .within(computed(allowed, because))
            .refuses(control)
    }

    fn range_of_friction(&self, source: Source) -> Claim {
        claim(format!("part of the flowing elements with sin φ of .2 to .6, {}", self.flow().words()), "1")
            .run(self.run())
            .at_least(0.95, source, |done| Ok(share(&steady(&done[0], "sine_of_friction")?, [0.2, 0.6])))
            .within(exactly("required in advance: the source states the range but not the fraction of elements in it"))
            .refuses(Control::misread("tan φ taken for sin φ", ensemble::tangent))
    }

    /// Returns the claims on two correlations over elements: of two measures of friction, and of two strain rates. The
    /// negative controls shuffle the elements, so that the correlations vanish.
    fn correlations(&self, cited: [CitedNumber; 2]) -> Vec<Claim> {
        let [for_criteria, for_rates] =
            cited.map(|cited| format!("required in advance; the prototype has {}", cited.value));
        let [criteria, rates] = cited.map(|cited| cited.source());
        vec![
            claim("correlation of sin φ with Drucker and Prager's ratio", "1")
                .run(self.run())
                .at_least(0.92, criteria, |done| ensemble::of_criteria(&done[0]))
                .within(exactly(for_criteria))
                .refuses(ensemble::FRICTION_ELSEWHERE),
            claim("correlation of log |D₀| of the instant with that from positions .2 τ apart", "1")
                .run(self.run())
                .at_least(0.95, rates, |done| ensemble::of_rates(&done[0]))
                .within(exactly(for_rates))
                .refuses(ensemble::RATE_ELSEWHERE),
        ]
    }

    fn coaxiality(&self, cited: [CitedNumber; 2]) -> Vec<Claim> {
        let of_frames = ["angle between the axes of largest T and D in blocks of 5 d", "deg"];
        let of_windows = ["the same angle of means over 20 frames", "deg"];
        vec![
            self.equals(of_frames, cited[0], ensemble::STRESS_ELSEWHERE, |done| ensemble::angle(done, false)),
            self.equals(of_windows, cited[1], ensemble::STRESS_ELSEWHERE, |done| ensemble::angle(done, true)),
        ]
    }

    /// Returns the claim on the mean rotation from the major axis of stress to that of strain rate. Outward rotation is
    /// positive in both halves. The mean is small for a symmetric flow.
    pub(crate) fn turn(&self, cited: CitedNumber) -> Claim {
        let quantity = ["turn from T to D in the plane, with the sign of x", "deg"];
        self.equals(quantity, cited, ensemble::RATE_TURNED, ensemble::turn)
    }

    pub(crate) fn symmetry(&self) -> Claim {
        claim("mean shear stress T_xz over the pressure, of the whole silo", "1")
            .run(self.run())
            .holds("scene, walls and slit are their own mirror image in x = 0", |done| {
                Ok(Measurement::new(mean(&ensemble::whole(&done[0], "shear_over_pressure")?), 0.0, 1.0))
            })
            .within(judged(
                0.03,
                "the deposit is not mirror-symmetric; gravity tilted by 10° gives .07 in the prototype",
            ))
            .refuses(turned_gravity())
    }

    /// Returns the claims on the packing fraction φ in bins of the inertial number |I₀|: the largest error in a bin,
    /// and the mean error over the bins of flowing elements.
    fn over_inertia(&self, bins: &'static [CitedNumber]) -> Vec<Claim> {
        let cited = move || bins.iter().map(|cited| cited.value).enumerate();
        let mean_off = "packing fraction over |I₀| less that of the prototype, mean over bins";
        vec![
            claim("packing fraction over |I₀| in bins, worst", "1")
                .run(self.run())
                .equals(bins[0].source(), move |done| {
                    let full = cited().take(ensemble::FULL);
                    let found = ensemble::over_inertia(&done[0], f64::INFINITY)?;
                    Ok(ensemble::worst(&ensemble::in_bins_of(&found, full)?))
                })
                .within(required(
                    0.008,
                    "required in advance: two runs of the prototype differ by .005 to .008; in units of φ; bins up to \
                     |I₀| = .1 have enough elements for this tolerance",
                ))
                .refuses(no_springs()),
            claim(mean_off, "1")
                .run(self.run())
                .equals(bins[0].source(), move |done| {
                    // These are the bins from the second to the last but one, which the table of ten packings covers.
                    let middle = cited().skip(1).take(bins.len() - 2);
                    let pairs = ensemble::in_bins_of(&ensemble::over_inertia_flowing(&done[0])?, middle)?;
                    let off: Vec<f64> = pairs.iter().map(|[found, expected]| found - expected).collect();
                    Ok(Measurement::new(mean(&off), 0.0, 1.0))
                })
                .within(computed(apart(self.packings, mean_off), format!("{PACKINGS}; in units of φ")))
                .refuses(ensemble::DENSITY_OF_ONE),
        ]
    }

    pub(crate) fn deposit(&self, cited: CitedNumber) -> Claim {
        let quantity = ["packing fraction of the deposit", "1"];
        self.equals(quantity, cited, ensemble::LARGER_RADII, ensemble::deposit)
    }

    pub(crate) fn beside_lammps(&self, [quantity, unit]: [&'static str; 2], read: RunReader) -> Claim {
        let run = |solver| Run::new("beside", solver, LEVELS[0].resolution).read_by(ELEMENTS).kept().long();
        let control = Control::our_contact_law("tangential springs a millionth as stiff in ours", |law| {
            law.scale_tangential(1e-6)
        });
        let because = format!("because of chaos the two runs are independent samples after .8 τ; {PACKINGS}");
        let (spread, mean) = (apart(self.packings, quantity), mean_of(self.packings, quantity));
        let allowed = computed(spread / mean, format!("{because}; in units of the mean of ten packings"));
        row(quantity, unit, allowed, [run("dem:lammps"), run("lammps")], control, move |done| {
            Ok(Measurement::new(read(&done[0])?, read(&done[1])?, mean))
        })
    }

    /// Returns the claim that our solver agrees with LAMMPS until chaotic trajectories separate. Other claims may use
    /// stored results of our solver; this claim always runs our solver.
    fn beginning(&self) -> Claim {
        let run = |solver| Run::new("beginning", solver, LEVELS[0].resolution);
        let time = if self.set == Set::Long { 0.05 } else { 0.2 };
        let allowed = rounding(
            2.0 * (0.2_f64 / 0.033).exp(),
            "order of sums: the difference grows by e every .033 τ, up to .2 τ; an energy has twice the relative error \
             of velocities",
        );
        let control = Control::our_contact_law("friction .25 for .5 in ours", |law| law.friction = 0.25);
        let words = format!("kinetic energy up to {time} τ, worst");
        row(&words, "m g d", allowed, [run("dem:lammps"), run("lammps")], control, |done| {
            worst(done, &[ENERGY], largest(done[1].column(ENERGY)?))
        })
    }
}
