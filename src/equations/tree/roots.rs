//! Equations that determine quantities, and how they are solved: Newton's rule, eq. (ode.11), with steps that are shortened
//! until the equations come nearer to nothing and do not change much, so that they are not led past where they are singular.

use super::{Expr, QuantityId};
use crate::elementary;
use serde::{Deserialize, Serialize};

/// Equations that determine some quantities together.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Equations {
    /// What they determine: in `residuals`, and nowhere else, these stand for the numbers that are looked for.
    pub unknowns: Vec<QuantityId>,
    /// What is nothing, one for each unknown. They do not look back.
    pub residuals: Vec<Expr>,
    /// Where the search begins.
    pub starts: Vec<Expr>,
}

/// Most times that the equations are worked out for a solution.
const MOST_EVALUATIONS: usize = 200;
/// A step of this part of the unknowns is the last: the next one would be its square.
const LAST_STEP: f64 = 1e-9;
/// Where a step of this part of the unknowns does not bring the equations nearer to nothing, round-off is all that is left of them.
const ROUND_OFF: f64 = 1e-6;
/// A step that is shortened to less than this part of the unknowns leads nowhere.
const LEAST_STEP: f64 = 1e-13;
/// The determinant of the slopes may change by this factor in a step, as a logarithm: ln 4.
const LARGEST_CHANGE: f64 = 1.386_294_361_119_890_6;
/// A step of this part of the unknowns may change it by more: there is a kink.
const ACROSS_KINK: f64 = 1e-3;

/// Numbers of a search for `count` unknowns in a row of registers, for each of `L` lanes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Search {
    /// How many unknowns there are.
    pub count: usize,
}

impl Search {
    /// How many registers a search takes.
    pub const fn registers(self) -> usize {
        7 * self.count + 2 * self.count * self.count
    }

    /// The unknowns; they hold the starts before, and the solution after, or what is no number where there is none.
    pub const fn unknown(self, index: usize) -> usize {
        index
    }

    /// The values of the equations, which `evaluate` of [`Search::solve`] sets.
    pub const fn residual(self, index: usize) -> usize {
        self.count + index
    }

    /// Their derivatives, row by row, which `evaluate` sets, too.
    pub const fn slope(self, row: usize, column: usize) -> usize {
        7 * self.count + row * self.count + column
    }

    const fn base(self, index: usize) -> usize {
        2 * self.count + index
    }

    const fn step(self, index: usize) -> usize {
        3 * self.count + index
    }

    /// What the values of the equations are at the base, by their size.
    const fn scale(self, index: usize) -> usize {
        4 * self.count + index
    }

    const fn start(self, index: usize) -> usize {
        5 * self.count + index
    }

    /// The step from the unknowns.
    const fn next_step(self, index: usize) -> usize {
        6 * self.count + index
    }

    const fn factor(self, row: usize, column: usize) -> usize {
        7 * self.count + self.count * self.count + row * self.count + column
    }

    /// Solves the equations that `evaluate` works out, in each lane as if it were alone.
    pub fn solve<const L: usize>(self, work: &mut [[f64; L]], mut evaluate: impl FnMut(&mut [[f64; L]])) {
        let mut lanes =
            [Lane { share: 1.0, distance: f64::INFINITY, side: 0.0, size: 0.0, is_begun: false, is_done: false }; L];
        for index in 0..self.count {
            work[self.start(index)] = work[self.unknown(index)];
            work[self.scale(index)] = [1.0; L];
        }
        for _ in 0..MOST_EVALUATIONS {
            evaluate(work);
            for (l, lane) in lanes.iter_mut().enumerate().filter(|(_, lane)| !lane.is_done) {
                self.advance(work, l, lane);
            }
            if lanes.iter().all(|lane| lane.is_done) {
                return;
            }
        }
        for (l, _) in lanes.iter().enumerate().filter(|(_, lane)| !lane.is_done) {
            self.fail(work, l);
        }
    }

    /// Takes the values at the unknowns up: goes on from there, or with a shorter step, or is done.
    fn advance<const L: usize>(self, work: &mut [[f64; L]], l: usize, lane: &mut Lane) {
        let distance = self.distance(work, l);
        // A step that is shortened to a share of itself should bring the equations nearer by about that share.
        let is_nearer = !lane.is_begun || distance <= (1.0 - lane.share / 8.0) * lane.distance;
        if is_nearer && (0..self.count).all(|index| work[self.residual(index)][l] == 0.0) {
            lane.is_done = true;
            return;
        }
        let slopes = if is_nearer { self.newton(work, l) } else { (0.0, 0.0) };
        if is_nearer && (!lane.is_begun || self.is_beside(work, l, lane, slopes)) {
            self.go_on(work, l, lane, slopes);
        } else {
            self.shorten(work, l, lane);
        }
    }

    /// Whether the slopes are so like those at the base that the equations are not singular between. Beyond where they are there are other
    /// solutions, if any.
    fn is_beside<const L: usize>(self, work: &[[f64; L]], l: usize, lane: &Lane, (side, size): (f64, f64)) -> bool {
        let is_like = (size - lane.size).abs() <= LARGEST_CHANGE;
        side == lane.side && (is_like || self.is_short(work, l, ACROSS_KINK / lane.share))
    }

    /// Makes the unknowns the base of the next step.
    fn go_on<const L: usize>(self, work: &mut [[f64; L]], l: usize, lane: &mut Lane, (side, size): (f64, f64)) {
        for index in 0..self.count {
            work[self.base(index)][l] = work[self.unknown(index)][l];
            work[self.step(index)][l] = work[self.next_step(index)][l];
            let sizes = (0..self.count).map(|column| work[self.slope(index, column)][l].abs());
            let size = sizes.fold(0.0, f64::max);
            work[self.scale(index)][l] = if size > 0.0 { size } else { 1.0 };
        }
        if side == 0.0 || !(0..self.count).all(|index| work[self.step(index)][l].is_finite()) {
            self.fail(work, l);
            lane.is_done = true;
            return;
        }
        // Where a step had to be shortened the next one is not tried as a whole.
        let share = if lane.is_begun { (4.0 * lane.share).min(1.0) } else { 1.0 };
        let is_done = share == 1.0 && self.is_short(work, l, LAST_STEP);
        *lane = Lane { share, distance: self.distance(work, l), side, size, is_begun: true, is_done };
        self.go(work, l, share);
    }

    /// Tries a shorter step from the base.
    fn shorten<const L: usize>(self, work: &mut [[f64; L]], l: usize, lane: &mut Lane) {
        if lane.share == 1.0 && self.is_short(work, l, ROUND_OFF) {
            (0..self.count).for_each(|index| work[self.unknown(index)][l] = work[self.base(index)][l]);
            lane.is_done = true;
            return;
        }
        lane.share /= 2.0;
        if self.is_short(work, l, LEAST_STEP / lane.share) {
            self.fail(work, l);
            lane.is_done = true;
            return;
        }
        self.go(work, l, lane.share);
    }

    /// The largest of the equations' values by their scales at the base.
    fn distance<const L: usize>(self, work: &[[f64; L]], l: usize) -> f64 {
        let of = |index: usize| (work[self.residual(index)][l] / work[self.scale(index)][l]).abs();
        // What is no number is far away.
        (0..self.count).map(of).fold(0.0_f64, |most, one| if most.is_nan() || one <= most { most } else { one })
    }

    fn is_short<const L: usize>(self, work: &[[f64; L]], l: usize, part: f64) -> bool {
        (0..self.count).all(|index| {
            // Of what is nothing no part is short, so the start says a little of what is.
            let size = work[self.base(index)][l].abs().max(1e-8 * work[self.start(index)][l].abs());
            work[self.step(index)][l].abs() <= part * size
        })
    }

    fn go<const L: usize>(self, work: &mut [[f64; L]], l: usize, share: f64) {
        for index in 0..self.count {
            work[self.unknown(index)][l] = work[self.base(index)][l] + share * work[self.step(index)][l];
        }
    }

    fn fail<const L: usize>(self, work: &mut [[f64; L]], l: usize) {
        (0..self.count).for_each(|index| work[self.unknown(index)][l] = f64::NAN);
    }

    /// The step at which the equations would be nothing if they were straight, by Gauss' elimination with row exchanges;
    /// returns the sign of the slopes' determinant and the logarithm of its size.
    fn newton<const L: usize>(self, work: &mut [[f64; L]], l: usize) -> (f64, f64) {
        let (count, mut side, mut size) = (self.count, 1.0, 0.0);
        for row in 0..count {
            // Rows by their scales, so that units do not choose.
            let scale = work[self.scale(row)][l];
            work[self.next_step(row)][l] = -work[self.residual(row)][l] / scale;
            (0..count).for_each(|column| work[self.factor(row, column)][l] = work[self.slope(row, column)][l] / scale);
        }
        for column in 0..count {
            let entry = |work: &[[f64; L]], row: usize| work[self.factor(row, column)][l].abs();
            let best =
                (column..count).fold(column, |best, row| if entry(work, row) > entry(work, best) { row } else { best });
            if best != column {
                side = -side;
                for other in column..count {
                    let swapped = work[self.factor(best, other)][l];
                    work[self.factor(best, other)][l] = work[self.factor(column, other)][l];
                    work[self.factor(column, other)][l] = swapped;
                }
                let swapped = work[self.next_step(best)][l];
                work[self.next_step(best)][l] = work[self.next_step(column)][l];
                work[self.next_step(column)][l] = swapped;
            }
            let pivot = work[self.factor(column, column)][l];
            side *= f64::from(i8::from(pivot > 0.0) - i8::from(pivot < 0.0));
            size += elementary::ln(pivot.abs()) + elementary::ln(work[self.scale(column)][l]);
            for row in column + 1..count {
                let factor = work[self.factor(row, column)][l] / work[self.factor(column, column)][l];
                for other in column + 1..count {
                    work[self.factor(row, other)][l] -= factor * work[self.factor(column, other)][l];
                }
                work[self.next_step(row)][l] -= factor * work[self.next_step(column)][l];
            }
        }
        for row in (0..count).rev() {
            let known: f64 = (row + 1..count)
                .map(|column| work[self.factor(row, column)][l] * work[self.next_step(column)][l])
                .sum();
            work[self.next_step(row)][l] = (work[self.next_step(row)][l] - known) / work[self.factor(row, row)][l];
        }
        (side, size)
    }
}

/// Where the search in a lane is.
#[derive(Clone, Copy)]
struct Lane {
    /// The part of the step that is tried.
    share: f64,
    /// How far the equations are from nothing at the base.
    distance: f64,
    /// The sign of the determinant of their slopes there, and the logarithm of its size.
    side: f64,
    size: f64,
    is_begun: bool,
    is_done: bool,
}

impl Equations {
    /// The unknown with an index, directly: slopes are differences, which a search needs roughly only.
    pub(super) fn evaluate_at(&self, index: u32, time: f64, value: &dyn Fn(QuantityId, f64) -> f64) -> f64 {
        let search = Search { count: self.unknowns.len() };
        let mut work = vec![[0.0]; search.registers()];
        for (number, start) in self.starts.iter().enumerate() {
            work[search.unknown(number)] = [start.evaluate_at(time, &value)];
        }
        let residual = |row: usize, unknowns: &[f64]| {
            let of = |quantity: QuantityId, at: f64| {
                let known = self.unknowns.iter().position(|unknown| *unknown == quantity);
                known.map_or_else(|| value(quantity, at), |number| unknowns[number])
            };
            self.residuals[row].evaluate_at(time, &of)
        };
        search.solve(&mut work, |work: &mut [[f64; 1]]| {
            let mut unknowns: Vec<f64> = (0..search.count).map(|number| work[search.unknown(number)][0]).collect();
            for row in 0..search.count {
                work[search.residual(row)] = [residual(row, &unknowns)];
            }
            for column in 0..search.count {
                let here = unknowns[column];
                let width = 1e-6 * here.abs().max(1e-6);
                for row in 0..search.count {
                    unknowns[column] = here + width;
                    let above = residual(row, &unknowns);
                    unknowns[column] = here - width;
                    let below = residual(row, &unknowns);
                    unknowns[column] = here;
                    // On the edge of where the equations are numbers one side tells.
                    let slope = match (above.is_finite(), below.is_finite()) {
                        (true, true) => (above - below) / (2.0 * width),
                        (true, false) => (above - work[search.residual(row)][0]) / width,
                        _ => (work[search.residual(row)][0] - below) / width,
                    };
                    work[search.slope(row, column)] = [slope];
                }
            }
        });
        work[search.unknown(index as usize)][0]
    }

    /// The number of every quantity used but the unknowns, as often as it is used.
    pub(super) fn used(&self) -> Vec<QuantityId> {
        let (mut in_starts, mut in_residuals) = (Vec::new(), Vec::new());
        self.starts.iter().for_each(|start| start.each_quantity(&mut |quantity| in_starts.push(quantity)));
        self.residuals.iter().for_each(|one| one.each_quantity(&mut |quantity| in_residuals.push(quantity)));
        in_residuals.retain(|quantity| !self.unknowns.contains(quantity));
        in_starts.extend(in_residuals);
        in_starts
    }

    /// The same with all expressions changed; the unknowns keep their numbers.
    pub fn map(&self, change: impl Fn(&Expr) -> Expr) -> Self {
        Self {
            unknowns: self.unknowns.clone(),
            residuals: self.residuals.iter().map(&change).collect(),
            starts: self.starts.iter().map(&change).collect(),
        }
    }

    /// All expressions.
    pub fn expressions(&self) -> impl Iterator<Item = &Expr> {
        self.residuals.iter().chain(&self.starts)
    }
}

#[cfg(test)]
mod tests {
    use super::Search;

    /// The solution of one equation from a start.
    fn root(start: f64, equation: impl Fn(f64) -> (f64, f64)) -> f64 {
        let search = Search { count: 1 };
        let mut work = vec![[start]; search.registers()];
        search.solve(&mut work, |work: &mut [[f64; 1]]| {
            let (value, slope) = equation(work[0][0]);
            (work[search.residual(0)], work[search.slope(0, 0)]) = ([value], [slope]);
        });
        work[0][0]
    }

    #[test]
    fn roots_are_found_from_far_away_and_across_edges() {
        let close =
            |found: f64, wanted: f64| assert!((found - wanted).abs() <= 1e-14 * wanted.abs(), "{found}, not {wanted}");
        close(root(1.0, |x| (x * x - 2.0, 2.0 * x)), 2_f64.sqrt());
        close(root(20.0, |x| (x.exp() - 5.0, x.exp())), 5_f64.ln());
        // Whole steps of Newton's rule go farther and farther away here.
        close(root(10.0, |x| (x.atan() - 0.5, 1.0 / (1.0 + x * x))), 0.5_f64.tan());
        // A whole step leaves where there is a logarithm.
        close(root(50.0, |x| (x.ln() + 3.0, 1.0 / x)), (-3_f64).exp());
        // Slopes change by a factor of twenty at once.
        let kink = |x: f64| if x < 1.0 { (x, 1.0) } else { (20.0 * x - 19.0, 20.0) };
        close(root(0.5, |x| (kink(x).0 - 5.0, kink(x).1)), 1.2);
        close(root(5.0, |x| (kink(x).0 - 0.5, kink(x).1)), 0.5);
        close(root(1e-8, |x| (x * x - 1.0, 2.0 * x)), 1.0);
        assert_eq!(root(7.0, |x| (x * 3.0, 3.0)), 0.0);
        assert_eq!(root(0.0, |x| (x.sinh(), x.cosh())), 0.0);
    }

    #[test]
    fn what_has_no_solution_is_no_number() {
        assert!(root(3.0, |x| (x * x + 1.0, 2.0 * x)).is_nan());
        assert!(root(0.0, |x| (x * x - 1.0, 2.0 * x)).is_nan(), "it is flat at the start");
        assert!(root(1.0, |_| (f64::NAN, 1.0)).is_nan());
        // The other solution, 2.2, lies beyond where the slope is nothing.
        for value in [2.0001, 2.1, 3.0, 4.0, 5.0, 10.0, 100.0] {
            assert!(root(-2.0, |x| (x.powi(3) - 3.0 * x - value, 3.0 * x * x - 3.0)).is_nan(), "{value}");
        }
    }
}
