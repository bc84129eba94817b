//! The shape of a surface at its atoms: areas, normals and curvature of a cell as it stands.

use crate::Vec3;

/// Twice the area of a facet is taken to be at least this part of the squares of its edges: where a facet has no area left, a cotangent
/// would be infinite.
const LEAST: f64 = 1e-9;

/// The shape of a cell's surface at its atoms.
#[derive(Debug, Clone, Default)]
pub(super) struct AtomShapes {
    /// A third of the areas of the facets around an atom, µm².
    pub areas: Vec<f64>,
    /// The area that is nearer to an atom than to others on the facets around, µm²; of a facet with an obtuse angle a half at that angle
    /// and a quarter at the others (Meyer, Desbrun, Schröder and Barr 2003).
    nearest: Vec<f64>,
    /// A third of the area vectors of the facets around an atom.
    vectors: Vec<Vec3>,
    /// Sum over the edges of an atom of half the cotangents opposite, times the edge to it, µm.
    gradients: Vec<Vec3>,
}

impl AtomShapes {
    /// Takes the shape of a surface.
    pub fn take(&mut self, facets: &[[u32; 3]], positions: &[Vec3]) {
        let atoms = positions.len();
        for list in [&mut self.areas, &mut self.nearest] {
            list.clear();
            list.resize(atoms, 0.0);
        }
        for list in [&mut self.vectors, &mut self.gradients] {
            list.clear();
            list.resize(atoms, Vec3::zeros());
        }
        for facet in facets {
            let corners = facet.map(|atom| atom as usize);
            let [a, b, c] = corners.map(|atom| positions[atom]);
            let vector = (b - a).cross(&(c - a));
            let doubled = vector.norm();
            for atom in corners {
                self.areas[atom] += doubled / 6.0;
                self.vectors[atom] += vector / 6.0;
            }
            let cosines = [0, 1, 2].map(|at| {
                let [apex, left, right] = [0, 1, 2].map(|step| positions[corners[(at + step) % 3]]);
                (left - apex).dot(&(right - apex))
            });
            let obtuse = cosines.iter().position(|cosine| *cosine < 0.0);
            let least = LEAST * ((b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared());
            for corner in 0..3 {
                let [apex, left, right] = [0, 1, 2].map(|step| corners[(corner + step) % 3]);
                let weight = 0.5 * cosines[corner] / doubled.max(least);
                let edge = weight * (positions[left] - positions[right]);
                match obtuse {
                    None => [left, right].iter().for_each(|atom| {
                        self.nearest[*atom] += 0.25 * weight * (positions[left] - positions[right]).norm_squared();
                    }),
                    Some(at) => self.nearest[apex] += doubled * if at == corner { 0.25 } else { 0.125 },
                }
                self.gradients[left] += edge;
                self.gradients[right] -= edge;
            }
        }
    }

    /// The outward unit normal, eq. (coupling.2); 0 where there is none.
    pub fn normal(&self, atom: usize) -> Vec3 {
        self.vectors[atom].try_normalize(0.0).unwrap_or_default()
    }

    /// The mean curvature, per µm, eq. (coupling.3).
    pub fn curvature(&self, atom: usize) -> f64 {
        0.5 * self.gradients[atom].dot(&self.normal(atom)) / self.nearest[atom].max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::icosphere;

    #[test]
    fn a_sphere_has_its_area_normals_and_curvature() {
        let (radius, middle) = (4.0, Vec3::new(3.0, -2.0, 7.0));
        let mut before = f64::INFINITY;
        let mut areas = 0.0;
        for level in [2, 3, 4] {
            let ball = icosphere(radius, level);
            let positions: Vec<Vec3> = ball.positions.iter().map(|x| x + middle).collect();
            let mut shapes = AtomShapes::default();
            shapes.take(&ball.facets, &positions);
            let whole: f64 = shapes.areas.iter().sum();
            let error = |atom: usize| (radius * shapes.curvature(atom) - 1.0).abs();
            let worst = (0..positions.len()).map(error).fold(0.0, f64::max);
            for (atom, x) in ball.positions.iter().enumerate() {
                assert!(shapes.normal(atom).dot(x) > 0.999 * radius, "a normal points outward");
            }
            let nearest: f64 = shapes.nearest.iter().sum();
            assert!((nearest / whole - 1.0).abs() < 1e-12, "areas share the surface");
            // Of second order at every atom: 4 times less on a mesh twice as fine, with what the next order leaves.
            assert!(worst < 0.35 * before, "level {level}: {worst} after {before}");
            before = worst;
            areas = whole / (4.0 * std::f64::consts::PI * radius * radius);
        }
        assert!((areas - 1.0).abs() < 2e-3 && before < 2e-3, "area {areas}, curvature {before}");
    }

    #[test]
    fn a_saddle_has_no_mean_curvature_and_a_cylinder_half_of_its() {
        // A flat sheet bent around a cylinder of 5 um, and one bent both ways alike.
        let side = 21;
        let at = |number: usize| ((number % side) as f64 - 10.0, (number / side) as f64 - 10.0);
        let facets: Vec<[u32; 3]> = (0..(side - 1) * (side - 1))
            .flat_map(|square| {
                let low = (square / (side - 1) * side + square % (side - 1)) as u32;
                let high = low + side as u32;
                [[low, low + 1, high + 1], [low, high + 1, high]]
            })
            .collect();
        let curvature = |bend: &dyn Fn(f64, f64) -> Vec3| {
            let positions: Vec<Vec3> = (0..side * side).map(|n| bend(0.05 * at(n).0, 0.05 * at(n).1)).collect();
            let mut shapes = AtomShapes::default();
            shapes.take(&facets, &positions);
            shapes.curvature(side * side / 2)
        };
        let cylinder = curvature(&|x, y| Vec3::new(5.0 * (x / 5.0).sin(), y, 5.0 * (x / 5.0).cos()));
        assert!((cylinder - 0.1).abs() < 1e-4, "a cylinder: {cylinder}");
        let saddle = curvature(&|x, y| Vec3::new(x, y, 0.1 * (x * x - y * y)));
        assert!(saddle.abs() < 1e-3, "a saddle: {saddle}");
    }
}
