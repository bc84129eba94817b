//! Documents of membranes: what differs from atom to atom, what there is once in a cell, and what is summed over its surface.

use super::build::{Builder, Use};
use super::declare::{SURFACE, tell_at};
use super::document::{Level, MembraneDescription, SurfaceVariable, Taken, Total};
use super::xml::Element;
use crate::equations::expression::Unit;
use crate::equations::tree::{Expr, QuantityId, Role, System};

/// Words for where a quantity lives.
pub(super) const ON_SURFACE: &str = "differs from atom to atom";

impl Builder<'_, '_> {
    /// What a document of membranes says beside its equations.
    pub(super) fn membrane(&mut self, root: &Element) -> Option<MembraneDescription> {
        let elements = |name: &'static str| root.all(name).filter(|element| element.attribute("id").is_some());
        if self.known.level != Level::Membrane {
            for element in elements("variable").chain(elements("input")) {
                for name in ["diffusion", "level"].into_iter().filter(|name| element.attribute(name).is_some()) {
                    let message = format!("`{name}` cannot stand in a document of level {}", self.known.level.name());
                    let help = "variables spread along the surface of a cell in a document of level=\"membrane\"; what spreads in \
                                space is a <field>";
                    self.context.fault(element.location(name), &message, "not at this level", help);
                }
            }
            return None;
        }
        let surface: Vec<SurfaceVariable> =
            elements("variable").filter_map(|element| self.surface_variable(element)).collect();
        if let (true, true) = (surface.is_empty(), self.context.is_clean()) {
            let help =
                "declare <variable id=\"a\" initial=\"1\" diffusion=\"0.1\" rate=\"0\"/>, or write level=\"cell\"";
            self.context.fault(
                root.at.clone(),
                "no variable of the document lives on the membrane",
                "level=\"membrane\"",
                help,
            );
        }
        let totals = self.totals(root, &micrometre().to_the(2.0));
        let given = elements("input").filter_map(|element| self.given_at_atoms(element)).collect();
        Some(MembraneDescription { surface, given, totals, local: Vec::new() })
    }

    fn surface_variable(&mut self, element: &Element) -> Option<SurfaceVariable> {
        let id = element.word("id");
        if self.choice(element, "level", &["membrane", "cell"]) == 1 {
            if element.attribute("diffusion").is_some() {
                let message = format!("`{id}` is the same in the whole cell, and has a diffusion coefficient");
                let help = "remove `diffusion`, or level=\"cell\": what is in the cell is mixed at once";
                self.context.fault(element.location("diffusion"), &message, "spreads where?", help);
            }
            return None;
        }
        let spreads = micrometre().to_the(2.0).times(&self.known.time.to_the(-1.0));
        let what = format!("the diffusion coefficient of `{id}`");
        let diffusion = self.attribute(element, "diffusion", Use::Fixed, Some((&spreads, what.as_str())));
        Some(SurfaceVariable {
            quantity: self.find(&id)?,
            diffusion: diffusion.unwrap_or(Expr::Number(0.0)),
            location: self.context.location(element.location("id"), "the variable"),
        })
    }

    /// An input that differs from atom to atom.
    fn given_at_atoms(&mut self, element: &Element) -> Option<QuantityId> {
        match self.choice(element, "level", &["cell", "membrane"]) {
            1 => self.find(&element.word("id")),
            _ => None,
        }
    }

    /// What the document sums up, over the surface of a cell or over the grid, whose measure has this unit.
    pub(super) fn totals(&mut self, root: &Element, measure: &Unit) -> Vec<Total> {
        let elements = |name: &'static str| root.all(name).filter(|element| element.attribute("id").is_some());
        let totals = elements("mean").map(|element| (element, Taken::Mean));
        let totals = totals.chain(elements("integral").map(|element| (element, Taken::Integral)));
        let mut totals: Vec<Total> =
            totals.filter_map(|(element, taken)| self.total(element, taken, measure)).collect();
        totals.sort_by_key(|total| total.quantity);
        totals
    }

    fn total(&mut self, element: &Element, taken: Taken, measure: &Unit) -> Option<Total> {
        let id = element.word("id");
        let own = self.unit_of(&id);
        let (unit, what) = match (taken, self.known.level) {
            (Taken::Mean, _) => (own, format!("the mean `{id}`")),
            (Taken::Integral, level) => {
                let density = own.map(|unit| unit.times(&measure.to_the(-1.0)));
                let whole = if level == Level::Field { "grid" } else { "area" };
                (density, format!("what `{id}` sums up over the {whole}"))
            }
        };
        let integrand = self.expression(&element.text, Use::All, unit.as_ref().map(|unit| (unit, what.as_str())))?;
        let location = self.context.location(element.location("id"), "declared here");
        Some(Total { quantity: self.find(&id)?, taken, integrand, location })
    }

    /// Finds what differs from atom to atom, and tells what there is once in a cell and uses it all the same.
    pub(super) fn finish_membrane(&mut self, membrane: &mut MembraneDescription, system: &System) {
        membrane.local = local(membrane, system);
        let is_local = |quantity: QuantityId| membrane.local[quantity as usize];
        for (number, quantity) in system.quantities.iter().enumerate() {
            let Some(declared) = self.known.quantities.get(number) else { continue };
            let Role::Variable { rate } = &quantity.role else { continue };
            if is_local(number as QuantityId) {
                continue;
            }
            for (expr, attribute) in [(rate, "id"), (&quantity.initial, "initial")] {
                let used = first(expr, &is_local);
                if let Some(used) = used.map(|used| &system.quantities[used as usize].id) {
                    let message =
                        format!("`{}` is one number of the cell, but uses `{used}`, which {ON_SURFACE}", quantity.id);
                    let help =
                        format!("use its mean or sum over the surface: <mean id=\"m\">{used}</mean> or <integral>");
                    tell_at(self.context, declared.element, attribute, &message, "which atom's?", &help);
                }
            }
        }
        self.check_totals(&membrane.totals, system);
        if !self.context.is_clean() {
            return;
        }
        let values = super::start::values(system);
        for variable in &membrane.surface {
            let value = variable.diffusion.evaluate(0.0, &|number| values[number as usize]);
            if !(value.is_finite() && value >= 0.0) {
                let quantity = &self.known.quantities[variable.quantity as usize];
                let message = format!("`diffusion` of `{}` is {value}; 0 or more was expected", quantity.id);
                let help = "what gathers by itself has no solution; attraction belongs into the rate";
                tell_at(self.context, quantity.element, "diffusion", &message, "not 0 or more", help);
            }
        }
    }
}

impl Builder<'_, '_> {
    /// Tells sums of sums.
    pub(super) fn check_totals(&mut self, totals: &[Total], system: &System) {
        let is_total = |quantity: QuantityId| totals.iter().any(|total| total.quantity == quantity);
        for total in totals {
            let reached = reached(&total.integrand, system);
            if let Some(used) = reached.iter().copied().find(|used| is_total(*used)) {
                let (id, used) = (&system.quantities[total.quantity as usize].id, &system.quantities[used as usize].id);
                let message = format!("`{id}` sums up an expression that uses the sum `{used}`");
                let element = self.known.quantities[total.quantity as usize].element;
                let help = "sums stand side by side: let a <define> join them";
                tell_at(self.context, element, "id", &message, "a sum of sums", help);
            }
        }
    }
}

pub(super) fn micrometre() -> Unit {
    Unit::read("um").unwrap_or_else(|_| Unit::plain())
}

/// The first quantity of an expression of which something holds.
pub(super) fn first(expr: &Expr, holds: &impl Fn(QuantityId) -> bool) -> Option<QuantityId> {
    let mut found = None;
    expr.each_quantity(&mut |used| {
        if found.is_none() && holds(used) {
            found = Some(used);
        }
    });
    found
}

/// All quantities that an expression uses, also through definitions.
pub fn reached(expr: &Expr, system: &System) -> Vec<QuantityId> {
    let (mut open, mut seen) = (Vec::new(), Vec::new());
    expr.each_quantity(&mut |used| open.push(used));
    while let Some(quantity) = open.pop() {
        if seen.contains(&quantity) {
            continue;
        }
        seen.push(quantity);
        if let Role::Defined { rule } = &system.quantities[quantity as usize].role {
            rule.each_quantity(&mut |used| open.push(used));
        }
    }
    seen
}

/// Of each quantity, whether it differs from atom to atom.
fn local(membrane: &MembraneDescription, system: &System) -> Vec<bool> {
    let surface = membrane.surface.iter().map(|variable| variable.quantity);
    differing(surface.chain(membrane.given.iter().copied()), system)
}

/// Of each quantity, whether it differs from point to point, as these do and the position.
pub(super) fn differing(these: impl Iterator<Item = QuantityId>, system: &System) -> Vec<bool> {
    let mut local = vec![false; system.quantities.len()];
    these.for_each(|quantity| local[quantity as usize] = true);
    for (number, quantity) in system.quantities.iter().enumerate() {
        local[number] |= quantity.role == Role::Input && SURFACE[..3].contains(&quantity.id.as_str());
    }
    for (number, quantity) in system.quantities.iter().enumerate() {
        if let Role::Defined { rule } = &quantity.role {
            let own = local.clone();
            local[number] = reached(rule, system).iter().any(|used| own[*used as usize]);
        }
    }
    local
}
