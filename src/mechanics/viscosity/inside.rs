//! How the material of a filled body resists a change of its shape at a rate, as a fluid does, eqs. (viscosity.7) and (viscosity.8).

use crate::mechanics::lanes::{Real, V3, Vectors, VectorsMut};
use crate::mechanics::tangent::matrix::Blocks;

/// Six times the smallest volume of a tetrahedron, µm³: below it no gradients are defined.
const NO_VOLUME: f64 = 1e-100;

/// The viscosity of what fills a body, ready for all cells that share its mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Inside {
    tetrahedra: Vec<[u32; 4]>,
    /// Viscosity η of each tetrahedron, Pa·s = pN·s/µm².
    shear: Vec<f64>,
}

/// A tetrahedron as its viscosity sees it.
struct Seen<T> {
    /// Gradients of the weights of its atoms, 1/µm.
    gradients: [V3<T>; 4],
    /// Its volume, µm³.
    volume: T,
}

impl<T: Real> Seen<T> {
    #[inline(always)]
    fn new(x: &Vectors<T>, [a, b, c, d]: [u32; 4]) -> Self {
        let origin = x.get(a as usize);
        let (u, v, w) = (x.get(b as usize) - origin, x.get(c as usize) - origin, x.get(d as usize) - origin);
        let across = [v.cross(w), w.cross(u), u.cross(v)];
        let six_volumes = u.dot(across[0]);
        // Turned inside out for a while it resists as its mirror image does.
        let size = six_volumes.max(-six_volumes).max(T::constant(x.token, NO_VOLUME));
        let per = six_volumes / (size * size);
        let [b, c, d] = [across[0].times(per), across[1].times(per), across[2].times(per)];
        Self { gradients: [-(b + c + d), b, c, d], volume: size * (1.0 / 6.0) }
    }
}

impl Inside {
    /// Of tetrahedra with these viscosities, Pa·s.
    ///
    /// # Panics
    /// When there are not as many of one as of the other.
    pub fn new(tetrahedra: &[[u32; 4]], shear: Vec<f64>) -> Self {
        assert_eq!(tetrahedra.len(), shear.len());
        Self { tetrahedra: tetrahedra.to_vec(), shear }
    }

    /// The atoms of its tetrahedra.
    pub fn tetrahedra(&self) -> &[[u32; 4]] {
        &self.tetrahedra
    }

    /// The viscosities of its tetrahedra, Pa·s.
    pub fn shear(&self) -> &[f64] {
        &self.shear
    }

    /// Adds `factor` times V(x) v, eq. (viscosity.8), to `f`.
    #[inline(always)]
    pub fn add_to<T: Real>(&self, factor: f64, x: &Vectors<T>, v: &Vectors<T>, f: &mut VectorsMut<T>) {
        for (atoms, shear) in self.tetrahedra.iter().zip(&self.shear) {
            let seen = Seen::new(x, *atoms);
            let mut moved = [V3::zero(x.token); 4];
            let mut divergence = T::constant(x.token, 0.0);
            for k in 0..4 {
                moved[k] = v.get(atoms[k] as usize);
                divergence += seen.gradients[k].dot(moved[k]);
            }
            let (weight, dilation) = (seen.volume * (shear * factor), divergence * (-2.0 / 3.0));
            for i in 0..4 {
                let g = seen.gradients[i];
                let mut stress = g.times(dilation);
                for j in 0..4 {
                    let h = seen.gradients[j];
                    stress += moved[j].times(g.dot(h)) + h.times(g.dot(moved[j]));
                }
                f.add(atoms[i] as usize, stress.times(weight));
            }
        }
    }

    /// Adds `factor` times V(x) to the blocks of a matrix.
    #[inline(always)]
    pub fn add_blocks<T: Real>(&self, factor: f64, x: &Vectors<T>, blocks: &mut Blocks<T>) {
        for (atoms, shear) in self.tetrahedra.iter().zip(&self.shear) {
            let seen = Seen::new(x, *atoms);
            let weight = seen.volume * (shear * factor);
            for i in 0..4 {
                for j in 0..=i {
                    let (g, h) = (seen.gradients[i], seen.gradients[j]);
                    let (along, h_part, g_part) = (g.dot(h) * weight, h.times(weight), h.times(weight * (-2.0 / 3.0)));
                    let mut rows = [
                        g.times(h_part.x) + g_part.times(g.x),
                        g.times(h_part.y) + g_part.times(g.y),
                        g.times(h_part.z) + g_part.times(g.z),
                    ];
                    rows[0].x += along;
                    rows[1].y += along;
                    rows[2].z += along;
                    blocks.add(atoms[i], atoms[j], rows);
                }
            }
        }
    }
}
