//! Tracers: massless points on the surface of bodies, carried by the grid.

use crate::basis::Basis;
use crate::bodies::Body;
use crate::grid::{Lattice, Node, Stencil};
use crate::seed::Patch;
use grainbench_scene::space::Space;
use nalgebra::Vector3;

/// Tracers of all bodies, structure of arrays.
#[derive(Clone, Debug)]
pub(crate) struct Tracers<S: Space> {
    /// Position (m).
    pub(crate) position: Vec<S::Vector>,
    /// Area times outward unit normal (m²; m in the plane).
    pub(crate) area: Vec<S::Vector>,
    /// In the plane, the neighbours along the surface: the one before and the one after.
    pub(crate) neighbours: Vec<[u32; 2]>,
}

impl<S: Space> Tracers<S> {
    pub(crate) const fn new() -> Self {
        Self { position: Vec::new(), area: Vec::new(), neighbours: Vec::new() }
    }

    pub(crate) fn len(&self) -> usize {
        self.position.len()
    }

    /// Adds a closed surface; in the plane its patches follow each other with the body on their left.
    pub(crate) fn add(&mut self, patches: &[Patch]) {
        let (start, count) = (self.len() as u32, patches.len() as u32);
        for (number, patch) in (0..count).zip(patches) {
            self.position.push(S::restrict(patch.position));
            self.area.push(S::restrict(patch.area));
            self.neighbours.push([start + (number + count - 1) % count, start + (number + 1) % count]);
        }
    }

    /// Carries the tracers of a body for `elapsed` (s) with `velocity` (m/s) of its nodes, interpolated over those that
    /// carry mass.
    pub(crate) fn carry<B: Basis>(
        &mut self,
        lattice: &Lattice,
        body: &Body,
        nodes: &[Node<S>],
        velocity: impl Fn(usize) -> S::Vector,
        elapsed: f64,
    ) {
        let window = &body.part.window;
        for at in body.tracers.clone() {
            let stencil = Stencil::new::<S, B>(lattice, self.position[at], body.part.half);
            if !window.holds(S::DIMENSION, stencil.base(), B::WIDTH as i32) {
                continue;
            }
            let (mut total, mut way, mut gradient) = (0.0, S::ORIGIN, S::NO_GRADIENT);
            let mut slope = S::ORIGIN;
            stencil.each::<S, B>(window, |node| {
                if nodes[node.slot].mass > 0.0 {
                    let velocity = velocity(node.slot);
                    total += node.weight;
                    way += velocity * node.weight;
                    if S::DIMENSION == 3 {
                        let along = stencil.gradient(&node);
                        gradient += S::outer(velocity, along);
                        slope += along;
                    }
                }
            });
            if total <= 1e-6 {
                continue;
            }
            let velocity = way * (1.0 / total);
            self.position[at] += velocity * elapsed;
            if S::DIMENSION == 3 {
                // Gradient of the interpolation over the nodes with mass: (Σ v ∇N − v̄ Σ ∇N)/Σ N.
                let gradient = (gradient - S::outer(velocity, slope)) * (1.0 / total);
                self.area[at] = transported::<S>(self.area[at], gradient, elapsed);
            }
        }
        if S::DIMENSION == 2 {
            for at in body.tracers.clone() {
                let [before, after] = self.neighbours[at].map(|neighbour| self.position[neighbour as usize]);
                let half = S::embed(after - before) * 0.5;
                self.area[at] = S::restrict(Vector3::new(half.y, -half.x, 0.0));
            }
        }
    }
}

/// An area vector carried with the material: ȧ = (tr L) a − Lᵀa (Nanson).
#[inline(always)]
fn transported<S: Space>(area: S::Vector, gradient: S::Matrix, elapsed: f64) -> S::Vector {
    let (gradient, area) = (S::embed_gradient(gradient), S::embed(area));
    S::restrict(area + (area * gradient.trace() - gradient.transpose() * area) * elapsed)
}
