//! The linear systems of implicit steps, one for each cell: whole matrices, or, where most of their entries are nothing, the others alone.

use pulp::Simd;

use super::lu::{self, Swap};
use super::wide::{negated_where_finite, take_away};
use crate::equations::program::{Elimination, Lanes, Program};

/// Rows are not exchanged among entries that are picked. Where what is taken from a row has been so many times larger than the row itself, ten of the
/// sixteen digits may be lost: the lane's matrix is then factored as a whole.
const GROWTH: f64 = 1e6;

/// Matrices and their factors.
#[derive(Debug, Clone)]
pub struct Linear<const L: usize> {
    /// The entries that are picked.
    entries: Vec<Lanes<L>>,
    /// One row of them, or a right side, by the order of elimination.
    row: Vec<Lanes<L>>,
    /// Lanes whose matrices are factored as a whole in spite of that.
    whole: [bool; L],
    /// Whole matrices, `matrix[row·n + column]`; only where they are needed.
    matrix: Vec<Lanes<L>>,
    /// Their row exchanges.
    swaps: Vec<Swap<L>>,
    /// A right side for them.
    right: Vec<Lanes<L>>,
}

impl<const L: usize> Linear<L> {
    /// Buffers for the matrices of a program; none where no method asks for any.
    pub fn new(program: &Program, is_asked: bool) -> Self {
        let n = if is_asked { program.size() } else { 0 };
        let (picked, whole) = match program.elimination.as_ref().filter(|_| is_asked) {
            Some(known) => (known.columns.len(), 0),
            None => (0, n * n),
        };
        let lanes = |count: usize| vec![[0.0; L]; count];
        Self {
            entries: lanes(picked),
            row: lanes(if picked > 0 { n } else { 0 }),
            whole: [false; L],
            matrix: lanes(whole),
            swaps: Vec::with_capacity(whole / 2),
            right: Vec::new(),
        }
    }

    /// Factors diagonal − J, whose entries stand in the registers of the program's `linear` code.
    #[inline(always)]
    pub fn factor<S: Simd>(&mut self, simd: S, program: &Program, file: &[Lanes<L>], diagonal: &Lanes<L>) {
        let Some(known) = &program.elimination else {
            self.factor_whole(simd, program, file, diagonal);
            return;
        };
        self.entries.fill([0.0; L]);
        for (&to, &register) in known.from_pattern.iter().zip(&program.linear.outputs[2 * program.size()..]) {
            negated_where_finite(simd, &file[register as usize], &mut self.entries[to as usize]);
        }
        for &to in &known.diagonals {
            for l in 0..L {
                self.entries[to as usize][l] += diagonal[l];
            }
        }
        self.whole = self.factor_picked(simd, known);
        if self.whole.contains(&true) {
            self.factor_whole(simd, program, file, diagonal);
            self.right.resize(program.size(), [0.0; L]);
        }
    }

    #[inline(always)]
    fn factor_whole<S: Simd>(&mut self, simd: S, program: &Program, file: &[Lanes<L>], diagonal: &Lanes<L>) {
        let n = program.size();
        self.matrix.resize(n * n, [0.0; L]);
        self.matrix.fill([0.0; L]);
        for (&(row, column), &register) in program.pattern.iter().zip(&program.linear.outputs[2 * n..]) {
            negated_where_finite(simd, &file[register as usize], &mut self.matrix[row as usize * n + column as usize]);
        }
        for v in 0..n {
            let entry = &mut self.matrix[v * n + v];
            for l in 0..L {
                entry[l] += diagonal[l];
            }
        }
        lu::factor(simd, &mut self.matrix, n, &mut self.swaps);
    }

    /// Factors the entries that are picked, row by row; the diagonal becomes its inverse. Returns the lanes in which rows have grown too much.
    #[inline(always)]
    fn factor_picked<S: Simd>(&mut self, simd: S, known: &Elimination) -> [bool; L] {
        let (entries, work) = (&mut self.entries, &mut self.row);
        let mut grown = [false; L];
        for (at, &diagonal) in known.diagonals.iter().enumerate() {
            let (start, end) = (known.starts[at] as usize, known.starts[at + 1] as usize);
            let mut size = [0.0_f64; L];
            for (entry, &column) in entries[start..end].iter().zip(&known.columns[start..end]) {
                work[column as usize] = *entry;
                for l in 0..L {
                    size[l] = size[l].max(entry[l].abs());
                }
            }
            let mut taken = [0.0_f64; L];
            for &column in &known.columns[start..diagonal as usize] {
                let above = known.diagonals[column as usize] as usize;
                let mut factor = work[column as usize];
                for l in 0..L {
                    factor[l] *= entries[above][l];
                }
                work[column as usize] = factor;
                let row = above + 1..known.starts[column as usize + 1] as usize;
                for (entry, &column) in entries[row.clone()].iter().zip(&known.columns[row]) {
                    take_away(simd, &mut work[column as usize], &factor, entry);
                    for l in 0..L {
                        taken[l] = taken[l].max((factor[l] * entry[l]).abs());
                    }
                }
            }
            for (entry, &column) in entries[start..end].iter_mut().zip(&known.columns[start..end]) {
                *entry = work[column as usize];
            }
            for l in 0..L {
                let pivot = &mut entries[diagonal as usize][l];
                *pivot = 1.0 / *pivot;
                grown[l] |= !(taken[l] <= GROWTH * size[l] && pivot.is_finite());
            }
        }
        grown
    }

    /// Solves with what was factored last, in place.
    #[inline(always)]
    pub fn solve<S: Simd>(&mut self, simd: S, program: &Program, right: &mut [Lanes<L>]) {
        let Some(known) = &program.elimination else {
            lu::solve(&self.matrix, right.len(), &self.swaps, right);
            return;
        };
        let any_whole = self.whole.contains(&true);
        if any_whole {
            self.right.copy_from_slice(right);
            lu::solve(&self.matrix, right.len(), &self.swaps, &mut self.right);
        }
        self.solve_picked(simd, known, right);
        if any_whole {
            for (to, whole) in right.iter_mut().zip(&self.right) {
                for l in 0..L {
                    to[l] = if self.whole[l] { whole[l] } else { to[l] };
                }
            }
        }
    }

    #[inline(always)]
    fn solve_picked<S: Simd>(&mut self, simd: S, known: &Elimination, right: &mut [Lanes<L>]) {
        let work = &mut self.row;
        for (at, &variable) in known.order.iter().enumerate() {
            let mut sum = right[variable as usize];
            let row = known.starts[at] as usize..known.diagonals[at] as usize;
            for (factor, &column) in self.entries[row.clone()].iter().zip(&known.columns[row]) {
                take_away(simd, &mut sum, factor, &work[column as usize]);
            }
            work[at] = sum;
        }
        for (at, &variable) in known.order.iter().enumerate().rev() {
            let (diagonal, mut sum) = (known.diagonals[at] as usize, work[at]);
            let row = diagonal + 1..known.starts[at + 1] as usize;
            for (factor, &column) in self.entries[row.clone()].iter().zip(&known.columns[row]) {
                take_away(simd, &mut sum, factor, &work[column as usize]);
            }
            for l in 0..L {
                sum[l] *= self.entries[diagonal][l];
            }
            work[at] = sum;
            right[variable as usize] = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::equations::program::run;
    use crate::equations::tree::{Binary, Expr, Quantity, Role, System};

    /// A program whose Jacobian has these entries times the variable `scale`, an input.
    fn program(size: usize, entries: &[(usize, usize, f64)]) -> Program {
        let rate = |row: usize| {
            let terms = entries.iter().filter(|entry| entry.0 == row);
            terms.fold(Expr::Number(0.0), |sum, &(_, column, factor)| {
                let factor = Expr::Number(factor).binary(Binary::Mul, Expr::Quantity(size as u32));
                sum.binary(Binary::Add, factor.binary(Binary::Mul, Expr::Quantity(column as u32)))
            })
        };
        let quantity = |id: String, role: Role| Quantity {
            id,
            name: String::new(),
            role,
            initial: Expr::Number(0.0),
            unit: String::new(),
        };
        let variables = (0..size).map(|row| quantity(format!("x{row}"), Role::Variable { rate: rate(row) }));
        let quantities = variables.chain([quantity("scale".into(), Role::Input)]).collect();
        Program::new(&System { quantities, ..System::default() }).expect("no circles")
    }

    /// Numbers between −1 and 1 that look random.
    fn number(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Some entries a row anywhere, and a few rows and columns that are long.
    fn network(size: usize, seed: &mut u64) -> Vec<(usize, usize, f64)> {
        let mut entries = Vec::new();
        for row in 0..size {
            for column in 0..size {
                let share = if row % 40 == 7 || column % 40 == 9 { 0.5 } else { 2.0 / size as f64 };
                if number(seed).abs() < share {
                    entries.push((row, column, number(seed)));
                }
            }
        }
        entries
    }

    /// What remains of diagonal·x − scale·J x − 1 for the x that is found, by lanes.
    fn remains<const L: usize>(
        program: &Program,
        entries: &[(usize, usize, f64)],
        (diagonal, scale): (Lanes<L>, Lanes<L>),
    ) -> (Lanes<L>, Vec<Lanes<L>>, Linear<L>) {
        let n = program.size();
        let mut file = program.file::<L>();
        file[program.first_open()] = scale;
        run(&program.linear, &mut file);
        let mut linear = Linear::new(program, true);
        linear.factor(pulp::Scalar, program, &file, &diagonal);
        let mut found = vec![[1.0; L]; n];
        linear.solve(pulp::Scalar, program, &mut found);
        let mut worst = [0.0_f64; L];
        for (row, own) in found.iter().enumerate() {
            for l in 0..L {
                let terms = entries.iter().filter(|entry| entry.0 == row).map(|e| e.2 * scale[l] * found[e.1][l]);
                let (sum, size) =
                    terms.fold((diagonal[l] * own[l] - 1.0, 1.0), |(sum, size), term| (sum - term, size + term.abs()));
                worst[l] = worst[l].max(sum.abs() / size);
            }
        }
        (worst, found, linear)
    }

    #[test]
    fn picked_entries_solve_what_whole_matrices_do() {
        let mut seed = 5;
        for size in [30, 120, 400] {
            let entries = network(size, &mut seed);
            let program = program(size, &entries);
            assert!(program.elimination.is_some(), "{size}");
            let (worst, _, linear) = remains(&program, &entries, ([3.0, 50.0, 2.0, 8.0], [1.0, 1.0, 0.5, 1.0]));
            assert!(worst.iter().all(|worst| *worst < 1e-11), "{size}: {worst:?}");
            assert_eq!(linear.whole, [false; 4], "{size}");
        }
    }

    #[test]
    fn rows_that_would_grow_are_exchanged() {
        // A pair that drives each other, with nothing else: its pivots are what the step adds, here a millionth of a millionth.
        let mut entries: Vec<_> = (2..60).map(|row| (row, row - 1, 1.0)).collect();
        entries.extend([(0, 1, 1.0), (1, 0, -1.0), (0, 59, 0.5)]);
        let program = program(60, &entries);
        assert!(program.elimination.is_some());
        let (worst, _, linear) = remains(&program, &entries, ([1e-12, 1.0], [1.0, 1.0]));
        assert_eq!(linear.whole, [true, false]);
        assert!(worst.iter().all(|worst| *worst < 1e-12), "{worst:?}");
    }

    #[test]
    fn a_lane_is_solved_the_same_whatever_its_neighbours() {
        let mut seed = 11;
        let entries = network(120, &mut seed);
        let program = program(120, &entries);
        let (_, together, linear) = remains(&program, &entries, ([1e-13, 3.0, 1e-13], [1.0, 1.0, 2.0]));
        assert_eq!(linear.whole, [true, false, true], "else nothing is shown");
        for (l, (diagonal, scale)) in [(1e-13, 1.0), (3.0, 1.0), (1e-13, 2.0)].into_iter().enumerate() {
            let (_, alone, _) = remains(&program, &entries, ([diagonal], [scale]));
            assert!(together.iter().zip(&alone).all(|(a, b)| a[l].to_bits() == b[0].to_bits()), "{l}");
        }
    }
}
