//! The values of earlier times that the equations of a single system use: the method of steps with dense output, eq. (ode.6).
//!
//! What has been solved is kept as the polynomials that the method has within its steps; before the start the system says what was. What a step
//! looks back at within itself is taken from the step as it was made last, until both are the same.

use std::sync::Arc;

use super::Method;
use super::history::{Frame, History, Piece};
use super::marks::Marks;
use super::scratch::LooksBack;
use crate::equations::program::code::Code;
use crate::equations::program::{Lanes, Past, Program, run};

/// The past of a system while it is solved. That of a system that does not look back is empty.
#[derive(Debug, Default)]
pub struct Lookback {
    history: History,
    /// When something happened at once.
    pub marks: Marks,
    /// Nothing where the system does not look back.
    frame: Option<Arc<Frame>>,
    /// How far all delays look back; infinite where one varies.
    reach: f64,
    /// When the system started.
    start: f64,
    /// Time, state and open quantities where the step begins.
    now: (f64, Vec<f64>, Vec<f64>),
    /// The length of the step that is being made.
    step: Option<f64>,
    /// The step as it was made last.
    pub present: Option<Piece>,
    /// Whether the step has been looked back at.
    is_met: bool,
    /// A delay that was not 0 or more: its index and the delay.
    pub ahead: Option<(usize, f64)>,
    /// Values before the start that do not depend on when.
    before: Vec<Option<f64>>,
    /// Registers of earlier times, by how many delays lie behind each other.
    files: Vec<Vec<Lanes<1>>>,
}

impl Lookback {
    /// The past of a system that has not begun.
    pub fn new(program: &Program, method: Method) -> Self {
        if program.delays.is_empty() {
            return Self::default();
        }
        let (order, degree) = match method {
            Method::Rk45 => (5, 4),
            Method::Rk65 => (6, 5),
            Method::Rosenbrock | Method::Rk4 { .. } => (4, 3),
            Method::Euler { .. } => (1, 1),
        };
        let reach = program.delays.iter().map(|delayed| delayed.reach).fold(0.0, f64::max);
        Self {
            marks: Marks::new(lags(program), order),
            frame: Some(Arc::new(Frame::new(looked_at(program), degree))),
            reach,
            before: vec![None; program.delays.len()],
            ..Self::default()
        }
    }

    /// Whether the system does not look back.
    pub fn is_empty(&self) -> bool {
        self.frame.is_none()
    }

    /// Forgets all and begins at a time.
    pub fn start(&mut self, time: f64) {
        self.history.clear();
        self.marks.start(time);
        (self.start, self.step, self.present) = (time, None, None);
    }

    /// A step begins at a time, a state and values of the open quantities.
    pub fn begin(&mut self, time: f64, state: &[Lanes<1>], open: &[f64]) {
        if self.is_empty() {
            return;
        }
        self.now.0 = time;
        self.now.1.clear();
        self.now.1.extend(state.iter().map(|value| value[0]));
        self.now.2.clear();
        self.now.2.extend_from_slice(open);
    }

    /// A step of this length is made.
    pub fn attempt(&mut self, step: f64) {
        (self.step, self.present, self.is_met, self.ahead) = (Some(step), None, false, None);
    }

    /// Whether the step has been looked back at.
    pub fn is_met(&self) -> bool {
        self.is_met
    }

    /// A piece for the values within a step; none where the system does not look back.
    pub fn blank(&self, begin: f64, length: f64) -> Option<Piece> {
        self.frame.as_ref().map(|frame| Piece::blank(frame, begin, length, &self.now.2))
    }

    /// Keeps the step as it was made last, up to a time at which it is left.
    pub fn keep(&mut self, end: f64) {
        self.step = None;
        let Some(mut piece) = self.present.take().filter(|piece| end > piece.begin) else { return };
        piece.end = end;
        self.history.push(piece);
        if self.reach.is_finite() {
            self.history.forget_before(end - self.reach);
            self.marks.forget_before(end - self.reach);
        }
    }

    /// Sets delayed values, and how fast they change with `rates`, for time and state in the registers. `shift` is how far these lie
    /// behind the step, where that is constant.
    fn set(
        &mut self,
        program: &Program,
        (delays, rates): (&[usize], bool),
        file: &mut [Lanes<1>],
        (level, shift): (usize, Option<f64>),
    ) {
        for &index in delays {
            let delayed = &program.delays[index];
            let delay = delayed.constant.unwrap_or_else(|| {
                run(&delayed.delay, file);
                file[delayed.delay.outputs[0] as usize][0]
            });
            let time = file[0][0];
            let (earlier, shift_then) = (time - delay, shift.zip(delayed.constant).map(|(a, b)| a + b));
            let (value, rate);
            if delay.is_nan() || delay < 0.0 {
                self.ahead.get_or_insert((index, delay));
                (value, rate) = (f64::NAN, 0.0);
            } else if earlier >= time {
                self.set(program, (&delayed.value.delays, false), file, (level, shift));
                run(&delayed.value, file);
                (value, rate) = (file[delayed.value.outputs[0] as usize][0], 0.0);
            } else {
                let step = self.step.filter(|_| rates);
                let mut at = |earlier: f64| self.value(program, index, (earlier, time), (level, shift_then));
                value = at(earlier);
                rate = step.map_or(0.0, |step| slope(0.25 * step, value, |by| at(earlier + by)));
            }
            file[delayed.register] = [value];
            if rates {
                file[delayed.register + 1] = [rate];
            }
        }
    }

    /// What is looked back at, at an earlier time.
    fn value(
        &mut self,
        program: &Program,
        index: usize,
        (earlier, time): (f64, f64),
        (level, shift): (usize, Option<f64>),
    ) -> f64 {
        let delayed = &program.delays[index];
        let middle = self.step.and_then(|step| shift.map(|shift| self.now.0 + 0.5 * step - shift));
        let earlier = self.marks.settled(earlier, middle, time);
        if earlier < self.start {
            return self.before(program, index, earlier);
        }
        if self.files.len() <= level {
            self.files.push(program.file());
        }
        let mut file = std::mem::take(&mut self.files[level]);
        file[0] = [earlier];
        self.look(program, earlier, &mut file);
        self.set(program, (&delayed.value.delays, false), &mut file, (level + 1, shift));
        run(&delayed.value, &mut file);
        let value = file[delayed.value.outputs[0] as usize][0];
        self.files[level] = file;
        value
    }

    /// What is looked back at, before the start.
    fn before(&mut self, program: &Program, index: usize, time: f64) -> f64 {
        if let Some(known) = self.before[index] {
            return known;
        }
        let (delayed, Some(system)) = (&program.delays[index], &program.system) else { return f64::NAN };
        let past = Past { system, start: self.start };
        let value = past.value(&delayed.expression, time, &|quantity| program.initial[quantity as usize]);
        self.before[index] = delayed.is_steady.then_some(value);
        value
    }

    /// Sets the registers of variables and open quantities to what they were.
    fn look(&mut self, program: &Program, time: f64, file: &mut [Lanes<1>]) {
        let within = self.step.is_some() && time >= self.now.0;
        let met = within && time > self.now.0;
        self.is_met |= met;
        let last = self.history.at(time);
        // What is not yet known goes on as it did, unless something has just happened.
        let goes_on = |piece: &&Piece| !self.marks.is_at(self.now.0) && piece.end == self.now.0;
        let piece = match (within, &self.present) {
            (false, _) => last,
            (true, Some(present)) => Some(present).filter(|_| met),
            (true, None) => last.filter(goes_on).filter(|_| met),
        };
        let first_open = program.first_open();
        let mut set = |variable: usize, value: f64| file[1 + variable] = [value];
        let open = match piece {
            Some(piece) => {
                piece.values(time, &mut set);
                &piece.open
            }
            None => {
                self.now.1.iter().enumerate().for_each(|(variable, &value)| set(variable, value));
                &self.now.2
            }
        };
        file[first_open..].iter_mut().zip(open).for_each(|(register, &value)| *register = [value]);
    }
}

impl LooksBack<1> for Lookback {
    fn fill(&mut self, program: &Program, code: &Code, file: &mut [Lanes<1>]) {
        if !code.delays.is_empty() {
            let rates = std::ptr::eq(code, &program.linear);
            // What is written down is what holds from then on, wherever in the step it lies.
            let shift = (!std::ptr::eq(code, &program.observe)).then_some(0.0);
            self.set(program, (&code.delays, rates), file, (0, shift));
        }
    }
}

/// The slope at 0 of what is `first` there, by its values at four points a distance apart, of fourth order.
fn slope(apart: f64, first: f64, mut value: impl FnMut(f64) -> f64) -> f64 {
    const WEIGHTS: [f64; 4] = [48.0, -36.0, 16.0, -3.0];
    let gain = |(point, weight): (usize, &f64)| weight * (value((point + 1) as f64 * apart) - first);
    WEIGHTS.iter().enumerate().map(gain).sum::<f64>() / (12.0 * apart)
}

/// The constant delays by which rates and triggers look back.
fn lags(program: &Program) -> Vec<f64> {
    let first = [Some(&program.rates), program.further.first()].into_iter().flatten();
    let mut open: Vec<usize> = first.flat_map(|code| code.delays.iter().copied()).collect();
    let (mut seen, mut lags) = (vec![false; program.delays.len()], Vec::new());
    while let Some(index) = open.pop() {
        if std::mem::replace(&mut seen[index], true) {
            continue;
        }
        let delayed = &program.delays[index];
        open.extend(delayed.value.delays.iter().chain(&delayed.delay.delays));
        lags.extend(delayed.constant.filter(|lag| *lag > 0.0 && lag.is_finite() && !lags.contains(lag)));
    }
    lags
}

/// The positions of the variables that are looked back at, in order.
fn looked_at(program: &Program) -> Vec<usize> {
    let mut read = vec![false; program.size()];
    for code in program.delays.iter().flat_map(|delayed| [&delayed.value, &delayed.delay]) {
        let operands = code.ops.iter().flat_map(|op| [op.a, op.b, op.c]).chain(code.outputs.iter().copied());
        for register in operands.map(|register| register as usize).filter(|register| *register > 0) {
            read.get_mut(register - 1).into_iter().for_each(|read| *read = true);
        }
    }
    (0..read.len()).filter(|&variable| read[variable]).collect()
}
