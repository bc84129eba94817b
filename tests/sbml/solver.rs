//! A plain solver over the tree itself, slow and simple, that says what a system's solution is.

use pseudopod::chemistry::tree::{Event, Expr, QuantityId, Role, System};

/// Values of all quantities at each of the times, the first of which is the start.
pub fn solve_for_test(system: &System, times: &[f64], rtol: f64, atol: f64) -> Vec<Vec<f64>> {
    let mut run = Run::new(system, times[0]);
    let mut rows = Vec::new();
    let largest = times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min) / 4.0;
    let mut step = largest * 1e-3;
    run.happen();
    for &until in times {
        while run.time < until {
            step = run.advance(step.min(largest), until, rtol, atol);
            run.happen();
        }
        rows.push(run.values(run.time, &run.state));
    }
    rows
}

/// An event that has fired and waits.
struct Waiting {
    event: usize,
    due: f64,
    values: Option<Vec<f64>>,
}

struct Run<'s> {
    system: &'s System,
    variables: Vec<QuantityId>,
    order: Vec<QuantityId>,
    /// Initial values of all quantities.
    start: Vec<f64>,
    state: Vec<f64>,
    time: f64,
    held: Vec<bool>,
    waiting: Vec<Waiting>,
}

impl<'s> Run<'s> {
    fn new(system: &'s System, time: f64) -> Self {
        let variables = system.variables();
        let order = system.definition_order().expect("no circles");
        let mut known = vec![None; system.quantities.len()];
        let all = 0..system.quantities.len() as QuantityId;
        let start: Vec<f64> = all.map(|place| initial(system, place, time, &mut known)).collect();
        let state = variables.iter().map(|&place| start[place as usize]).collect();
        let held = system.events.iter().map(|event| event.true_before_start).collect();
        Self { system, variables, order, start, state, time, held, waiting: Vec::new() }
    }

    fn values(&self, time: f64, state: &[f64]) -> Vec<f64> {
        let mut values = self.start.clone();
        for (&place, &value) in self.variables.iter().zip(state) {
            values[place as usize] = value;
        }
        for &place in &self.order {
            if let Role::Defined { rule } = &self.system.quantities[place as usize].role {
                values[place as usize] = rule.evaluate(time, &|other| values[other as usize]);
            }
        }
        values
    }

    fn slope(&self, time: f64, state: &[f64]) -> Vec<f64> {
        let values = self.values(time, state);
        let slope = |&place: &QuantityId| match &self.system.quantities[place as usize].role {
            Role::Variable { rate } => rate.evaluate(time, &|other| values[other as usize]),
            _ => unreachable!("variables have rates"),
        };
        self.variables.iter().map(slope).collect()
    }

    /// One accepted step of the Rosenbrock method of Kaps and Rentrop with Shampine's numbers, not across an event;
    /// gives the next step to try.
    fn advance(&mut self, mut step: f64, until: f64, rtol: f64, atol: f64) -> f64 {
        if self.variables.is_empty() && self.system.events.is_empty() {
            self.time = until;
            return step;
        }
        let first_due = self.waiting.iter().map(|waiting| waiting.due).fold(until, f64::min);
        let jacobian = self.jacobian();
        loop {
            let left = first_due - self.time;
            let clipped = step >= left * (1.0 - 1e-9);
            let tried = if clipped { left } else { step };
            let (state, error) = self.attempt(tried, &jacobian, rtol, atol);
            let factor = (0.9 * error.max(1e-8).powf(-0.25)).clamp(0.2, 3.0);
            if error.is_nan() || error > 1.0 {
                step = tried * if error.is_nan() { 0.1 } else { factor.min(0.9) };
                assert!(step > 1e-14 * (1.0 + self.time.abs()), "{}: no step at {}", self.system.name, self.time);
                continue;
            }
            let end = if clipped { first_due } else { self.time + tried };
            if self.fires(end, &state) {
                let end = self.crossing(tried, &jacobian);
                let (state, _) = self.attempt(end, &jacobian, rtol, atol);
                (self.time, self.state) = (self.time + end, state);
            } else {
                // What turned false again must be known before it can turn true anew.
                (self.time, self.state) = (end, state);
            }
            return if clipped { step.max(tried) } else { tried * factor };
        }
    }

    /// Whether a trigger that does not hold yet holds in a state, or one that holds no longer does.
    fn fires(&self, time: f64, state: &[f64]) -> bool {
        let values = self.values(time, state);
        let triggers = self.system.events.iter().zip(&self.held);
        triggers.into_iter().any(|(event, &held)| truth(&event.trigger, time, &values) != held)
    }

    /// The shortest step after which a trigger has changed.
    fn crossing(&self, step: f64, jacobian: &[Vec<f64>]) -> f64 {
        let (mut low, mut high) = (0.0, step);
        while high - low > 1e-13 * (self.time.abs() + step) {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            let (state, _) = self.attempt(middle, jacobian, 1.0, 1.0);
            if self.fires(self.time + middle, &state) { high = middle } else { low = middle }
        }
        high
    }

    fn jacobian(&self) -> Vec<Vec<f64>> {
        let base = self.slope(self.time, &self.state);
        let largest = self.state.iter().fold(1e-30_f64, |largest, value| largest.max(value.abs()));
        let size = self.state.len();
        let mut jacobian = vec![vec![0.0; size]; size];
        for column in 0..size {
            let mut moved = self.state.clone();
            let shift = 1e-7 * moved[column].abs().max(1e-3 * largest);
            moved[column] += shift;
            let slope = self.slope(self.time, &moved);
            for row in 0..size {
                jacobian[row][column] = (slope[row] - base[row]) / (moved[column] - self.state[column]);
                if !jacobian[row][column].is_finite() {
                    jacobian[row][column] = 0.0;
                }
            }
        }
        jacobian
    }

    /// The state after a step, and its error over the tolerance.
    fn attempt(&self, h: f64, jacobian: &[Vec<f64>], rtol: f64, atol: f64) -> (Vec<f64>, f64) {
        let size = self.state.len();
        let mut matrix: Vec<Vec<f64>> = jacobian.iter().map(|row| row.iter().map(|j| -j).collect()).collect();
        for place in 0..size {
            matrix[place][place] += 2.0 / h;
        }
        let pivots = factor(&mut matrix);
        let shift = 1e-6 * h;
        let base = self.slope(self.time, &self.state);
        let later = self.slope(self.time + shift, &self.state);
        let along: Vec<f64> =
            base.iter().zip(&later).map(|(a, b)| if (b - a).is_finite() { (b - a) / shift } else { 0.0 }).collect();
        let solve = |slope: &[f64], c: f64, parts: &[(&Vec<f64>, f64)]| {
            let mut right: Vec<f64> = (0..size)
                .map(|i| slope[i] + h * c * along[i] + parts.iter().map(|(g, w)| g[i] * w / h).sum::<f64>())
                .collect();
            back(&matrix, &pivots, &mut right);
            right
        };
        let sum = |parts: &[(&Vec<f64>, f64)]| -> Vec<f64> {
            (0..size).map(|i| self.state[i] + parts.iter().map(|(g, w)| g[i] * w).sum::<f64>()).collect()
        };
        let g1 = solve(&base, 0.5, &[]);
        let slope = self.slope(self.time + h, &sum(&[(&g1, 2.0)]));
        let g2 = solve(&slope, -1.5, &[(&g1, -8.0)]);
        let slope = self.slope(self.time + 0.6 * h, &sum(&[(&g1, 48.0 / 25.0), (&g2, 6.0 / 25.0)]));
        let g3 = solve(&slope, 121.0 / 50.0, &[(&g1, 372.0 / 25.0), (&g2, 12.0 / 5.0)]);
        let g4 = solve(&slope, 29.0 / 250.0, &[(&g1, -112.0 / 125.0), (&g2, -54.0 / 125.0), (&g3, -2.0 / 5.0)]);
        let state = sum(&[(&g1, 19.0 / 9.0), (&g2, 0.5), (&g3, 25.0 / 108.0), (&g4, 125.0 / 108.0)]);
        let mut error: f64 = 0.0;
        for i in 0..size {
            let off = g1[i] * 17.0 / 54.0 + g2[i] * 7.0 / 36.0 + g4[i] * 125.0 / 108.0;
            if self.state[i].is_nan() {
                continue; // a value that nothing has set yet
            }
            let share = off.abs() / (atol + rtol * self.state[i].abs().max(state[i].abs()));
            error = if share.is_nan() { f64::NAN } else { error.max(share) };
        }
        (state, error)
    }

    /// Everything that events do at this time.
    fn happen(&mut self) {
        self.fire();
        loop {
            let values = self.values(self.time, &self.state);
            let ready = (0..self.waiting.len()).filter(|&place| self.waiting[place].due <= self.time);
            let priority = |place: usize| {
                let event: &Event = &self.system.events[self.waiting[place].event];
                let value = event.priority.as_ref().map(|p| p.evaluate(self.time, &|other| values[other as usize]));
                value.unwrap_or(f64::NEG_INFINITY)
            };
            let Some(next) = ready.reduce(|a, b| if priority(b) > priority(a) { b } else { a }) else { break };
            let Waiting { event, values: kept, .. } = self.waiting.remove(next);
            let event = &self.system.events[event];
            for (number, (place, value)) in event.assignments.iter().enumerate() {
                let value = match &kept {
                    Some(kept) => kept[number],
                    None => value.evaluate(self.time, &|other| values[other as usize]),
                };
                let slot = self.variables.iter().position(|variable| variable == place).expect("events set variables");
                self.state[slot] = value;
            }
            self.fire();
        }
    }

    /// Notes triggers that changed.
    fn fire(&mut self) {
        let values = self.values(self.time, &self.state);
        for (number, event) in self.system.events.iter().enumerate() {
            let holds = truth(&event.trigger, self.time, &values);
            let held = std::mem::replace(&mut self.held[number], holds);
            if held && !holds && !event.persistent {
                self.waiting.retain(|waiting| waiting.event != number);
            }
            if holds && !held {
                let evaluate = |expr: &Expr| expr.evaluate(self.time, &|other| values[other as usize]);
                let kept = event
                    .values_from_firing
                    .then(|| event.assignments.iter().map(|(_, value)| evaluate(value)).collect());
                let due = self.time + event.delay.as_ref().map_or(0.0, evaluate);
                self.waiting.push(Waiting { event: number, due, values: kept });
            }
        }
    }
}

fn truth(condition: &Expr, time: f64, values: &[f64]) -> bool {
    condition.evaluate(time, &|other| values[other as usize]) != 0.0
}

fn initial(system: &System, place: QuantityId, time: f64, known: &mut Vec<Option<f64>>) -> f64 {
    if let Some(value) = known[place as usize] {
        return value;
    }
    let quantity = &system.quantities[place as usize];
    let expr = if let Role::Defined { rule } = &quantity.role { rule } else { &quantity.initial };
    let mut used = Vec::new();
    expr.each_quantity(&mut |other| used.push(other));
    for other in used {
        initial(system, other, time, known);
    }
    let value = expr.evaluate(time, &|other| known[other as usize].expect("known before"));
    known[place as usize] = Some(value);
    value
}

/// LU factors with row exchanges.
fn factor(matrix: &mut [Vec<f64>]) -> Vec<usize> {
    let size = matrix.len();
    let mut pivots = Vec::new();
    for k in 0..size {
        let best = (k..size).fold(k, |best, row| if matrix[row][k].abs() > matrix[best][k].abs() { row } else { best });
        matrix.swap(k, best);
        pivots.push(best);
        let pivot = matrix[k].clone();
        for row in matrix.iter_mut().skip(k + 1) {
            row[k] /= pivot[k];
            let share = row[k];
            if share != 0.0 {
                row.iter_mut().zip(&pivot).skip(k + 1).for_each(|(entry, above)| *entry -= share * above);
            }
        }
    }
    pivots
}

fn back(matrix: &[Vec<f64>], pivots: &[usize], right: &mut [f64]) {
    let size = right.len();
    for (k, &pivot) in pivots.iter().enumerate() {
        right.swap(k, pivot);
    }
    for k in 0..size {
        for row in k + 1..size {
            right[row] -= matrix[row][k] * right[k];
        }
    }
    for k in (0..size).rev() {
        right[k] = (right[k] - (k + 1..size).map(|c| matrix[k][c] * right[c]).sum::<f64>()) / matrix[k][k];
    }
}
