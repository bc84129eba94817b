//! Links between the system and the model: `from="system.U" to="cell.atom[4].y" transfer="3*value"`.
//!
//! An end is `system.ID`, or `scene`, `cell`, `cell[INDEX]`, `type[INDEX]`, `field[INDEX]` followed by steps
//! `.word` or `.word[INDEX]`; INDEX is a number from 0 or a name. What the steps mean is known to the experiment.

use super::build::Builder;
use super::declare::tell;
use super::document::{Endpoint, Index, LinkDescription, Root, Step};
use super::vocabulary::with_article;
use super::xml::{Element, Text};
use crate::equations::expression::{Measure, Scope, Trouble, UnitScope, is_identifier, is_reserved, parse};
use crate::equations::tree::{Expr, QuantityId, System};
use crate::error::words::{any_of, meant};
use std::collections::BTreeMap;

/// The word for the value in a transfer.
const VALUE: &str = "value";
/// What an end may begin with.
const ROOTS: [&str; 5] = ["system", "scene", "cell", "type", "field"];
/// The most identifiers among which the one that was meant is looked for.
const MOST_KNOWN: usize = 5000;
/// How an end is written, for advice.
const EXAMPLE: &str =
    "write an end such as system.U, cell.volume, cell.atom[4].y, type[neutrophil].stiffness or field[cAMP]";

impl Builder<'_, '_> {
    /// The links of the document.
    pub(super) fn links(&mut self, root: &Element) -> Vec<LinkDescription> {
        root.all("link").filter_map(|element| self.link(element)).collect()
    }

    fn link(&mut self, element: &Element) -> Option<LinkDescription> {
        let from = element.attribute("from").and_then(|text| self.endpoint(text));
        let to = element.attribute("to").and_then(|text| self.endpoint(text));
        let gain = self.number(element, "gain");
        let transfer = self.transfer(element, from.as_ref());
        let (from, to) = (from?, to?);
        self.check_ends(element, &from, &to);
        Some(LinkDescription {
            id: element.word("id"),
            from,
            to,
            transfer: transfer?,
            gain: gain.unwrap_or(1.0),
            location: self.context.location(element.at.clone(), "this link"),
        })
    }

    /// One end is the system, the other is not; what is set from outside is an input.
    fn check_ends(&mut self, element: &Element, from: &Endpoint, to: &Endpoint) {
        match (&from.root, &to.root) {
            (Root::System(_), Root::System(_)) => {
                let help = "inside a system write expressions; a link joins it to scene, cell, type or field";
                self.context.fault(
                    element.location("to"),
                    "both ends of the link are in the system",
                    "the same system",
                    help,
                );
            }
            (Root::System(_), _) => {}
            (_, Root::System(number)) => {
                let Some(target) = self.known.quantities.get(*number as usize) else { return };
                if target.element.kind.name != "input" {
                    let name = with_article(target.element.kind.name);
                    let message = format!("a link cannot set `{}`, which is {name}", target.id);
                    let help = format!("declare <input id=\"{}\" default=\"…\"/> and use it in an equation", target.id);
                    self.context.fault(element.location("to"), &message, "set from outside", &help);
                }
            }
            _ => {
                let help = "let one end be system.ID: a link joins this system to the model";
                self.context.fault(element.location("from"), "no end of the link is in the system", "this link", help);
            }
        }
    }

    fn transfer(&mut self, element: &Element, from: Option<&Endpoint>) -> Option<Expr> {
        let Some(text) = element.attribute("transfer") else { return Some(Expr::Quantity(LinkDescription::VALUE)) };
        let names = BTreeMap::from([(VALUE.to_owned(), Expr::Quantity(LinkDescription::VALUE))]);
        let (node, troubles) = parse(&text.text);
        troubles.iter().for_each(|trouble| tell(self.context, text, trouble));
        match self.now.resolve_with(&node, &names) {
            Err(more) => {
                more.iter().for_each(|trouble| tell(self.context, text, trouble));
                None
            }
            Ok(_) if !troubles.is_empty() => None,
            Ok(transfer) => {
                self.check_transfer(text, &node, from);
                Some(transfer)
            }
        }
    }

    fn check_transfer(&mut self, text: &Text, node: &crate::equations::expression::Node, from: Option<&Endpoint>) {
        let unit = from.and_then(|from| match from.root {
            Root::System(number) => self.known.quantities.get(number as usize).and_then(|q| self.unit_of(&q.id)),
            _ => None,
        });
        let measure = unit.map_or(Measure::Unknown, Measure::Known);
        let scope: &Scope = &self.known.scope;
        let units = UnitScope { units: &self.known.units, scope, time: self.known.time_in_units() };
        let mut troubles: Vec<Trouble> = Vec::new();
        units.measure_with(node, &BTreeMap::from([(VALUE.to_owned(), measure)]), &mut troubles);
        troubles.iter().for_each(|trouble| tell(self.context, text, trouble));
    }

    fn endpoint(&mut self, text: &Text) -> Option<Endpoint> {
        match end_of(&text.text, self.known.ids(), |id| self.find(id)) {
            Ok((root, path)) => {
                let location = self.context.location(text.whole(), "this end");
                Some(Endpoint { root, path, text: text.text.trim().to_owned(), location })
            }
            Err(trouble) => {
                tell(self.context, text, &trouble);
                None
            }
        }
    }
}

/// Reads an end of a link that stands outside of the document, such as `cell.volume` or `system.U`.
///
/// # Errors
/// What is wrong with it and where in the text.
pub fn read_end(text: &str, system: &System) -> Result<(Root, Vec<Step>), Trouble> {
    end_of(text, system.quantities.iter().map(|quantity| quantity.id.as_str()), |id| system.find(id))
}

/// Reads a transfer that stands outside of the document: an expression of `value` and the system's quantities.
///
/// # Errors
/// All that is wrong with it and where in the text.
pub fn read_transfer(text: &str, system: &System) -> Result<Expr, Vec<Trouble>> {
    let number = |(number, quantity): (usize, &crate::equations::tree::Quantity)| (quantity.id.clone(), number as u32);
    let quantities = system.quantities.iter().enumerate().map(number).collect();
    let no_delay = "only rates, definitions and events can look back".to_owned();
    let scope = Scope { quantities, no_delay, ..Scope::default() };
    let names = BTreeMap::from([(VALUE.to_owned(), Expr::Quantity(LinkDescription::VALUE))]);
    let (node, mut troubles) = parse(text);
    match scope.resolve_with(&node, &names) {
        Ok(transfer) if troubles.is_empty() => Ok(transfer),
        Ok(_) => Err(troubles),
        Err(more) => {
            troubles.extend(more);
            Err(troubles)
        }
    }
}

/// What an end belongs to and the path from there; `ids` are the system's, `find` looks one up.
fn end_of<'a>(
    text: &str,
    ids: impl Iterator<Item = &'a str>,
    find: impl Fn(&str) -> Option<QuantityId>,
) -> Result<(Root, Vec<Step>), Trouble> {
    let steps = steps(text)?;
    let first = &steps[0];
    let rest = |root, skipped: usize| Ok((root, steps[skipped..].to_vec()));
    let (message, help) = match (first.name.as_str(), &first.index, steps.len()) {
        ("system", None, 2) if steps[1].index.is_none() => {
            let id = &steps[1].name;
            match find(id) {
                Some(number) => return rest(Root::System(number), 2),
                None => {
                    let help = match meant(id, ids.take(MOST_KNOWN)) {
                        Some(near) => format!("did you mean system.{near}?"),
                        None => "declare it in this document".to_owned(),
                    };
                    (format!("the system has no `{id}`"), help)
                }
            }
        }
        ("system", ..) => ("the system's end is not system.ID".to_owned(), EXAMPLE.to_owned()),
        ("scene", None, 2..) => return rest(Root::Scene, 1),
        ("cell", index, 2..) => return rest(Root::Cell(index.clone()), 1),
        ("type", Some(index), 2..) => return rest(Root::Type(index.clone()), 1),
        ("field", Some(index), _) => return rest(Root::Field(index.clone()), 1),
        ("type" | "field", None, _) => {
            (format!("`{}` needs a name in brackets", first.name), format!("write {}[NAME]", first.name))
        }
        ("scene", Some(_), _) => ("there is one scene".to_owned(), "write `scene` without brackets".to_owned()),
        ("scene" | "cell" | "type", ..) => {
            (format!("`{}` alone has no number to link", text.trim()), EXAMPLE.to_owned())
        }
        (other, ..) => {
            let help = match meant(other, ROOTS) {
                Some(near) => format!("did you mean `{near}`?"),
                None if find(other).is_some() => format!("write system.{other}"),
                None => format!("it begins with {}", any_of(ROOTS)),
            };
            (format!("an end of a link cannot begin with `{other}`"), help)
        }
    };
    let start = text.len() - text.trim_start().len();
    Err(Trouble::new(message, start..start + text.trim().len()).label("this end").help(help))
}

/// Takes a path apart: words with or without an index, between points.
fn steps(text: &str) -> Result<Vec<Step>, Trouble> {
    let mut found = Vec::new();
    let mut position = 0;
    loop {
        let rest = &text[position..];
        let start = position + rest.len() - rest.trim_start().len();
        let length = text[start..].find(['.', '[', ']']).unwrap_or(text.len() - start);
        let name = text[start..start + length].trim();
        if !is_identifier(name) {
            let message = format!("\"{name}\" is no word of a path");
            return Err(Trouble::new(message, start..start + length).label("a word was expected").help(EXAMPLE));
        }
        position = start + length;
        let mut index = None;
        if text[position..].starts_with('[') {
            let Some(end) = text[position..].find(']') else {
                let trouble = Trouble::new("a bracket is not closed", position..position + 1);
                return Err(trouble.label("opened here").help("close it with `]`"));
            };
            let inner = text[position + 1..position + end].trim();
            index = Some(match inner.parse::<usize>() {
                Ok(number) => Index::Number(number),
                Err(_) if inner.is_empty() || inner.contains(['.', '[']) || is_reserved(inner) => {
                    let message = format!("\"{inner}\" is no index");
                    let trouble = Trouble::new(message, position + 1..position + end);
                    return Err(trouble.label("this index").help("write a number from 0 or a name, as in atom[4]"));
                }
                Err(_) => Index::Name(inner.to_owned()),
            });
            position += end + 1;
        }
        found.push(Step { name: name.to_owned(), index });
        let rest = text[position..].trim_start();
        if rest.is_empty() {
            return Ok(found);
        }
        let at = text.len() - rest.len();
        if !rest.starts_with('.') {
            let length = rest.chars().next().map_or(0, char::len_utf8);
            let trouble = Trouble::new("the path does not go on with a point", at..at + length);
            return Err(trouble.label("here").help(EXAMPLE));
        }
        position = at + 1;
    }
}
