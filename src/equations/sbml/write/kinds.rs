//! What each quantity of a system is in SBML.

use crate::equations::tree::{Expr, Quantity, Reaction, Role, System};
use crate::units::{Dimension, parse_unit};

/// What a quantity is in SBML.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A species that formulas take as its amount.
    Amount,
    /// A species that formulas take as its concentration, in a compartment of 1 l.
    Concentration,
    /// A parameter.
    Parameter,
    /// The rate of a reaction: extents in the unit of time, where `is_dense` of a litre.
    Reaction {
        /// Whether what it changes are concentrations.
        is_dense: bool,
    },
}

/// The kinds of all quantities.
pub struct Kinds {
    /// Of each quantity.
    pub of: Vec<Kind>,
    /// Whether reactions name each quantity and leave it as it is, all of them.
    pub held: Vec<bool>,
    /// Whether reactions change each quantity.
    pub changed: Vec<bool>,
    /// Whether each quantity stays as it is, events included.
    pub constant: Vec<bool>,
}

impl Kinds {
    /// Simulators show species, so what may be one by its unit is, and what changes without a unit, and all that reactions name. What
    /// only events change is a switch and no species where its unit does not say otherwise.
    pub fn new(system: &System) -> Self {
        let count = system.quantities.len();
        let (mut held, mut changed) = (vec![false; count], vec![false; count]);
        for reaction in &system.reactions {
            for (_, participant) in reaction.participants() {
                let number = participant.quantity as usize;
                if participant.is_held { held[number] = true } else { changed[number] = true }
            }
        }
        held.iter_mut().zip(&changed).for_each(|(held, changed)| *held &= !changed);
        let numbered = system.quantities.iter().enumerate();
        let mut of: Vec<Kind> = numbered.map(|(number, it)| kind(it, held[number] || changed[number])).collect();
        for reaction in &system.reactions {
            of[reaction.rate as usize] = Kind::Reaction { is_dense: is_dense(reaction, &of) };
        }
        let is_constant = |quantity: &Quantity| matches!(quantity.role, Role::Parameter | Role::Input);
        let mut constant: Vec<bool> = system.quantities.iter().map(is_constant).collect();
        let set = system.events.iter().flat_map(|event| &event.assignments);
        set.for_each(|(target, _)| constant[*target as usize] = false);
        Self { of, held, changed, constant }
    }
}

/// Whether what a reaction changes are concentrations.
fn is_dense(reaction: &Reaction, kinds: &[Kind]) -> bool {
    reaction.changed().any(|number| kinds[number as usize] == Kind::Concentration)
}

fn kind(quantity: &Quantity, in_reactions: bool) -> Kind {
    let rate = match &quantity.role {
        Role::Variable { rate } => Some(rate),
        _ if in_reactions => None,
        _ => return Kind::Parameter,
    };
    match dimension(&quantity.unit) {
        Dimension::CONCENTRATION => Kind::Concentration,
        Dimension::AMOUNT => Kind::Amount,
        Dimension::NUMBER if rate.is_some_and(|rate| *rate != Expr::Number(0.0)) => Kind::Amount,
        _ if in_reactions => Kind::Amount,
        _ => Kind::Parameter,
    }
}

/// The dimension of a unit; that of a plain number where there is none.
fn dimension(unit: &str) -> Dimension {
    parse_unit(unit).map_or(Dimension::NUMBER, |unit| unit.dimension)
}

/// Whether an amount of a species can be in a unit: an amount of substance, a mass or a plain number.
pub fn is_substance(unit: &str) -> bool {
    [Dimension::AMOUNT, Dimension::MASS, Dimension::NUMBER].contains(&dimension(unit))
}
