//! The part of a field of vectors that moves a cell as a rigid body: translation and rotation about its centre.
//!
//! The implicit step must not slow rigid motion, so the six rigid modes are taken out before the elastic solve and
//! moved with the free mobility, eq. (step.4).

use super::lanes::{BlockWork, Real, V3, Vectors, VectorsMut, dispatch};

/// The rigid frame of a cell: centre, and the inverse of Σ (r² I − r rᵀ) in its six entries.
#[derive(Clone, Copy)]
pub struct RigidFrame<T> {
    centre: V3<T>,
    inverse: [T; 6],
}

impl<T: Real> RigidFrame<T> {
    /// Measures the frame of the current positions. Cells on a line get a rotation of zero about it.
    #[inline(always)]
    pub fn of(x: &Vectors<T>, atoms: usize) -> Self {
        let token = x.token;
        let mut centre = V3::zero(token);
        for atom in 0..atoms {
            centre += x.get(atom);
        }
        let centre = centre.scaled(1.0 / atoms as f64);
        let zero = T::constant(token, 0.0);
        let (mut xx, mut yy, mut zz, mut xy, mut xz, mut yz) = (zero, zero, zero, zero, zero, zero);
        for atom in 0..atoms {
            let r = x.get(atom) - centre;
            xx += r.y * r.y + r.z * r.z;
            yy += r.x * r.x + r.z * r.z;
            zz += r.x * r.x + r.y * r.y;
            xy -= r.x * r.y;
            xz -= r.x * r.z;
            yz -= r.y * r.z;
        }
        let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
        let trace = xx + yy + zz;
        // A floor far below any real cell's value keeps a body on a line from dividing by zero.
        let floor = trace * trace * trace * 1e-18 + 1e-300;
        let one = T::constant(token, 1.0) / (xx * a + xy * b + xz * c).max(floor);
        let inverse = [
            a * one,
            (xx * zz - xz * xz) * one,
            (xx * yy - xy * xy) * one,
            b * one,
            c * one,
            (xy * xz - xx * yz) * one,
        ];
        Self { centre, inverse }
    }

    /// Mean vector and angular rate of the rigid part of `field`, eq. (step.4).
    #[inline(always)]
    pub fn project(&self, x: &Vectors<T>, field: &Vectors<T>, atoms: usize) -> (V3<T>, V3<T>) {
        let token = x.token;
        let (mut sum, mut torque) = (V3::zero(token), V3::zero(token));
        for atom in 0..atoms {
            let value = field.get(atom);
            sum += value;
            torque += (x.get(atom) - self.centre).cross(value);
        }
        let [xx, yy, zz, xy, xz, yz] = self.inverse;
        let spin = V3 {
            x: xx * torque.x + xy * torque.y + xz * torque.z,
            y: xy * torque.x + yy * torque.y + yz * torque.z,
            z: xz * torque.x + yz * torque.y + zz * torque.z,
        };
        (sum.scaled(1.0 / atoms as f64), spin)
    }

    /// The rigid field at a position.
    #[inline(always)]
    pub fn at(&self, position: V3<T>, mean: V3<T>, spin: V3<T>) -> V3<T> {
        mean + spin.cross(position - self.centre)
    }
}

/// How cells give way as a whole.
#[derive(Debug, Clone, Copy)]
pub struct Whole<'a> {
    /// What becomes of a field that moves them as a whole.
    pub mobility: f64,
    /// What is left of its mean before that.
    pub going: f64,
    /// What is left of its rotation.
    pub turning: f64,
    /// What becomes of its rotation, a matrix for each cell as a block has three atoms, or empty where nothing does.
    pub turned: &'a [f64],
}

impl Whole<'_> {
    /// As drag alone lets cells go and turn.
    pub fn free(mobility: f64) -> Self {
        Self { mobility, going: 1.0, turning: 1.0, turned: &[] }
    }
}

/// Splits `field` of a block: what stays in it is the deforming part; its rigid part, scaled, goes to `rigid`.
pub fn split_block(lanes: usize, atoms: usize, x: &[f64], field: &mut [f64], rigid: &mut [f64], whole: Whole) {
    dispatch(lanes, Split { atoms, x, field, rigid, whole });
}

struct Split<'a> {
    atoms: usize,
    x: &'a [f64],
    field: &'a mut [f64],
    rigid: &'a mut [f64],
    whole: Whole<'a>,
}

impl BlockWork for Split<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let positions = T::view(token, self.x);
        for part in 0..stride {
            let x = Vectors::<T>::new(token, positions, stride, part);
            let frame = RigidFrame::of(&x, self.atoms);
            let (mean, spin) = {
                let field = Vectors::<T>::new(token, T::view(token, self.field), stride, part);
                frame.project(&x, &field, self.atoms)
            };
            let mut field = VectorsMut::<T>::new(token, T::view_mut(token, self.field), stride, part);
            let mut rigid = VectorsMut::<T>::new(token, T::view_mut(token, self.rigid), stride, part);
            (0..self.atoms).for_each(|atom| field.sub(atom, frame.at(x.get(atom), mean, spin)));
            let mut spin = spin;
            if !self.whole.turned.is_empty() {
                let rows = Vectors::<T>::new(token, T::view(token, self.whole.turned), stride, part);
                spin = V3 { x: rows.get(0).dot(spin), y: rows.get(1).dot(spin), z: rows.get(2).dot(spin) };
            }
            let (mean, spin) = (mean.scaled(self.whole.going), spin.scaled(self.whole.turning));
            for atom in 0..self.atoms {
                rigid.set(atom, frame.at(x.get(atom), mean, spin).scaled(self.whole.mobility));
            }
        }
    }
}

/// Replaces `field` of a block by its deforming part plus `rigid`.
pub fn join_block(lanes: usize, atoms: usize, x: &[f64], field: &mut [f64], rigid: &[f64]) {
    dispatch(lanes, Join { atoms, x, field, rigid });
}

struct Join<'a> {
    atoms: usize,
    x: &'a [f64],
    field: &'a mut [f64],
    rigid: &'a [f64],
}

impl BlockWork for Join<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let positions = T::view(token, self.x);
        let moved = T::view(token, self.rigid);
        for part in 0..stride {
            let x = Vectors::<T>::new(token, positions, stride, part);
            let rigid = Vectors::<T>::new(token, moved, stride, part);
            let frame = RigidFrame::of(&x, self.atoms);
            let (mean, spin) = {
                let field = Vectors::<T>::new(token, T::view(token, self.field), stride, part);
                frame.project(&x, &field, self.atoms)
            };
            let mut field = VectorsMut::<T>::new(token, T::view_mut(token, self.field), stride, part);
            for atom in 0..self.atoms {
                let keep = rigid.get(atom) - frame.at(x.get(atom), mean, spin);
                field.add(atom, keep);
            }
        }
    }
}
