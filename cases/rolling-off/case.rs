//! A ball rolls off a fixed ball: its spin and velocity after separation, and the angle of separation.

use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const STEP: Level = LEVELS[1];

pub(crate) static CASE: Case = crate::heads::ROLLING_OFF.with(LEVELS, 1, &claims);

/// Fixed ball and rolling ball.
struct Balls {
    gravity: f64,
    friction: f64,
    radius: f64,
    /// Distance of the centres in contact (m).
    distance: f64,
    /// Initial angle of the line of centres from the vertical (rad).
    angle: f64,
    /// Largest relative error of the velocity.
    off: f64,
}

/// Angle of the line of centres (rad), velocity v (m/s) and surface speed ωR (m/s).
type State = [f64; 3];

impl Balls {
    fn from_scene(scene: &Scene) -> Self {
        let [fixed, ball] = [&scene.grains[0], &scene.grains[1]];
        let law = scene.laws[0].unwrap_or_default();
        let (gravity, distance) = (scene.gravity.norm(), ball.radius + fixed.radius);
        let angle = ball.position.x.atan2(ball.position.z);
        let swing = 2.0 / 7.0 * gravity * angle.sin() / (3.5 * law.tangential_stiffness() / ball.mass).sqrt();
        let fast = (gravity * distance * 10.0 / 17.0).sqrt();
        let overlap = ball.mass * gravity / law.normal_stiffness();
        let step = STEP.step(scene);
        let off = (swing + gravity * step) / fast + overlap / distance + overlap / ball.radius;
        Self { gravity, friction: law.friction, radius: ball.radius, distance, angle, off }
    }

    /// Returns the normal force divided by the mass (m/s²).
    fn press(&self, [angle, speed, _]: State) -> f64 {
        self.gravity * angle.cos() - speed * speed / self.distance
    }

    /// Returns the time derivatives of a state, for rolling or slipping.
    fn rates(&self, state: State, slips: bool) -> State {
        let down = self.gravity * state[0].sin();
        let friction = if slips { self.friction * self.press(state).max(0.0) } else { 2.0 / 7.0 * down };
        [state[1] / self.distance, down - friction, 2.5 * friction]
    }

    /// Returns the state at separation.
    fn leaves(&self) -> State {
        let step = 1e-5;
        let mut state = [self.angle, 0.0, 0.0];
        let mut slips = false;
        while self.press(state) > 0.0 {
            slips |= 2.0 / 7.0 * self.gravity * state[0].sin() > self.friction * self.press(state);
            let moved =
                |from: State, by: State, part: f64| -> State { [0, 1, 2].map(|at| from[at] + part * step * by[at]) };
            let first = self.rates(state, slips);
            let second = self.rates(moved(state, first, 0.5), slips);
            let third = self.rates(moved(state, second, 0.5), slips);
            let fourth = self.rates(moved(state, third, 1.0), slips);
            state = [0, 1, 2]
                .map(|at| state[at] + step / 6.0 * (first[at] + 2.0 * second[at] + 2.0 * third[at] + fourth[at]));
        }
        state
    }
}

fn claims() -> Vec<Claim> {
    let mut claims = vec![angle()];
    for variant in ["rough", "slippery"] {
        claims.push(kept(variant, "spin after it has left", "rad/s", "ball.omega_y", |balls| {
            balls.leaves()[2] / balls.radius
        }));
        claims.push(kept(variant, "velocity along x after it has left", "m/s", "ball.vx", |balls| {
            let [angle, speed, _] = balls.leaves();
            speed * angle.cos()
        }));
    }
    claims
}

fn off(variant: &str, times: f64) -> Tolerance {
    computed(
        CASE.number(variant, |scene| times * Balls::from_scene(scene).off),
        "vibration of the spring at the start, (2/7) g sin θ₀/ω_t, and one step of gravity, relative to the velocity; \
         overlap over the distance and over the radius",
    )
}

/// Returns the claim on the angle cos θ = (10/17) cos θ₀ of separation, from the spin: ω²R² = g d cos θ.
fn angle() -> Claim {
    claim("cosine of the angle at which the rough ball leaves, from its spin", "1")
        .run(Run::new("rough", "dem", STEP.resolution))
        .equals(Source::Derived("energy and v = ωR: cos θ = (10/17) cos θ₀ (derivation)"), |done| {
            let balls = Balls::from_scene(&done[0].scene);
            let surface = done[0].last("ball.omega_y")? * balls.radius;
            let exact = 10.0 / 17.0 * balls.angle.cos();
            Ok(Measurement::relative(surface * surface / (balls.gravity * balls.distance), exact))
        })
        .within(off("rough", 2.0))
        .refuses(Control::scene("the inertia of a disc", |scene| scene.grains[1].inertia *= 1.25))
        .solver_independent_springs()
}

fn kept(
    variant: &'static str,
    quantity: &str,
    unit: &'static str,
    column: &'static str,
    exact: fn(&Balls) -> f64,
) -> Claim {
    let control = if variant == "rough" {
        Control::scene("the inertia of a disc", |scene| scene.grains[1].inertia *= 1.25)
    } else {
        Control::contact_law("friction × 1.05", |law| law.friction *= 1.05)
    };
    claim(format!("{quantity}, {variant}"), unit)
        .run(Run::new(variant, "dem", STEP.resolution))
        .equals(Source::Derived("Newton's law with Coulomb's, by Runge and Kutta's method (derivation)"), move |done| {
            Ok(Measurement::relative(done[0].last(column)?, exact(&Balls::from_scene(&done[0].scene))))
        })
        .within(off(variant, 1.0))
        .refuses(control)
        .solver_independent_springs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the integration reproduces the closed form of the rough ball.
    #[test]
    fn the_rough_ball_leaves_at_ten_seventeenths() {
        let balls = Balls::from_scene(&CASE.variant("rough").unwrap());
        let [angle, speed, surface] = Balls { friction: 1e9, ..balls }.leaves();
        let exact = 10.0 / 17.0 * CASE.variant("rough").map(|scene| Balls::from_scene(&scene).angle.cos()).unwrap();
        assert!((angle.cos() - exact).abs() < 1e-4 && (speed - surface).abs() < 1e-9, "{} {exact}", angle.cos());
    }
}
