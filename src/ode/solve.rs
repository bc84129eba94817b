//! A single system from one time to another, with events and values wherever they are asked for.

use serde::{Deserialize, Serialize};

use super::control::Tolerances;
use super::course::{Course, CourseBuffers, LONGEST_SHARE};
use super::digits::Ended;
use super::events::{Chooser, EventBuffers, EventPlan, Events};
#[cfg(feature = "diffsol")]
use super::multistep;
use super::scheme::Scheme;
use super::starts::drawn;
use super::stepper::Stepper;
use super::switches::LOOKS_IN_SOLVE;
use super::{Method, Numbers, OdeTrouble, Reason, Work, lost};
use crate::equations::program::Program;
use crate::equations::tree::{QuantityId, Schedule, System};

/// Scheme and tolerances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SolveOptions {
    /// How to solve.
    pub scheme: Scheme,
    /// Error of a step relative to the size of each variable.
    pub relative: f64,
    /// Error of a step in the unit of each variable.
    pub absolute: f64,
    /// Most steps in all.
    pub max_steps: u32,
    /// Seed of the choices between events of one time and one priority.
    pub seed: u64,
    /// The longest step that a method takes which chooses its steps, in the unit of time; those of diffsol heed it not.
    pub longest: f64,
}

impl Default for SolveOptions {
    /// The Rosenbrock method, which takes stiff and other systems, with and without events.
    fn default() -> Self {
        let scheme = Scheme::OneStep(Method::Rosenbrock);
        Self { scheme, relative: 1e-7, absolute: 1e-14, max_steps: 2_000_000, seed: 0, longest: f64::INFINITY }
    }
}

/// Values at the times asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The times, as asked.
    pub times: Vec<f64>,
    /// Of each time the values of all quantities, defined ones included.
    pub values: Vec<Vec<f64>>,
    /// Work done.
    pub work: Work,
}

/// Solves a system from its initial values at `from`, until `until`, with values at `points` (ascending, within that
/// time). Comparisons of time with what does not vary are met exactly, so that what is switched by the clock costs no
/// accuracy. Where an event is executed at a point the values are those after it.
///
/// # Errors
/// When the numbers fail, or the system has circles or events that the scheme cannot take.
///
/// # Panics
/// When the points do not ascend within the time.
pub fn solve(
    system: &System,
    from: f64,
    until: f64,
    points: &[f64],
    options: &SolveOptions,
) -> Result<Solution, OdeTrouble> {
    let mut solution = Solution { times: Vec::new(), values: Vec::new(), work: Work::default() };
    let (times, rows) = (&mut solution.times, &mut solution.values);
    solution.work = solve_each(system, from, until, points, options, &mut |time, values| {
        times.push(time);
        rows.push(values.to_vec());
    })?;
    Ok(solution)
}

/// As [`solve()`]; hands the values of all quantities over, point by point, as soon as they are known. When the numbers
/// fail, those of all points before have been handed over.
///
/// # Errors
/// As [`solve()`].
///
/// # Panics
/// As [`solve()`].
pub fn solve_each(
    system: &System,
    from: f64,
    until: f64,
    points: &[f64],
    options: &SolveOptions,
    each: &mut dyn FnMut(f64, &[f64]),
) -> Result<Work, OdeTrouble> {
    assert!(points.is_sorted(), "points ascend");
    assert!(points.iter().all(|point| (from..=until).contains(point)), "points from {from} until {until}");
    let trouble = |detail: String| OdeTrouble {
        system: system.name.clone(),
        cell: None,
        time: from,
        variable: None,
        reason: Reason::Solver,
        detail,
    };
    let system = &*drawn(system, Numbers { seed: options.seed, system: &system.name }, 0);
    let compiled = EventPlan::compile(system, from);
    let (program, plan) = compiled.map_err(|circle| trouble(format!("a circle of {}", circle.join(", "))))?;
    if let Some(detail) = too_many_times(system, &program.initial, (from, until)) {
        return Err(OdeTrouble { reason: Reason::TooManyTimes, ..trouble(detail) });
    }
    let tolerances =
        Tolerances { relative: options.relative, absolute: options.absolute, max_steps: options.max_steps };
    match options.scheme {
        Scheme::OneStep(method) => {
            let SolveOptions { seed, longest, .. } = *options;
            let solver = Solver { program: &program, plan: &plan, method, tolerances, seed, longest };
            solver.solve_to_values((from, until), points, each)
        }
        _ if program.size() == 0 => {
            let options = SolveOptions { scheme: SolveOptions::default().scheme, ..*options };
            solve_each(system, from, until, points, &options, each)
        }
        _ if !program.delays.is_empty() => {
            Err(trouble("this scheme takes no delays: use rosenbrock, rk45, rk65, rk4 or euler".into()))
        }
        _ if !system.events.is_empty() => {
            Err(trouble("this scheme takes no events: use rosenbrock, rk45, rk65, rk4 or euler".into()))
        }
        #[cfg(not(feature = "diffsol"))]
        _ => Err(trouble("this program was built without diffsol: use rosenbrock, rk45, rk65, rk4 or euler".into())),
        #[cfg(feature = "diffsol")]
        scheme => multistep::solve(&program, scheme, (from, until), points, &tolerances, each),
    }
}

/// Which schedule has more times in a span than a course can have, in words; with the values of the start.
pub fn too_many_times(system: &System, initial: &[f64], span: (f64, f64)) -> Option<String> {
    let value = |quantity: QuantityId| initial[quantity as usize];
    system.events.iter().find_map(|event| {
        let schedule = event.schedule.as_ref()?;
        let (count, every) = (schedule.count(span, &value), schedule.every.evaluate(span.0, &value));
        // What is no number of times is too many as well.
        let is_good = count <= Schedule::MOST;
        (!is_good).then(|| format!("the event '{}' fires every {every:?} until {}", event.id, span.1))
    })
}

/// A system and how it is solved in one course.
struct Solver<'a> {
    program: &'a Program,
    plan: &'a EventPlan,
    method: Method,
    tolerances: Tolerances,
    seed: u64,
    longest: f64,
}

impl Solver<'_> {
    /// The course until the first values asked for that its equations do not determine: where nothing changes at a rate, only these
    /// tell that there is no solution.
    fn solve_to_values(
        self,
        span: (f64, f64),
        points: &[f64],
        each: &mut dyn FnMut(f64, &[f64]),
    ) -> Result<Work, OdeTrouble> {
        let (program, mut first) = (self.program, None);
        let solved = self.solve(span, points, &mut |time, values| {
            let is_lost = |quantity: &QuantityId| !values[*quantity as usize].is_finite();
            match program.searched.iter().copied().find(is_lost) {
                Some(unknown) => first = first.or(Some((time, unknown))),
                None if first.is_none() => each(time, values),
                None => {}
            }
        });
        let Some((time, unknown)) = first else { return solved };
        Err(OdeTrouble {
            system: program.name.clone(),
            cell: None,
            time,
            variable: None,
            reason: Reason::NotFinite,
            detail: lost(program, Some(unknown)),
        })
    }

    /// The course, and a second one with half of the relative tolerance where variables have become so small that round-off may
    /// be all that is left of them. With events it is not made: these happen at other times by their last bits.
    fn solve(self, span: (f64, f64), points: &[f64], each: &mut dyn FnMut(f64, &[f64])) -> Result<Work, OdeTrouble> {
        let (ended, mut work) = self.course(span, points, each)?;
        let (program, tolerances) = (self.program, self.tolerances);
        let fixed = matches!(self.method, Method::Rk4 { .. } | Method::Euler { .. });
        if fixed || !self.plan.is_empty() || ended.small(&program.sizes, tolerances).next().is_none() {
            return Ok(work);
        }
        let tighter = Tolerances { relative: 0.5 * tolerances.relative, ..tolerances };
        let Ok((other, more)) = Self { tolerances: tighter, ..self }.course(span, &[], &mut |_, _| ()) else {
            return Ok(work);
        };
        work.add(more);
        let Some((v, value)) = ended.lost(&other, &program.sizes, tolerances) else { return Ok(work) };
        Err(OdeTrouble {
            system: program.name.clone(),
            cell: None,
            time: span.1,
            variable: Some(program.names[program.variables[v] as usize].clone()),
            reason: Reason::RoundOff,
            detail: format!("{:e}, and {value:e} with half the relative tolerance", ended.state[v]),
        })
    }

    fn course(
        &self,
        (from, until): (f64, f64),
        points: &[f64],
        each: &mut dyn FnMut(f64, &[f64]),
    ) -> Result<(Ended, Work), OdeTrouble> {
        let mut stepper = Stepper::new(self.program, self.method, self.tolerances, from);
        let (mut memory, mut buffers) = (self.plan.before_start(from), EventBuffers::default());
        let choices = Numbers { seed: self.seed, system: &self.program.name }.choices();
        let mut events = Events::new(self.plan, &mut memory, &mut buffers, Chooser { choices, cell: 0 });
        stepper.longest = self.longest;
        if !self.plan.is_empty() {
            stepper.longest = self.longest.min(LONGEST_SHARE * (until - from));
        }
        let mut scratch = CourseBuffers::default();
        Course::new(&mut stepper, &mut events, (until, LOOKS_IN_SOLVE), points, each, &mut scratch).run()?;
        let mut state = Vec::new();
        stepper.state_into(&mut state);
        Ok((Ended { state, largest: scratch.largest }, stepper.work))
    }
}
