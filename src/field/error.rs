//! How wrong a step of fields is that was taken whole and in halves: beside the size of a species, and beside what reactions change in it.

/// Parts of a field: its mean, and what differs from it.
const PARTS: usize = 2;

/// What is below this part of a species' size counts as round-off: no pattern, and no error that could become one.
const ROUND_OFF: f64 = 1e-9;

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

/// The error of a step in one piece in tolerances, eq. (field.7): the largest over the species of the root mean square beside their size.
pub fn error_of_size(len: usize, fine: &[f64], whole: &[f64], [relative, absolute]: [f64; 2]) -> f64 {
    let mut worst: f64 = 0.0;
    for (fine, whole) in fine.chunks_exact(len).zip(whole.chunks_exact(len)) {
        let (mut apart, mut size) = ([0.0; 8], [0.0; 8]);
        for (at, (fine, whole)) in fine.iter().zip(whole).enumerate() {
            apart[at % 8] += (fine - whole) * (fine - whole);
            size[at % 8] += fine * fine;
        }
        let mean = |sums: [f64; 8]| (sums.iter().sum::<f64>() / len as f64).sqrt();
        // The halves are wrong by a quarter of the whole step, so that their difference is three quarters of it.
        let error = 4.0 / 3.0 * mean(apart) / (absolute + relative * mean(size)).max(f64::MIN_POSITIVE);
        if error.is_nan() {
            return error;
        }
        worst = error.max(worst);
    }
    worst
}

/// What reactions change in a step.
#[derive(Debug, Clone, Default)]
pub struct Change {
    len: usize,
    /// Parts of each species after the step.
    sizes: Vec<[f64; PARTS]>,
    /// The largest change by reactions of a part of a species, over that part; 1 at most.
    pub share: f64,
}

impl Change {
    /// Writes NaN over what it knows.
    pub fn poison(&mut self) {
        self.sizes.fill([f64::NAN; PARTS]);
        self.share = f64::NAN;
    }

    /// Takes it from the values after the step in halves, those before it and after it in one piece, and what diffusion and decay changed
    /// in that.
    pub fn take(&mut self, len: usize, fine: &[f64], [before, whole, spread]: [&[f64]; 3]) {
        self.sizes.clear();
        let mut share: f64 = 0.0;
        for first in (0..fine.len()).step_by(len) {
            let of = moments(len, |at| fine[first + at]);
            let changed = moments(len, |at| whole[first + at] - before[first + at] - spread[first + at]);
            for (part, changed) in of.into_iter().zip(changed) {
                if part > ROUND_OFF * size(of) {
                    share = share.max(changed / part);
                }
            }
            self.sizes.push(of);
        }
        (self.len, self.share) = (len, share.min(1.0));
    }
}

/// The error of a step beside what reactions change in it, in tolerances, eq. (field.14). `error` is that of the values, spread over the time
/// in which reactions change them as a whole.
pub fn error_of_rates(error: &[f64], change: &Change, [relative, absolute]: [f64; 2]) -> f64 {
    let mut worst: f64 = 0.0;
    for (error, of) in error.chunks_exact(change.len).zip(&change.sizes) {
        let least = relative * ROUND_OFF * size(*of);
        for (wrong, part) in moments(change.len, |at| error[at]).into_iter().zip(of) {
            let borne = change.share * (absolute + relative * part) + least;
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
        let error = error_of_size(64, &fine, &whole, [1e-2, 0.0]);
        assert!((error - 0.04 / 0.01 / 1.01).abs() < 1e-9, "{error}");
        assert!((error_of_size(64, &fine, &whole, [0.0, 0.08]) - 0.5).abs() < 1e-12);
        assert!(error_of_size(64, &[f64::NAN; 64], &whole, [1.0, 1.0]).is_nan());
    }

    #[test]
    fn a_small_pattern_is_weighed_by_itself_and_not_beside_the_mean() {
        let (before, fine) = (wave(5.0, 1e-4), wave(5.0, 1.1e-4));
        let still = vec![0.0; 64];
        // Reactions made the pattern a tenth higher (over 1.1) and left the mean.
        let mut change = Change::default();
        change.take(64, &fine, [&before, &fine, &still]);
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
    fn round_off_is_no_pattern() {
        let fine = wave(5.0, 1e-15);
        let mut change = Change::default();
        change.take(64, &fine, [&wave(4.9, 1e-13), &fine, &vec![0.0; 64]]);
        assert!((change.share - 0.02).abs() < 1e-9, "only the mean counts: {}", change.share);
        assert!(error_of_rates(&wave(0.0, 1e-15), &change, [1e-3, 0.0]) < 1e-3);
    }
}
