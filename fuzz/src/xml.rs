//! Changes of EML and SBML: elements, their attributes and how they are nested.

use std::ops::Range;

use crate::chance::Chance;
use crate::mutate::times;
use crate::shipped::Shipped;

/// One change of a document.
pub fn change(text: &str, shipped: &Shipped, chance: &mut Chance) -> String {
    let all = elements(text);
    let Some(element) = all.get(chance.below(all.len())).cloned() else { return shipped.text(chance).to_owned() };
    let own = &text[element.clone()];
    match chance.below(8) {
        0 => replaced(text, element, ""),
        1 => replaced(text, element.clone(), &own.repeat(times(chance))),
        2 => replaced(text, element, element_elsewhere(own, shipped.text(chance), chance)),
        3 => {
            let other = element_elsewhere(own, shipped.text(chance), chance);
            replaced(text, element, &format!("{own}{other}"))
        }
        4 => {
            let name = name(own);
            let depth = times(chance);
            let nested = format!("{}{own}{}", format!("<{name}>").repeat(depth), format!("</{name}>").repeat(depth));
            replaced(text, element, &nested)
        }
        5 => {
            let other = all[chance.below(all.len())].clone();
            if other.start < element.end && element.start < other.end {
                return replaced(text, element, "");
            }
            let (first, second) = if element.start < other.start { (element, other) } else { (other, element) };
            let (one, two) = (&text[first.clone()], &text[second.clone()]);
            [&text[..first.start], two, &text[first.end..second.start], one, &text[second.end..]].concat()
        }
        // An identifier in place of another makes circles, and values that are defined twice.
        _ => {
            let values = attribute_values(text);
            let [one, other] = [0, 0].map(|_| values.get(chance.below(values.len())).cloned());
            match (one, other) {
                (Some(one), Some(other)) => replaced(text, one, &text[other]),
                _ => replaced(text, element, ""),
            }
        }
    }
}

fn replaced(text: &str, part: Range<usize>, by: &str) -> String {
    [&text[..part.start], by, &text[part.end..]].concat()
}

/// Where the elements of a text stand, as far as its tags match.
fn elements(text: &str) -> Vec<Range<usize>> {
    let (mut found, mut open, mut from) = (Vec::new(), Vec::new(), 0);
    while let Some(start) = text[from..].find('<').map(|at| from + at) {
        let Some(end) = text[start..].find('>').map(|at| start + at + 1) else { break };
        let tag = &text[start..end];
        if tag.starts_with("</") {
            found.extend(open.pop().map(|start| start..end));
        } else if tag.ends_with("/>") {
            found.push(start..end);
        } else if !tag.starts_with("<!") && !tag.starts_with("<?") {
            open.push(start);
        }
        from = end;
    }
    found
}

fn name(element: &str) -> &str {
    let rest = element.trim_start_matches('<');
    &rest[..rest.find(|c: char| c.is_whitespace() || matches!(c, '>' | '/')).unwrap_or(rest.len())]
}

/// An element of the same name in another document, or any.
fn element_elsewhere<'a>(own: &str, other: &'a str, chance: &mut Chance) -> &'a str {
    let all = elements(other);
    let same: Vec<&Range<usize>> = all.iter().filter(|range| name(&other[(*range).clone()]) == name(own)).collect();
    let chosen = same.get(chance.below(same.len())).copied().or_else(|| all.get(chance.below(all.len())));
    chosen.map_or("", |range| &other[range.clone()])
}

/// Where values of attributes stand.
fn attribute_values(text: &str) -> Vec<Range<usize>> {
    let starts = text.match_indices("=\"").map(|(at, sign)| at + sign.len());
    starts.filter_map(|start| Some(start..start + text[start..].find('"')?)).collect()
}
