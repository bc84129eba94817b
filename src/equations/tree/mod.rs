//! The equations of a system as a tree: what EML and SBML are read into and what every solver is fed from.

mod functions;
mod roots;
mod walk;

pub use functions::{Binary, Unary, larger, smaller};
pub use roots::{Equations, Search};

use serde::{Deserialize, Serialize};

/// Number of a quantity within its [`System`].
pub type QuantityId = u32;

/// An expression. Truth is a number: 1 true, 0 false; every number but 0 counts as true.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Expr {
    /// A number.
    Number(f64),
    /// The time of the system, in its unit of time.
    Time,
    /// The value of a quantity.
    Quantity(QuantityId),
    /// A function of one argument.
    Unary(Unary, Box<Expr>),
    /// An operator or function of two arguments.
    Binary(Binary, Box<Expr>, Box<Expr>),
    /// The value beside the first condition that holds, or else the last one.
    Piecewise {
        /// (condition, value) in order.
        branches: Vec<(Expr, Expr)>,
        /// The value when no condition holds.
        otherwise: Box<Expr>,
    },
    /// What the first was a time ago that the second tells: x(t − τ). Not below 0; at 0 it is the value now.
    Delay(Box<Expr>, Box<Expr>),
    /// The unknown with an index among those that equations determine. It stands in the rules of these unknowns and nowhere else.
    Root(Box<Equations>, u32),
}

/// What a quantity is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Role {
    /// Fixed for the whole run at its initial value.
    Parameter,
    /// Changes at this rate (a plain 0 for what only events change).
    Variable {
        /// Rate of change.
        rate: Expr,
    },
    /// Equal to an expression of others at all times.
    Defined {
        /// The expression.
        rule: Expr,
    },
    /// Given from outside: by a link, or by the caller; the initial value stands until then.
    Input,
}

/// A named number of a system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// Its identifier, unique in the system.
    pub id: String,
    /// A name for people, or empty.
    pub name: String,
    /// What it is.
    pub role: Role,
    /// Its value at the start; may use the initial values of others and, in SBML, time. Ignored for [`Role::Defined`].
    pub initial: Expr,
    /// The unit it is given in, as the document writes it; empty when there is none.
    pub unit: String,
}

/// What happens when a condition becomes true.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Its identifier, or a made one.
    pub id: String,
    /// The event fires when this turns from false to true.
    pub trigger: Expr,
    /// What the trigger counts as before the start; an event whose trigger is true at the start and counts as false
    /// before fires at the start.
    pub true_before_start: bool,
    /// Time from firing to execution.
    pub delay: Option<Expr>,
    /// Of events at the same time the one with the larger priority is executed first.
    pub priority: Option<Expr>,
    /// Whether the new values are those of the firing (or else of the execution).
    pub values_from_firing: bool,
    /// Whether a delayed event is executed even when its trigger has become false again.
    pub persistent: bool,
    /// Quantities and their new values, all computed before any is set.
    pub assignments: Vec<(QuantityId, Expr)>,
    /// The schedule that its trigger stands for, if it has one.
    pub schedule: Option<Schedule>,
}

/// Times at equal intervals, made of numbers and parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Schedule {
    /// The first time.
    pub first: Expr,
    /// From one time to the next, above 0.
    pub every: Expr,
    /// No time is after this; none: without end.
    pub until: Option<Expr>,
}

impl Schedule {
    /// A condition that turns true at each of the times and at no other, and holds for half of the interval.
    pub fn trigger(&self) -> Expr {
        let two = |function, a: Expr, b: Expr| Expr::Binary(function, Box::new(a), Box::new(b));
        let half = || Expr::Number(0.5);
        let since = || two(Binary::Sub, Expr::Time, self.first.clone());
        let number = |since: Expr| two(Binary::Div, since, self.every.clone());
        let phase = two(Binary::Rem, number(since()), Expr::Number(1.0));
        let begun = two(Binary::Ge, Expr::Time, self.first.clone());
        let holds = two(Binary::And, begun, two(Binary::Lt, phase, half()));
        let Some(until) = &self.until else { return holds };
        // Half an interval after the last time, so that it counts though round-off puts it a little late.
        let span = number(two(Binary::Sub, until.clone(), self.first.clone()));
        let last = Expr::Unary(Unary::Floor, Box::new(two(Binary::Add, span, Expr::Number(1e-9))));
        two(Binary::And, holds, two(Binary::Lt, number(since()), two(Binary::Add, last, half())))
    }

    /// The most times that a course can have: each costs it a step at least.
    pub const MOST: f64 = 1e7;

    /// How many of them lie in a span of time, but for one at either end.
    pub fn count(&self, (from, until): (f64, f64), value: &impl Fn(QuantityId) -> f64) -> f64 {
        let of = |expr: &Expr| expr.evaluate(from, value);
        let last = self.until.as_ref().map_or(until, |last| of(last).min(until));
        (last - of(&self.first).max(from)).max(0.0) / of(&self.every)
    }

    /// Whether a time is one of them, but for round-off.
    pub fn has(&self, time: f64, value: &impl Fn(QuantityId) -> f64) -> bool {
        let of = |expr: &Expr| expr.evaluate(time, value);
        let (first, every) = (of(&self.first), of(&self.every));
        let number = (time - first) / every;
        let last = self.until.as_ref().map_or(f64::INFINITY, |until| (of(until) - first) / every + 1e-9);
        number > -1e-9 && number < last && (number - number.round()).abs() < 1e-9
    }
}

/// What turns some variables into others at one rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reaction {
    /// The defined quantity that has its rate: how often it happens in the unit of time; below 0 it goes backwards.
    pub rate: QuantityId,
    /// Whether it is meant to go both ways.
    pub reversible: bool,
    /// What is used up.
    pub reactants: Vec<Participant>,
    /// What is made.
    pub products: Vec<Participant>,
}

/// What takes part in a reaction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Participant {
    /// Which quantity: a variable, or anything that is held.
    pub quantity: QuantityId,
    /// How much of it is used up or made each time, above 0.
    pub stoichiometry: f64,
    /// Whether the reaction leaves it as it is.
    pub is_held: bool,
}

impl Reaction {
    /// All that takes part, with the sign of its change.
    pub fn participants(&self) -> impl Iterator<Item = (f64, &Participant)> {
        let signed = |sign: f64| move |participant| (sign, participant);
        self.reactants.iter().map(signed(-1.0)).chain(self.products.iter().map(signed(1.0)))
    }

    /// The variables that it changes, one that stands on both sides twice.
    pub fn changed(&self) -> impl Iterator<Item = QuantityId> {
        self.participants().filter(|(_, participant)| !participant.is_held).map(|(_, participant)| participant.quantity)
    }
}

/// A system of differential equations, free of any document format. Functions are expanded, local parameters renamed;
/// the rules of defined quantities form no circle.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct System {
    /// A name for messages.
    pub name: String,
    /// All quantities.
    pub quantities: Vec<Quantity>,
    /// All events.
    pub events: Vec<Event>,
    /// What some quantities were before the start: expressions of parameters and the time. All others had their values of the
    /// start, and defined ones followed from these by their rules.
    pub history: Vec<(QuantityId, Expr)>,
    /// Reactions. The rate of a variable that one of them changes is the sum of its parts in all of them and nothing else, and
    /// stands in the variable as well: who solves the system need not look at them.
    pub reactions: Vec<Reaction>,
    /// Numbers that are drawn for each cell where the system starts.
    pub draws: Vec<Draw>,
}

/// A number that is drawn for each cell where a system starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Draw {
    /// The parameter that holds it; without a draw it is in its middle.
    pub quantity: QuantityId,
    /// The variable whose start uses it.
    pub variable: String,
    /// Which one of those of the variable it is.
    pub element: u32,
    /// Whether it is normal, with mean 0 and variance 1, or else uniform between 0 and 1.
    pub is_normal: bool,
}

impl System {
    /// The number of the quantity with an identifier.
    pub fn find(&self, id: &str) -> Option<QuantityId> {
        self.quantities.iter().position(|quantity| quantity.id == id).map(|number| number as QuantityId)
    }

    /// Numbers of the variables, in order: the state vector.
    pub fn variables(&self) -> Vec<QuantityId> {
        let is_variable = |number: &QuantityId| matches!(self.quantities[*number as usize].role, Role::Variable { .. });
        (0..self.quantities.len() as QuantityId).filter(is_variable).collect()
    }

    /// What a quantity was before the start, where that does not follow from the start.
    pub fn before_start(&self, quantity: QuantityId) -> Option<&Expr> {
        self.history.iter().find(|(of, _)| *of == quantity).map(|(_, before)| before)
    }

    /// Whether anything looks back: the equations are delay differential equations.
    pub fn has_delays(&self) -> bool {
        let of_quantity = |quantity: &Quantity| match &quantity.role {
            Role::Variable { rate: own } | Role::Defined { rule: own } => {
                own.has_delay() || quantity.initial.has_delay()
            }
            Role::Parameter | Role::Input => quantity.initial.has_delay(),
        };
        let of_event = |event: &Event| {
            let formulas = [Some(&event.trigger), event.delay.as_ref(), event.priority.as_ref()];
            let values = event.assignments.iter().map(|(_, value)| value);
            formulas.into_iter().flatten().chain(values).any(Expr::has_delay)
        };
        self.quantities.iter().any(of_quantity) || self.events.iter().any(of_event)
    }

    /// Numbers of the defined quantities in an order in which each uses only those before it.
    ///
    /// # Errors
    /// The identifiers along a circle of definitions.
    pub fn definition_order(&self) -> Result<Vec<QuantityId>, Vec<String>> {
        let mut order = Vec::new();
        let mut mark = vec![Mark::New; self.quantities.len()];
        for number in 0..self.quantities.len() as QuantityId {
            self.visit(number, &mut mark, &mut order, &mut Vec::new())?;
        }
        Ok(order)
    }

    fn visit(
        &self,
        number: QuantityId,
        mark: &mut [Mark],
        order: &mut Vec<QuantityId>,
        path: &mut Vec<QuantityId>,
    ) -> Result<(), Vec<String>> {
        let quantity = &self.quantities[number as usize];
        let Role::Defined { rule } = &quantity.role else { return Ok(()) };
        match mark[number as usize] {
            Mark::Done => return Ok(()),
            Mark::Open => {
                let begin = path.iter().position(|&other| other == number).unwrap_or(0);
                return Err(path[begin..].iter().map(|&q| self.quantities[q as usize].id.clone()).collect());
            }
            Mark::New => {}
        }
        mark[number as usize] = Mark::Open;
        path.push(number);
        let mut used = Vec::new();
        rule.each_quantity(&mut |other| used.push(other));
        for other in used {
            self.visit(other, mark, order, path)?;
        }
        path.pop();
        mark[number as usize] = Mark::Done;
        order.push(number);
        Ok(())
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Mark {
    New,
    Open,
    Done,
}
