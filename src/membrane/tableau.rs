//! The additive Runge–Kutta pair ARK3(2)4L[2]SA of Kennedy and Carpenter (2003): reactions explicitly, diffusion implicitly (L-stable),
//! order 3 together, with an estimate of order 2.

/// Stages.
pub const STAGES: usize = 4;
/// The diagonal of the implicit part.
pub const GAMMA: f64 = 1767732205903.0 / 4055673282236.0;
/// Shares of the step at which the stages stand.
pub const C: [f64; STAGES] = [0.0, 1767732205903.0 / 2027836641118.0, 3.0 / 5.0, 1.0];
/// Weights of earlier stages, explicit.
pub const EXPLICIT: [[f64; STAGES]; STAGES] = [
    [0.0; STAGES],
    [1767732205903.0 / 2027836641118.0, 0.0, 0.0, 0.0],
    [5535828885825.0 / 10492691773637.0, 788022342437.0 / 10882634858940.0, 0.0, 0.0],
    [6485989280629.0 / 16251701735622.0, -4246266847089.0 / 9704473918619.0, 10755448449292.0 / 10357097424841.0, 0.0],
];
/// The same, implicit; the weight of the stage itself is [`GAMMA`] in all but the first.
pub const IMPLICIT: [[f64; STAGES]; STAGES] = [
    [0.0; STAGES],
    [GAMMA, GAMMA, 0.0, 0.0],
    [2746238789719.0 / 10658868560708.0, -640167445237.0 / 6845629431997.0, GAMMA, 0.0],
    B,
];
/// Weights of the result.
pub const B: [f64; STAGES] =
    [1471266399579.0 / 7840856788654.0, -4482444167858.0 / 7529755066697.0, 11266239266428.0 / 11593286722821.0, GAMMA];
/// Weights of the result of order 2.
const LOWER: [f64; STAGES] = [
    2756255671327.0 / 12835298489170.0,
    -10771552573575.0 / 22201958757719.0,
    9247589265047.0 / 10645013368117.0,
    2193209047091.0 / 5459859503100.0,
];
/// Weights of the estimated error.
pub const ERROR: [f64; STAGES] = [B[0] - LOWER[0], B[1] - LOWER[1], B[2] - LOWER[2], B[3] - LOWER[3]];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_fulfil_the_conditions_of_order_three_and_two() {
        let close = |found: f64, expected: f64, what: &str| {
            // The fractions are given to 25 digits of their quotients' 13 or so.
            assert!((found - expected).abs() < 2e-13, "{what}: {found} against {expected}");
        };
        let sum =
            |weights: &[f64; 4], values: &dyn Fn(usize) -> f64| (0..4).map(|i| weights[i] * values(i)).sum::<f64>();
        for (weights, order) in [(&B, 3), (&LOWER, 2)] {
            close(sum(weights, &|_| 1.0), 1.0, "order 1");
            close(sum(weights, &|i| C[i]), 0.5, "order 2");
            if order == 3 {
                close(sum(weights, &|i| C[i] * C[i]), 1.0 / 3.0, "order 3");
                for stages in [&EXPLICIT, &IMPLICIT] {
                    close(sum(weights, &|i| sum(&stages[i], &|j| C[j])), 1.0 / 6.0, "order 3, trees");
                }
            }
        }
        for stages in [&EXPLICIT, &IMPLICIT] {
            (0..4).for_each(|i| close(sum(&stages[i], &|_| 1.0), C[i], "rows"));
        }
        // Stiffly accurate: what decays at once is gone at the end of the step.
        assert_eq!(IMPLICIT[3], B);
    }
}
