//! A document of fields that has more beside them, taken apart: the fields, to which the rest is given from outside, and a system of the scene,
//! to which means and sums of the fields are.

use super::document::{Document, FieldDescription, Level, SolverChoice};
use crate::equations::tree::{Binary, Expr, Quantity, QuantityId, Role, System};

/// What an event sets fields to.
#[derive(Debug, Clone)]
pub struct FieldEvent {
    /// Its identifier.
    pub id: String,
    /// The variable of the system of the scene that counts its executions.
    pub count: QuantityId,
    /// Fields and their new values, expressions at each point.
    pub sets: Vec<(QuantityId, Expr)>,
}

/// A system as its fields see it: variables that are none of them are given from outside.
pub(super) fn of_fields(system: &System, fields: &[FieldDescription]) -> System {
    let mut system = system.clone();
    for (number, quantity) in system.quantities.iter_mut().enumerate() {
        let is_field = || fields.iter().any(|field| field.quantity as usize == number);
        if matches!(quantity.role, Role::Variable { .. }) && !is_field() {
            quantity.role = Role::Input;
        }
    }
    system
}

impl Document {
    /// What stands once beside the fields and changes: variables of the scene, and parameters that events set.
    pub fn beside(&self) -> Vec<QuantityId> {
        let system = &self.system;
        let is_set =
            |number: QuantityId| system.events.iter().any(|e| e.assignments.iter().any(|(set, _)| *set == number));
        let beside = |(number, quantity): (usize, &Quantity)| {
            let number = number as QuantityId;
            let stands_beside = match quantity.role {
                Role::Variable { .. } => !self.fields.iter().any(|field| field.quantity == number),
                Role::Parameter => is_set(number),
                Role::Input | Role::Defined { .. } => false,
            };
            stands_beside.then_some(number)
        };
        match self.scene {
            Some(_) => system.quantities.iter().enumerate().filter_map(beside).collect(),
            None => Vec::new(),
        }
    }

    /// What is one number of the scene beside the fields and may change, to be shown and recorded.
    pub fn quantities_beside(&self) -> Vec<QuantityId> {
        let (Some(scene), beside) = (&self.scene, self.beside()) else { return Vec::new() };
        let shown = |number: &QuantityId| {
            let role = &self.system.quantities[*number as usize].role;
            !scene.local[*number as usize] && (*role != Role::Parameter || beside.contains(number))
        };
        (0..self.system.quantities.len() as QuantityId).filter(shown).collect()
    }

    /// The fields alone, with the same quantities in the same order: what stands beside them is given as inputs.
    #[must_use]
    pub fn fields_alone(&self) -> Self {
        let mut alone = self.clone();
        for number in self.beside() {
            alone.system.quantities[number as usize].role = Role::Input;
        }
        alone.system.events.clear();
        alone.scene = None;
        alone
    }

    /// What stands beside the fields as a system of the scene, with the same quantities in the same order (those of the fields keep one value
    /// here) and behind them one for each event that sets fields, which counts its executions; nothing where there are fields alone.
    pub fn scene_alone(&self) -> Option<(Self, Vec<FieldEvent>)> {
        let scene = self.scene.as_ref()?;
        let mut alone = self.clone();
        (alone.level, alone.scene, alone.grid) = (Level::Scene, None, None);
        (alone.fields, alone.noise, alone.solver) = (Vec::new(), Vec::new(), SolverChoice::default());
        let system = &mut alone.system;
        for (quantity, _) in system.quantities.iter_mut().zip(&scene.local).filter(|(_, local)| **local) {
            (quantity.role, quantity.initial) = (Role::Parameter, Expr::Number(0.0));
        }
        let changed = |rate: QuantityId| scene.local.get(rate as usize) == Some(&true);
        system.reactions.retain(|reaction| !changed(reaction.rate));
        let is_field = |quantity: QuantityId| self.fields.iter().any(|field| field.quantity == quantity);
        let mut events = Vec::new();
        for event in &mut system.events {
            let (sets, kept) = std::mem::take(&mut event.assignments).into_iter().partition(|(set, _)| is_field(*set));
            event.assignments = kept;
            let sets: Vec<(QuantityId, Expr)> = sets;
            if sets.is_empty() {
                continue;
            }
            let count = system.quantities.len() as QuantityId;
            system.quantities.push(Quantity {
                // No identifier has a blank.
                id: format!("executions of {}", event.id),
                name: String::new(),
                role: Role::Variable { rate: Expr::Number(0.0) },
                initial: Expr::Number(0.0),
                unit: String::new(),
            });
            alone.locations.push(self.fields[0].location.clone());
            let one_more = Expr::Quantity(count).binary(Binary::Add, Expr::Number(1.0));
            event.assignments.push((count, one_more));
            event.values_from_firing &= event.delay.is_some();
            events.push(FieldEvent { id: event.id.clone(), count, sets });
        }
        Some((alone, events))
    }
}
