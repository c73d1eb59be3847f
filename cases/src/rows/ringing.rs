//! Elastic discs between walls that move in by a small distance and stop: the force at rest, the frequency of free
//! vibration and the apparent spring stiffness. The runs have no friction. They are compared with rigid discs on
//! springs that have the same force at rest.

use crate::rows::elastic::stiffen;
use grainbench_harness::prelude::*;
use grainbench_scene::contact_law::Springs;

/// Parameters and exact values of one arrangement of discs.
#[derive(Clone, Copy)]
pub(crate) struct FreeVibration {
    /// Variant of the case.
    pub(crate) variant: &'static str,
    /// Column of the force at a wall.
    pub(crate) column: &'static str,
    /// Bulk and shear modulus of the elastic discs (Pa).
    pub(crate) moduli: [f64; 2],
    /// Distance by which each wall moves in (m).
    pub(crate) squeeze: f64,
    /// Duration of the motion of the walls (s).
    pub(crate) ramp: f64,
    /// End of the run (s), about ten periods after the walls have stopped.
    pub(crate) time: f64,
    /// Time between two samples (s).
    pub(crate) sample: f64,
    /// Cells per radius, except in the long tier.
    pub(crate) cells: f64,
    /// Cells per radius in the long tier.
    pub(crate) fine: f64,
    /// Function that returns the exact values for a scene and a squeeze (m); `None` if the discs are rigid.
    pub(crate) exact: fn(&Scene, f64) -> Option<VibrationParameters>,
    /// Factor n in ω² = n k_n/m, for rigid discs on springs.
    pub(crate) springs: f64,
    /// Force at a wall at rest, divided by k_n times the squeeze, for rigid discs on springs.
    pub(crate) share: f64,
    /// Source of the closed form.
    pub(crate) source: &'static str,
    /// Largest relative error of the force that passes.
    pub(crate) allowed: f64,
    /// Reason for the tolerance of the force.
    pub(crate) because: &'static str,
}

/// Forces and parameters of the free vibration of elastic discs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VibrationParameters {
    /// Force at a wall at rest (N/m).
    pub(crate) force: f64,
    /// Restoring force on a disc, divided by its displacement (N/m²).
    pub(crate) restoring: f64,
    /// Added mass of a disc, divided by its mass. The added mass is the inertia of the deformation (Rayleigh).
    pub(crate) stirred: f64,
    /// Half-width of a contact patch, divided by the radius.
    pub(crate) patch: f64,
    /// Relative increase of the compliance of a disc if every contact yields by a further ΔF/(πE').
    pub(crate) share: f64,
}

impl FreeVibration {
    /// Makes the discs elastic. Sets the motion of the walls, the duration and the sampling.
    fn elastic(self, scene: &mut Scene) {
        let [bulk_modulus, shear_modulus] = self.moduli;
        scene.deformable[0] = Some(Deformable { bulk_modulus, shear_modulus, constitutive: Constitutive::NeoHookean });
        for wall in &mut scene.walls {
            let phase = &mut wall.motion.phases[0];
            phase.velocity *= self.squeeze / self.ramp / phase.velocity.norm();
            phase.stop = Moment::Seconds(self.ramp);
        }
        scene.duration = Duration::Seconds(self.time);
        scene.sampling = Sampling::Seconds(self.sample);
    }

    /// Makes the discs rigid, with springs that give the force of the elastic discs at rest.
    fn on_springs(self, scene: &mut Scene) {
        self.elastic(scene);
        if let Some(VibrationParameters { force, .. }) = (self.exact)(scene, self.squeeze) {
            scene.change_laws(|law| {
                let (normal, tangential) = (force / (self.share * self.squeeze), law.tangential_stiffness());
                law.springs = Springs::Linear { normal, tangential };
            });
        }
    }

    pub(crate) fn discs(self, cells: f64) -> Run {
        let run = Run::new(self.variant, "mpm", Resolution::grid(cells, 3));
        run.adjusted("elastic discs", move |scene| self.elastic(scene))
    }

    pub(crate) fn rigid(self) -> Run {
        let run = Run::new(self.variant, "dem", Resolution::CriticalFraction(0.05));
        run.adjusted("springs with the force of elastic discs", move |scene| self.on_springs(scene))
    }

    /// Returns the exact values for the scene of a run.
    pub(crate) fn exact(self, done: &FinishedRun) -> Result<VibrationParameters, MissingData> {
        (self.exact)(&done.scene, self.squeeze).ok_or_else(|| "moduli in its scene".into())
    }

    /// Returns the angular frequency of elastic discs in closed form (rad/s).
    fn expected(self, done: &FinishedRun) -> Result<f64, MissingData> {
        let VibrationParameters { restoring, stirred, .. } = self.exact(done)?;
        Ok((restoring / (done.scene.grains[0].mass * (1.0 + stirred))).sqrt())
    }

    /// Returns times and wall forces after the walls have stopped.
    fn ringing(self, done: &FinishedRun) -> Result<(Vec<f64>, Vec<f64>), MissingData> {
        let force = done.column(self.column)?;
        Ok(done.series().time.iter().zip(force).filter(|(time, _)| **time > self.ramp).unzip())
    }

    fn frequency(self, done: &FinishedRun) -> Result<f64, MissingData> {
        let near = self.expected(done)?;
        let (time, force) = self.ringing(done)?;
        Ok(dominant_frequency(&time, &force, 0.5 * near, 1.6 * near))
    }

    /// Returns the relative decrease of the frequency due to the contact springs between the surfaces of the discs.
    /// These springs are as soft as a layer of material of 0.4 cells.
    fn softened(self, mut scene: Scene, cells: f64) -> f64 {
        self.elastic(&mut scene);
        let soft = |rung: VibrationParameters| 0.5 * rung.share * PI * 0.4 / (2.0 * cells * rung.patch);
        (self.exact)(&scene, self.squeeze).map_or(f64::NAN, soft)
    }

    pub(crate) fn claims(self, case: &Case, set: impl Fn(Run) -> Run) -> Vec<Claim> {
        let softer = |cells: f64| {
            Control::scene("discs a quarter softer", |scene| stiffen(scene, 0.75))
                .coarser(Resolution::grid(0.5 * cells, 3))
        };
        let exact = Source::Derived(self.source);
        let softened = |cells| {
            computed(
                case.number(self.variant, |scene| self.softened(scene.clone(), cells)),
                "springs between surfaces are as soft as .4 cells of material: under F/2a they yield by .4 h F/(2a \
                 E'), which is π h/5a of F/(πE') at every contact; the relative change of the frequency is half that \
                 of the compliance",
            )
        };
        let rings = |run: Run, cells: f64| {
            claim(format!("frequency at which elastic discs ring, {cells} cells a radius"), "rad/s")
                .run(run)
                .equals(exact, move |done| {
                    Ok(Measurement::relative(self.frequency(&done[0])?, self.expected(&done[0])?))
                })
                .within(softened(cells))
                .refuses(softer(cells))
        };
        vec![
            claim("force at the wall of elastic discs, mean after the walls have stopped", "N/m")
                .run(set(self.discs(self.cells)))
                .equals(exact, move |done| {
                    let force = self.exact(&done[0])?.force;
                    let (_, found) = self.ringing(&done[0])?;
                    Ok(Measurement::relative(found.iter().sum::<f64>() / found.len() as f64, force))
                })
                .within(estimated(self.allowed, self.because))
                .refuses(softer(self.cells)),
            rings(set(self.discs(self.cells)), self.cells),
            rings(self.discs(self.fine).long(), self.fine),
            claim("frequency of elastic discs over that of rigid ones on springs with their force at rest", "1")
                .run(set(self.discs(self.cells)))
                .run(self.rigid().aside())
                .equals(exact, move |done| {
                    let VibrationParameters { force, restoring, stirred, .. } = self.exact(&done[0])?;
                    // The mass cancels. `spring` is the stiffness k_n for which rigid discs have the same force at
                    // rest.
                    let spring = force / (self.share * self.squeeze);
                    let expected = (restoring / (self.springs * spring * (1.0 + stirred))).sqrt();
                    Ok(Measurement::relative(self.frequency(&done[0])? / self.frequency(&done[1])?, expected))
                })
                .within(softened(self.cells))
                .refuses(softer(self.cells)),
        ]
    }
}
