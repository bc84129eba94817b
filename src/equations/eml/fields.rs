//! Fields, their grid and their walls.

use super::build::{Builder, Use};
use super::document::{FieldDescription, GridDescription, Profile, SIDES, Wall};
use super::parts::of_fields;
use super::reads::reads;
use super::xml::Element;
use crate::equations::Range;
use crate::equations::tree::{Expr, System};

impl Builder<'_, '_> {
    /// The grid of the fields.
    pub(super) fn grid(&mut self, root: &Element) -> Option<GridDescription> {
        let mut elements = root.all("grid");
        let Some(element) = elements.next() else {
            if let Some(field) = root.all("field").next() {
                let help = "write <grid dimension=\"2\" spacing=\"1\"/>";
                self.context.fault(field.at.clone(), "the fields have no grid", "which grid?", help);
            }
            return None;
        };
        if let Some(second) = elements.next() {
            let help = "the fields of a document share one grid; use a second document for another";
            self.context.fault(second.at.clone(), "there are two grids", "a second one", help);
        }
        // One that is not told counts as 2.
        let dimension = match self.choice(element, "dimension", &["1", "2", "3"]) {
            0 if element.word("dimension").trim() != "1" => 2,
            number => number + 1,
        };
        let spacing = self.positive(element, "spacing");
        let origin = self.numbers(element, "origin", dimension);
        let size = self.numbers(element, "size", dimension);
        if let Some(size) = size
            && size[..dimension].iter().any(|side| *side < spacing.unwrap_or(0.0).max(f64::MIN_POSITIVE))
        {
            let help = "write lengths that hold several points";
            self.context.fault(element.location("size"), "a side is shorter than the spacing", "too short", help);
        }
        Some(GridDescription {
            dimension,
            spacing: spacing.unwrap_or(1.0),
            origin,
            size,
            unit: self.known.length_text.clone(),
            micrometres: self.known.length.size(),
            location: self.context.location(element.at.clone(), "the grid"),
        })
    }

    /// As many numbers as there are dimensions.
    pub(super) fn numbers(&mut self, element: &Element, name: &str, dimension: usize) -> Option<[f64; 3]> {
        let text = element.attribute(name)?;
        let words: Vec<&str> = text.text.split_whitespace().collect();
        let read: Option<Vec<f64>> =
            words.iter().map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect();
        match read {
            Some(read) if read.len() == dimension => {
                let mut found = [0.0; 3];
                found[..dimension].copy_from_slice(&read);
                Some(found)
            }
            _ => {
                let plural = if dimension == 1 { "number was" } else { "numbers were" };
                let message = format!("`{name}` is \"{}\"; {dimension} {plural} expected", text.text.trim());
                let example = ["100", "100 100", "100 100 50"][dimension - 1];
                self.context.fault(
                    text.whole(),
                    &message,
                    "here",
                    &format!("write them with blanks between: \"{example}\""),
                );
                None
            }
        }
    }

    /// The fields, in the order of the text.
    pub(super) fn fields(&mut self, root: &Element, dimension: usize) -> Vec<FieldDescription> {
        let named = root.all("field").filter(|field| field.attribute("id").is_some());
        named.filter_map(|element| self.field(element, dimension)).collect()
    }

    fn field(&mut self, element: &Element, dimension: usize) -> Option<FieldDescription> {
        let id = element.word("id");
        let (time, length) = (self.known.time.clone(), self.known.length.clone());
        let spreads = length.to_the(2.0).times(&time.to_the(-1.0));
        let fades = time.to_the(-1.0);
        let none = |expr: Option<Expr>| expr.unwrap_or(Expr::Number(0.0));
        let diffusion =
            none(self.attribute(element, "diffusion", Use::Now, Some((&spreads, "the diffusion coefficient"))));
        let decay = none(self.attribute(element, "decay", Use::Fixed, Some((&fades, "the decay"))));
        let initial = self.profile(element);
        let range = match self.choice(element, "range", &["non_negative", "free"]) {
            0 => Range::NonNegative,
            _ => Range::Free,
        };
        let walls = self.walls(element, &id, dimension);
        let advection = self.advection(element, &id, dimension);
        let taxis = self.taxis(element, &id);
        let sources = self.sources(element, &id, dimension);
        Some(FieldDescription {
            quantity: self.find(&id)?,
            diffusion,
            decay,
            advection,
            taxis,
            sources,
            initial: initial?,
            range,
            walls,
            location: self.context.location(element.location("id"), "the field"),
            id,
        })
    }

    fn profile(&mut self, element: &Element) -> Option<Profile> {
        let starts = ["initial", "image", "dataset"];
        let given: Vec<&str> = starts.into_iter().filter(|name| element.attribute(name).is_some()).collect();
        match given[..] {
            [] => {
                let message = format!("the field `{}` has no initial value", element.word("id"));
                let help =
                    "write initial=\"0\" or an expression of x, y, z, or image=\"…\" or dataset=\"FILE:/DATASET\"";
                self.context.fault(element.location("id"), &message, "starts how?", help);
                return None;
            }
            [_, second, ..] => {
                let message = format!("the field `{}` has {} starts", element.word("id"), given.len());
                self.context.fault(
                    element.location(second),
                    &message,
                    "a second start",
                    "keep one of `initial`, `image`, `dataset`",
                );
            }
            _ => {}
        }
        let scale = self.number(element, "scale").unwrap_or(1.0);
        let location = self.context.location(element.location(given[0]), "the start");
        // Seen from the folder of the document that is read, also in one that it includes.
        let file = |written: &str| self.context.path(element.location(given[0]).start, written).display().to_string();
        Some(match given[0] {
            // The system has the expression, and has been told of its faults.
            "initial" => Profile::Expression(Expr::Number(0.0)),
            "image" => Profile::Image { file: file(&element.word("image")), scale, location },
            _ => {
                let text = element.word("dataset");
                let Some((name, dataset)) = text.rsplit_once(":/") else {
                    let help = "write dataset=\"FILE:/DATASET\", such as \"start.h5:/fields/U\"";
                    self.context.fault(
                        element.location("dataset"),
                        "the dataset of the file is not named",
                        "which dataset?",
                        help,
                    );
                    return None;
                };
                Profile::Dataset { file: file(name), dataset: format!("/{dataset}"), scale, location }
            }
        })
    }

    fn walls(&mut self, element: &Element, id: &str, dimension: usize) -> [Wall; 6] {
        let mut walls: [Option<Wall>; 6] = [const { None }; 6];
        let own = self.unit_of(id);
        for wall in element.all("wall").filter(|wall| wall.attribute("side").is_some()) {
            let kind = self.choice(wall, "kind", &["no_flux", "fixed", "periodic", "flux", "open"]);
            let (unit, what) = match kind {
                3 => {
                    let speed = self.known.length.times(&self.known.time.to_the(-1.0));
                    (own.as_ref().map(|unit| unit.times(&speed)), format!("the flux of `{id}` through the wall"))
                }
                _ => (own.clone(), format!("the value of `{id}` at the wall")),
            };
            let value = self.attribute(wall, "value", Use::Now, unit.as_ref().map(|unit| (unit, what.as_str())));
            // What flows in at an open wall may be nothing.
            let (needs, has) = ([1, 3].contains(&kind), wall.attribute("value").is_some());
            if needs != has && kind != 4 && wall.attribute("kind").is_some() {
                let (message, help) = match kind {
                    1 => ("a fixed wall has no value", "write value=\"…\""),
                    3 => ("a wall with a flux has no value", "write value=\"…\", what comes in through it"),
                    _ => (
                        "only a wall that is fixed, open or has a flux has a value",
                        "write kind=\"fixed\", or remove `value`",
                    ),
                };
                self.context.fault(wall.location("kind"), message, "this kind", help);
            }
            let side = wall.word("side");
            let Some(index) = SIDES[..2 * dimension].iter().position(|known| *known == side) else {
                let sides = SIDES[..2 * dimension].join(", ");
                let plural = if dimension == 1 { "dimension" } else { "dimensions" };
                let message = format!("a grid of {dimension} {plural} has no side \"{side}\"");
                self.context.fault(wall.location("side"), &message, "unknown side", &format!("its sides are {sides}"));
                continue;
            };
            if walls[index].is_some() {
                let message = format!("`{id}` has two walls at {side}");
                self.context.fault(wall.location("side"), &message, "a second one", "remove one of them");
            }
            walls[index] = Some(match kind {
                0 => Wall::NoFlux,
                1 => Wall::Fixed(value.unwrap_or(Expr::Number(0.0))),
                3 => Wall::Flux(value.unwrap_or(Expr::Number(0.0))),
                4 => Wall::Open(value.unwrap_or(Expr::Number(0.0))),
                _ => Wall::Periodic,
            });
        }
        let walls = walls.map(|wall| wall.unwrap_or(Wall::NoFlux));
        for axis in 0..3 {
            let periodic = [0, 1].map(|side| walls[2 * axis + side] == Wall::Periodic);
            if periodic[0] != periodic[1] {
                let alone = SIDES[2 * axis + usize::from(periodic[1])];
                let wall = element.all("wall").find(|wall| wall.word("side") == alone).unwrap_or(element);
                let other = SIDES[2 * axis + usize::from(periodic[0])];
                let message = format!("`{id}` is periodic at {alone} and not at {other}");
                let help = format!("write <wall side=\"{other}\" kind=\"periodic\"/> too");
                self.context.fault(wall.location("side"), &message, "what leaves here comes in where?", &help);
            }
        }
        walls
    }

    /// Puts the starting expressions in, and tells coefficients that are below 0 or not finite.
    pub(super) fn finish_fields(&mut self, fields: &mut [FieldDescription], system: &System) {
        for field in fields.iter_mut().filter(|field| matches!(field.initial, Profile::Expression(_))) {
            field.initial = Profile::Expression(system.quantities[field.quantity as usize].initial.clone());
        }
        if !self.context.is_clean() {
            return;
        }
        let values = super::start::values(system);
        let system = &of_fields(system, fields);
        for field in fields {
            let element = self.known.quantities[field.quantity as usize].element;
            self.check_transport(field, system);
            for (name, expr) in [("diffusion", &field.diffusion), ("decay", &field.decay)] {
                if !reads(expr, system).is_number() {
                    continue;
                }
                let value = expr.evaluate(0.0, &|number| values[number as usize]);
                if !(value.is_finite() && value >= 0.0) {
                    let message = format!("`{name}` of `{}` is {value}; 0 or more was expected", field.id);
                    let help = match name {
                        "decay" => "what grows belongs into <reaction>",
                        _ => "a field that gathers by itself has no solution; attraction belongs into <reaction>",
                    };
                    self.context.fault(element.location(name), &message, "not 0 or more", help);
                }
            }
        }
    }
}
