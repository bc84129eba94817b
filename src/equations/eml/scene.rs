//! What stands once beside the fields of a document: variables of the scene, events, and what is summed over the grid.

use super::build::Builder;
use super::declare::tell_at;
use super::document::{FieldDescription, Level, SceneDescription};
use super::membrane::{differing, first, reached};
use super::xml::Element;
use crate::equations::tree::{Event, Expr, QuantityId, Role, System};

/// Words for where a quantity lives.
const IN_FIELD: &str = "differs from point to point";
/// What to do about it.
const TAKE_MEAN: &str = "use its mean or sum over the grid: <mean id=\"m\">…</mean> or <integral>";

impl Builder<'_, '_> {
    /// What a document of fields has beside these; none where it has fields alone.
    pub(super) fn scene(&mut self, root: &Element, dimension: usize) -> Option<SceneDescription> {
        let beside = |element: &Element| matches!(element.kind.name, "variable" | "event" | "mean" | "integral");
        if self.known.level != Level::Field || !root.children.iter().any(beside) {
            return None;
        }
        let measure = self.known.length.to_the(dimension as f64);
        Some(SceneDescription { totals: self.totals(root, &measure), local: Vec::new() })
    }

    /// Finds what differs from point to point, and tells what there is once and uses it all the same.
    pub(super) fn finish_scene(&mut self, scene: &mut SceneDescription, fields: &[FieldDescription], system: &System) {
        scene.local = differing(fields.iter().map(|field| field.quantity), system);
        self.check_totals(&scene.totals, system);
        self.check_starts(scene, system);
        let is_local = |quantity: QuantityId| scene.local[quantity as usize];
        for (number, quantity) in system.quantities.iter().enumerate() {
            let (Some(declared), Role::Variable { rate }) = (self.known.quantities.get(number), &quantity.role) else {
                continue;
            };
            if is_local(number as QuantityId) {
                continue;
            }
            let element = declared.element;
            for (expr, attribute) in [(rate, "id"), (&quantity.initial, "initial")] {
                if let Some(used) = first(expr, &is_local) {
                    let (id, used) = (&quantity.id, &system.quantities[used as usize].id);
                    let message = format!("`{id}` is one number of the scene, but uses `{used}`, which {IN_FIELD}");
                    tell_at(self.context, element, attribute, &message, "at which point?", TAKE_MEAN);
                }
            }
            if element.attribute("noise").is_some() {
                let message = format!("`{}` stands beside fields and has noise", quantity.id);
                let help = "give it a document of its own, without fields, and join the two by links";
                tell_at(self.context, element, "noise", &message, "cannot be kicked here", help);
            }
        }
        self.check_set_parameters(fields, system);
    }

    /// What starts from a mean or a sum, which is known only when everything has started.
    fn check_starts(&mut self, scene: &SceneDescription, system: &System) {
        let is_total = |quantity: &QuantityId| scene.totals.iter().any(|total| total.quantity == *quantity);
        for (number, quantity) in system.quantities.iter().enumerate() {
            let Some(declared) = self.known.quantities.get(number) else { continue };
            if let Some(used) = reached(&quantity.initial, system).iter().find(|used| is_total(used)) {
                let (id, used) = (&quantity.id, &system.quantities[*used as usize].id);
                let message = format!("`{id}` starts from `{used}`, which is known only when the fields have started");
                let help = "let an event with when=\"time ge 0\" set it";
                tell_at(self.context, declared.element, "initial", &message, "not known yet", help);
            }
        }
    }

    /// Tells events of a document of fields that ask for a number of a point, or set fields to what has been.
    pub(super) fn check_events_of_scene(&mut self, root: &Element, scene: &SceneDescription, system: &System) {
        let is_local = |quantity: QuantityId| scene.local[quantity as usize];
        if root.all("event").count() != system.events.len() {
            // Some are at fault themselves.
            return;
        }
        let is_field =
            |quantity: QuantityId| self.known.sort(&system.quantities[quantity as usize].id) == Some("field");
        let mut found = Vec::new();
        for (element, event) in root.all("event").zip(&system.events) {
            let asked = [
                ("when", Some(&event.trigger)),
                ("delay", event.delay.as_ref()),
                ("priority", event.priority.as_ref()),
            ];
            for (attribute, expr) in asked {
                if let Some(used) = expr.and_then(|expr| first(expr, &is_local)) {
                    let used = &system.quantities[used as usize].id;
                    let message = format!("`{attribute}` of the event uses `{used}`, which {IN_FIELD}");
                    found.push((element, attribute, message, "at which point?", TAKE_MEAN));
                }
            }
            for &(set, ref value) in &event.assignments {
                let id = &system.quantities[set as usize].id;
                let used = first(value, &is_local).filter(|_| !is_field(set));
                if let Some(used) = used.map(|used| &system.quantities[used as usize].id) {
                    let message =
                        format!("the event sets `{id}`, one number of the scene, by `{used}`, which {IN_FIELD}");
                    let element = element.all("set").find(|set| set.word("id") == *id).unwrap_or(element);
                    found.push((element, "id", message, "at which point?", TAKE_MEAN));
                }
            }
            if event.assignments.iter().any(|(set, _)| is_field(*set)) && keeps_values(event) {
                let message =
                    "the event sets a field by values of its firing, which no field keeps until the event is executed"
                        .to_owned();
                found.push((element, "delay", message, "executed later", "write values_from=\"execution\""));
            }
        }
        for (element, attribute, message, label, help) in found {
            tell_at(self.context, element, attribute, &message, label, help);
        }
    }

    /// Coefficients that keep one value cannot use a parameter that events set.
    fn check_set_parameters(&mut self, fields: &[FieldDescription], system: &System) {
        let set = |quantity: QuantityId| {
            let is_set = |event: &Event| event.assignments.iter().any(|(set, _)| *set == quantity);
            system.quantities[quantity as usize].role == Role::Parameter && system.events.iter().any(is_set)
        };
        for field in fields {
            let Some(used) = first(&field.decay, &set) else { continue };
            let used = &system.quantities[used as usize].id;
            let message = format!("`decay` of `{}` keeps one value, and an event sets `{used}`", field.id);
            let element = self.known.quantities[field.quantity as usize].element;
            let help = "write what decays as a <reaction>, or set something else";
            tell_at(self.context, element, "decay", &message, "keeps one value", help);
        }
    }
}

/// Whether an event is executed later than it fires, by the values of its firing.
fn keeps_values(event: &Event) -> bool {
    event.values_from_firing && event.delay.as_ref().is_some_and(|delay| *delay != Expr::Number(0.0))
}
