//! Minimal hand-written DEM for discs on undamped springs. It is the reference for the kernel of a scene without other
//! effects.
//!
//! It does only what such a scene needs. The neighbour list is built once, with one row per disc, from all pairs whose
//! gap is below a skin. Each step updates velocities and positions by the forces, tracks the largest displacement since
//! the list was built, and computes the forces from the overlaps.

/// Discs with the same stiffness.
pub(crate) struct Minimal {
    position: Vec<[f64; 2]>,
    velocity: Vec<[f64; 2]>,
    force: Vec<[f64; 2]>,
    radius: Vec<f64>,
    inverse_mass: Vec<f64>,
    reference: Vec<[f64; 2]>,
    /// Rows of the list: the neighbours of disc k are `partner[start[k]..start[k + 1]]`.
    start: Vec<u32>,
    partner: Vec<u32>,
    /// Material of each disc. Like every scene, the code selects the stiffness by the materials of a pair.
    material: Vec<u16>,
    /// Stiffness of each pair of materials (N/m).
    stiffness: Vec<f64>,
    /// Number of contacts evaluated.
    pub(crate) touching: u64,
    /// Largest squared displacement of a disc since the list was built (m²).
    pub(crate) farthest: f64,
}

impl Minimal {
    /// Builds discs, given as position (m), radius (m) and mass (kg), with a list of pairs whose gap is below `skin` (m).
    pub(crate) fn new(discs: &[([f64; 2], f64, f64)], stiffness: f64, skin: f64) -> Self {
        let (mut start, mut partner) = (vec![0], Vec::new());
        for (row, (a, radius, _)) in discs.iter().enumerate() {
            for (other, (b, reach, _)) in discs.iter().enumerate().skip(row + 1) {
                if f64::hypot(b[0] - a[0], b[1] - a[1]) < radius + reach + skin {
                    partner.push(other as u32);
                }
            }
            start.push(partner.len() as u32);
        }
        let position: Vec<[f64; 2]> = discs.iter().map(|(place, ..)| *place).collect();
        let mut minimal = Self {
            reference: position.clone(),
            position,
            velocity: vec![[0.0; 2]; discs.len()],
            force: vec![[0.0; 2]; discs.len()],
            radius: discs.iter().map(|(_, radius, _)| *radius).collect(),
            inverse_mass: discs.iter().map(|(.., mass)| 1.0 / mass).collect(),
            start,
            partner,
            material: vec![0; discs.len()],
            stiffness: vec![stiffness],
            touching: 0,
            farthest: 0.0,
        };
        minimal.forces();
        minimal
    }

    /// Runs one calculation cycle.
    pub(crate) fn step(&mut self, time_step: f64) {
        self.farthest = 0.0;
        for k in 0..self.position.len() {
            let mut squared = 0.0;
            for axis in 0..2 {
                self.velocity[k][axis] += self.force[k][axis] * self.inverse_mass[k] * time_step;
                self.force[k][axis] = 0.0;
                self.position[k][axis] += self.velocity[k][axis] * time_step;
                squared += (self.position[k][axis] - self.reference[k][axis]).powi(2);
            }
            self.farthest = self.farthest.max(squared);
        }
        self.forces();
    }

    fn forces(&mut self) {
        for row in 0..self.position.len() {
            let (place, radius) = (self.position[row], self.radius[row]);
            let laws = &self.stiffness[usize::from(self.material[row])..];
            let mut sum = [0.0; 2];
            for &partner in &self.partner[self.start[row] as usize..self.start[row + 1] as usize] {
                let other = partner as usize;
                let between = [self.position[other][0] - place[0], self.position[other][1] - place[1]];
                let squared = between[0] * between[0] + between[1] * between[1];
                let reach = radius + self.radius[other];
                if squared < reach * reach {
                    self.touching += 1;
                    let distance = squared.sqrt();
                    let push = laws[usize::from(self.material[other])] * (reach - distance) / distance;
                    for axis in 0..2 {
                        sum[axis] -= push * between[axis];
                        self.force[other][axis] += push * between[axis];
                    }
                }
            }
            self.force[row][0] += sum[0];
            self.force[row][1] += sum[1];
        }
    }
}
