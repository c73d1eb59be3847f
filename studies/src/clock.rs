//! Time of the processor, which another program at work disturbs less than it does the clock on the wall.

use std::hint::black_box;
use std::time::Instant;

/// Processor time of this process and of the programs that it ran and that have ended (s); wall-clock time since the first
/// call where the system does not tell.
#[must_use]
pub fn cpu_seconds() -> f64 {
    #[cfg(unix)]
    {
        use nix::sys::resource::{UsageWho, getrusage};
        let of = |who| {
            getrusage(who).map(|usage| {
                let seconds = |time: nix::sys::time::TimeVal| time.tv_sec() as f64 + 1e-6 * time.tv_usec() as f64;
                seconds(usage.user_time()) + seconds(usage.system_time())
            })
        };
        if let (Ok(own), Ok(children)) = (of(UsageWho::RUSAGE_SELF), of(UsageWho::RUSAGE_CHILDREN)) {
            return own + children;
        }
    }
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Processor time of a fixed piece of arithmetic that no change of this program's solvers touches (s), the shortest of
/// three: what a time is divided by when two sessions are compared, so that a machine that was slower for a while is not
/// taken for a program that is. About a millisecond.
#[must_use]
pub fn reference_seconds() -> f64 {
    (0..3)
        .map(|_| {
            let start = cpu_seconds();
            black_box(arithmetic(black_box(1.0)));
            cpu_seconds() - start
        })
        .fold(f64::INFINITY, f64::min)
}

/// Springs between sixty-four points in a row: multiplications, additions, square roots and a cache line now and then, as in
/// the loops of solvers.
fn arithmetic(stretch: f64) -> f64 {
    let mut place = [0.0_f64; 64];
    let mut speed = [0.0_f64; 64];
    for (at, x) in place.iter_mut().enumerate() {
        *x = stretch * at as f64;
    }
    for _ in 0..2000 {
        for at in 1..63 {
            let (left, right) = (place[at] - place[at - 1], place[at + 1] - place[at]);
            speed[at] += 1e-3 * ((right * right + 1e-6).sqrt() - (left * left + 1e-6).sqrt());
        }
        for (x, v) in place.iter_mut().zip(&speed) {
            *x += 1e-3 * v;
        }
    }
    place[32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_passes_while_the_processor_works() {
        let (before, start) = (cpu_seconds(), Instant::now());
        while start.elapsed().as_secs_f64() < 0.05 {
            black_box(arithmetic(1.0));
        }
        let (after, wall) = (cpu_seconds(), start.elapsed().as_secs_f64());
        assert!(after > before && after - before < 3.0 * wall, "{before} {after}");
        assert!(reference_seconds() > 1e-6);
    }
}
