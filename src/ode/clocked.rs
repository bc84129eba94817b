//! Populations whose systems the clock switches: windows are cut where it does, eq. (ode.9), for all cells alike.

use super::buffers::PopulationScratch;
use super::population::Population;
use super::stepper::{Stepper, StepperBuffers};
use super::stops::{Stops, stops};
use super::switches::{Ahead, LOOKS_IN_WINDOW, Switches, after};
use super::{Method, OdeTrouble, Tolerances, Work};
use crate::equations::program::Program;
use crate::equations::tree::{Expr, Role, System};

/// Compiles a system without events for populations, and beside its rates what the clock switches in all cells at the same times: what depends
/// on no input.
///
/// # Errors
/// As [`Program::with`].
pub fn clocked(system: &System) -> Result<Program, Vec<String>> {
    let Stops { mut differences, mut counts } = stops(system);
    [&mut differences, &mut counts].into_iter().for_each(|group| group.retain(|switch| !has_input(system, switch)));
    match differences.is_empty() && counts.is_empty() {
        true => Program::new(system),
        // In the places where they stand of systems with events.
        false => Program::with(system, 0.0, &[], &[Vec::new(), Vec::new(), differences, counts]),
    }
}

fn has_input(system: &System, expression: &Expr) -> bool {
    let mut used = Vec::new();
    expression.each_quantity(&mut |quantity| used.push(quantity));
    used.into_iter().any(|quantity| match &system.quantities[quantity as usize].role {
        Role::Input => true,
        Role::Defined { rule } => has_input(system, rule),
        Role::Variable { .. } | Role::Parameter => false,
    })
}

impl Population {
    /// As [`Self::advance`], of a program from [`clocked`]: piece by piece between the times at which the clock switches something.
    ///
    /// # Errors
    /// As [`Self::advance`]; where a piece fails no cell goes beyond it.
    ///
    /// # Panics
    /// As [`Self::advance`].
    pub fn advance_by_clock(
        &mut self,
        program: &Program,
        (from, until): (f64, f64),
        tolerances: &Tolerances,
        scratch: &mut PopulationScratch,
    ) -> Result<Work, OdeTrouble> {
        if program.further.is_empty() || after(from, until) >= until {
            return self.advance(program, from, until, tolerances, scratch);
        }
        scratch.suit(program, self.method(), self.blocks());
        let known = scratch.clock.take();
        let (buffers, mut switches) =
            known.unwrap_or_else(|| (StepperBuffers::new(program, false), Switches::default()));
        // It tells the time alone.
        let mut clock = Stepper::within(buffers, program, Method::Euler { step: 1.0 }, *tolerances);
        let initial = |quantity: &u32| program.initial[*quantity as usize];
        clock.resume(from, program.variables.iter().map(initial), program.open.iter().map(initial), (0.0, 1.0));
        switches.begin(&clock, until, LOOKS_IN_WINDOW);
        if switches.are_at_present(&mut clock) {
            clock.time = after(from, until);
        }
        let mut result = Ok(Work::default());
        while clock.time < until {
            let Ahead { switch, seen } = switches.next(&mut clock);
            let limit = until.min(switch.at).min(seen);
            let end = if limit == switch.at { switch.before } else { limit };
            if end > clock.time {
                let advanced = self.advance(program, clock.time, end, tolerances, scratch);
                match (&mut result, advanced) {
                    (Ok(work), Ok(more)) => work.add(more),
                    (_, advanced) => {
                        result = advanced;
                        break;
                    }
                }
            }
            clock.time = if limit == switch.at { switch.after } else { limit };
        }
        scratch.clock = Some((clock.into_buffers(), switches));
        result
    }
}
