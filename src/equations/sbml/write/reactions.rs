//! Reactions with their kinetic laws.

use super::Writer;
use super::element::Element;
use super::kinds::Kind;
use crate::equations::tree::{Participant, Reaction, Role};
use std::collections::BTreeSet;

impl Writer<'_> {
    /// The reactions of the model.
    pub(super) fn reactions(&mut self) -> Vec<Element> {
        self.document.system.reactions.iter().map(|reaction| self.reaction(reaction)).collect()
    }

    fn reaction(&self, reaction: &Reaction) -> Element {
        let element = self.head("reaction", reaction.rate as usize).with_flag("reversible", reaction.reversible);
        let element = element
            .list("listOfReactants", self.side(&reaction.reactants))
            .list("listOfProducts", self.side(&reaction.products))
            .list("listOfModifiers", self.modifiers(reaction));
        let Role::Defined { rule } = &self.document.system.quantities[reaction.rate as usize].role else {
            return element;
        };
        let law = match self.kinds.of[reaction.rate as usize] {
            Kind::Reaction { is_dense: true } => self.formulas.in_compartment(rule),
            _ => self.formulas.number(rule, None),
        };
        element.child(Element::new("kineticLaw").child(law))
    }

    /// Whether a species stands among the reactants or products: not where a reaction leaves it as it is and others do not.
    fn is_on_side(&self, participant: &Participant) -> bool {
        !participant.is_held || self.kinds.held[participant.quantity as usize]
    }

    fn side(&self, participants: &[Participant]) -> Vec<Element> {
        let named = participants.iter().filter(|participant| self.is_on_side(participant));
        let reference = |participant: &Participant| {
            Element::new("speciesReference")
                .with("species", &self.names.quantities[participant.quantity as usize])
                .with("stoichiometry", participant.stoichiometry.to_string())
                .with_flag("constant", true)
        };
        named.map(reference).collect()
    }

    /// Species that take part in a reaction and that it leaves as they are, because its law uses them or it says so.
    fn modifiers(&self, reaction: &Reaction) -> Vec<Element> {
        let on_sides: BTreeSet<u32> = reaction
            .participants()
            .map(|(_, participant)| participant)
            .filter(|participant| self.is_on_side(participant))
            .map(|participant| participant.quantity)
            .collect();
        let mut found: BTreeSet<u32> = reaction.participants().map(|(_, participant)| participant.quantity).collect();
        if let Role::Defined { rule } = &self.document.system.quantities[reaction.rate as usize].role {
            rule.each_quantity(&mut |number| {
                if matches!(self.kinds.of[number as usize], Kind::Amount | Kind::Concentration) {
                    found.insert(number);
                }
            });
        }
        let modifiers = found.difference(&on_sides).map(|number| &self.names.quantities[*number as usize]);
        modifiers.map(|id| Element::new("modifierSpeciesReference").with("species", id)).collect()
    }
}
