//! What an expression of a document of fields depends on.

use crate::equations::tree::{Expr, QuantityId, Role, System};

/// The position in a field.
pub(super) const POSITION: [&str; 3] = ["x", "y", "z"];

/// What an expression depends on, also through definitions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Reads {
    /// The time.
    pub time: bool,
    /// What is given from outside.
    pub inputs: bool,
    /// The position.
    pub position: bool,
    /// Fields.
    pub fields: bool,
}

impl Reads {
    /// Whether it is one number, of parameters alone.
    pub fn is_number(self) -> bool {
        self == Self::default()
    }

    /// Whether it is the same at all times, whatever the fields do.
    pub fn stands_still(self) -> bool {
        !(self.time || self.inputs || self.fields)
    }
}

/// What an expression depends on.
pub fn reads(expr: &Expr, system: &System) -> Reads {
    let mut found = Reads { time: expr.uses_time(), ..Reads::default() };
    let (mut open, mut seen): (Vec<QuantityId>, Vec<QuantityId>) = (Vec::new(), Vec::new());
    expr.each_quantity(&mut |used| open.push(used));
    while let Some(number) = open.pop() {
        if seen.contains(&number) {
            continue;
        }
        seen.push(number);
        let quantity = &system.quantities[number as usize];
        match &quantity.role {
            Role::Parameter => {}
            Role::Variable { .. } => found.fields = true,
            Role::Input if POSITION.contains(&quantity.id.as_str()) => found.position = true,
            Role::Input => found.inputs = true,
            Role::Defined { rule } => {
                found.time |= rule.uses_time();
                rule.each_quantity(&mut |used| open.push(used));
            }
        }
    }
    found
}
