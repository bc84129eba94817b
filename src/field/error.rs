//! How wrong a step of fields is that was taken whole and in halves: beside the size of a species, and beside what reactions change in it.

/// Parts of a field: its mean, and what differs from it.
const PARTS: usize = 2;

/// What is below this part of a species' size counts as round-off: no pattern, and no error that could become one.
const ROUND_OFF: f64 = 1e-9;

/// A step in which reactions change less than this part is judged as if they changed so much. Where a rate jumps, what a step is wrong by falls
/// only as what it changes does, so that no step would do; and a hundred steps that are wrong by a hundredth of the tolerance are wrong by
/// the tolerance.
const LEAST_SHARE: f64 = 1e-2;

/// Mean and root mean square deviation from it of numbers that are told by their places; both are not negative. In eight sums, so that
/// lanes of numbers are added side by side.
fn moments(len: usize, number: impl Fn(usize) -> f64) -> [f64; PARTS] {
    // Measured from one of them, so that little is lost where all are nearly the same.
    let origin = number(0);
    let (mut sum, mut squares) = ([0.0; 8], [0.0; 8]);
    for at in 0..len {
        let apart = number(at) - origin;
        sum[at % 8] += apart;
        squares[at % 8] += apart * apart;
    }
    let mean = |sums: [f64; 8]| sums.iter().sum::<f64>() / len as f64;
    let (first, second) = (mean(sum), mean(squares));
    let variance = second - first * first;
    // What is no number stays so, to be found.
    [(origin + first).abs(), if variance < 0.0 { 0.0 } else { variance.sqrt() }]
}

/// Root mean square.
fn size([mean, deviation]: [f64; PARTS]) -> f64 {
    (mean * mean + deviation * deviation).sqrt()
}

/// The size that the error of a step is judged beside: that after the step. What was not there before it counts as what it will be at the end
/// of the window, which is so many steps long, if it goes on as in this one: what begins at nothing, as t⁵ where a Hill function of the fourth
/// power makes it, is wrong by the same part of itself in its first step however short that is.
fn judged(before: f64, after: f64, steps: f64) -> f64 {
    if before < ROUND_OFF * after { after * steps } else { after }
}

/// The error of a step in one piece in tolerances, eq. (field.7): the largest over the species of the root mean square beside their size. With
/// the values before the step, and how many such steps a window has, where what begins at nothing is to be borne.
pub fn error_of_size(
    len: usize,
    fine: &[f64],
    whole: &[f64],
    [relative, absolute]: [f64; 2],
    begun: Option<(&[f64], f64)>,
) -> f64 {
    let mut worst: f64 = 0.0;
    for (species, (fine, whole)) in fine.chunks_exact(len).zip(whole.chunks_exact(len)).enumerate() {
        let after = root_mean_square(len, |at| fine[at]);
        let size = match begun {
            None => after,
            Some((before, steps)) => judged(root_mean_square(len, |at| before[species * len + at]), after, steps),
        };
        // The halves are wrong by a quarter of the whole step, so that their difference is three quarters of it.
        let wrong = 4.0 / 3.0 * root_mean_square(len, |at| fine[at] - whole[at]);
        let error = wrong / (absolute + relative * size).max(f64::MIN_POSITIVE);
        if error.is_nan() {
            return error;
        }
        worst = error.max(worst);
    }
    worst
}

/// The root mean square of numbers that are told by their places, in eight sums.
fn root_mean_square(len: usize, number: impl Fn(usize) -> f64) -> f64 {
    let mut sums = [0.0; 8];
    for at in 0..len {
        sums[at % 8] += number(at) * number(at);
    }
    (sums.iter().sum::<f64>() / len as f64).sqrt()
}

/// What reactions change in a step.
#[derive(Debug, Clone, Default)]
pub struct Change {
    len: usize,
    /// Parts of each species after the step, and what their errors are judged beside.
    sizes: Vec<[[f64; PARTS]; 2]>,
    /// The largest change by reactions of a part of a species, over that part; 1 at most.
    pub share: f64,
}

impl Change {
    /// Writes NaN over what it knows.
    pub fn poison(&mut self) {
        self.sizes.fill([[f64::NAN; PARTS]; 2]);
        self.share = f64::NAN;
    }

    /// Takes it from the values after the step in halves, those before it and after it in one piece, and what diffusion and decay changed
    /// in that. A window has so many steps as this one.
    pub fn take(&mut self, len: usize, fine: &[f64], [before, whole, spread]: [&[f64]; 3], steps: f64) {
        self.sizes.clear();
        let mut share: f64 = 0.0;
        for first in (0..fine.len()).step_by(len) {
            let of = moments(len, |at| fine[first + at]);
            let began = moments(len, |at| before[first + at]);
            let changed = moments(len, |at| whole[first + at] - before[first + at] - spread[first + at]);
            for (part, changed) in of.into_iter().zip(changed) {
                if part > ROUND_OFF * size(of) {
                    share = share.max(changed / part);
                }
            }
            let beside = std::array::from_fn(|part| judged(began[part], of[part], steps));
            self.sizes.push([of, beside]);
        }
        (self.len, self.share) = (len, share.min(1.0));
    }
}

/// The error of a step beside what reactions change in it, in tolerances, eq. (field.14). `error` is that of the values, spread over the time
/// in which reactions change them as a whole.
pub fn error_of_rates(error: &[f64], change: &Change, [relative, absolute]: [f64; 2]) -> f64 {
    let mut worst: f64 = 0.0;
    let share = change.share.max(LEAST_SHARE);
    for (error, [of, beside]) in error.chunks_exact(change.len).zip(&change.sizes) {
        let least = relative * ROUND_OFF * size(*of);
        for (wrong, part) in moments(change.len, |at| error[at]).into_iter().zip(beside) {
            let borne = share * (absolute + relative * part) + least;
            let error = wrong / borne.max(f64::MIN_POSITIVE);
            if error.is_nan() {
                return error;
            }
            worst = error.max(worst);
        }
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wave of height `height` around a mean, on so many boxes.
    fn wave(mean: f64, height: f64) -> Vec<f64> {
        let turn = |at: usize| std::f64::consts::TAU * at as f64 / 64.0;
        (0..64).map(|at| mean + height * turn(at).sin()).collect()
    }

    #[test]
    fn the_error_of_size_is_that_of_halves_that_are_wrong_by_a_quarter() {
        // The exact value is 1, a whole step 1.04, halves 1.01.
        let (fine, whole) = (vec![1.01; 64], vec![1.04; 64]);
        let error = error_of_size(64, &fine, &whole, [1e-2, 0.0], None);
        assert!((error - 0.04 / 0.01 / 1.01).abs() < 1e-9, "{error}");
        assert!((error_of_size(64, &fine, &whole, [0.0, 0.08], None) - 0.5).abs() < 1e-12);
        assert!(error_of_size(64, &[f64::NAN; 64], &whole, [1.0, 1.0], None).is_nan());
    }

    #[test]
    fn a_small_pattern_is_weighed_by_itself_and_not_beside_the_mean() {
        let (before, fine) = (wave(5.0, 1e-4), wave(5.0, 1.1e-4));
        let still = vec![0.0; 64];
        // Reactions made the pattern a tenth higher (over 1.1) and left the mean.
        let mut change = Change::default();
        change.take(64, &fine, [&before, &fine, &still], 1.0);
        assert!((change.share - 0.1 / 1.1).abs() < 1e-6, "{}", change.share);
        // An error of a hundredth of the pattern: nothing beside the mean, and a ninth of what it grew, but for what counts as round-off.
        let error = error_of_rates(&wave(0.0, 1.1e-6), &change, [1e-2, 0.0]);
        let least = 1e-9 * 5.0 / (change.share * 1.1e-4 / 2f64.sqrt());
        assert!((error * (1.0 + least) - 11.0).abs() < 1e-4, "{error}");
        // The same size, of the mean alone, is a five millionth of it.
        let error = error_of_rates(&vec![1.1e-6; 64], &change, [1e-2, 0.0]);
        assert!((error - 1.1e-6 / (5e-2 * change.share)).abs() < 1e-6, "{error}");
    }

    #[test]
    fn what_was_not_there_counts_as_what_it_will_be_at_the_end_of_the_window() {
        let (before, fine) = (vec![0.0; 64], wave(2.0, 0.5));
        let whole = wave(2.02, 0.5);
        let wrong = 4.0 / 3.0 * 0.02;
        let size = root_mean_square(64, |at| fine[at]);
        let beside = |begun| error_of_size(64, &fine, &whole, [1e-2, 0.0], begun);
        assert!((beside(None) - wrong / (1e-2 * size)).abs() < 1e-9);
        assert!((beside(Some((&before, 8.0))) - wrong / (8e-2 * size)).abs() < 1e-9);
        // What was there counts as what it is, and what was there without a pattern too, but for the pattern.
        assert!((beside(Some((&[0.1; 64], 8.0))) - beside(None)).abs() < 1e-12);
        let mut change = Change::default();
        change.take(64, &fine, [&[0.1; 64], &fine, &[0.0; 64]], 8.0);
        assert!((error_of_rates(&[wrong; 64], &change, [1e-2, 0.0]) - wrong / 2e-2).abs() < 1e-6);
        let deviation = 0.5 / 2f64.sqrt();
        let error = error_of_rates(&wave(0.0, 0.5), &change, [1e-2, 0.0]);
        assert!((error - deviation / (8e-2 * deviation)).abs() < 1e-5, "{error}");
    }

    #[test]
    fn round_off_is_no_pattern() {
        let fine = wave(5.0, 1e-15);
        let mut change = Change::default();
        change.take(64, &fine, [&wave(4.9, 1e-13), &fine, &vec![0.0; 64]], 1.0);
        assert!((change.share - 0.02).abs() < 1e-9, "only the mean counts: {}", change.share);
        assert!(error_of_rates(&wave(0.0, 1e-15), &change, [1e-3, 0.0]) < 1e-3);
    }
}
