//! Helfrich's energy at the atoms of a closed surface, on the metric that it has at the time.

use super::star::{KEPT, Kept, Star};
use crate::Vec3;
use crate::mechanics::lanes::{Real, V3, Vectors, VectorsMut};
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::mechanics::tangent::matrix::Blocks;

/// The bending of a closed mesh, ready for all cells that share it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Atoms {
    /// κ, pN·µm.
    rigidity: f64,
    /// The neighbours of each atom in their order around it, and the curvature without energy there, 1/µm.
    rings: Vec<(Vec<u32>, f64)>,
}

impl Atoms {
    /// Atoms with these rings, free of stress in the shape `positions` (µm) or where they are flat.
    pub fn new<'a>(positions: &[Vec3], rings: impl Iterator<Item = &'a [u32]>, rigidity: f64, remembers: bool) -> Self {
        let x = flat(positions);
        let x = Vectors::<f64>::new((), &x, 1, 0);
        let mut kept = Kept::new(());
        let mut rest = |(atom, ring): (usize, &[u32])| {
            if !remembers || ring.is_empty() {
                return (ring.to_vec(), 0.0);
            }
            let star = Star::measure(&x, atom, ring, &mut kept);
            (ring.to_vec(), star.bent / star.area)
        };
        Self { rigidity, rings: rings.enumerate().map(&mut rest).collect() }
    }

    /// The atoms that have neighbours.
    fn stars(&self) -> impl Iterator<Item = (usize, &[u32], f64)> {
        let all = self.rings.iter().enumerate().map(|(atom, (ring, rest))| (atom, ring.as_slice(), *rest));
        all.filter(|(_, ring, _)| !ring.is_empty())
    }

    /// Adds the force on every atom and returns the energy, eq. (bending.1), pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        let mut kept = Kept::new(x.token);
        for (atom, ring, rest) in self.stars() {
            let star = Star::measure(x, atom, ring, &mut kept);
            let curvature = star.bent / star.area;
            let excess = curvature + -rest;
            energy += excess * excess * star.area * (0.5 * self.rigidity);
            // ∂E = κ (h − c₀) (∂M − ½ (h + c₀) ∂A).
            let by_bent = excess * self.rigidity;
            let by_area = by_bent * (curvature + rest) * -0.5;
            let mut sum = V3::zero(x.token);
            star.gradients(by_bent, by_area, |k, gradient| {
                f.sub(ring[k] as usize, gradient);
                sum += gradient;
            });
            f.add(atom, sum);
        }
        energy
    }

    /// Adds the tangent stiffness of each atom against a change of its curvature h, and that of a tension κ (h² − c²)/2 where that is
    /// positive, which on a sphere is what the bend of h adds, eq. (step.10).
    #[inline(always)]
    pub fn add_tangent<T: Real>(&self, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        let mut kept = Kept::new(x.token);
        let (zero, one) = (T::constant(x.token, 0.0), T::constant(x.token, 1.0));
        let mut few = [V3::zero(x.token); KEPT];
        for (atom, ring, rest) in self.stars() {
            let star = Star::measure(x, atom, ring, &mut kept);
            let by_bent = one / star.area;
            let by_area = -(star.bent * by_bent * by_bent);
            let mut own = V3::zero(x.token);
            star.gradients(by_bent, by_area, |k, gradient| {
                own -= gradient;
                if k < KEPT {
                    few[k] = gradient;
                }
            });
            let gradient = |k: usize| if k < KEPT { few[k] } else { star.gradient(k, by_bent, by_area) };
            let weight = star.area * self.rigidity;
            blocks.add_product(atom as u32, atom as u32, [own, own], weight);
            for (k, &row) in ring.iter().enumerate() {
                let on_row = gradient(k);
                blocks.add_product(row, atom as u32, [on_row, own], weight);
                for (j, &column) in ring[..=k].iter().enumerate() {
                    blocks.add_product(row, column, [on_row, gradient(j)], weight);
                }
            }
            let curvature = star.bent * by_bent;
            let tension = ((curvature * curvature + -(rest * rest)) * (0.5 * self.rigidity)).max(zero);
            // Each facet is a third of each of its atoms'. (`for_each` in its place is not compiled for wide registers.)
            for k in 0..ring.len() {
                star.add_tension(k, tension * (1.0 / 3.0), blocks);
            }
        }
    }

    /// Adds an isotropic bound of the stiffness that [`Self::add_tangent`] has in the shape `x` (µm), equal to it where that is flat.
    pub fn add_stiffness(&self, x: &[Vec3], matrix: &mut StiffnessMatrix) {
        let numbers = flat(x);
        let all = Vectors::<f64>::new((), &numbers, 1, 0);
        let mut kept = Kept::new(());
        for (atom, ring, _) in self.stars() {
            let star = Star::measure(&all, atom, ring, &mut kept);
            let (by_bent, by_area) = (1.0 / star.area, -star.bent / star.area.powi(2));
            let mut gradients = Vec::with_capacity(ring.len());
            star.gradients(by_bent, by_area, |_, gradient| gradients.push(vector(gradient)));
            // In a frame with the normal, (P + Q + R)² ≤ (p + q + r)(P²/p + Q²/q + R²/r) for each of its axes.
            let axes = frame(x, atom, ring);
            let sizes = axes.map(|axis| gradients.iter().map(|g| g.dot(&axis).powi(2)).sum::<f64>().sqrt());
            let scale = star.area * self.rigidity * sizes.iter().sum::<f64>();
            let atoms: Vec<usize> = std::iter::once(atom).chain(ring.iter().map(|&k| k as usize)).collect();
            for (axis, size) in axes.into_iter().zip(sizes) {
                let around: Vec<f64> = gradients.iter().map(|g| g.dot(&axis)).collect();
                let row: Vec<f64> = std::iter::once(-around.iter().sum::<f64>()).chain(around).collect();
                let weight = if size > 0.0 { scale / size } else { 0.0 };
                for (&i, a) in atoms.iter().zip(&row) {
                    for (&j, b) in atoms.iter().zip(&row) {
                        matrix.add(i, j, weight * a * b);
                    }
                }
            }
        }
    }
}

/// The normal of the surface at an atom and two directions along it.
fn frame(x: &[Vec3], atom: usize, ring: &[u32]) -> [Vec3; 3] {
    let side = |k: usize| x[ring[k % ring.len()] as usize] - x[atom];
    let normal: Vec3 = (0..ring.len()).map(|k| side(k).cross(&side(k + 1))).sum();
    let normal = normal.try_normalize(0.0).unwrap_or(Vec3::z());
    let along = side(0) - normal * normal.dot(&side(0));
    let along = along.try_normalize(0.0).unwrap_or(Vec3::zeros());
    [normal, along, normal.cross(&along)]
}

fn flat(positions: &[Vec3]) -> Vec<f64> {
    positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect()
}

fn vector(v: V3<f64>) -> Vec3 {
    Vec3::new(v.x, v.y, v.z)
}
