//! Jumps of the rates that no step is short enough for, eq. (ode.10).

use pulp::Scalar;

use super::stepper::Stepper;

/// Rates after a jump are alike when they differ by less than this share of the larger, or what they change by this share of the relative tolerance.
const ALIKE: f64 = 1e-3;

impl Stepper<'_> {
    /// Passes a jump of the rates by Euler's rule in the shortest of steps, which moves the jump by no more than the clock can tell, and leaves the
    /// proposal. No step is short enough where a variable is nothing before the jump and its error is measured by what it is. Returns whether it
    /// is one: the rates are those after it then, and stay so. Where they grow without bound, or go to and fro, it is none.
    pub(super) fn passes_jump(&mut self, step: f64) -> bool {
        let n = self.s.state.len();
        let begin = self.s.state.clone();
        let mut rates = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
        for (rates, number) in rates.iter_mut().zip(0..) {
            self.s.rates_at_state(Scalar, self.program, [self.time + f64::from(number) * step]);
            for (v, rate) in rates.iter_mut().enumerate() {
                *rate = self.s.stages[v][0];
                self.s.state[v][0] += step * *rate;
            }
            if number == 0 {
                self.s.proposal.copy_from_slice(&self.s.state);
            }
        }
        self.s.state.copy_from_slice(&begin);
        self.s.stages.fill([0.0]);
        self.forget_rates();
        let [_, first, second] = &rates;
        let alike =
            |(a, b): (&f64, &f64)| (a - b).abs() <= ALIKE * a.abs().max(b.abs()) && a.is_finite() && b.is_finite();
        first.iter().zip(second).all(alike)
    }
}
