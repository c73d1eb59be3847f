//! Search for the prescribed wall motion: the strain ratio that leads to stage A, and the strain of stage B.

use super::walls::{Course, drive, run, run_elastic, size, watch};
use grainbench::cases::stage::{NEAR_IN_GROWTH, NEAR_IN_OVERLAP, NEAR_IN_RATIO, Stage};
use grainbench::scene::motion::Moment;
use grainbench::scene::scene::{Duration, Scene};
use grainbench::solver::record::Snapshot;
use std::error::Error;

/// Ratio F_H/F_V of horizontal to vertical wall force at stage A.
const RATIO: f64 = 0.39;
/// Mean overlap divided by the mean radius at stage A.
const OVERLAP: f64 = 1e-3;
/// F_V at stage B divided by F_V at stage A.
const GROWTH: f64 = 1.04348;
/// Vertical strain after which the search at one strain ratio ends. A strain ratio that needs a larger strain has no
/// stage A.
const FAR: f64 = 0.1;

/// Times (s) of a scene: first stop of the walls, stage A, second stop of the walls, stage B.
#[derive(Clone, Copy)]
struct Times {
    stop: f64,
    a: f64,
    stop_again: f64,
    b: f64,
}

/// Wall motion as strains relative to the initial box.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WallStrains {
    /// Inward vertical strain up to stage A.
    pub(crate) strain: f64,
    /// Outward horizontal strain divided by inward vertical strain, up to stage A.
    pub(crate) ratio: f64,
    /// Inward vertical and outward horizontal strain from stage A to stage B.
    pub(crate) further: f64,
}

/// Function that runs a scene for a time (s) and returns the final snapshot.
type Run = fn(&Scene, f64) -> Result<Snapshot, Box<dyn Error>>;

/// Solver and initial values of the search, for discs with spring contacts or for elastic discs. A run with elastic
/// discs takes a thousand times the computing time of a run with spring contacts. The walls then move so fast that the
/// forces during the motion have no meaning.
struct Manner {
    run: Run,
    /// First strain ratio tried for stage A, in units of 1/5.
    first: i32,
    /// First strain tried after stage A. If it is `None`, a run with moving walls determines it.
    further: Option<f64>,
    /// Factor by which a strain after stage A increases if it was too small.
    widen: f64,
    /// True if contact forces relax at rest. The growth of F_V is then relative to F_V at the time of stage B in a run
    /// without wall motion after stage A.
    relaxes: bool,
}

const SPRINGS: Manner = Manner { run, first: -2, further: None, widen: 1.08, relaxes: false };
const ELASTIC: Manner = Manner { run: run_elastic, first: 3, further: Some(1e-4), widen: 1.5, relaxes: true };

/// A packing and the search for its wall motion.
pub(crate) struct Search<'s> {
    scene: &'s Scene,
    times: Times,
    manner: Manner,
}

impl<'s> Search<'s> {
    /// Reads the times of the stages from the motion of the first wall and the duration of the scene.
    pub(crate) fn new(scene: &'s Scene) -> Result<Self, Box<dyn Error>> {
        let (Some([first, second]), Duration::Seconds(b)) =
            (scene.walls.first().map(|wall| &wall.motion.phases[..]), scene.duration)
        else {
            return Err("walls that move twice, and a duration in seconds".into());
        };
        let seconds = |moment: Moment| moment.seconds(f64::NAN);
        let times = Times { stop: seconds(first.stop), a: seconds(second.start), stop_again: seconds(second.stop), b };
        let manner = if scene.deformable.iter().any(Option::is_some) { ELASTIC } else { SPRINGS };
        Ok(Self { scene, times, manner })
    }

    /// Returns the scene with this wall motion.
    pub(crate) fn driven(&self, imposed: &WallStrains) -> Scene {
        let mut scene = self.scene.clone();
        let ([width, height], times) = (size(self.scene), self.times);
        let ends = 0.5 * imposed.strain * height / times.stop;
        let sides = 0.5 * imposed.strain * imposed.ratio * width / times.stop;
        let after = 0.5 * imposed.further / (times.stop_again - times.a);
        drive(
            &mut scene,
            &[
                Course { sides, ends, from: 0.0, to: times.stop },
                Course { sides: after * width, ends: after * height, from: times.a, to: times.stop_again },
            ],
        );
        scene
    }

    /// Finds the strains up to stage A and from stage A to stage B.
    pub(crate) fn impose(&self) -> Result<WallStrains, Box<dyn Error>> {
        let a = self.to_a()?;
        self.to_b(a)
    }

    /// Finds the vertical strain at which the mean overlap is that of stage A, for one strain ratio. The first trial is
    /// the strain `guess`. Returns `None` if the strain exceeds [`FAR`].
    fn at_overlap(&self, ratio: f64, guess: f64) -> Result<Option<(WallStrains, Stage)>, Box<dyn Error>> {
        let at = |strain: f64| -> Result<(WallStrains, Stage), Box<dyn Error>> {
            let imposed = WallStrains { strain, ratio, further: 0.0 };
            Ok((imposed, Stage::from_snapshot(&(self.manner.run)(&self.driven(&imposed), self.times.a)?)))
        };
        let off = |(_, stage): &(WallStrains, Stage)| stage.overlap - OVERLAP;
        let (mut low, mut of_low, mut high) = (0.0, -OVERLAP, at(guess)?);
        while off(&high) < 0.0 {
            (low, of_low) = (high.0.strain, off(&high));
            if low > FAR {
                return Ok(None);
            }
            high = at(1.3 * low)?;
        }
        let mut best = high;
        for _ in 0..8 {
            if off(&best).abs() < NEAR_IN_OVERLAP {
                break;
            }
            let part = (-of_low / (off(&high) - of_low)).clamp(0.1, 0.9);
            let middle = at(low + part * (high.0.strain - low))?;
            if off(&middle).abs() < off(&best).abs() {
                best = middle;
            }
            if off(&middle) < 0.0 { (low, of_low) = (middle.0.strain, off(&middle)) } else { high = middle }
        }
        Ok(Some(best))
    }

    /// Finds stage A. The strain ratio increases in steps of 1/5 until F_H/F_V falls below the required value.
    /// Interpolation between the last two strain ratios then gives the result.
    fn to_a(&self) -> Result<(WallStrains, Stage), Box<dyn Error>> {
        let mut before: Option<(WallStrains, Stage)> = None;
        for fifth in self.manner.first..10 {
            let guess = before.map_or(1e-3, |(imposed, _)| imposed.strain);
            let Some(now) = self.at_overlap(0.2 * f64::from(fifth), guess)? else { break };
            if let Some(before) = before.filter(|before| before.1.ratio() > RATIO && now.1.ratio() < RATIO) {
                return self.between(before, now);
            }
            if (now.1.ratio() - RATIO).abs() < NEAR_IN_RATIO {
                return Ok(now);
            }
            before = Some(now);
        }
        Err(format!("F_H/F_V never falls to {RATIO} at this overlap").into())
    }

    fn between(
        &self,
        mut above: (WallStrains, Stage),
        mut below: (WallStrains, Stage),
    ) -> Result<(WallStrains, Stage), Box<dyn Error>> {
        let off = |(_, stage): &(WallStrains, Stage)| (stage.ratio() - RATIO).abs();
        let mut best = if off(&above) < off(&below) { above } else { below };
        for _ in 0..10 {
            if off(&best) < NEAR_IN_RATIO {
                break;
            }
            let (high, low) = (above.1.ratio(), below.1.ratio());
            let part = ((high - RATIO) / (high - low)).clamp(0.15, 0.85);
            let ratio = above.0.ratio + part * (below.0.ratio - above.0.ratio);
            let guess = above.0.strain.min(below.0.strain);
            let Some(middle) = self.at_overlap(ratio, guess)? else { break };
            if off(&middle) < off(&best) {
                best = middle;
            }
            if middle.1.ratio() > RATIO { above = middle } else { below = middle }
        }
        Ok(best)
    }

    /// Finds the strain from stage A to stage B at which F_V at rest has the required growth. The first trial is
    /// [`Manner::further`]. If it is `None`, a run with moving walls gives the first trial.
    fn to_b(&self, (a, of_a): (WallStrains, Stage)) -> Result<WallStrains, Box<dyn Error>> {
        let alone = if self.manner.relaxes {
            Stage::from_snapshot(&(self.manner.run)(&self.driven(&a), self.times.b)?)
        } else {
            of_a
        };
        let grown = |stage: &Stage| stage.vertical / alone.vertical - GROWTH;
        let guess = match self.manner.further {
            Some(guess) => guess,
            None => self.on_the_way(&a, &grown)?,
        };
        let at = |further: f64| -> Result<(f64, f64), Box<dyn Error>> {
            let scene = self.driven(&WallStrains { further, ..a });
            Ok((further, grown(&Stage::from_snapshot(&(self.manner.run)(&scene, self.times.b)?))))
        };
        let (mut low, mut high) = ((0.0, 1.0 - GROWTH), at(guess)?);
        for _ in 0..40 {
            if high.1 >= 0.0 {
                break;
            }
            low = high;
            high = at(self.manner.widen * low.0)?;
        }
        let mut best = high;
        for _ in 0..12 {
            if best.1.abs() < NEAR_IN_GROWTH {
                break;
            }
            let part = (-low.1 / (high.1 - low.1)).clamp(0.1, 0.9);
            let middle = at(low.0 + part * (high.0 - low.0))?;
            if middle.1.abs() < best.1.abs() {
                best = middle;
            }
            if middle.1 < 0.0 { low = middle } else { high = middle }
        }
        Ok(WallStrains { further: best.0, ..a })
    }

    /// Returns the strain after stage A at which F_V has the required growth while the walls still move.
    fn on_the_way(&self, a: &WallStrains, grown: &dyn Fn(&Stage) -> f64) -> Result<f64, Box<dyn Error>> {
        let times = self.times;
        let mut found = None;
        for most in [0.002, 0.01, 0.05] {
            let scene = self.driven(&WallStrains { further: most, ..*a });
            let every = 2e-3 * (times.stop_again - times.a);
            watch(&scene, times.stop_again, every, |snapshot| {
                let part = (snapshot.time - times.a) / (times.stop_again - times.a);
                if part > 0.0 && grown(&Stage::from_snapshot(snapshot)) > 0.0 {
                    found = Some(part * most);
                }
                found.is_none()
            })?;
            if found.is_some() {
                break;
            }
        }
        found.ok_or_else(|| "F_V never grows as it should from stage A".into())
    }
}
