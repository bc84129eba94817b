//! How well a cell can know the direction of a gradient from the receptors that it has, and how straight it would go by that alone.

/// What a cell reads a concentration with. Concentrations may be in any unit, the same for all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Receptors {
    /// Number on the cell.
    pub number: f64,
    /// Concentration at which half of them are bound.
    pub dissociation: f64,
    /// Length of the cell along the gradient, µm.
    pub length: f64,
}

impl Receptors {
    /// Part of the receptors that is bound at a concentration.
    pub fn occupied(&self, concentration: f64) -> f64 {
        concentration / (concentration + self.dissociation)
    }

    /// By how many the bound receptors of the front half exceed those of the rear, were all at its ends, eq. (analysis.30).
    ///
    /// * `gradient` – of the concentration, by µm.
    pub fn difference(&self, concentration: f64, gradient: f64) -> f64 {
        let slope = self.dissociation / (concentration + self.dissociation).powi(2);
        self.number * gradient * slope * self.length
    }

    /// Signal to noise ratio s: the square of the difference over the variance of the number that is bound, eq. (analysis.31). NaN where nothing or all is bound.
    pub fn signal_to_noise(&self, concentration: f64, gradient: f64) -> f64 {
        let occupied = self.occupied(concentration);
        self.difference(concentration, gradient).powi(2) / (self.number * occupied * (1.0 - occupied))
    }
}

/// What bound receptors make, and what a cell goes by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Messenger {
    /// Rate at which a bound receptor is left, per s.
    pub off: f64,
    /// How many a bound receptor makes, per s.
    pub made: f64,
    /// Mean life, s.
    pub life: f64,
}

impl Receptors {
    /// Variance of what a cell reads along an axis of where its messenger is, in bound receptors each counted by its part of the radius, eq. (analysis.32).
    pub fn reading_variance(&self, messenger: &Messenger, concentration: f64) -> f64 {
        let occupied = self.occupied(concentration);
        let rate = messenger.off * (1.0 + concentration / self.dissociation);
        let binding = occupied * (1.0 - occupied) / (1.0 + messenger.life * rate);
        self.number / 3.0 * (binding + occupied / (messenger.made * messenger.life))
    }

    /// Signal to noise ratio of that reading on a sphere, eq. (analysis.33): the square of its mean, a sixth of the difference, over its variance. NaN where nothing is bound.
    pub fn reading_signal_to_noise(&self, messenger: &Messenger, concentration: f64, gradient: f64) -> f64 {
        (self.difference(concentration, gradient) / 6.0).powi(2) / self.reading_variance(messenger, concentration)
    }
}

/// The mean cosine between a cue of the length `preference` and the direction that is taken by it of `candidates` directions in the plane, each anywhere, eq. (analysis.34). A cue
/// longer than 300 takes the nearest of them, to 10⁻⁴, and counts as 300.
pub fn choice_index(preference: f64, candidates: u32) -> f64 {
    // Beyond 350 weights underflow.
    let preference = preference.clamp(-300.0, 300.0);
    // Means over the circle of w exp(−t w) cos θ and of exp(−t w), w = exp(κ (cos θ − 1)): the midpoint rule, exact to round-off.
    const ANGLES: usize = 256;
    let cosines: [f64; ANGLES] =
        std::array::from_fn(|k| (std::f64::consts::PI * (k as f64 + 0.5) / ANGLES as f64).cos());
    let weights = cosines.map(|cosine| (preference * (cosine - 1.0)).exp());
    // The integral over t in equal steps of ln t: its ends fall off as fast as exp(−t) and t.
    const STEP: f64 = 0.02;
    let lowest = -40.0;
    let highest = 2.0 * preference.abs() + 5.0;
    let steps = ((highest - lowest) / STEP) as usize;
    let integral: f64 = (0..=steps)
        .map(|step| {
            let t = (lowest + STEP * step as f64).exp();
            let (mut part, mut rest) = (0.0, 0.0);
            for (cosine, weight) in cosines.iter().zip(&weights) {
                let left = (-t * weight).exp();
                part += weight * left * cosine;
                rest += left;
            }
            t * part * (rest / ANGLES as f64).powi(candidates as i32 - 1)
        })
        .sum();
    f64::from(candidates) * integral * STEP / ANGLES as f64
}

/// The mean cosine between the true direction in the plane and one estimated with a signal to noise ratio `s`, eq. (analysis.29): from 0 for no signal to 1.
pub fn chemotactic_index(s: f64) -> f64 {
    let x = 0.25 * s;
    (0.5 * std::f64::consts::PI * x).sqrt() * (scaled_bessel_i(0, x) + scaled_bessel_i(1, x))
}

/// Argument from which the asymptotic series is used. Its smallest term there is about e⁻⁵⁰.
const LARGE: f64 = 25.0;

/// e⁻ˣ Iₙ(x) for the modified Bessel function of the first kind and x ≥ 0, to a few units of the last digit.
pub fn scaled_bessel_i(order: u32, x: f64) -> f64 {
    let n = f64::from(order);
    if x < LARGE {
        // The ascending series: all terms are positive.
        let quarter = 0.25 * x * x;
        let mut term = (1..=order).fold(1.0, |term, k| term * 0.5 * x / f64::from(k));
        let (mut sum, mut k) = (term, 1.0);
        while term > 1e-17 * sum {
            term *= quarter / (k * (k + n));
            sum += term;
            k += 1.0;
        }
        return (-x).exp() * sum;
    }
    // Hankel's expansion.
    let (mut term, mut sum, mut k) = (1.0_f64, 1.0, 1.0);
    while term.abs() > 1e-17 && k < 2.0 * x {
        term *= -(4.0 * n * n - (2.0 * k - 1.0).powi(2)) / (8.0 * k * x);
        sum += term;
        k += 1.0;
    }
    sum / (2.0 * std::f64::consts::PI * x).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::noise;

    #[test]
    fn bessel_functions_have_the_digits_of_the_tables() {
        // I₀ and I₁ of Abramowitz & Stegun, table 9.8 and 9.11.
        for (order, x, known) in [
            (0, 0.0, 1.0),
            (1, 0.0, 0.0),
            (0, 1.0, 1.266_065_877_752_008),
            (1, 1.0, 0.565_159_103_992_485),
            (0, 5.0, 27.239_871_823_604_44),
            (1, 5.0, 24.335_642_142_450_53),
            (0, 10.0, 2_815.716_628_466_254),
            (1, 10.0, 2_670.988_303_701_255),
        ] {
            let found: f64 = scaled_bessel_i(order, x) * f64::exp(x);
            assert!((found - known).abs() <= 2e-15 * known.max(1.0) * 4.0, "I{order}({x}) = {found}");
        }
        // The two series meet.
        for order in [0, 1, 2] {
            let (below, above) = (scaled_bessel_i(order, LARGE * (1.0 - 1e-15)), scaled_bessel_i(order, LARGE));
            assert!((above / below - 1.0).abs() < 1e-13, "I{order}: {below} {above}");
        }
        // Iₙ₋₁ − Iₙ₊₁ = (2n/x) Iₙ at both sides.
        for x in [0.3, 7.0, 24.0, 26.0, 300.0] {
            let wrong = scaled_bessel_i(0, x) - scaled_bessel_i(2, x) - 2.0 / x * scaled_bessel_i(1, x);
            assert!(wrong.abs() < 1e-14, "{x}: {wrong}");
        }
    }

    #[test]
    fn the_index_is_the_mean_cosine_of_a_noisy_vector() {
        // A true vector of length √s and noise of variance 1 along each axis.
        for s in [0.01_f64, 0.3, 2.0, 20.0] {
            let mut uniform = noise::uniform(s.to_bits());
            let number = 40_000;
            let mut cosines = Vec::with_capacity(number);
            for _ in 0..number {
                let (radius, angle) = ((-2.0 * (-uniform()).ln_1p()).sqrt(), std::f64::consts::TAU * uniform());
                let [x, y] = [s.sqrt() + radius * angle.cos(), radius * angle.sin()];
                cosines.push(x / x.hypot(y));
            }
            let mean = crate::analysis::statistics::mean(&cosines);
            let error = crate::analysis::statistics::standard_error(&cosines);
            let expected = chemotactic_index(s);
            println!("s = {s}: {expected} from {mean} ± {error}");
            assert!((mean - expected).abs() < 3.0 * error, "s = {s}: {expected} from {mean} ± {error}");
        }
        assert_eq!(chemotactic_index(0.0), 0.0);
        // 1 − 1/2s for much signal, √(πs/8) for little.
        assert!((chemotactic_index(1e4) - (1.0 - 0.5e-4)).abs() < 1e-8);
        assert!((chemotactic_index(1e-8) / (std::f64::consts::PI * 1e-8 / 8.0).sqrt() - 1.0).abs() < 1e-8);
    }

    #[test]
    fn one_of_many_directions_is_nearer_to_the_cue_than_one_of_few() {
        // One candidate knows nothing of the cue; a weak cue takes 1 − 1/n of what one direction of von Mises' law would have; a strong one the nearest.
        assert!(choice_index(1.25, 1).abs() < 1e-12);
        for n in [2, 8, 100] {
            let weak = choice_index(1e-4, n);
            assert!((weak / (0.5e-4 * (1.0 - 1.0 / f64::from(n))) - 1.0).abs() < 1e-3, "{n}: {weak}");
        }
        let many = scaled_bessel_i(1, 1.25) / scaled_bessel_i(0, 1.25);
        assert!((choice_index(1.25, 10_000) / many - 1.0).abs() < 1e-3, "von Mises");
        // The nearest of two on a circle: the angle to it falls off linearly, with the mean cosine 4/π².
        let nearest = choice_index(2_000.0, 2);
        assert!((nearest - 4.0 / std::f64::consts::PI.powi(2)).abs() < 2e-3, "{nearest}");
        // Choices by chance, as pseudopods are chosen.
        let mut uniform = noise::uniform(4);
        let cosines: Vec<f64> = (0..40_000)
            .map(|_| {
                let candidates: [f64; 8] = std::array::from_fn(|_| (std::f64::consts::TAU * uniform()).cos());
                let weights = candidates.map(|cosine| (1.25 * cosine).exp());
                weights.iter().zip(candidates).map(|(weight, cosine)| weight * cosine).sum::<f64>()
                    / weights.iter().sum::<f64>()
            })
            .collect();
        let (found, error) =
            (crate::analysis::statistics::mean(&cosines), crate::analysis::statistics::standard_error(&cosines));
        assert!(
            (found - choice_index(1.25, 8)).abs() < 3.0 * error,
            "{found} ± {error}, not {}",
            choice_index(1.25, 8)
        );
    }

    #[test]
    fn receptors_tell_most_near_their_constant() {
        let receptors = Receptors { number: 25_000.0, dissociation: 1_000.0, length: 10.0 };
        assert_eq!(receptors.occupied(1_000.0), 0.5);
        assert_eq!(receptors.difference(1_000.0, 1.0), 25_000.0 / 4_000.0 * 10.0);
        // At a given relative gradient the ratio is N (gL/c)² occ (1 − occ), largest where half is bound.
        let at = |c: f64| receptors.signal_to_noise(c, 0.01 * c);
        assert!((at(1_000.0) - 25_000.0 * 0.01_f64.powi(2) * 100.0 * 0.25).abs() < 1e-9);
        assert!(at(1_000.0) > at(500.0) && at(1_000.0) > at(2_000.0) && at(1e6) < 0.01 * at(1_000.0));
    }
}
