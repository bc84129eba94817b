//! The linear system of the implicit step, (ζ/dt + γK) Y = F, factored once and shared by all cells of a mesh.
//!
//! K is the constant [`StiffnessMatrix`], the same along x, y and z, so that one N × N factor serves three axes and
//! eight cells at a time: a solve works on rows of 24 numbers. Small meshes keep the dense inverse (one product, no
//! chains of dependent operations); larger ones an envelope Cholesky factor after a reverse Cuthill–McKee ordering.

use super::envelope::Envelope;
use super::lanes::{BlockWork, LANES, Real, dispatch};
use super::stiffness::StiffnessMatrix;

/// Meshes up to this size keep the dense inverse; at 64 atoms the envelope's two passes cost as much as the product.
const DENSE_UP_TO: usize = 64;

/// The factored matrix ζ/dt + γK with held atoms taken out.
#[derive(Debug, Clone)]
pub struct Factor {
    atoms: usize,
    method: Method,
}

#[derive(Debug, Clone)]
enum Method {
    /// Row-major inverse; rows and columns of held atoms are zero.
    Dense(Vec<f64>),
    Envelope(Envelope),
}

impl Factor {
    /// Factors `diagonal + scale·stiffness`; `held` tells the atoms that do not move along this axis.
    pub fn new(stiffness: &StiffnessMatrix, diagonal: f64, scale: f64, held: &[bool]) -> Self {
        let atoms = stiffness.atoms();
        let envelope = Envelope::new(stiffness, diagonal, scale, held);
        if atoms > DENSE_UP_TO {
            return Self { atoms, method: Method::Envelope(envelope) };
        }
        let mut inverse = vec![0.0; atoms * atoms];
        for (atom, row) in inverse.chunks_exact_mut(atoms).enumerate() {
            row[atom] = 1.0;
            envelope.solve(1, row, &mut vec![0.0; atoms]);
        }
        Self { atoms, method: Method::Dense(inverse) }
    }

    /// Solves in place for rows of `width` numbers an atom (`values[atom][width]`); `scratch` is as long as `values`.
    pub fn solve(&self, width: usize, values: &mut [f64], scratch: &mut [f64]) {
        debug_assert_eq!(values.len(), width * self.atoms);
        match &self.method {
            Method::Envelope(envelope) => envelope.solve(width, values, scratch),
            Method::Dense(inverse) if width == 3 * LANES => {
                scratch.copy_from_slice(values);
                dispatch(LANES, WideProduct { atoms: self.atoms, inverse, from: scratch, to: values });
            }
            Method::Dense(inverse) => {
                scratch.copy_from_slice(values);
                for (row, to) in inverse.chunks_exact(self.atoms).zip(values.chunks_exact_mut(width)) {
                    to.fill(0.0);
                    for (entry, from) in row.iter().zip(scratch.chunks_exact(width)) {
                        to.iter_mut().zip(from).for_each(|(t, s)| *t += entry * s);
                    }
                }
            }
        }
    }
}

struct WideProduct<'a> {
    atoms: usize,
    inverse: &'a [f64],
    from: &'a [f64],
    to: &'a mut [f64],
}

impl BlockWork for WideProduct<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let (from, to) = (T::view(token, self.from), T::view_mut(token, self.to));
        let (width, zero) = (3 * stride, T::constant(token, 0.0));
        // Two atoms and three registers at a time: six sums in flight hide the latency of the additions.
        for pair in 0..self.atoms.div_ceil(2) {
            let (i, k) = (2 * pair, (2 * pair + 1).min(self.atoms - 1));
            let row_i = &self.inverse[i * self.atoms..(i + 1) * self.atoms];
            let row_k = &self.inverse[k * self.atoms..(k + 1) * self.atoms];
            for at in (0..width).step_by(3) {
                let (mut a, mut b) = ([zero; 3], [zero; 3]);
                for ((p, q), value) in row_i.iter().zip(row_k).zip(from.chunks_exact(width)) {
                    for c in 0..3 {
                        let v = T::load(token, value[at + c]);
                        a[c] += v * *p;
                        b[c] += v * *q;
                    }
                }
                for c in 0..3 {
                    to[i * width + at + c] = a[c].raw();
                    to[k * width + at + c] = b[c].raw();
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(atoms: usize) -> StiffnessMatrix {
        let mut matrix = StiffnessMatrix::new(atoms);
        for i in 1..atoms {
            matrix.add_spring(i - 1, i, 1.0 + i as f64);
            matrix.add_spring(0, i, 0.5);
        }
        matrix
    }

    #[test]
    fn both_factors_invert_the_matrix_at_every_width_with_held_atoms() {
        for atoms in [5, 64, 65, 130] {
            for width in [1, 3, 24] {
                let stiffness = chain(atoms);
                let held: Vec<bool> = (0..atoms).map(|i| i == 3).collect();
                let factor = Factor::new(&stiffness, 2.0, 0.7, &held);
                let right: Vec<f64> = (0..atoms * width).map(|i| ((i * 7919) % 101) as f64 - 50.0).collect();
                let mut y = right.clone();
                factor.solve(width, &mut y, &mut vec![0.0; atoms * width]);
                for i in (0..atoms).filter(|&i| !held[i]) {
                    for c in 0..width {
                        let product: f64 = 2.0 * y[i * width + c]
                            + stiffness.row(i).map(|(j, k)| 0.7 * k * y[j * width + c]).sum::<f64>();
                        // Round-off of sums of at most 130 terms of size up to about 1e4.
                        assert!((product - right[i * width + c]).abs() < 1e-8, "{atoms} {width} {i}");
                    }
                }
                assert!((0..width).all(|c| y[3 * width + c] == 0.0));
            }
        }
    }
}
