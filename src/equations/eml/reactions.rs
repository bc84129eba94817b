//! Equations of reactions, "2 A + $B -> C": what is used up and made, how many at a time.

use super::context::Context;
use super::vocabulary::with_article;
use super::xml::{Element, Text};
use crate::equations::expression::{Unit, is_identifier};
use crate::equations::tree::{Participant, QuantityId, Reaction};
use std::collections::HashMap;
use std::ops::Range;

/// Arrows between the sides and whether the reaction goes both ways; a longer one stands before those that begin it.
const ARROWS: [(&str, bool); 8] =
    [("<->", true), ("<=>", true), ("->", false), ("=>", false), ("→", false), ("⇌", true), ("↔", true), ("=", true)];

/// How an equation is written, for advice.
const EXAMPLE: &str = "write it such as `2 A + B -> C`, with `=` for what goes both ways; one side may be empty";

/// The equation of a reaction.
pub(super) struct Equation {
    is_reversible: bool,
    sides: [Vec<Term>; 2],
}

/// What takes part, and where it is written.
struct Term {
    participant: Participant,
    id: String,
    at: Range<usize>,
}

impl Equation {
    /// The reaction, whose rate is a quantity.
    pub(super) fn reaction(&self, rate: QuantityId) -> Reaction {
        let [reactants, products] =
            [0, 1].map(|side: usize| self.sides[side].iter().map(|term| term.participant).collect());
        Reaction { rate, reversible: self.is_reversible, reactants, products }
    }

    fn changed(&self) -> impl Iterator<Item = &Term> {
        self.sides.iter().flatten().filter(|term| !term.participant.is_held)
    }
}

/// Whether what an element declares can be changed by reactions.
pub(super) fn changes(element: &Element) -> bool {
    matches!(element.kind.name, "variable" | "field")
}

/// Reads the equation of a reaction. `find` has the number of a quantity and the element that declares it, if one does; `names`
/// has the identifiers of all that reactions can change.
pub(super) fn equation<'a, N: Iterator<Item = &'a str>>(
    context: &mut Context,
    element: &Element,
    find: &impl Fn(&str) -> Option<(QuantityId, Option<&'a Element>)>,
    names: &impl Fn() -> N,
) -> Option<Equation> {
    let text = element.attribute("equation")?;
    let (before, arrow, is_reversible) = arrow(&text.text, 0).or_else(|| {
        context.fault(text.whole(), "the equation of the reaction has no arrow", "what becomes what?", EXAMPLE);
        None
    })?;
    if let Some((_, second, _)) = self::arrow(&text.text, arrow.end) {
        let help = "write a <reaction> for each step";
        context.fault(text.location(&second), "the equation of the reaction has two arrows", "a second one", help);
        return None;
    }
    let ranges = [before, arrow.end..text.text.len()];
    let mut sides = [Vec::new(), Vec::new()];
    let mut is_good = true;
    for (side, range) in sides.iter_mut().zip(ranges) {
        let written = &text.text[range.clone()];
        if written.trim().is_empty() {
            continue;
        }
        let mut start = range.start;
        for part in written.split('+') {
            let term = term(context, text, start..start + part.len(), find, names);
            is_good &= term.is_some();
            side.extend(term);
            start += part.len() + 1;
        }
    }
    let found = Equation { is_reversible, sides };
    if is_good && found.changed().next().is_none() {
        context.fault(text.whole(), "the reaction changes nothing", "no variable that is not held", EXAMPLE);
        return None;
    }
    let is_one = is_good && lives_together(context, &found, find);
    is_one.then_some(found)
}

/// The text before the first arrow after a position, the arrow, and whether it goes both ways.
fn arrow(text: &str, from: usize) -> Option<(Range<usize>, Range<usize>, bool)> {
    let (start, _) = text[from..].char_indices().find(|(at, _)| begins(&text[from + at..]).is_some())?;
    let start = from + start;
    let (sign, both) = begins(&text[start..])?;
    Some((0..start, start..start + sign.len(), both))
}

fn begins(text: &str) -> Option<(&'static str, bool)> {
    ARROWS.into_iter().find(|(sign, _)| text.starts_with(sign))
}

/// "2 A", "A", "$A": how many of what.
fn term<'a, N: Iterator<Item = &'a str>>(
    context: &mut Context,
    text: &Text,
    range: Range<usize>,
    find: &impl Fn(&str) -> Option<(QuantityId, Option<&'a Element>)>,
    names: &impl Fn() -> N,
) -> Option<Term> {
    let written = &text.text[range.clone()];
    let start = range.start + written.len() - written.trim_start().len();
    let written = written.trim();
    let at = text.location(&(start..start + written.len()));
    if written.is_empty() {
        context.fault(text.location(&range), "a `+` has nothing beside it", "what?", EXAMPLE);
        return None;
    }
    let digits = written.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(written.len());
    let stoichiometry = if digits == 0 { Some(1.0) } else { written[..digits].parse().ok() };
    let stoichiometry = stoichiometry.filter(|count: &f64| count.is_finite() && *count > 0.0);
    let rest = written[digits..].trim_start();
    let rest = if digits > 0 { rest.strip_prefix('*').unwrap_or(rest).trim_start() } else { rest };
    let (id, is_held) = rest.strip_prefix('$').map_or((rest, false), |id| (id, true));
    let (Some(stoichiometry), true) = (stoichiometry, is_identifier(id)) else {
        let message = format!("`{written}` is no part of a reaction");
        let help = "write an identifier, after a number above 0 where there are more at a time: `2 A`";
        context.fault(at, &message, "how many of what?", help);
        return None;
    };
    let id = id.to_owned();
    match find(&id) {
        Some((quantity, declared)) if is_held || declared.is_some_and(changes) => {
            Some(Term { participant: Participant { quantity, stoichiometry, is_held }, id, at })
        }
        Some((_, declared)) => {
            let what = declared.map_or("is given".to_owned(), |other| format!("is {}", with_article(other.kind.name)));
            let message = format!("a reaction cannot change `{id}`, which {what}");
            let help = format!("write `${id}` if the reaction leaves it as it is, or declare it as a <variable>");
            context.fault(at, &message, "changed here", &help);
            None
        }
        None => {
            let help = context.meant(&id, names()).map_or_else(
                || format!("declare <variable id=\"{id}\" initial=\"…\"/>"),
                |near| format!("did you mean `{near}`?"),
            );
            context.fault(at, &format!("nothing has the identifier `{id}`"), "unknown identifier", &help);
            None
        }
    }
}

/// Whether all that a reaction changes lives in one location; on membranes some of it may be on the surface and some inside.
fn lives_together<'a>(
    context: &mut Context,
    equation: &Equation,
    find: &impl Fn(&str) -> Option<(QuantityId, Option<&'a Element>)>,
) -> bool {
    let inside = |term: &Term| {
        let declared = find(&term.id).and_then(|(_, declared)| declared);
        declared.is_some_and(|element| element.word("level") == "cell")
    };
    let Some(first) = equation.changed().next() else { return true };
    let Some(other) = equation.changed().find(|term| inside(term) != inside(first)) else { return true };
    let (surface, pool) = if inside(first) { (other, first) } else { (first, other) };
    let message = format!("the reaction changes `{}` on the surface and `{}` inside the cell", surface.id, pool.id);
    let help = "write two reactions, one of the surface and one of the cell, with an <integral> of the first in the rate of the second";
    context.fault(other.at.clone(), &message, "lives elsewhere", help);
    false
}

/// The unit that all that a reaction changes has, where some has one; one rate changes all of it.
pub(super) fn shared_unit(context: &mut Context, equation: &Equation, units: &HashMap<String, Unit>) -> Option<Unit> {
    let mut measured = equation.changed().filter_map(|term| Some((term, units.get(&term.id)?)));
    let (first, unit) = measured.next()?;
    for (term, other) in measured.filter(|(_, other)| !other.is_same(unit)) {
        let message = format!("`{}` is in {} and `{}` in {}", first.id, unit.text(), term.id, other.text());
        let help = "one rate changes all that takes part: let both have one unit";
        context.fault(term.at.clone(), &message, &format!("in {}", other.text()), help);
    }
    Some(unit.clone())
}
