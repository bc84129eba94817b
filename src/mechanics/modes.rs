//! The softest shapes of a mesh: eigenvectors of the stiffness K of the implicit step.
//!
//! K is the same along x, y and z, so that a mode is one number an atom, and is shared by all cells of a mesh, however they are turned.
//! A force on a few atoms moves them mostly by these: as a whole (the mode without stiffness), and by the shapes that give way most.

use nalgebra::{DMatrix, SymmetricEigen};

use super::envelope::products;
use super::implicit::Factor;
use super::lanes::{BlockWork, LANES, Real, dispatch};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;

/// Modes kept of a mesh.
pub const MODES: usize = 16;

/// A number of each mode.
pub type OfModes = [f64; MODES];

/// Meshes up to this size have all their eigenvectors found; larger ones only the softest.
const ALL_UP_TO: usize = 200;

/// Vectors that are iterated: eight beside those kept, so that these settle.
const WIDTH: usize = MODES + 8;

/// Rounds of the iteration, at most. What they leave only means that a little of a mode counts as what is left.
const ROUNDS: usize = 24;

/// The iteration ends where a round changes no stiffness of a mode by more, over itself: an error of a shape is squared in it. The first of what is left
/// is then known to a hundredth.
const SETTLED: f64 = 1e-4;

/// How much of anything is in what an iteration begins with.
const ANY: f64 = 1e-2;

/// What rounding makes of a mode without stiffness, over the largest eigenvalue.
const ROUNDED: f64 = 1e-14;

/// What makes K invertible, over its largest eigenvalue.
const SHIFT: f64 = 1e-7;

/// The softest modes of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Of each atom its part in each mode. Modes are orthonormal; atoms that are held have no part.
    pub shapes: Vec<OfModes>,
    /// Stiffness of each mode, pN/µm; those that are not there have no shape.
    pub stiffness: OfModes,
    /// Stiffness of the softest of what is left, pN/µm; none where nothing is left.
    pub rest: Option<f64>,
}

impl Modes {
    /// The softest modes of K for a mesh of this rest shape (µm, where iterations begin) of which some atoms are held.
    pub fn new(stiffness: &StiffnessMatrix, rest: &[Vec3], held: &[bool]) -> Self {
        let free: Vec<usize> = (0..stiffness.atoms()).filter(|&atom| !held[atom]).collect();
        let pairs = if free.len() <= ALL_UP_TO { all(stiffness, &free) } else { softest(stiffness, rest, held, &free) };
        let mut modes =
            Self { shapes: vec![OfModes::default(); stiffness.atoms()], stiffness: OfModes::default(), rest: None };
        for (number, (value, vector)) in pairs.iter().take(MODES).enumerate() {
            modes.stiffness[number] = value.max(0.0);
            for (&atom, part) in free.iter().zip(vector) {
                modes.shapes[atom][number] = *part;
            }
        }
        modes.rest = pairs.get(MODES).map(|(value, _)| value.max(0.0));
        modes
    }
}

impl Modes {
    /// Those of a rigid body: it moves as a whole, held by springs of this stiffness an atom (pN/µm), and in no other shape.
    pub fn rigid(atoms: usize, stiffness: f64) -> Self {
        let whole = std::array::from_fn(|number| if number == 0 { 1.0 / (atoms as f64).sqrt() } else { 0.0 });
        let stiffness = std::array::from_fn(|number| if number == 0 { stiffness } else { 0.0 });
        Self { shapes: vec![whole; atoms], stiffness, rest: None }
    }
}

/// Stiffness and shape of a mode over the free atoms.
type Pair = (f64, Vec<f64>);

/// All eigenvectors, the softest first.
fn all(stiffness: &StiffnessMatrix, free: &[usize]) -> Vec<Pair> {
    if free.is_empty() {
        return Vec::new();
    }
    let mut row_of = vec![usize::MAX; stiffness.atoms()];
    free.iter().enumerate().for_each(|(row, &atom)| row_of[atom] = row);
    let mut matrix = DMatrix::zeros(free.len(), free.len());
    for (row, &atom) in free.iter().enumerate() {
        for (other, value) in stiffness.row(atom).filter(|&(other, _)| row_of[other] != usize::MAX) {
            matrix[(row, row_of[other])] += value;
        }
    }
    sorted(SymmetricEigen::new(matrix), |vector| vector.to_vec())
}

fn sorted(found: SymmetricEigen<f64, nalgebra::Dyn>, shape: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Pair> {
    let columns = found.eigenvectors.column_iter().map(|column| column.iter().copied().collect::<Vec<f64>>());
    let mut pairs: Vec<Pair> = found.eigenvalues.iter().copied().zip(columns).collect();
    pairs.sort_by(|one, other| one.0.total_cmp(&other.0));
    pairs.iter().map(|(value, vector)| (*value, shape(vector))).collect()
}

/// The softest eigenvectors by iteration with the inverse (subspace iteration with Rayleigh and Ritz).
fn softest(stiffness: &StiffnessMatrix, rest: &[Vec3], held: &[bool], free: &[usize]) -> Vec<Pair> {
    let largest = stiffness.largest().max(f64::MIN_POSITIVE);
    let inverse = Factor::new(stiffness, SHIFT * largest, 1.0, held);
    let mut values = smooth(rest);
    values.chunks_exact_mut(WIDTH).zip(held).filter(|(_, held)| **held).for_each(|(row, _)| row.fill(0.0));
    let mut scratch = values.clone();
    orthonormalise(&mut values, WIDTH);
    let mut found = projected(stiffness, &values, WIDTH);
    for _ in 0..ROUNDS {
        inverse.solve(WIDTH, &mut values, &mut scratch);
        orthonormalise(&mut values, WIDTH);
        let before = sorted_values(&found);
        found = projected(stiffness, &values, WIDTH);
        // Moving as a whole has no stiffness but what is rounded.
        let settled = |(before, now): (&f64, &f64)| (before - now).abs() <= SETTLED * now + ROUNDED * largest;
        if before.iter().zip(&sorted_values(&found)).take(MODES).all(settled) {
            break;
        }
    }
    ritz(found, free, &values, WIDTH)
}

/// Where the iteration begins: the products of up to three coordinates, which soft modes are nearly, and a little of anything, so that none is made of
/// the others. The first is constant: moving as a whole is a mode of every free mesh, and is to be one exactly.
fn smooth(rest: &[Vec3]) -> Vec<f64> {
    let middle = rest.iter().sum::<Vec3>() / rest.len() as f64;
    let size = rest.iter().map(|position| (position - middle).norm()).fold(f64::MIN_POSITIVE, f64::max);
    let row = |(atom, position): (usize, &Vec3)| -> [f64; WIDTH] {
        let at = (position - middle) / size;
        let [x, y, z] = [at.x, at.y, at.z];
        let products = [1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x, x * y * z];
        let squares = [x * x, y * y, z * z];
        let cubes = [x, y, z].into_iter().flat_map(|one| squares.map(|square| one * square));
        let mut all = products.into_iter().chain(cubes);
        std::array::from_fn(|mode| {
            let number = atom * WIDTH + mode;
            let any = if mode == 0 { 0.0 } else { ((number * 7919 + 13) % 1009) as f64 / 504.5 - 1.0 };
            all.next().map_or(any, |smooth| smooth + ANY * any)
        })
    };
    rest.iter().enumerate().flat_map(row).collect()
}

/// The eigenvalues, the least first.
fn sorted_values(found: &SymmetricEigen<f64, nalgebra::Dyn>) -> Vec<f64> {
    let mut values: Vec<f64> = found.eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Gram and Schmidt, twice, over rows of `width` numbers an atom.
fn orthonormalise(values: &mut [f64], width: usize) {
    let atoms = values.len() / width;
    let mut columns: Vec<f64> = (0..values.len()).map(|i| values[i % atoms * width + i / atoms]).collect();
    dispatch(LANES, GramSchmidt { atoms, columns: &mut columns });
    for (atom, row) in values.chunks_exact_mut(width).enumerate() {
        row.iter_mut().enumerate().for_each(|(c, value)| *value = columns[c * atoms + atom]);
    }
}

struct GramSchmidt<'a> {
    atoms: usize,
    columns: &'a mut [f64],
}

impl BlockWork for GramSchmidt<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, _: T::Token, _: usize) {
        for start in (0..self.columns.len()).step_by(self.atoms) {
            let (before, rest) = self.columns.split_at_mut(start);
            let column = &mut rest[..self.atoms];
            for _ in 0..2 {
                for other in before.chunks_exact(self.atoms) {
                    let [along] = products(column, [other]);
                    column.iter_mut().zip(other).for_each(|(a, b)| *a -= along * b);
                }
            }
            let [squares] = products(column, [&*column]);
            let size = squares.sqrt();
            column.iter_mut().for_each(|a| *a /= size);
        }
    }
}

/// The eigenvectors of K within the span of columns.
fn projected(stiffness: &StiffnessMatrix, values: &[f64], width: usize) -> SymmetricEigen<f64, nalgebra::Dyn> {
    let mut product = vec![0.0; values.len()];
    for atom in 0..stiffness.atoms() {
        for (other, entry) in stiffness.row(atom) {
            for column in 0..width {
                product[atom * width + column] += entry * values[other * width + column];
            }
        }
    }
    let mut small = DMatrix::<f64>::zeros(width, width);
    for (shapes, products) in values.chunks_exact(width).zip(product.chunks_exact(width)) {
        for (column, shape) in small.as_mut_slice().chunks_exact_mut(width).zip(shapes) {
            column.iter_mut().zip(products).for_each(|(to, product)| *to += shape * product);
        }
    }
    SymmetricEigen::new(0.5 * (&small + small.transpose()))
}

/// The same over atoms, the softest first.
fn ritz(found: SymmetricEigen<f64, nalgebra::Dyn>, free: &[usize], values: &[f64], width: usize) -> Vec<Pair> {
    sorted(found, |vector| {
        free.iter().map(|&atom| (0..width).map(|c| vector[c] * values[atom * width + c]).sum()).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::icosphere;

    fn springs(level: u32, held: &[usize]) -> (StiffnessMatrix, Vec<Vec3>, Vec<bool>) {
        let ball = icosphere(1.0, level);
        let atoms = ball.positions.len();
        let mut stiffness = StiffnessMatrix::new(atoms);
        for &[i, j, k] in &ball.facets {
            [(i, j), (j, k), (k, i)].into_iter().for_each(|(i, j)| stiffness.add_spring(i as usize, j as usize, 2.0));
        }
        (stiffness, ball.positions, (0..atoms).map(|atom| held.contains(&atom)).collect())
    }

    #[test]
    fn modes_are_orthonormal_eigenvectors_and_the_first_moves_all_alike() {
        // 42 and 162 atoms by all eigenvectors, 642 by iteration, which settles the soft ones first.
        for (level, off) in [(1, 1e-12), (2, 1e-12), (3, 1e-3)] {
            let (stiffness, rest, held) = springs(level, &[]);
            let modes = Modes::new(&stiffness, &rest, &held);
            let column = |k: usize| -> Vec<f64> { modes.shapes.iter().map(|shape| shape[k]).collect() };
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            for k in 0..MODES {
                let shape = column(k);
                for other in 0..=k {
                    let wanted = f64::from(u8::from(other == k));
                    assert!((dot(&shape, &column(other)) - wanted).abs() < 1e-10, "{level} {k} {other}");
                }
                let product: Vec<f64> =
                    (0..shape.len()).map(|i| stiffness.row(i).map(|(j, value)| value * shape[j]).sum()).collect();
                let left = product.iter().zip(&shape).map(|(p, v)| (p - modes.stiffness[k] * v).powi(2)).sum::<f64>();
                assert!(left.sqrt() < off * stiffness.largest(), "{level} {k}: {}", left.sqrt());
            }
            let even = 1.0 / (modes.shapes.len() as f64).sqrt();
            assert!(modes.stiffness[0] < 1e-10 && column(0).iter().all(|part| (part.abs() - even).abs() < 1e-12));
            assert!(modes.rest.is_some_and(|rest| rest >= modes.stiffness[MODES - 1]));
        }
    }

    #[test]
    fn what_the_iteration_leaves_of_stiffnesses_is_as_little_as_its_constants_say() {
        // By all eigenvectors, which rounding leaves to 1e-9 of a stiffness.
        let (stiffness, rest, held) = springs(3, &[]);
        let free: Vec<usize> = (0..held.len()).collect();
        let modes = Modes::new(&stiffness, &rest, &held);
        let exact: Vec<f64> = all(&stiffness, &free).iter().map(|(value, _)| *value).collect();
        for (found, exact) in modes.stiffness.iter().zip(&exact).skip(1) {
            assert!((-1e-9..SETTLED).contains(&(found / exact - 1.0)), "{found} {exact}");
        }
        let left = modes.rest.expect("more than the modes") / exact[MODES] - 1.0;
        println!("the softest of what is left: {left}");
        assert!((-1e-9..0.01).contains(&left), "{left}");
    }

    #[test]
    fn atoms_that_are_held_have_no_part_and_few_atoms_have_all_modes() {
        let (stiffness, rest, held) = springs(0, &[4]);
        let modes = Modes::new(&stiffness, &rest, &held);
        assert_eq!(modes.shapes[4], [0.0; MODES]);
        assert!(modes.rest.is_none() && modes.stiffness[0] > 0.0, "eleven free atoms, one of them held beside");
        let nothing = Modes::new(&stiffness, &rest, &[true; 12]);
        assert!(nothing.rest.is_none() && nothing.shapes.iter().all(|shape| *shape == [0.0; MODES]));
    }
}
