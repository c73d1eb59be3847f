//! One grain on a plane: closed forms, and scenes with a prescribed static overlap.
//!
//! With `i = I/(mR²)` (1/2 for a disc, 2/5 for a sphere), gravity along the plane g_t and onto it g_n, friction μ:
//!
//! ```text
//! rolls without slip iff g_t/g_n ≤ μ(1+i)/i         F = m g_t f,   f = i/(1+i)
//! rolling   a = g_t/(1+i)                            slipping   a = g_t − μ g_n,   R dΩ/dt = μ g_n/i
//! ```
//!
//! An elastic tangential spring k_t first sticks and oscillates. With slip velocity u = v − ΩR, F = k_t ∫u dt and du/dt
//! = g_t − (F/m)(1 + 1/i). Hence F/m = f g_t (1 − cos ωt) with ω² = (k_t/m)(1 + 1/i), until F/m reaches μ g_n. Sources:
//! Bardenhagen, Brackbill & Sulsky 2000, eq. 25; Bardenhagen et al. 2001, eqs. 23-26. The compliant forms are derived
//! here.

use grainbench_harness::prelude::*;
use grainbench_scene::contact_law::Springs;
use grainbench_scene::dimension::Dimension;

/// One grain, its plane and their contact law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OneGrain {
    /// Radius R (m).
    pub(crate) radius: f64,
    /// Mass m (kg).
    pub(crate) mass: f64,
    /// Inertia factor i = I/(mR²): 1/2 for a disc, 2/5 for a sphere.
    pub(crate) inertia_factor: f64,
    /// Gravity along the plane g_t (m/s²), down the slope.
    pub(crate) along: f64,
    /// Gravity onto the plane g_n (m/s²).
    pub(crate) onto: f64,
    /// Friction coefficient μ.
    pub(crate) friction: f64,
    /// Tangential stiffness k_t (N/m), at the static overlap.
    pub(crate) tangential_stiffness: f64,
    /// Initial spin Ω₀ in the direction that drives the grain down the slope (rad/s).
    pub(crate) spin: f64,
    /// Static overlap divided by the radius.
    pub(crate) overlap_ratio: f64,
    /// Normal stiffness at the static overlap (N/m).
    pub(crate) normal_stiffness: f64,
    /// Tangential damping divided by the mass, γ_t (1/s), without the damping that is proportional to the stiffness.
    pub(crate) tangential_damping: f64,
}

/// Motion of the grain down the slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct State {
    /// Displacement down the slope (m).
    pub(crate) x: f64,
    /// Velocity down the slope (m/s).
    pub(crate) v: f64,
    /// Spin in the direction of rolling down (rad/s).
    pub(crate) omega: f64,
}

impl OneGrain {
    /// Reads a scene with one grain on a plane. The normal of the plane is y in two dimensions, z in three.
    pub(crate) fn from_scene(scene: &Scene) -> Self {
        let grain = &scene.grains[0];
        let law = scene.laws.iter().flatten().next().copied().unwrap_or_default();
        let onto = -scene.gravity[normal_axis(scene)];
        let overlap = static_overlap(&law.springs, grain.mass * onto, grain.radius);
        let (normal_stiffness, tangential_stiffness) = law.springs.stiffness(overlap, grain.radius);
        Self {
            radius: grain.radius,
            mass: grain.mass,
            inertia_factor: grain.inertia / (grain.mass * grain.radius * grain.radius),
            along: scene.gravity.x,
            onto,
            friction: law.friction,
            tangential_stiffness,
            spin: match scene.dimension {
                Dimension::Two => -grain.spin.z,
                Dimension::Three => grain.spin.y,
            },
            overlap_ratio: overlap / grain.radius,
            normal_stiffness,
            tangential_damping: law.tangential_damping,
        }
    }

    /// Returns f = i/(1+i), the friction force on a rolling grain divided by the gravity force along the plane.
    pub(crate) fn share(&self) -> f64 {
        self.inertia_factor / (1.0 + self.inertia_factor)
    }

    /// Returns true if a rigid grain rolls without slip.
    pub(crate) fn sticks(&self) -> bool {
        self.along * self.share() <= self.friction * self.onto
    }

    /// Returns the state at t (s) of a rigid grain released from rest on the slope.
    pub(crate) fn rigid_incline(&self, t: f64) -> State {
        if self.sticks() {
            let a = self.along / (1.0 + self.inertia_factor);
            State { x: 0.5 * a * t * t, v: a * t, omega: a * t / self.radius }
        } else {
            let a = self.along - self.friction * self.onto;
            let turn = self.friction * self.onto / (self.inertia_factor * self.radius);
            State { x: 0.5 * a * t * t, v: a * t, omega: turn * t }
        }
    }

    /// Returns the frequency of the tangential spring, ω² = (k_t/m)(1 + 1/i) (rad/s).
    fn tangential_frequency(&self) -> f64 {
        (self.tangential_stiffness / self.mass * (1.0 + 1.0 / self.inertia_factor)).sqrt()
    }

    /// Returns the latest time (s) at which friction is fully mobilised, for any release height within the static
    /// overlap: half a period of the tangential spring plus half a period of the normal spring.
    pub(crate) fn onset(&self) -> f64 {
        PI / self.tangential_frequency() + PI / (self.normal_stiffness / self.mass).sqrt()
    }

    /// Returns the amplitude a/ω (m/s) of the slip velocity of a rolling grain on an undamped tangential spring, for a
    /// force per mass a (m/s²).
    pub(crate) fn ringing(&self, acceleration: f64) -> f64 {
        acceleration / self.tangential_frequency()
    }

    /// Returns the displacement of the tangential spring (m) under a force per mass a (m/s²): m a/k_t.
    pub(crate) fn stretch(&self, acceleration: f64) -> f64 {
        self.mass * acceleration / self.tangential_stiffness
    }

    /// Returns the time of the Coulomb limit of the undamped spring, arccos(1 − μ g_n/(f g_t))/ω (s); NaN if never.
    pub(crate) fn slips_from(&self) -> f64 {
        (1.0 - self.friction * self.onto / (self.share() * self.along)).acos() / self.tangential_frequency()
    }

    /// Returns the largest relative deviation from the rigid solution at t (s) that a tangential spring can cause, for
    /// a grain released on the slope. A sliding grain has no friction until an undamped spring reaches the Coulomb
    /// limit, and full friction from then on. For a rolling grain, the spring oscillates by up to twice its
    /// displacement f g_t/ω², and the final velocities are those of the rigid grain.
    pub(crate) fn compliance(&self, t: f64) -> State {
        let exact = self.rigid_incline(t);
        if self.sticks() {
            let stretch = self.share() * self.along / self.tangential_frequency().powi(2);
            return State { x: 2.0 * stretch / exact.x, v: 0.0, omega: 0.0 };
        }
        let late = self.slips_from();
        let velocity = late * self.friction * self.onto / exact.v;
        State { x: 2.0 * velocity, v: velocity, omega: late / t }
    }

    /// Returns the fraction of a slip velocity that remains after t (s), while tangential spring and dashpot oscillate
    /// about rolling: e^{−λt}. λ is the slower rate of s″ + 2b s′ + ω² s = 0, 2b = γ_t (1 + 1/i).
    pub(crate) fn rung(&self, t: f64) -> f64 {
        (-self.settling_rate() * t).exp()
    }

    /// Returns the slower decay rate λ (1/s) of the slip velocity.
    fn settling_rate(&self) -> f64 {
        let (half, omega) =
            (0.5 * self.tangential_damping * (1.0 + 1.0 / self.inertia_factor), self.tangential_frequency());
        if half > omega { half - (half * half - omega * omega).sqrt() } else { half }
    }

    /// Returns the frequency (rad/s) of a grain on its rolling spring (Ai, Chen, Rotter & Ooi 2011): ω_r² = k_r/((1 +
    /// i)mR²) with k_r = 2.25 k_n μ_r² R².
    pub(crate) fn rolling_frequency(&self, rolling_friction: f64) -> f64 {
        let moment = (1.0 + self.inertia_factor) * self.mass;
        1.5 * rolling_friction * (self.normal_stiffness / moment).sqrt()
    }

    /// Returns the remaining fraction of the initial acceleration of a grain on a critically damped rolling spring,
    /// averaged from t to 2t. With v = a t e^{−ω_r t}, the average is at most e^{−ω_r t}. The time is reduced by 1/λ,
    /// the delay of the friction force behind the slip velocity.
    pub(crate) fn rolled(&self, rolling_friction: f64, t: f64) -> f64 {
        (-self.rolling_frequency(rolling_friction) * (t - 1.0 / self.settling_rate())).exp()
    }

    /// Returns the lag (m) of a grain behind the rigid solution at the end of sliding, if the dashpot force counts in
    /// the Coulomb limit. Below the slip velocity s_c = γ_t μ g_n (1 + 1/i)/(k_t/m), the spring grows too slowly and
    /// friction falls below its limit. The remaining slip has ∫s dt < s_c γ_t/(k_t/m). The lag is the fraction f of
    /// this integral.
    pub(crate) fn tail(&self) -> f64 {
        let follows = self.tangential_damping * self.mass / self.tangential_stiffness;
        self.share() * follows * follows * self.friction * self.onto * (1.0 + 1.0 / self.inertia_factor)
    }

    /// Returns the state at t (s) of a grain released from rest on the slope with an undamped tangential spring.
    pub(crate) fn compliant_incline(&self, t: f64) -> State {
        let (i, f, g) = (self.inertia_factor, self.share(), self.along);
        let omega = self.tangential_frequency();
        let stick = |t: f64| State {
            x: g * ((1.0 - f) * t * t / 2.0 + f * (1.0 - (omega * t).cos()) / (omega * omega)),
            v: g * ((1.0 - f) * t + f * (omega * t).sin() / omega),
            omega: g * f / (i * self.radius) * (t - (omega * t).sin() / omega),
        };
        let slips_from = self.slips_from();
        if slips_from.is_nan() || t <= slips_from {
            return stick(t);
        }
        let (start, tau) = (stick(slips_from), t - slips_from);
        let slide = self.rigid_incline(1.0).v;
        let turn = self.friction * self.onto / (i * self.radius);
        State {
            x: start.x + start.v * tau + 0.5 * slide * tau * tau,
            v: start.v + slide * tau,
            omega: start.omega + turn * tau,
        }
    }

    /// Returns the state at t (s) of a rigid grain that is placed on a flat plane with spin Ω₀ and no velocity. It
    /// slides until v = ΩR, then rolls.
    pub(crate) fn rigid_backspin(&self, t: f64) -> State {
        let a = self.friction * self.onto;
        let last = self.radius * self.spin * self.share();
        let until = last / a;
        if t < until {
            let turn = a / (self.inertia_factor * self.radius);
            State { x: 0.5 * a * t * t, v: a * t, omega: self.spin - turn * t }
        } else {
            State { x: 0.5 * a * until * until + last * (t - until), v: last, omega: last / self.radius }
        }
    }

    /// Returns the lever arm of friction (m) in the contact convention of a solver: R − overlap/2 for LIGGGHTS, R for LAMMPS.
    pub(crate) fn arm(&self, solver: &str) -> f64 {
        if solver == "dem:liggghts" { self.radius * (1.0 - 0.5 * self.overlap_ratio) } else { self.radius }
    }

    /// Returns the velocity of rolling down the slope at t (m/s) if tangential forces have the lever arm a (`arm`)
    /// instead of R. v(1 + i(R/a)²) = g_t t follows from m dv/dt = m g_t − F, I dΩ/dt = aF and v = aΩ.
    pub(crate) fn rolling_velocity(&self, t: f64, arm: f64) -> f64 {
        self.along * t / (1.0 + self.inertia_factor * (self.radius / arm).powi(2))
    }

    /// Returns the final velocity after backspin with the lever arm a (`arm`) (m/s): iR²(Ω₀ − Ω) = a v and v = aΩ.
    pub(crate) fn backspin_velocity(&self, arm: f64) -> f64 {
        let moment = self.inertia_factor * self.radius * self.radius;
        moment * self.spin * arm / (arm * arm + moment)
    }
}

/// Returns the overlap (m) at which the springs balance a force (N), for a grain of this radius (m) on a plane: F/k_n,
/// or by Hertz's law (3F/(4E*√R))^{2/3}.
#[must_use]
pub fn static_overlap(springs: &Springs, force: f64, radius: f64) -> f64 {
    match *springs {
        Springs::Absent => 0.0,
        Springs::Linear { normal, .. } => force / normal,
        Springs::Hertz { effective_modulus, .. } => {
            (0.75 * force / (effective_modulus * radius.sqrt())).max(0.0).cbrt().powi(2)
        }
    }
}

/// Returns the axis of the plane's normal: 1 (y) in two dimensions, 2 (z) in three.
pub(crate) fn normal_axis(scene: &Scene) -> usize {
    scene.dimension.count() - 1
}

/// Sets stiffness and start so that the grain rests at a static overlap of `ratio`·R: k_n = m g_n/(ratio R), k_t =
/// (2/7) k_n. The normal damping ratio is ζ and the tangential coefficient is equal: γ_n = γ_t = 2ζ√(k_n/m).
pub(crate) fn rest_at_overlap(scene: &mut Scene, ratio: f64, damping_ratio: f64) {
    let axis = normal_axis(scene);
    let onto = -scene.gravity[axis];
    let grain = &mut scene.grains[0];
    grain.position[axis] = grain.radius * (1.0 - ratio);
    let stiffness = grain.mass * onto / (ratio * grain.radius);
    let damping = 2.0 * damping_ratio * (stiffness / grain.mass).sqrt();
    scene.change_laws(|law| {
        law.springs = Springs::Linear { normal: stiffness, tangential: stiffness * 2.0 / 7.0 };
        law.normal_damping = damping;
        law.tangential_damping = damping;
    });
}

/// Returns time (s) and state of the probe `grain` at each sample; an error if the record lacks the probe.
pub(crate) fn course(done: &FinishedRun) -> Result<Vec<(f64, State)>, MissingData> {
    let (x, v) = (done.column("grain.x")?, done.column("grain.vx")?);
    let (spin, sign) = match done.scene.dimension {
        Dimension::Two => (done.column("grain.omega")?, -1.0),
        Dimension::Three => (done.column("grain.omega_y")?, 1.0),
    };
    let start = done.scene.grains[0].position.x;
    let samples = done.series().time.iter().zip(x).zip(v).zip(spin);
    Ok(samples.map(|(((&t, x), &v), omega)| (t, State { x: x - start, v, omega: sign * omega })).collect())
}

/// Returns time (s) and state of the last sample; an error without probe or samples.
pub(crate) fn last(done: &FinishedRun) -> Result<(f64, State), MissingData> {
    course(done)?.last().copied().ok_or_else(|| "samples".into())
}

/// Returns time (s) and state of the sample nearest to the time `moment` (s); an error without probe or samples.
pub(crate) fn nearest(done: &FinishedRun, moment: f64) -> Result<(f64, State), MissingData> {
    let course = course(done)?;
    let near = course.iter().min_by(|a, b| (a.0 - moment).abs().total_cmp(&(b.0 - moment).abs()));
    near.copied().ok_or_else(|| "samples".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a disc of 2 kg and 0.5 m on a slope of 60°, μ = 0.3, k_n = 2e4 N/m, k_t = (2/7) k_n, γ_t = 100/s.
    fn disc() -> OneGrain {
        OneGrain {
            radius: 0.5,
            mass: 2.0,
            inertia_factor: 0.5,
            along: 8.5,
            onto: 4.9,
            friction: 0.3,
            tangential_stiffness: 2e4 * 2.0 / 7.0,
            spin: 10.0,
            overlap_ratio: 1e-3,
            normal_stiffness: 2e4,
            tangential_damping: 100.0,
        }
    }

    /// Checks that the closed form of the undamped spring nearly reaches the bound of `compliance`.
    #[test]
    fn an_undamped_spring_takes_no_more_than_compliance_says() {
        let worst = |grain: OneGrain, component: fn(State) -> f64| {
            let used = |t: f64| {
                let exact = component(grain.rigid_incline(t));
                ((component(grain.compliant_incline(t)) - exact) / exact).abs() / component(grain.compliance(t))
            };
            (0..200).map(|at| used(1.0 + 1e-3 * f64::from(at))).fold(0.0, f64::max)
        };
        let rolls = worst(OneGrain { friction: 1.5, ..disc() }, |state| state.x);
        assert!((0.99..1.0 + 1e-9).contains(&rolls), "{rolls}");
        let all: [fn(State) -> f64; 3] = [|state| state.x, |state| state.v, |state| state.omega];
        for component in all {
            let slips = worst(disc(), component);
            assert!((0.4..1.0).contains(&slips), "{slips}");
        }
    }

    /// Integrates s″ + 2b s′ + ω² s = 0 for the slip velocity s, which decays at the slower rate. At the end of a
    /// slide, the lag of the grain is between a third of the bound and the bound.
    #[test]
    fn the_end_of_a_slide_is_that_of_a_damped_spring() {
        let grain = disc();
        let factor = 1.0 + 1.0 / grain.inertia_factor;
        let (damping, square) = (factor * grain.tangential_damping, factor * grain.tangential_stiffness / grain.mass);
        let slows = factor * grain.friction * grain.onto;
        let start =
            grain.tangential_damping * grain.mass / grain.tangential_stiffness * grain.friction * grain.onto * factor;
        let (mut slip, mut rate, mut way, step) = (start, -slows, 0.0, 1e-6);
        let mut early = f64::NAN;
        for at in 0..300_000 {
            if at == 200_000 {
                early = slip;
            }
            rate -= (damping * rate + square * slip) * step;
            slip += rate * step;
            way += slip * step;
        }
        assert!((slip / early / grain.rung(0.1) - 1.0).abs() < 1e-3, "{} of {}", slip / early, grain.rung(0.1));
        let lacks = grain.share() * (way - 0.5 * start * start / slows);
        assert!(lacks < grain.tail() && lacks > grain.tail() / 3.0, "{lacks} of {}", grain.tail());
    }

    /// Integrates a grain that comes to rest on its tangential spring and its rolling spring. The remaining
    /// acceleration is between half of the bound and the bound.
    #[test]
    fn a_grain_comes_to_rest_on_its_rolling_spring() {
        let (grain, rolling_friction, half, step) = (disc(), 0.05, 2.0, 1e-5);
        let about_contact = (1.0 + grain.inertia_factor) * grain.mass * grain.radius.powi(2);
        let stiffness = 2.25 * grain.normal_stiffness * (rolling_friction * grain.radius).powi(2);
        let damping = 2.0 * (about_contact * stiffness).sqrt();
        let (mut speed, mut spin, mut slipped, mut angle) = (0.0, 0.0, 0.0, 0.0);
        let mut after = |steps: u32| {
            for _ in 0..steps {
                let slip = speed - spin * grain.radius;
                let friction = grain.tangential_stiffness * slipped + grain.tangential_damping * grain.mass * slip;
                let moment = stiffness * angle + damping * spin;
                speed += (grain.along - friction / grain.mass) * step;
                spin += (friction * grain.radius - moment) * step
                    / (grain.inertia_factor * grain.mass * grain.radius.powi(2));
                slipped += (speed - spin * grain.radius) * step;
                angle += spin * step;
            }
            speed
        };
        let [early, late] = [200_000, 200_000].map(&mut after);
        let left = (early - late) / half / (grain.along / (1.0 + grain.inertia_factor));
        let expected = grain.rolled(rolling_friction, half);
        assert!(left < expected && left > 0.5 * expected, "{left} of {expected}");
    }
}
