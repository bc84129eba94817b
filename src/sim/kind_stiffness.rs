//! How stiff the cells of a kind are: the constant stiffness K of the implicit step, and how it stands to the true one, J.

use super::kind::Kind;
use super::softest::{COVERED, any_direction, measure_softest_ratio, stiffness_along};
use crate::Vec3;
use crate::mechanics::implicit::Factor;
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::mechanics::sum::stiffness;
use crate::mechanics::tangent::Tangent;
use crate::mechanics::{Force, rigid, volume};

/// Rounds of the power iteration for the largest stiffness.
const POWER_ROUNDS: usize = 150;

/// The largest ratio of the true stiffness at rest to the constant one of the implicit step.
const LARGEST_RATIO: f64 = 0.75;

/// Below this part of K the true stiffness of some shape is so small that K tells nothing of it.
const LEAST_TOLD: f64 = 0.02;

/// The same for a single cell that tools touch, which tell what force it takes to dent it: what K takes too stiff follows over several
/// steps, and meanwhile the force is too large.
const LEAST_TOLD_OF_TOUCHED: f64 = 0.1;

impl Kind {
    /// Whether K tells for all shapes of a cell, by a factor, how stiff it is, eq. (step.9).
    pub fn is_told(&self) -> bool {
        self.softest_ratio > LEAST_TOLD
    }

    /// Largest eigenvalue of the true stiffness at rest, pN/µm: of elastic forces by power iteration on differences, of all others
    /// (fibres at full activation) by the sum of a bound of each; what explicit schemes need to know.
    pub fn measure_largest_stiffness(&self) -> f64 {
        // Power iteration approaches from below; two percent cover what is left after the last round.
        let elastic = 1.02 * self.power_iteration(&self.rest.positions, |_| ());
        // Each by itself, so that what one bound is does not depend on which atoms others act on; those that are driven first.
        let bounds = |driven: bool| -> f64 {
            let forces = self.forces.iter().filter(|force| force.handle().is_some() == driven);
            forces.filter_map(Force::largest_stiffness).sum()
        };
        // Twice what the fibres of one atom sum up to bounds those that come and go.
        elastic + bounds(true) + bounds(false) + 2.0 * self.pod_fibre_stiffness()
    }

    /// Sets the stiffness K of the implicit step to the one that fits the rest shape; see [`Kind::stiffness_at`].
    pub fn bound_stiffness(&mut self) {
        // Bodies of an elastic material have their own, and it takes long to find out how a constant one of so many atoms stands to it.
        if self.solids().next().is_some() {
            self.stiffness = stiffness(&self.forces, &self.rest.positions, &self.rest.positions);
            self.softest_ratio = 0.0;
            return;
        }
        self.stiffness = self.stiffness_at(&self.rest.positions);
        self.softest_ratio = self.usual_softest_ratio();
    }

    /// Lets each cell have its own stiffness, eq. (step.10), where K overestimates the shear of a membrane too far; `touched` by tools, a
    /// single one sooner, and where a membrane is viscous, whose part of the matrix is each cell's own. Not for cells that contacts move by the drag of their atoms alone.
    pub fn use_tangent(&mut self, touched: bool) {
        let is_alone = touched && self.lanes == 1;
        let creeps = |least: f64| measure_softest_ratio(self, LARGEST_RATIO) <= least;
        if self.viscosity.is_some()
            || self.has_filling()
            || self.plates().next().is_some()
            || self.has_soft_shear()
            || is_alone && self.shears() && creeps(LEAST_TOLD_OF_TOUCHED)
        {
            self.tangent = Some(Tangent::new(&self.forces, self.viscosity.as_ref(), &self.rest.positions, self.lanes));
        }
    }

    /// Whether K overestimates the shear of a membrane so far that cells creep where they have no stiffness of their own.
    pub fn has_soft_shear(&self) -> bool {
        self.shears() && !self.is_told()
    }

    /// Whether springs or an elastic material fill its cells, whose true stiffness is known.
    fn has_filling(&self) -> bool {
        let fills = |force: &Force| matches!(force, Force::Solid(_) | Force::Springs(_));
        !self.tetrahedra.is_empty() && self.forces.iter().any(fills)
    }

    /// Whether a membrane resists shear.
    fn shears(&self) -> bool {
        let shears = |force: &Force| matches!(force, Force::Membrane(membrane) if membrane.law().shear() > 0.0);
        self.forces.iter().any(shears)
    }

    /// The stiffness K of the implicit step for a cell in the shape `x` (µm): the linear part of its elastic forces there,
    /// raised until the true stiffness J there is nowhere more than [`LARGEST_RATIO`] times as large, since the scheme
    /// bears a K that is too small by two and cells go on deforming; then that of all other forces.
    pub fn stiffness_at(&self, x: &[Vec3]) -> StiffnessMatrix {
        let mut matrix = stiffness(&self.forces, &self.rest.positions, x);
        let free = vec![false; self.atoms()];
        // A little of the identity makes K invertible; J does not resist what K does not resist.
        let inverse = Factor::new(&matrix, 1e-5 * matrix.largest().max(f64::MIN_POSITIVE), 1.0, &free);
        let mut scratch = vec![0.0; 3 * self.atoms()];
        let ratio = self.power_iteration(x, |v| inverse.solve(3, v, &mut scratch));
        if ratio > LARGEST_RATIO {
            matrix.scale(ratio / LARGEST_RATIO);
        }
        let others = self.forces.iter().filter(|force| !force.is_elastic());
        others.for_each(|force| force.add_stiffness(&self.rest.positions, x, &mut matrix));
        matrix
    }

    /// The least eigenvalue of K⁻¹ J at rest over all that is no rigid motion, for filters of errors: by power iteration on what the largest
    /// is more, which on fine meshes stands still above the softest shapes, that [`measure_softest_ratio`] finds.
    fn usual_softest_ratio(&self) -> f64 {
        let (rest, held) = (&self.rest.positions, vec![false; self.atoms()]);
        let little = 1e-5 * self.stiffness.largest().max(f64::MIN_POSITIVE);
        let inverse = Factor::new(&self.stiffness, little, 1.0, &held);
        let mut scratch = vec![0.0; 3 * self.atoms()];
        let x: Vec<f64> = rest.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        let mut rigid = vec![0.0; x.len()];
        let mut before: Vec<f64> = Vec::new();
        let beyond = self.power_iteration(rest, |next| {
            inverse.solve(3, next, &mut scratch);
            // `next` is K⁻¹ J v; what is iterated is v less that, without what moves the cell as a whole.
            if before.len() == next.len() {
                next.iter_mut().zip(&before).for_each(|(next, v)| *next = LARGEST_RATIO * v - *next);
            }
            if !self.is_held() {
                rigid::split_block(1, self.atoms(), &x, next, &mut rigid, rigid::Whole::free(1.0));
            }
            let size = next.iter().map(|a| a * a).sum::<f64>().sqrt();
            before = next.iter().map(|a| a / size).collect();
        });
        // The iteration approaches from above, slowly where many shapes are nearly as soft.
        COVERED * (LARGEST_RATIO - beyond).max(0.0)
    }

    /// The largest eigenvalue of P J, J the stiffness in the shape `x` and P the change that `precondition` makes in place.
    fn power_iteration(&self, x: &[Vec3], mut precondition: impl FnMut(&mut [f64])) -> f64 {
        let mut v = any_direction(3 * x.len());
        let mut largest: f64 = 0.0;
        for round in 0..POWER_ROUNDS {
            volume::hold(1, &self.held, &mut v);
            let size = v.iter().map(|a| a * a).sum::<f64>().sqrt();
            if size == 0.0 {
                break;
            }
            v.iter_mut().for_each(|a| *a /= size);
            let mut next = stiffness_along(self, x, &v);
            precondition(&mut next);
            let before = largest;
            largest = next.iter().zip(&v).map(|(a, b)| a * b).sum::<f64>();
            v = next;
            if round > 20 && (largest - before).abs() < 1e-4 * largest {
                break;
            }
        }
        largest
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, SymmetricEigen};

    use super::*;
    use crate::geometry::{Topology, icosphere};
    use crate::mechanics::membrane::{Membrane, MembraneLaw};
    use crate::mechanics::shape_memory::{Reaction, ShapeMemory};
    use crate::mechanics::sum::measure_elastic;

    /// The eigenvalues of K⁻¹ J at rest by dense matrices, rising, of what is not held.
    fn ratios(kind: &Kind) -> Vec<f64> {
        let x: Vec<f64> = kind.rest.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
        let size = x.len();
        let force = |column: usize, shift: f64| {
            let mut moved = x.clone();
            moved[column] += shift;
            let mut f = vec![0.0; size];
            measure_elastic(&kind.forces, 1, &moved, &mut f, &mut [0.0]);
            f
        };
        let columns: Vec<(Vec<f64>, Vec<f64>)> = (0..size).map(|c| (force(c, -1e-6), force(c, 1e-6))).collect();
        let true_one = DMatrix::from_fn(size, size, |i, j| {
            let slope = |i: usize, j: usize| (columns[j].0[i] - columns[j].1[i]) / 2e-6;
            0.5 * (slope(i, j) + slope(j, i))
        });
        let mut constant = DMatrix::identity(size, size) * (1e-5 * kind.stiffness.largest());
        for i in 0..kind.atoms() {
            for (j, value) in kind.stiffness.row(i) {
                (0..3).for_each(|axis| constant[(3 * i + axis, 3 * j + axis)] += value);
            }
        }
        let free: Vec<usize> = (0..size).filter(|i| kind.held.get(*i) != Some(&0.0)).collect();
        let [constant, true_one] =
            [constant, true_one].map(|matrix: DMatrix<f64>| matrix.select_rows(&free).select_columns(&free));
        let inverse = constant.cholesky().expect("K is positive").l().try_inverse().expect("K is positive");
        let both = &inverse * true_one * inverse.transpose();
        let mut values: Vec<f64> = SymmetricEigen::new(both).eigenvalues.iter().copied().collect();
        values.sort_by(f64::total_cmp);
        values
    }

    #[test]
    fn the_constant_stiffness_is_told_apart_from_the_true_one_as_dense_matrices_do() {
        let ball = icosphere(5.0, 1);
        let rings: Vec<Vec<u32>> = Topology::of(&ball).rings.into_iter().map(|ring| ring.atoms).collect();
        let memory = Force::ShapeMemory(ShapeMemory::new(&ball.positions, &rings, 2.0, Reaction::Exact));
        let membrane = Force::Membrane(Membrane::new(
            &ball.positions,
            &ball.facets,
            MembraneLaw::Skalak { shear: 100.0, area: 200.0 },
        ));
        for force in [memory, membrane] {
            let mut kind = Kind::new("ball", ball.clone(), vec![force]);
            kind.bound_stiffness();
            let values = ratios(&kind);
            let largest = values.last().copied().expect("values");
            assert!((largest / LARGEST_RATIO - 1.0).abs() < 0.05, "{largest}");
            // Six are rigid motions, to which J is blind.
            let softest = values[6];
            println!("{softest}, found {}", kind.softest_ratio);
            assert!(values[5].abs() < 1e-6 && softest > 0.01, "{values:?}");
            let share = kind.softest_ratio / softest;
            assert!((0.75..1.0).contains(&share), "{} and {softest}", kind.softest_ratio);
        }
    }

    #[test]
    fn the_softest_shape_of_a_held_shell_is_found() {
        // Many shapes bend normal to the surface and are nearly as soft: power iteration found 0.44 for a shell of 642 atoms
        // whose softest has 0.056.
        let ball = icosphere(5.0, 2);
        let law = MembraneLaw::NeoHookean { shear: 112.5, area: 225.0, hardening: 0.0 };
        let membrane = Force::Membrane(Membrane::new(&ball.positions, &ball.facets, law));
        let mut kind = Kind::new("shell", ball.clone(), vec![membrane]);
        kind.held = ball.positions.iter().flat_map(|p| [if p.z < 0.0 { 0.0 } else { 1.0 }; 3]).collect();
        kind.bound_stiffness();
        let (softest, found) = (ratios(&kind)[0], measure_softest_ratio(&kind, LARGEST_RATIO));
        assert!((0.75..0.9).contains(&(found / softest)) && softest < 0.2, "{found} and {softest}");
    }
}
