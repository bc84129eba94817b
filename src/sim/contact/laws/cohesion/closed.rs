//! Which bonds of surfaces are closed where a step begins.

use super::patch::Patch;
use super::search::Spot;
use super::table::CohesionTable;
use crate::contact::Scene;
use crate::sim::contact::state::SurfaceBonds;

/// The bonds of a part of a surface in a step.
#[derive(Debug, Clone, Copy)]
pub struct PatchBonds {
    /// Those where the step begins.
    pub before: SurfaceBonds,
    /// The largest traction of all of them, closed or not, as [`Patch::strength`], pN/µm².
    pub strength: f64,
    /// The share that is closed where the step ends.
    pub after: f64,
}

/// The bonds that there were before a step, and when it begins.
#[derive(Debug, Clone, Copy)]
pub struct Earlier<'a> {
    /// In the order of facets.
    pub bonds: &'a [SurfaceBonds],
    /// When the step begins, s: at 0 contacts have the bonds that a run begins with.
    pub time: f64,
}

impl PatchBonds {
    /// The share that is closed where the step begins.
    pub fn closed(&self) -> f64 {
        self.before.closed
    }
}

impl<'a> Earlier<'a> {
    /// Those of the facets from a body's first on.
    pub fn from_body(self, scene: &Scene, body: u32) -> Self {
        let first = scene.bodies.get(body as usize).map_or(u32::MAX, |body| body.first_facet);
        Self { bonds: &self.bonds[self.bonds.partition_point(|bonds| bonds.facet < first)..], ..self }
    }

    /// The bonds of a part of a surface of a body, which then attracts by those that are closed. Parts are asked for in their order.
    pub fn bind(
        &mut self,
        table: &CohesionTable,
        scene: &Scene,
        (body, Spot { facet, point }): (u32, Spot),
        patch: &mut Patch,
    ) -> PatchBonds {
        let other = patch.faces(scene);
        let cohesive = table.of(scene, body, other);
        let strength = patch.strength;
        let Some(bonds) = cohesive.bonds else {
            let before = SurfaceBonds { facet, point, other, closed: 1.0 };
            return PatchBonds { before, strength, after: 1.0 };
        };
        while self.bonds.first().is_some_and(|known| (known.facet, known.point) < (facet, point)) {
            self.bonds = &self.bonds[1..];
        }
        let is_same = |known: &&SurfaceBonds| (known.facet, known.point, known.other) == (facet, point, other);
        let new = if self.time == 0.0 { bonds.start } else { 0.0 };
        let closed = self.bonds.first().filter(is_same).map_or(new, |known| known.closed);
        patch.strength *= closed;
        PatchBonds { before: SurfaceBonds { facet, point, other, closed }, strength, after: closed }
    }
}
