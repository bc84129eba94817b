//! Quantiles of the laws that intervals of fits go by.

use std::f64::consts::{FRAC_PI_2, PI};

/// How many standard errors to each side hold a value with some confidence, eq. (fit.8): of Student's law with so many degrees of freedom,
/// or of the normal law where errors are known.
pub fn standard_errors(confidence: f64, freedom: Option<usize>) -> f64 {
    let within = |reach: f64| match freedom {
        None => integral(|x| (-0.5 * x * x).exp(), reach) / (0.5 * PI).sqrt(),
        // With t = √ν tan θ Student's law is cos^(ν-1) θ.
        Some(freedom) => {
            let law = |angle: f64| angle.cos().max(0.0).powi(freedom.max(1) as i32 - 1);
            integral(law, (reach / (freedom.max(1) as f64).sqrt()).atan()) / integral(law, FRAC_PI_2)
        }
    };
    let (mut low, mut high) = (0.0, 1.0);
    while within(high) < confidence && high < 1e9 {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if within(middle) < confidence { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// The integral of a smooth function from 0, by Simpson's rule.
fn integral(f: impl Fn(f64) -> f64, to: f64) -> f64 {
    const PARTS: usize = 2_000;
    let h = to / PARTS as f64;
    let inner = (1..PARTS).map(|k| if k % 2 == 1 { 4.0 } else { 2.0 } * f(h * k as f64)).sum::<f64>();
    h / 3.0 * (f(0.0) + inner + f(to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (confidence, freedom, expected) in [
            (0.95, None, 1.959_964),
            (0.6827, None, 1.000_022),
            (0.95, Some(1), 12.706_205),
            (0.95, Some(5), 2.570_582),
            (0.99, Some(24), 2.796_940),
            (0.95, Some(1_000), 1.962_339),
        ] {
            let found = standard_errors(confidence, freedom);
            assert!((found - expected).abs() < 2e-6 * expected, "{confidence} {freedom:?}: {found}, not {expected}");
        }
    }
}
