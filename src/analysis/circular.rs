//! Directions in the plane: where they point on the whole, and whether they point anywhere more than elsewhere.

/// What some directions are like together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Directions {
    /// Number of directions.
    pub number: usize,
    /// Length of the mean of the unit vectors, from 0 (all around) to 1 (all alike), eq. (analysis.27); NaN for none.
    pub resultant: f64,
    /// Where that mean points, radians from the x axis towards the y axis; NaN for none.
    pub mean: f64,
    /// Probability that directions without any preference have so large a resultant, by Rayleigh's test, eq. (analysis.28); NaN for none.
    pub p_value: f64,
}

/// Describes directions, radians. Those that are not numbers do not count.
pub fn describe(directions: impl IntoIterator<Item = f64>) -> Directions {
    let (mut number, mut cosine, mut sine) = (0_usize, 0.0, 0.0);
    for direction in directions.into_iter().filter(|direction| !direction.is_nan()) {
        number += 1;
        cosine += direction.cos();
        sine += direction.sin();
    }
    let count = number as f64;
    let resultant = (cosine * cosine + sine * sine).sqrt() / count;
    let mean = if number > 0 { sine.atan2(cosine) } else { f64::NAN };
    Directions { number, resultant, mean, p_value: rayleigh(count, count * resultant) }
}

/// Rayleigh's probability of a sum of `count` unit vectors at least as long as `sum` (Wilkie 1983), good to 0.001 from ten directions on.
fn rayleigh(count: f64, sum: f64) -> f64 {
    let exponent = (1.0 + 4.0 * count + 4.0 * (count * count - sum * sum)).sqrt() - (1.0 + 2.0 * count);
    // Round-off may lift it above 0; NaN stays what it is.
    if exponent > 0.0 { 1.0 } else { exponent.exp() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::noise;
    use crate::analysis::statistics::kolmogorov_smirnov;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn directions_that_agree_have_a_resultant_of_one_and_opposite_ones_none() {
        let alike = describe([0.3; 20]);
        assert!((alike.resultant - 1.0).abs() < 1e-12 && (alike.mean - 0.3).abs() < 1e-12 && alike.p_value < 1e-7);
        let opposite = describe([0.1, 0.1 + PI, 0.1 + 0.5 * PI, 0.1 - 0.5 * PI]);
        assert!(opposite.resultant < 1e-12 && (opposite.p_value - 1.0).abs() < 1e-9);
        assert!(describe([]).resultant.is_nan() && describe([f64::NAN]).p_value.is_nan());
        assert_eq!(describe([0.0, f64::NAN]).number, 1);
    }

    #[test]
    fn the_p_value_of_directions_without_preference_is_uniform() {
        for number in [10, 50] {
            let p: Vec<f64> = (0..4_000)
                .map(|sample| {
                    let mut uniform = noise::uniform(sample + 10_000 * number);
                    describe((0..number).map(|_| TAU * uniform())).p_value
                })
                .collect();
            let test = kolmogorov_smirnov(&p, |value| value.clamp(0.0, 1.0)).unwrap();
            println!("{number} directions: distance {}, p = {}", test.distance, test.p_value);
            assert!(test.p_value > 0.01, "{number} directions: {test:?}");
        }
    }

    #[test]
    fn weak_preference_of_many_is_found_with_the_power_of_the_test() {
        // The unit vectors of cos-weighted directions, density (1 + 2ρ cos θ)/2π with ρ = 0.3: n = 50 and 5 % give a power of
        // P(χ²₂(2nρ²) > 5.99) = 0.78 in the limit of large n.
        let mut found = 0;
        for sample in 0..1_000 {
            let mut uniform = noise::uniform(sample);
            let mut next = || loop {
                let direction = TAU * uniform();
                if 1.6 * uniform() < 1.0 + 0.6 * direction.cos() {
                    return direction;
                }
            };
            found += u32::from(describe((0..50).map(|_| next())).p_value < 0.05);
        }
        println!("{found} of 1000");
        assert!((730..=830).contains(&found), "{found} of 1000");
    }
}
