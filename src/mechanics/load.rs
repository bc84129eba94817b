//! Loads: a force with a course in time, spread over some atoms of every cell of a kind, eq. (loads.1).

use super::control::Handle;
use super::course::Course;
use super::lanes::{LANES, Real, V3, Vectors, VectorsMut};
use crate::Vec3;

/// What may be set is a factor of the force.
pub const HANDLE: Handle = Handle {
    word: "load",
    key: "loads",
    range: [f64::NEG_INFINITY, f64::INFINITY],
    expected: "a finite number",
    unset: 1.0,
};

/// A load on a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// Its name; the series is `load.<name>`.
    pub name: String,
    /// Atoms and their shares, which sum to one.
    pub atoms: Vec<(u32, f64)>,
    /// Unit direction.
    pub direction: Vec3,
    /// Total force, pN.
    pub force: Course,
}

impl Load {
    /// A load.
    pub fn new(name: &str, atoms: Vec<(u32, f64)>, direction: Vec3, force: Course) -> Self {
        Self { name: name.to_owned(), atoms, direction, force }
    }

    /// The total force on the cell of each lane at a time, pN: that of the course times what is set.
    pub(super) fn strength(&self, time: f64, set: &[f64; LANES]) -> [f64; LANES] {
        let force = self.force.at(time);
        set.map(|factor| force * factor)
    }

    /// Adds the total force (pN) to the atoms by their shares and returns the energy, pN·µm: minus the work done from
    /// the origin.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, force: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        for &(atom, share) in &self.atoms {
            let [along_x, along_y, along_z] = [0, 1, 2].map(|axis| share * self.direction[axis]);
            let pull = V3 { x: force * along_x, y: force * along_y, z: force * along_z };
            f.add(atom as usize, pull);
            energy += -pull.dot(x.get(atom as usize));
        }
        energy
    }
}
