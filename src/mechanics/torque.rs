//! A torque on some atoms of every cell of a kind, by forces that have no sum, eq. (loads.5).

use super::course::Course;
use super::lanes::{Real, V3, Vectors, VectorsMut};
use crate::Vec3;

/// A torque on a cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Torque {
    /// Its name; the series are `twist.<name>` and `twist_angle.<name>`.
    pub name: String,
    /// Atoms and their shares, which sum to one.
    pub atoms: Vec<(u32, f64)>,
    /// Unit axis in space.
    pub axis: Vec3,
    /// The torque about it, pN·µm.
    pub torque: Course,
    /// Where the atoms are in the cell at rest from the mean by shares, µm: their angle is told from there.
    rest: Vec<Vec3>,
}

impl Torque {
    /// A torque on atoms of cells with this shape at rest. `shares` sum to one.
    pub fn new(name: &str, shares: Vec<(u32, f64)>, axis: Vec3, torque: Course, rest: &[Vec3]) -> Self {
        let at = |atom: u32| rest[atom as usize];
        let middle: Vec3 = shares.iter().map(|(atom, share)| *share * at(*atom)).sum();
        let rest = shares.iter().map(|(atom, _)| at(*atom) - middle).collect();
        Self { name: name.to_owned(), atoms: shares, axis, torque, rest }
    }

    /// How near the atoms at rest are to one line, along which no forces on them have a torque: 0 there, 1 for atoms that spread alike along all axes.
    pub fn spread(&self) -> f64 {
        let part = |(at, (_, share)): (&Vec3, &(u32, f64))| {
            *share * (at.norm_squared() * nalgebra::Matrix3::identity() - at * at.transpose())
        };
        let spread = self.rest.iter().zip(&self.atoms).map(part).sum::<nalgebra::Matrix3<f64>>();
        let sizes = spread.symmetric_eigenvalues();
        if sizes.max() > 0.0 { sizes.min() / sizes.max() } else { 0.0 }
    }

    /// Adds the forces of a torque (pN·µm). It has no energy.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, torque: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let zero = T::constant(x.token, 0.0);
        let mut middle = V3::zero(x.token);
        for &(atom, share) in &self.atoms {
            middle += x.get(atom as usize).scaled(share);
        }
        let [mut xx, mut yy, mut zz, mut xy, mut yz, mut zx] = [zero; 6];
        for &(atom, share) in &self.atoms {
            let arm = x.get(atom as usize) - middle;
            let part = arm.scaled(share);
            xx += part.x * arm.x;
            yy += part.y * arm.y;
            zz += part.z * arm.z;
            xy += part.x * arm.y;
            yz += part.y * arm.z;
            zx += part.z * arm.x;
        }
        // The rows of J; the columns of its inverse are their cross products over the determinant.
        let rows =
            [V3 { x: yy + zz, y: -xy, z: -zx }, V3 { x: -xy, y: zz + xx, z: -yz }, V3 { x: -zx, y: -yz, z: xx + yy }];
        let columns = [rows[1].cross(rows[2]), rows[2].cross(rows[0]), rows[0].cross(rows[1])];
        let over = torque / rows[0].dot(columns[0]);
        let turn = (columns[0].scaled(self.axis.x) + columns[1].scaled(self.axis.y) + columns[2].scaled(self.axis.z))
            .times(over);
        for &(atom, share) in &self.atoms {
            f.add(atom as usize, turn.cross(x.get(atom as usize) - middle).scaled(share));
        }
        zero
    }

    /// By how much the atoms have turned about the axis since the cell was as it is at rest, rad, from −π to π: in the least squares of what of them is
    /// across it.
    pub fn angle(&self, at: impl Fn(u32) -> Vec3) -> f64 {
        let middle: Vec3 = self.atoms.iter().map(|(atom, share)| *share * at(*atom)).sum();
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (&(atom, share), rest) in self.atoms.iter().zip(&self.rest) {
            let arm = at(atom) - middle;
            sine += share * rest.cross(&arm).dot(&self.axis);
            cosine += share * (rest.dot(&arm) - rest.dot(&self.axis) * arm.dot(&self.axis));
        }
        sine.atan2(cosine)
    }
}
