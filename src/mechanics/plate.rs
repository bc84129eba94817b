//! A flexible plate to which atoms of a cell are bonded: a spring between a base that goes on a course and what is bonded, which goes along a
//! direction as one, eqs. (rigid.5) and (rigid.6). A microplate, or the lever of a force microscope.
//!
//! The plate has no drag of its own: where it is follows from where its atoms are, so that its force is the gradient of an energy of the atoms alone.

use super::course::Course;
use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use super::tangent::matrix::Blocks;
use crate::Vec3;

/// An atom that is bonded to a plate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bonded {
    /// Its number.
    pub atom: u32,
    /// Stiffness of its bond along the direction, pN/µm.
    pub stiffness: f64,
    /// How far along the direction it is at rest, in the mesh, µm.
    pub offset: f64,
}

/// A flexible plate.
#[derive(Debug, Clone, PartialEq)]
pub struct Plate {
    /// Its name; the series are `plate_force.<name>` and `plate_displacement.<name>`.
    pub name: String,
    /// The atoms that are bonded to it.
    pub bonded: Vec<Bonded>,
    /// The direction in which it goes and bends, of length 1.
    pub direction: Vec3,
    /// Force over deflection, pN/µm.
    pub stiffness: f64,
    /// Where the centre of the cell is along the direction at 0 s, µm.
    pub at: f64,
    /// How far the base is from where it began, µm.
    pub displacement: Course,
}

impl Plate {
    /// How far the plate has gone from where it began, µm, for a cell whose atoms are at these positions.
    pub fn gone(&self, time: f64, position: impl Fn(u32) -> Vec3) -> f64 {
        let along = |bonded: &Bonded| position(bonded.atom).dot(&self.direction) - bonded.offset - self.at;
        let pulled: f64 = self.bonded.iter().map(|bonded| bonded.stiffness * along(bonded)).sum();
        (pulled + self.stiffness * self.displacement.at(time)) / (self.bonds() + self.stiffness)
    }

    /// The force on the cell along the direction where the plate has `gone` so far (µm) at a time (s), pN.
    pub fn force(&self, time: f64, gone: f64) -> f64 {
        self.stiffness * (self.displacement.at(time) - gone)
    }

    /// The stiffness of all bonds together, pN/µm.
    fn bonds(&self) -> f64 {
        self.bonded.iter().map(|bonded| bonded.stiffness).sum()
    }

    /// The largest stiffness of a bond, pN/µm.
    pub(super) fn largest_stiffness(&self) -> f64 {
        self.bonded.iter().map(|bonded| bonded.stiffness).fold(0.0, f64::max)
    }

    /// Adds the force on every atom where the base has gone so far (µm), eq. (rigid.6), and returns the energy of bonds and plate, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, base: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let token = x.token;
        let along = V3::constant(token, self.direction.into());
        let base = base + self.at;
        let mut pulled = base * self.stiffness;
        for bonded in &self.bonded {
            pulled += (x.get(bonded.atom as usize).dot(along) + -bonded.offset) * bonded.stiffness;
        }
        let plate = pulled * (1.0 / (self.bonds() + self.stiffness));
        let bent = plate - base;
        let mut energy = bent * bent * (0.5 * self.stiffness);
        for bonded in &self.bonded {
            let off = x.get(bonded.atom as usize).dot(along) + -bonded.offset - plate;
            let pull = off * bonded.stiffness;
            f.sub(bonded.atom as usize, along.times(pull));
            energy += off * pull * 0.5;
        }
        energy
    }

    /// Adds the stiffness of the bonds, which that of all atoms together is far below.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        self.bonded.iter().for_each(|bonded| matrix.add(bonded.atom as usize, bonded.atom as usize, bonded.stiffness));
    }

    /// Adds what its tangent stiffness needs to be there: bonded atoms act on each other.
    pub fn add_pattern(&self, matrix: &mut StiffnessMatrix) {
        for (number, one) in self.bonded.iter().enumerate() {
            let others = &self.bonded[number + 1..];
            others.iter().for_each(|other| matrix.add_spring(one.atom as usize, other.atom as usize, 1.0));
        }
    }

    /// Adds its stiffness, the same in all shapes.
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        let n = V3::constant(x.token, self.direction.into());
        let less = 1.0 / (self.bonds() + self.stiffness);
        for (number, one) in self.bonded.iter().enumerate() {
            let own = T::constant(x.token, one.stiffness - one.stiffness * one.stiffness * less);
            blocks.add_product(one.atom, one.atom, [n, n], own);
            for other in &self.bonded[number + 1..] {
                let both = T::constant(x.token, -one.stiffness * other.stiffness * less);
                blocks.add_product(one.atom, other.atom, [n, n], both);
            }
        }
    }
}
