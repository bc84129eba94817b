//! Areas and weights of the present shape of `L` cells side by side; positions stand as `[atom][axis][lane]`.

use super::mesh::SurfaceMesh;

/// Twice the area of a facet is taken to be at least this part of the squares of its edges: where a facet has no area left, a
/// cotangent would be infinite.
const LEAST: f64 = 1e-9;

type Vector<const L: usize> = [[f64; L]; 3];

#[inline(always)]
fn minus<const L: usize>(x: &[[f64; L]], a: u32, b: u32) -> Vector<L> {
    let mut result = [[0.0; L]; 3];
    for axis in 0..3 {
        let (a, b) = (&x[3 * a as usize + axis], &x[3 * b as usize + axis]);
        for l in 0..L {
            result[axis][l] = a[l] - b[l];
        }
    }
    result
}

#[inline(always)]
fn dot<const L: usize>(a: &Vector<L>, b: &Vector<L>) -> [f64; L] {
    let mut result = [0.0; L];
    for l in 0..L {
        result[l] = a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l];
    }
    result
}

/// Twice the area spanned by two sides.
#[inline(always)]
fn double_area<const L: usize>(a: &Vector<L>, b: &Vector<L>) -> [f64; L] {
    let mut result = [0.0; L];
    for l in 0..L {
        let x = a[1][l] * b[2][l] - a[2][l] * b[1][l];
        let y = a[2][l] * b[0][l] - a[0][l] * b[2][l];
        let z = a[0][l] * b[1][l] - a[1][l] * b[0][l];
        result[l] = (x * x + y * y + z * z).sqrt();
    }
    result
}

/// The area of each atom, µm²: a third of those of its facets, eq. (surface.2).
#[inline(always)]
pub fn areas<const L: usize>(mesh: &SurfaceMesh, x: &[[f64; L]], areas: &mut [[f64; L]]) {
    areas.fill([0.0; L]);
    for &[a, b, c] in &mesh.facets {
        let double = double_area(&minus(x, b, a), &minus(x, c, a));
        for atom in [a, b, c] {
            let area = &mut areas[atom as usize];
            for l in 0..L {
                area[l] += double[l] * (1.0 / 6.0);
            }
        }
    }
}

/// The same, and the weight of each edge: half the sum of the cotangents of the angles opposite it, eq. (surface.2).
#[inline(always)]
pub fn areas_and_weights<const L: usize>(
    mesh: &SurfaceMesh,
    x: &[[f64; L]],
    areas: &mut [[f64; L]],
    weights: &mut [[f64; L]],
) {
    areas.fill([0.0; L]);
    weights.fill([0.0; L]);
    for (facet, edges) in mesh.facets.iter().zip(&mesh.facet_edges) {
        let &[a, b, c] = facet;
        let sides = [minus(x, c, b), minus(x, a, c), minus(x, b, a)];
        let double = double_area(&sides[1], &sides[2]);
        let squares = [dot(&sides[0], &sides[0]), dot(&sides[1], &sides[1]), dot(&sides[2], &sides[2])];
        for corner in 0..3 {
            let area = &mut areas[facet[corner] as usize];
            for l in 0..L {
                area[l] += double[l] * (1.0 / 6.0);
            }
            // The sides that meet in a corner run one to it and one away from it.
            let product = dot(&sides[(corner + 1) % 3], &sides[(corner + 2) % 3]);
            let weight = &mut weights[edges[corner] as usize];
            for l in 0..L {
                let least = LEAST * (squares[0][l] + squares[1][l] + squares[2][l]);
                weight[l] -= 0.5 * product[l] / double[l].max(least);
            }
        }
    }
}

/// The volume inside, µm³; 0 of an open surface.
#[inline(always)]
pub fn volume<const L: usize>(mesh: &SurfaceMesh, x: &[[f64; L]]) -> [f64; L] {
    let mut sum = [0.0; L];
    if !mesh.closed {
        return sum;
    }
    for &[a, b, c] in &mesh.facets {
        let (a, b, c) = (minus(x, a, 0), minus(x, b, 0), minus(x, c, 0));
        for l in 0..L {
            let x = b[1][l] * c[2][l] - b[2][l] * c[1][l];
            let y = b[2][l] * c[0][l] - b[0][l] * c[2][l];
            let z = b[0][l] * c[1][l] - b[1][l] * c[0][l];
            sum[l] += (a[0][l] * x + a[1][l] * y + a[2][l] * z) * (1.0 / 6.0);
        }
    }
    sum
}

/// The sum of all areas.
#[inline(always)]
pub fn total<const L: usize>(areas: &[[f64; L]]) -> [f64; L] {
    let mut sum = [0.0; L];
    for area in areas {
        for l in 0..L {
            sum[l] += area[l];
        }
    }
    sum
}

/// Positions from the centre of the surface (the mean over its area), `[axis][atom][lane]`.
#[inline(always)]
pub fn coordinates<const L: usize>(x: &[[f64; L]], areas: &[[f64; L]], to: &mut [[f64; L]]) {
    let (atoms, whole) = (areas.len(), total(areas));
    for axis in 0..3 {
        let mut centre = [0.0; L];
        for (atom, area) in areas.iter().enumerate() {
            for l in 0..L {
                centre[l] += area[l] * (x[3 * atom + axis][l] - x[axis][l]);
            }
        }
        for l in 0..L {
            centre[l] = x[axis][l] + centre[l] / whole[l];
        }
        for atom in 0..atoms {
            for l in 0..L {
                to[axis * atoms + atom][l] = x[3 * atom + axis][l] - centre[l];
            }
        }
    }
}
