//! The linear systems of an implicit stage, by conjugate gradients over `L` cells side by side.

use super::mesh::SurfaceMesh;

/// The matrix of a stage, eq. (surface.5): areas on its diagonal, and a lane's factor times the differences to the neighbours.
pub struct Matrix<'a, const L: usize> {
    pub mesh: &'a SurfaceMesh,
    pub areas: &'a [[f64; L]],
    pub weights: &'a [[f64; L]],
    /// γ h D, µm²; 0 in lanes that stand still.
    pub factor: [f64; L],
}

/// What the solver works in, one number an atom and lane.
#[derive(Debug, Clone, Default)]
pub struct Gradients<const L: usize> {
    residual: Vec<[f64; L]>,
    direction: Vec<[f64; L]>,
    image: Vec<[f64; L]>,
    inverse: Vec<[f64; L]>,
}

impl<const L: usize> Gradients<L> {
    pub fn suit(&mut self, atoms: usize) {
        for array in [&mut self.residual, &mut self.direction, &mut self.image, &mut self.inverse] {
            array.resize(atoms, [0.0; L]);
        }
    }

    pub fn poison(&mut self) {
        for array in [&mut self.residual, &mut self.direction, &mut self.image, &mut self.inverse] {
            array.fill([f64::NAN; L]);
        }
    }
}

/// What flows out of an atom to its neighbours for a factor of 1: Σ w (y_i − y_j). Flows between two atoms cancel to the last bit.
#[inline(always)]
pub fn outflow<const L: usize>(mesh: &SurfaceMesh, weights: &[[f64; L]], y: &[[f64; L]], atom: usize) -> [f64; L] {
    let own = &y[atom];
    let mut sum = [0.0; L];
    for &[other, edge] in mesh.near(atom) {
        let (other, weight) = (&y[other as usize], &weights[edge as usize]);
        for l in 0..L {
            sum[l] += weight[l] * (own[l] - other[l]);
        }
    }
    sum
}

/// The square of what may be left of a residual over what diffusion does in the stage.
const RIPPLE: f64 = 1e-2;
/// The square of what is round-off of a density.
const ROUND_OFF: f64 = 1e-28;

/// Solves the system for `areas * right`; `y` is the first guess, and then the solution. A lane is done when the root of the mean
/// square of its residual, as a density, is at most `bound`, and a tenth of what diffusion changes. Each lane has rounds of its own, so that it does not depend on the
/// others. Returns whether all lanes that `bound` gives a number above zero are done.
#[inline(always)]
pub fn solve<const L: usize>(
    matrix: &Matrix<L>,
    right: &[[f64; L]],
    y: &mut [[f64; L]],
    bound: &[f64; L],
    work: &mut Gradients<L>,
) -> [bool; L] {
    let Matrix { mesh, areas, weights, factor } = matrix;
    let atoms = mesh.atoms;
    let (mut whole, mut norm, mut old) = ([0.0; L], [0.0; L], [0.0; L]);
    let (mut spread, mut size) = ([0.0; L], [0.0; L]);
    for i in 0..atoms {
        let (out, given) = (outflow(mesh, weights, y, i), outflow(mesh, weights, right, i));
        let mut sum = [0.0; L];
        for &[_, edge] in mesh.near(i) {
            let weight = &weights[edge as usize];
            for l in 0..L {
                sum[l] += weight[l];
            }
        }
        for l in 0..L {
            let area = areas[i][l];
            let r = area * (right[i][l] - y[i][l]) - factor[l] * out[l];
            // Where angles are obtuse the sum may be negative; the diagonal of a positive matrix is not.
            let inverse = 1.0 / (area + factor[l] * sum[l].max(0.0));
            work.inverse[i][l] = inverse;
            work.residual[i][l] = r;
            work.direction[i][l] = inverse * r;
            whole[l] += area;
            norm[l] += r * r / area;
            old[l] += r * inverse * r;
            spread[l] += factor[l] * factor[l] * given[l] * given[l] / area;
            size[l] += area * right[i][l] * right[i][l];
        }
    }
    let mut limit = [0.0; L];
    for l in 0..L {
        // However small a ripple is, what diffusion does to it is known to a tenth, or it would grow until it meets the bound: without
        // a round the stage would take diffusion explicitly.
        limit[l] = (bound[l] * bound[l] * whole[l]).min(RIPPLE * spread[l]).max(ROUND_OFF * size[l]);
    }
    let mut done = [false; L];
    let most = 200 + 20 * (atoms as f64).sqrt() as usize;
    for _ in 0..most {
        for l in 0..L {
            // Also done is what is not a number: the step is refused for it.
            done[l] = norm[l] <= limit[l] || norm[l].is_nan();
        }
        if done.iter().all(|done| *done) {
            break;
        }
        let mut product = [0.0; L];
        for i in 0..atoms {
            let out = outflow(mesh, weights, &work.direction, i);
            for l in 0..L {
                let image = areas[i][l] * work.direction[i][l] + factor[l] * out[l];
                work.image[i][l] = image;
                product[l] += image * work.direction[i][l];
            }
        }
        let mut stride = [0.0; L];
        for l in 0..L {
            stride[l] = if done[l] || product[l] == 0.0 { 0.0 } else { old[l] / product[l] };
        }
        (norm, product) = ([0.0; L], [0.0; L]);
        for i in 0..atoms {
            for l in 0..L {
                y[i][l] += stride[l] * work.direction[i][l];
                let r = work.residual[i][l] - stride[l] * work.image[i][l];
                work.residual[i][l] = r;
                norm[l] += r * r / areas[i][l];
                product[l] += r * work.inverse[i][l] * r;
            }
        }
        let mut turn = [0.0; L];
        for l in 0..L {
            turn[l] = if done[l] || old[l] == 0.0 { 0.0 } else { product[l] / old[l] };
        }
        old = product;
        for i in 0..atoms {
            for l in 0..L {
                work.direction[i][l] = work.inverse[i][l] * work.residual[i][l] + turn[l] * work.direction[i][l];
            }
        }
    }
    done
}
