//! Events as SBML means them: triggers, delays, priorities, and what is still to be executed.

use super::memory::{EventMemory, reserve};
use super::stepper::Stepper;
use super::stops::{Stops, stops};
use super::{OdeTrouble, Reason};
use crate::equations::program::Program;
use crate::equations::tree::{Event, Expr, QuantityId, Role, System};
use crate::random::Choices;

/// Executions at one time after which events count as endless.
const MOST_AT_ONCE: u32 = 10_000;

/// Group of the triggers among [`Program::further`].
pub const TRIGGERS: usize = 0;
const PRIORITIES: usize = 1;
/// Group of the differences whose roots in time are met exactly.
pub const DIFFERENCES: usize = 2;
/// Group of what is met exactly where it is a whole number.
pub const COUNTS: usize = 3;
const FIRST_EVENT: usize = 4;

/// The events of a system beside its program.
#[derive(Debug, Clone, Default)]
pub struct EventPlan {
    events: Vec<Event>,
    /// Slot of each assigned quantity, event by event.
    slots: Vec<Vec<usize>>,
    /// Values of all quantities at the start, which schedules are made of.
    initial: Vec<f64>,
}

impl EventPlan {
    /// Compiles a system and its events for a start at a time. The parameters that events set are open in the program,
    /// and what events need stands behind its rates.
    ///
    /// # Errors
    /// As [`Program::with`].
    pub fn compile(system: &System, start: f64) -> Result<(Program, Self), Vec<String>> {
        let program = Program::with(system, start, &assigned_parameters(system), &groups(system))?;
        let slot = |quantity: QuantityId| {
            let variable = program.variable_index(quantity);
            variable.or_else(|| program.open_index(quantity).map(|index| program.size() + index)).unwrap_or(usize::MAX)
        };
        let slots = |event: &Event| event.assignments.iter().map(|&(quantity, _)| slot(quantity)).collect();
        let slots = system.events.iter().map(slots).collect();
        let plan = Self { events: system.events.clone(), slots, initial: program.initial.clone() };
        Ok((program, plan))
    }

    /// Whether there are no events.
    pub fn is_empty(&self) -> bool {
        self.events.is_empty()
    }

    /// What is known of the events before a start at a time. One with a schedule fires then if that is one of its times, and is else
    /// within what follows one.
    pub fn before_start(&self, time: f64) -> EventMemory {
        let value = |quantity: QuantityId| self.initial[quantity as usize];
        let held = |event: &Event| match &event.schedule {
            Some(schedule) => event.true_before_start || !schedule.has(time, &value),
            None => event.true_before_start,
        };
        EventMemory::new(self.events.iter().map(held).collect())
    }

    /// Makes sure that every event can wait once before a memory allocates.
    pub(super) fn suit(&self, memory: &mut EventMemory) {
        let kept = self.events.iter().filter(|event| event.values_from_firing).map(|event| event.assignments.len());
        memory.reserve(self.events.len(), kept.sum());
    }
}

/// The events of a system while it is solved.
pub struct Events<'a> {
    plan: &'a EventPlan,
    memory: &'a mut EventMemory,
    buffers: &'a mut EventBuffers,
    chooser: Chooser,
}

/// What chooses between the events of a cell that have one time and one priority.
#[derive(Debug, Clone, Copy)]
pub struct Chooser {
    /// The choices of the system.
    pub choices: Choices,
    /// The number of the cell.
    pub cell: u32,
}

/// What [`Events`] work in.
#[derive(Debug, Default)]
pub struct EventBuffers {
    state: Vec<f64>,
    triggers: Vec<f64>,
    /// Delay of an event that fires, and the values that it sets.
    firing: Vec<f64>,
    priorities: Vec<f64>,
    /// The same as `firing`, or the values alone, of an event that is executed.
    execution: Vec<f64>,
}

impl EventBuffers {
    /// Makes sure that the events of a plan and their program find memory.
    pub fn suit(&mut self, plan: &EventPlan, program: &Program) {
        let results = 1 + plan.slots.iter().map(Vec::len).max().unwrap_or(0);
        reserve(&mut self.state, program.size());
        [&mut self.triggers, &mut self.priorities].into_iter().for_each(|list| reserve(list, plan.events.len()));
        [&mut self.firing, &mut self.execution].into_iter().for_each(|list| reserve(list, results));
    }
}

/// Parameters that events set; they must stay open in the program.
pub fn assigned_parameters(system: &System) -> Vec<QuantityId> {
    let assigned = system.events.iter().flat_map(|event| event.assignments.iter().map(|(quantity, _)| *quantity));
    assigned.filter(|&quantity| matches!(system.quantities[quantity as usize].role, Role::Parameter)).collect()
}

/// The groups of expressions that events need in the program.
fn groups(system: &System) -> Vec<Vec<Expr>> {
    let number = Expr::Number;
    let triggers = system.events.iter().map(|event| event.trigger.clone()).collect();
    let priority = |event: &Event| event.priority.clone().unwrap_or(number(f64::NEG_INFINITY));
    let Stops { differences, counts } = stops(system, true);
    let mut groups = vec![triggers, system.events.iter().map(priority).collect(), differences, counts];
    for event in &system.events {
        let mut group = vec![event.delay.clone().unwrap_or(number(0.0))];
        group.extend(event.assignments.iter().map(|(_, value)| value.clone()));
        groups.push(group);
    }
    groups
}

impl<'a> Events<'a> {
    /// The events of a system with what is known of them.
    pub fn new(
        plan: &'a EventPlan,
        memory: &'a mut EventMemory,
        buffers: &'a mut EventBuffers,
        chooser: Chooser,
    ) -> Self {
        Self { plan, memory, buffers, chooser }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.plan.is_empty()
    }

    /// Whether a trigger that does not hold turns true by these values of all triggers.
    pub fn turns_true(&self, now: &[f64]) -> bool {
        now.iter().zip(&self.memory.holds).any(|(now, held)| *now != 0.0 && !held)
    }

    /// When the next waiting event is due.
    pub fn next(&self) -> f64 {
        self.memory.next()
    }

    /// Takes note of the triggers now: fires those that turned true, drops what no longer persists.
    pub fn update(&mut self, stepper: &mut Stepper) {
        let EventBuffers { state, triggers, firing, .. } = &mut *self.buffers;
        let program = stepper.program;
        stepper.state_into(state);
        stepper.evaluate(&program.further[TRIGGERS], stepper.time, state, triggers);
        for event in 0..self.plan.events.len() {
            let (held, holds) = (self.memory.holds[event], triggers[event] != 0.0);
            self.memory.holds[event] = holds;
            if !held && holds {
                stepper.evaluate(&program.further[FIRST_EVENT + event], stepper.time, state, firing);
                let delay = firing[0].max(0.0);
                let values = self.plan.events[event].values_from_firing.then(|| &firing[1..]);
                self.memory.add(event, stepper.time + delay, values);
            } else if held && !holds && !self.plan.events[event].persistent {
                self.memory.forget(event);
            }
        }
    }

    /// Takes note of triggers that no longer hold, within a step in which none turns true.
    pub fn note_falling(&mut self, now: &[f64]) {
        for (event, _) in now.iter().enumerate().filter(|(_, now)| **now == 0.0) {
            if self.memory.holds[event] && !self.plan.events[event].persistent {
                self.memory.forget(event);
            }
            self.memory.holds[event] = false;
        }
    }

    /// Executes all that is due, in the order of priorities worked out anew each time. Returns whether anything was executed.
    pub fn execute(&mut self, stepper: &mut Stepper) -> Result<bool, OdeTrouble> {
        let mut count: u32 = 0;
        while self.next() <= stepper.time {
            let Some(first) = self.first_due(stepper, count) else { break };
            let EventBuffers { state, execution, .. } = &mut *self.buffers;
            let program = stepper.program;
            let executed = self.memory.take(first, execution);
            let values = match executed.kept {
                Some(_) => &execution[..],
                None => {
                    let results = &program.further[FIRST_EVENT + executed.event];
                    stepper.evaluate(results, stepper.time, state, execution);
                    &execution[1..]
                }
            };
            for (&slot, &value) in self.plan.slots[executed.event].iter().zip(values) {
                let n = program.size();
                if slot < n {
                    stepper.set_state(slot, value);
                } else if let Some(open) = slot.checked_sub(n).and_then(|index| stepper.open.get_mut(index)) {
                    *open = value;
                }
            }
            stepper.work.events += 1;
            stepper.first_event = stepper.first_event.min(stepper.time);
            self.update(stepper);
            count += 1;
            if count > MOST_AT_ONCE {
                let detail = format!("event '{}'", self.plan.events[executed.event].id);
                return Err(OdeTrouble { detail, variable: None, ..stepper.trouble(Reason::EndlessEvents) });
            }
        }
        if count > 0 {
            stepper.restart();
        }
        Ok(count > 0)
    }

    /// Which of what waits and is due is executed next: that of the largest priority, of several equal ones any, as chance says.
    /// Those without a priority come last, in the order of their firing. Leaves the state in its buffer.
    fn first_due(&mut self, stepper: &mut Stepper, number: u32) -> Option<usize> {
        let EventBuffers { state, priorities, .. } = &mut *self.buffers;
        stepper.state_into(state);
        stepper.evaluate(&stepper.program.further[PRIORITIES], stepper.time, state, priorities);
        let mut due = self.memory.waiting().iter().enumerate().filter(|(_, waiting)| waiting.time <= stepper.time);
        let largest = due.clone().map(|(_, waiting)| priorities[waiting.event]).fold(f64::NEG_INFINITY, f64::max);
        if largest == f64::NEG_INFINITY {
            return due.next().map(|(at, _)| at);
        }
        let mut equals = due.filter(|(_, waiting)| priorities[waiting.event] == largest);
        let things = equals.clone().count();
        let chosen = match things {
            1 => 0,
            _ => self.chooser.choices.one(stepper.time, (self.chooser.cell, number), things),
        };
        equals.nth(chosen).map(|(at, _)| at)
    }
}
