//! What carries a field: flow, taxis, sources, and walls through which it passes.

use super::build::{Builder, Use};
use super::declare::POSITION;
use super::document::{FieldDescription, FieldSource, Taxis, Wall};
use super::reads::reads;
use super::xml::Element;
use crate::equations::tree::{Expr, System};

impl Builder<'_, '_> {
    /// The velocity that carries a field, along the axes of the grid.
    pub(super) fn advection(&mut self, field: &Element, id: &str, dimension: usize) -> Option<[Expr; 3]> {
        let mut elements = field.all("advection");
        let element = elements.next()?;
        if let Some(second) = elements.next() {
            let message = format!("`{id}` has two advections");
            let help = "write the sum of both velocities in one <advection>";
            self.context.fault(second.at.clone(), &message, "a second one", help);
        }
        let speed = self.known.length.times(&self.known.time.to_the(-1.0));
        let mut velocity = [const { Expr::Number(0.0) }; 3];
        for (axis, name) in POSITION.into_iter().enumerate() {
            if axis >= dimension && element.attribute(name).is_some() {
                let message = format!("`{id}` is carried along {name}, which its grid does not have");
                let help = format!("leave `{name}` away, or write dimension=\"{}\"", axis + 1);
                self.context.fault(element.location(name), &message, "along which axis?", &help);
                continue;
            }
            let what = format!("the velocity of `{id}` along {name}");
            if let Some(along) = self.attribute(element, name, Use::Now, Some((&speed, &what))) {
                velocity[axis] = along;
            }
        }
        Some(velocity)
    }

    /// The fields that a field moves up, or down, the gradients of.
    pub(super) fn taxis(&mut self, field: &Element, id: &str) -> Vec<Taxis> {
        let elements = field.all("taxis").filter(|element| element.attribute("towards").is_some());
        elements.filter_map(|element| self.one_taxis(element, id)).collect()
    }

    fn one_taxis(&mut self, element: &Element, id: &str) -> Option<Taxis> {
        let towards = element.word("towards");
        if self.known.sort(&towards) != Some("field") {
            let fields: Vec<&str> = self.known.ids().filter(|id| self.known.sort(id) == Some("field")).collect();
            let near = self.context.meant(&towards, fields.into_iter());
            let help =
                near.map_or("name a <field> of the document".to_owned(), |near| format!("did you mean `{near}`?"));
            let message = format!("there is no field `{towards}`");
            self.context.fault(element.location("towards"), &message, "towards what?", &help);
            return None;
        }
        if towards == id {
            let message = format!("`{id}` moves along its own gradient");
            let help = "that is diffusion which depends on it: write diffusion=\"…\" as an expression of the field";
            self.context.fault(element.location("towards"), &message, "itself", help);
            return None;
        }
        let spreads = self.known.length.to_the(2.0).times(&self.known.time.to_the(-1.0));
        let expected = self.unit_of(&towards).map(|unit| spreads.times(&unit.to_the(-1.0)));
        let what = format!("the sensitivity of `{id}` to `{towards}`");
        let expected = expected.as_ref().map(|unit| (unit, what.as_str()));
        let sensitivity = self.attribute(element, "sensitivity", Use::Now, expected)?;
        let location = self.context.location(element.at.clone(), "this taxis");
        Some(Taxis { towards: self.find(&towards)?, sensitivity, location })
    }

    /// The sources of a field at points and along lines.
    pub(super) fn sources(&mut self, field: &Element, id: &str, dimension: usize) -> Vec<FieldSource> {
        field.all("source").filter_map(|element| self.source(element, id, dimension)).collect()
    }

    fn source(&mut self, element: &Element, id: &str, dimension: usize) -> Option<FieldSource> {
        let given = |name: &str| element.attribute(name).is_some();
        let ends = match (given("at"), given("from"), given("to")) {
            (true, false, false) => ["at", "at"],
            (false, true, true) => ["from", "to"],
            _ => {
                let message = format!("a source of `{id}` lies at a point or on a line");
                let help = "write at=\"…\" for a point, or from=\"…\" and to=\"…\" for a line";
                self.context.fault(element.at.clone(), &message, "where?", help);
                return None;
            }
        };
        let from = self.numbers(element, ends[0], dimension);
        let to = if given("at") { from } else { self.numbers(element, ends[1], dimension) };
        let own = self.unit_of(id);
        let whole = self.known.length.to_the(dimension as f64).times(&self.known.time.to_the(-1.0));
        let what = format!("the strength of the source of `{id}`");
        let unit = own.map(|unit| unit.times(&whole));
        let strength = self.attribute(element, "strength", Use::Now, unit.as_ref().map(|unit| (unit, what.as_str())));
        let location = self.context.location(element.at.clone(), "this source");
        Some(FieldSource { ends: [from?, to?], strength: strength?, location })
    }

    /// Tells what carries a field and depends on what it cannot depend on.
    pub(super) fn check_transport(&mut self, field: &FieldDescription, system: &System) {
        let element = self.known.quantities[field.quantity as usize].element;
        let id = &field.id;
        let mut refuse = |at: std::ops::Range<usize>, what: &str, which: &str| {
            let message = format!("{what} of `{id}` depends on {which}");
            let help = match which {
                "a field" => {
                    "use numbers, parameters, inputs, the position and the time; attraction by fields is <taxis>"
                }
                _ => "use numbers, parameters, inputs and the time",
            };
            self.context.fault(at, &message, "depends on what?", help);
        };
        if let (Some(velocity), Some(element)) = (&field.advection, element.all("advection").next()) {
            for (along, name) in velocity.iter().zip(POSITION) {
                if reads(along, system).fields {
                    refuse(element.location(name), "the velocity", "a field");
                }
            }
        }
        for (source, element) in field.sources.iter().zip(element.all("source")) {
            let read = reads(&source.strength, system);
            if read.fields || read.position {
                let which = if read.fields { "a field" } else { "the position" };
                refuse(element.location("strength"), "the strength of a source", which);
            }
        }
        for wall in element.all("wall") {
            let side = super::document::SIDES.iter().position(|side| *side == wall.word("side"));
            if let Some(Wall::Fixed(value) | Wall::Open(value)) = side.map(|side| &field.walls[side])
                && reads(value, system).fields
            {
                refuse(wall.location("value"), "the value at a wall", "a field");
            }
        }
    }
}
