//! Wavefront OBJ: lines `v x y z` and `f 1 2 3`, atoms counted from 1, or backwards from −1.

use super::super::Surface;
use super::fan;
use super::text::{Text, Word};
use crate::error::Fault;

/// Give up after so many faults: the file is probably not what it claims to be.
const MOST_FAULTS: usize = 10;

/// Reads the vertices and polygons of an OBJ file and passes over everything else.
///
/// # Errors
/// The first ten faults, each with its location.
pub(super) fn parse(name: &str, bytes: &[u8]) -> Result<Surface, Vec<Fault>> {
    let text = Text::new(name, bytes);
    let mut surface = Surface::default();
    let mut faults = Vec::new();
    // Polygons may stand before the vertices they name, so atoms that are too large are only known at the end.
    let mut largest: Option<(i64, Word)> = None;
    for line in text.lines() {
        let end = line.iter().position(|word| word.text.starts_with('#')).unwrap_or(line.len());
        let Some((keyword, rest)) = line[..end].split_first() else { continue };
        let outcome = match keyword.text {
            "v" => text.point(&line[..end]).map(|point| surface.positions.push(point)),
            "f" => polygon(&text, *keyword, rest, surface.positions.len(), &mut largest)
                .map(|corners| surface.facets.extend(fan(&corners))),
            _ => Ok(()),
        };
        faults.extend(outcome.err());
        if faults.len() >= MOST_FAULTS {
            return Err(faults);
        }
    }
    if let Some((atom, word)) = largest
        && atom >= surface.positions.len() as i64
        && faults.is_empty()
    {
        faults.push(text.fault(
            word,
            format!("facet names vertex {}, but the file has {} vertices", atom + 1, surface.positions.len()),
            "no such vertex",
            "vertices are counted from 1 in the order of the `v` lines",
        ));
    }
    if faults.is_empty() { Ok(surface) } else { Err(faults) }
}

/// The corners of a polygon, counted from 0. `so_far` is the number of vertices above this line.
fn polygon<'a>(
    text: &Text,
    keyword: Word,
    words: &[Word<'a>],
    so_far: usize,
    largest: &mut Option<(i64, Word<'a>)>,
) -> Result<Vec<u32>, Fault> {
    if words.len() < 3 {
        return Err(text.fault(
            keyword,
            format!("a facet has {} corners", words.len()),
            "expected at least 3 vertices",
            "write `f 1 2 3`",
        ));
    }
    words
        .iter()
        .map(|&word| {
            let number = word.text.split('/').next().unwrap_or("");
            let atom = match number.parse::<i64>() {
                Ok(number) if number > 0 => number - 1,
                Ok(number) if number < 0 => (so_far as i64).saturating_add(number),
                _ => -1,
            };
            if !(0..i64::from(u32::MAX)).contains(&atom) {
                return Err(text.fault(
                    word,
                    format!("`{}` names no vertex", word.text),
                    "expected a vertex number",
                    "vertices are counted from 1; negative numbers count back from the last vertex above the line",
                ));
            }
            if largest.is_none_or(|(most, _)| atom > most) {
                *largest = Some((atom, word));
            }
            Ok(atom as u32)
        })
        .collect()
}
