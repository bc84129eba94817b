//! Contacts as rows of the system that the sweeps solve.

use crate::Vec3;

/// One contact as it stands in a step, eq. (adhesion.1). The gap changes by `normal · Σ weights[i] D[atoms[i]]` when atoms are displaced by
/// D. A packed population has almost as many contacts as atoms, and every sweep reads them all: what need not be exact to
/// more than seven digits has four bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Its atoms; those that are not there have weight 0.
    pub atoms: [u32; 4],
    /// Where it is: the weights of the second and third atom of a facet, or the positions along two edges; see [`Row::weights`].
    pub coordinates: [f32; 2],
    /// From the other side to the first, and the gap where the step began, µm.
    pub normal_and_gap: [f32; 4],
    /// Least normal force, pN: minus the pull at which the contact parts.
    pub least: f32,
    /// Largest tangential force, pN.
    pub shear: f32,
    /// Tangential force over the speed at which its sides slide beyond what `shear` holds, pN·s/µm.
    pub friction: f32,
    /// Displacement over force along the normal, µm/pN; 0 where nothing can move.
    pub compliance: f32,
    /// The same across it, at most, µm/pN.
    pub across: f32,
    /// What it holds of a change of its force; the rest yields.
    pub kept: f32,
    /// What went into its compliance and has not come back where the step began, pN·µm.
    pub stored: f32,
    /// What touches.
    pub pairing: Pairing,
}

/// What touches in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pairing {
    /// An atom, and the three of a facet.
    AtomOnFacet,
    /// The two atoms of an edge, and those of another.
    Edges,
    /// An atom, four times.
    AtomOnObstacle,
    /// All atoms move as one, so that the contact does nothing.
    Rigid,
}

/// What a contact carries; forces on the first side, pN.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pull {
    /// Now.
    pub force: [f32; 3],
    /// Where the step began.
    pub carried: [f32; 3],
    /// What the last sweep changed.
    pub(super) change: [f32; 3],
    /// The direction that speeds the sweeps up.
    pub(super) direction: [f32; 3],
}

impl Row {
    /// A row that does nothing.
    pub(super) const NOTHING: Self = Self {
        atoms: [0; 4],
        coordinates: [0.0; 2],
        normal_and_gap: [0.0; 4],
        least: 0.0,
        shear: 0.0,
        friction: 0.0,
        compliance: 0.0,
        across: 0.0,
        kept: 1.0,
        stored: 0.0,
        pairing: Pairing::Rigid,
    };

    /// The weights of its atoms: positive on the first side of the contact, negative on the other; each side sums to ±1.
    #[inline(always)]
    pub fn weights(&self) -> [f64; 4] {
        let [s, t] = self.coordinates.map(f64::from);
        match self.pairing {
            Pairing::AtomOnFacet => [1.0, -(1.0 - s - t), -s, -t],
            Pairing::Edges => [1.0 - s, s, t - 1.0, -t],
            Pairing::AtomOnObstacle => [1.0, 0.0, 0.0, 0.0],
            Pairing::Rigid => [0.0; 4],
        }
    }

    /// Force over displacement, pN/µm.
    #[inline(always)]
    pub fn stiffness(&self) -> f64 {
        f64::from(1.0 / self.compliance)
    }

    /// Unit vector from the other side to the first.
    pub fn normal(&self) -> Vec3 {
        let [x, y, z, _] = self.normal_and_gap.map(f64::from);
        Vec3::new(x, y, z)
    }

    /// Gap where the step began, µm.
    pub fn gap(&self) -> f64 {
        f64::from(self.normal_and_gap[3])
    }

    /// Cuts a force to what the contact bears along its present normal; friction has no bound.
    pub(super) fn bound(&self, force: Vec3) -> Vec3 {
        let (normal, shear) = (self.normal(), f64::from(self.shear));
        let along = force.dot(&normal);
        let across = force - along * normal;
        let size = across.norm();
        let kept = if size > shear && self.friction == 0.0 { shear / size } else { 1.0 };
        along.max(f64::from(self.least)) * normal + kept * across
    }
}

impl Pull {
    /// The force on the first side, pN.
    pub fn force(&self) -> Vec3 {
        vector(&self.force)
    }

    /// The force on the first side where the step began, pN.
    pub(super) fn carried(&self) -> Vec3 {
        vector(&self.carried)
    }
}

fn vector(numbers: &[f32; 3]) -> Vec3 {
    Vec3::from(numbers.map(f64::from))
}
