//! Keeps concentrations from going below zero where the second-order solve would, without making or losing any.
//!
//! The solve's flows are replaced, box by box and only as far as needed, by those of backward Euler, which never
//! gives a negative value: the flux correction of Boris and Book in the form of Zalesak, eq. (field.6).

use super::factors::Line;
use super::sweep::{WIDTH, section};

/// Numbers of scratch that the limiter and the sweep before it need for lines of `n` boxes: the values before the step,
/// Y, the result, and three more for the limiter, each `[box][line]`.
pub const fn scratch(n: usize) -> usize {
    6 * section(n)
}

/// A negative value this small beside the largest of its lines is set to zero and not worth a correction: the amount
/// so made is far below round-off of the whole.
const SPECK: f64 = 1e-20;

type Row = [f64; WIDTH];

/// Sets specks below zero to zero; says whether that was all that was needed.
pub fn clear_specks(values: &mut [f64], least: f64) -> bool {
    let most = values.iter().fold(0.0, |most: f64, value| most.max(*value));
    if -least > SPECK * most {
        return false;
    }
    for value in values {
        *value = value.max(0.0);
    }
    true
}

/// Corrects the lines in scratch, whose first part holds the values before the step, none of them negative.
pub fn limit(line: &Line, factor: f64, scratch: &mut [f64]) {
    let n = line.real.len();
    let mut parts = scratch.chunks_exact_mut(section(n)).map(|part| &mut part.as_chunks_mut::<WIDTH>().0[..n]);
    let mut next = || parts.next().expect("six sections");
    let [before, y, values, low, safe, shares] = std::array::from_fn(|_| next());
    backward_euler(line, before, low);
    // What stays after the flows of backward Euler, and which part of the further outflow it can pay for.
    for i in 0..n {
        let (out, inn) = (face(line, low, i + 1), face(line, low, i));
        let (high_out, high_in) = (face(line, y, i + 1), face(line, y, i));
        for lane in 0..WIDTH {
            let left = (before[i][lane] + (out[lane] - inn[lane])).max(0.0);
            let loss = (out[lane] - high_out[lane]).max(0.0) + (high_in[lane] - inn[lane]).max(0.0);
            safe[i][lane] = left;
            shares[i][lane] = if loss > left { left / loss } else { 1.0 };
        }
    }
    let bath = [1.0; WIDTH];
    for i in 0..n {
        let (out, inn) = (face(line, low, i + 1), face(line, low, i));
        let (high_out, high_in) = (face(line, y, i + 1), face(line, y, i));
        let ends = |at: usize| if line.ring.is_some() { &shares[at] } else { &bath };
        let above = if i + 1 == n { ends(0) } else { &shares[i + 1] };
        let below = if i == 0 { ends(n - 1) } else { &shares[i - 1] };
        for lane in 0..WIDTH {
            let (gain, loss) = (high_out[lane] - out[lane], high_in[lane] - inn[lane]);
            // Each flow is cut by the box that pays it.
            let gain = gain * if gain > 0.0 { above[lane] } else { shares[i][lane] };
            let loss = loss * if loss > 0.0 { shares[i][lane] } else { below[lane] };
            values[i][lane] = (safe[i][lane] + (gain - loss)).max(0.0) * factor;
        }
    }
}

/// The flow through the face below box `i` (of `n`: above the last), upwards in the sense of y_i − y_(i−1).
fn face(line: &Line, y: &[Row], i: usize) -> Row {
    let n = y.len();
    let mut flow = [0.0; WIDTH];
    for lane in 0..WIDTH {
        flow[lane] = match i {
            _ if i > 0 && i < n => y[i][lane] - y[i - 1][lane],
            _ if line.ring.is_some() => y[0][lane] - y[n - 1][lane],
            0 => line.walls[0] * y[0][lane],
            _ => -line.walls[1] * y[n - 1][lane],
        };
    }
    flow
}

/// Ratio × the solution of backward Euler.
fn backward_euler(line: &Line, before: &[Row], low: &mut [Row]) {
    let n = low.len();
    let mut running = [0.0; WIDTH];
    for i in 0..n {
        for lane in 0..WIDTH {
            running[lane] = (before[i][lane] + running[lane]) * line.real[i];
        }
        low[i] = running;
    }
    for i in (0..n - 1).rev() {
        for lane in 0..WIDTH {
            low[i][lane] += line.real[i] * low[i + 1][lane];
        }
    }
    let Some(ring) = &line.ring else { return };
    for lane in 0..WIDTH {
        let closing = (low[0][lane] + low[n - 1][lane]) * ring.real_close;
        for i in 0..n {
            low[i][lane] += ring.real_share[i] * closing;
        }
    }
}
