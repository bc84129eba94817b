//! Repeated parts and sums over them: `X[i]` in a `<repeat index="i">` is `X_1`, `X_2`, …, written before anything else is read.

use super::context::Context;
use super::vocabulary::MOST_REPEATED;
use super::xml::{Element, Text};
use crate::equations::expression::is_identifier;
use std::ops::Range;

/// Attributes that hold words and no identifiers or expressions.
const PLAIN: [&str; 9] = ["name", "unit", "level", "index", "periodic", "range", "image", "dataset", "args"];

/// An index and the value that it has; where it goes round, its first value and how many there are.
#[derive(Clone, Copy)]
struct Index<'a> {
    name: &'a str,
    value: i64,
    round: Option<(i64, i64)>,
}

/// Writes repeated parts and sums out.
pub(super) fn expand(context: &mut Context, root: &mut Element) {
    let mut made = context.repeated;
    if root.all("repeat").next().is_some() {
        let children = std::mem::take(&mut root.children);
        root.children = children.into_iter().flat_map(|child| copies(context, child, &mut made)).collect();
        // What is left has numbers alone: `X[3]`.
        replace_in(context, root, Index { name: "", value: 0, round: None });
    }
    let has_own = root.all("function").chain(root.all("table")).any(|element| element.word("id") == "sum");
    if !has_own {
        root.each_text(&mut |_, name, text| {
            if !PLAIN.contains(&name) {
                sums(context, text, &mut made);
            }
        });
    }
    context.repeated = made;
}

/// What an element is written out to: itself, or the copies of what it repeats.
fn copies(context: &mut Context, element: Element, made: &mut usize) -> Vec<Element> {
    if element.kind.name != "repeat" {
        return vec![element];
    }
    let index = element.word("index");
    if element.attribute("index").is_some() && !is_identifier(&index) {
        let help = "write a letter or a word, such as index=\"i\"";
        context.fault(element.location("index"), &format!("\"{index}\" is no identifier"), "this index", help);
    }
    let number = |context: &mut Context, name: &str, usual: Option<i64>, least: i64| {
        let Some(_) = element.attribute(name) else { return usual };
        let word = element.word(name);
        let found = word.parse().ok().filter(|number| (least..=1_000_000).contains(number));
        if found.is_none() {
            let message = format!("`{name}` is \"{word}\"; a whole number from {least} on was expected");
            context.fault(element.location(name), &message, "not such a number", "write one such as 20");
        }
        found
    };
    let (from, count) = (number(context, "from", Some(1), 0), number(context, "count", None, 1));
    let is_round = match element.word("periodic").as_str() {
        "" | "false" => false,
        "true" => true,
        other => {
            let message = format!("`periodic` cannot be \"{other}\"");
            context.fault(element.location("periodic"), &message, "unknown word", "write \"true\" or \"false\"");
            false
        }
    };
    let (Some(from), Some(count)) = (from, count) else { return Vec::new() };
    let mut found = Vec::new();
    for value in from..from + count {
        let index = Index { name: &index, value, round: is_round.then_some((from, count)) };
        for child in &element.children {
            let is_first = *made <= MOST_REPEATED;
            *made += cost(child.length());
            if *made > MOST_REPEATED {
                if is_first {
                    let message = format!("more than {MOST_REPEATED} elements are repeated");
                    let help = "what has so many equal parts spreads in space: write it as a field";
                    context.fault(element.at.clone(), &message, "too many", help);
                }
                return found;
            }
            let mut child = child.clone();
            replace_in(context, &mut child, index);
            found.extend(copies(context, child, made));
        }
    }
    found
}

/// What so many bytes count among the most that is made: long ones count as several.
fn cost(bytes: usize) -> usize {
    1 + bytes / 256
}

/// Puts the value of an index into an element.
fn replace_in(context: &mut Context, element: &mut Element, index: Index) {
    element.each_text(&mut |element, name, text| {
        if !PLAIN.contains(&name) {
            let is_end =
                element == "link" && ["from", "to"].contains(&name) && !text.text.trim().starts_with("system.");
            *text = replaced(context, text, index, is_end);
        }
    });
}

/// A text with the value of an index in its place: `X[i - 1]` becomes `X_2`, and `i` becomes `3`. In the end of a link, whose own
/// indices stand in brackets, `atom[i]` becomes `atom[3]`.
fn replaced(context: &mut Context, text: &Text, index: Index, is_end: bool) -> Text {
    let mut found = text.part(&(0..0));
    let mut rest = 0;
    while let Some(Piece { name: at, brackets }) = next(&text.text, rest) {
        found.append(&text.part(&(rest..at.start)));
        rest = at.end;
        let name = &text.text[at.clone()];
        if name == index.name && brackets.is_empty() {
            found.write(&index.value.to_string(), &text.location(&at));
            continue;
        }
        found.append(&text.part(&at));
        let mut stays = is_end;
        for bracket in brackets {
            let whole = bracket.start - 1..bracket.end + 1;
            rest = whole.end;
            // Of another index there is one around or within, and later ones wait for it.
            let Some(value) = number_in(&text.text[bracket.clone()], index) else {
                found.append(&text.part(&whole));
                stays = true;
                continue;
            };
            let value = index.round.map_or(value, |(from, count)| from + (value - from).rem_euclid(count));
            if value < 0 {
                let message = format!("`{name}[{}]` is {name}[{value}] here", &text.text[bracket]);
                let help = "indices begin with 0: let `from` be larger, or write periodic=\"true\"";
                context.fault(text.location(&(at.start..rest)), &message, "below 0", help);
            }
            let value = value.max(0);
            let written = if stays { format!("[{value}]") } else { format!("_{value}") };
            found.write(&written, &text.location(&whole));
        }
    }
    found.append(&text.part(&(rest..text.text.len())));
    found
}

/// A name and what stands in brackets right behind it.
struct Piece {
    name: Range<usize>,
    brackets: Vec<Range<usize>>,
}

/// The next name in a text. Units of numbers, which stand in brackets by themselves, are passed over, and so is what stands right behind a number,
/// unless it has an index: `2X[i]` is two of `X[i]`, but `2i` is no number with the value of `i` written behind the 2.
fn next(text: &str, from: usize) -> Option<Piece> {
    let (mut at, mut number_end) = (from, None);
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    while let Some(c) = text[at..].chars().next() {
        if c == '[' {
            at += text[at..].find(']').map_or(text.len() - at, |end| end + 1);
        } else if c.is_alphabetic() || c == '_' {
            let end = at + text[at..].find(|c| !is_part(c)).unwrap_or(text.len() - at);
            let (mut brackets, mut behind) = (Vec::new(), end);
            while let Some(length) = text[behind..].strip_prefix('[').and_then(|inner| inner.find(']')) {
                brackets.push(behind + 1..behind + 1 + length);
                behind += length + 2;
            }
            if number_end != Some(at) || !brackets.is_empty() {
                return Some(Piece { name: at..end, brackets });
            }
            at = end;
        } else if c.is_ascii_digit() {
            at += length_of_number(&text[at..]);
            number_end = Some(at);
        } else {
            at += c.len_utf8();
        }
    }
    None
}

/// The length of the number that a text begins with: `2e3` has no name in it, `2X` has one.
fn length_of_number(text: &str) -> usize {
    let digits = |from: usize| text[from..].find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len() - from);
    let whole = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let Some(rest) = text[whole..].strip_prefix(['e', 'E']) else { return whole };
    let exponent = whole + 1 + usize::from(rest.starts_with(['+', '-']));
    match digits(exponent) {
        0 => whole,
        length => exponent + length,
    }
}

/// What stands in brackets as a number: `i`, `i + 1`, `i - 2` or `7`.
fn number_in(text: &str, index: Index) -> Option<i64> {
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    if let Some(rest) = text.strip_prefix(index.name)
        && !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_')
    {
        let step =
            if rest.is_empty() { Some(0) } else { rest.parse::<i64>().ok().filter(|_| rest.starts_with(['+', '-'])) };
        return step.filter(|step| step.abs() <= 1_000_000).map(|step| index.value + step);
    }
    text.parse().ok().filter(|number| (0..=1_000_000).contains(number))
}

/// Writes the sums of a text out: `sum(j, 1, 3, X[j])` becomes `(X_1 + X_2 + X_3)`.
fn sums(context: &mut Context, text: &mut Text, made: &mut usize) {
    let mut from = 0;
    while let Some(piece) = next(&text.text, from) {
        from = piece.name.end;
        if &text.text[piece.name.clone()] != "sum" || !text.text[from..].starts_with('(') {
            continue;
        }
        let Some(parts) = arguments(&text.text, from + 1) else { return };
        let end = parts.last().map_or(from + 1, |part| part.end) + 1;
        let whole = text.location(&(piece.name.start..end));
        let word = |part: usize| parts.get(part).map_or("", |range| text.text[range.clone()].trim());
        let limits: [Option<i64>; 2] = [1, 2].map(|part| word(part).parse().ok());
        let ([Some(first), Some(last)], 4, true) = (limits, parts.len(), is_identifier(word(0))) else {
            let help = "write `sum(j, 1, 20, X[j])`: an index, its first and its last value, and what is summed";
            context.fault(whole.clone(), "`sum` is not read", "of what?", help);
            *text = around(text, piece.name.start..end, |written| written.write("0", &whole));
            from = piece.name.start;
            continue;
        };
        let terms = usize::try_from(last.saturating_sub(first)).unwrap_or(0);
        *made = made.saturating_add(terms.saturating_mul(cost(parts[3].len())));
        if !(0..=last).contains(&first) || *made > MOST_REPEATED {
            let help = "let both be whole numbers from 0 on, the last not below the first, and the sum have at most 20 000 terms, fewer if they are long";
            context.fault(whole.clone(), &format!("`sum` cannot go from {first} to {last}"), "these values", help);
            *text = around(text, piece.name.start..end, |written| written.write("0", &whole));
            from = piece.name.start;
            continue;
        }
        let term = text.part(&parts[3]);
        let name = word(0).to_owned();
        let terms: Vec<Text> = (first..=last)
            .map(|value| replaced(context, &term, Index { name: &name, value, round: None }, false))
            .collect();
        *text = around(text, piece.name.start..end, |written| join(&terms, &whole, written));
        // What was written may hold sums of its own.
        from = piece.name.start;
    }
}

/// A text with something else in place of a part.
fn around(text: &Text, part: Range<usize>, write: impl FnOnce(&mut Text)) -> Text {
    let mut written = text.part(&(0..part.start));
    write(&mut written);
    written.append(&text.part(&(part.end..text.text.len())));
    written
}

/// Terms joined by + as a balanced tree, so that many do not nest deep.
fn join(terms: &[Text], at: &Range<usize>, written: &mut Text) {
    written.write("(", at);
    match terms {
        [term] => written.append(term),
        _ => {
            let (left, right) = terms.split_at(terms.len().div_ceil(2));
            join(left, at, written);
            written.write(" + ", at);
            join(right, at, written);
        }
    }
    written.write(")", at);
}

/// The arguments of a call from behind its parenthesis on.
fn arguments(text: &str, from: usize) -> Option<Vec<Range<usize>>> {
    let (mut parts, mut start, mut depth) = (Vec::new(), from, 0);
    for (at, c) in text[from..].char_indices().map(|(at, c)| (from + at, c)) {
        match c {
            '(' => depth += 1,
            ')' if depth == 0 => {
                parts.push(start..at);
                return Some(parts);
            }
            ')' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(start..at);
                start = at + 1;
            }
            _ => {}
        }
    }
    None
}
