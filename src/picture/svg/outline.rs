//! Outlines of shapes.

use tiny_skia::{Path, PathBuilder, Rect};

use super::element::Element;

/// How far the handles of a Bézier curve stand from its ends, in radii, where it is a quarter of a circle.
const QUARTER: f32 = 0.552_284_8;

/// A rectangle, its corners rounded by the radius `rx`.
pub(super) fn rectangle(element: &Element) -> Option<Path> {
    let [x, y, width, height, round] = ["x", "y", "width", "height", "rx"].map(|key| element.number(key, 0.0));
    let rect = Rect::from_xywh(x, y, width, height)?;
    let round = round.min(0.5 * width).min(0.5 * height);
    if round <= 0.0 {
        return Some(PathBuilder::from_rect(rect));
    }
    let (left, top, right, bottom) = (rect.left(), rect.top(), rect.right(), rect.bottom());
    let near = round * (1.0 - QUARTER);
    let mut path = PathBuilder::new();
    path.move_to(left + round, top);
    path.line_to(right - round, top);
    path.cubic_to(right - near, top, right, top + near, right, top + round);
    path.line_to(right, bottom - round);
    path.cubic_to(right, bottom - near, right - near, bottom, right - round, bottom);
    path.line_to(left + round, bottom);
    path.cubic_to(left + near, bottom, left, bottom - near, left, bottom - round);
    path.line_to(left, top + round);
    path.cubic_to(left, top + near, left + near, top, left + round, top);
    path.close();
    path.finish()
}

/// A circle.
pub(super) fn circle(element: &Element) -> Option<Path> {
    let [x, y, radius] = ["cx", "cy", "r"].map(|key| element.number(key, 0.0));
    PathBuilder::from_circle(x, y, radius)
}

/// Straight lines from path data: the commands M, L, H, V and Z, absolute or (small letters) relative.
pub(super) fn lines(data: &str) -> Option<Path> {
    let mut path = PathBuilder::new();
    let mut at = [0.0_f32; 2];
    let ends = data.char_indices().filter(|(_, sign)| sign.is_ascii_alphabetic()).map(|(index, _)| index);
    let ends: Vec<usize> = ends.chain([data.len()]).collect();
    for pair in ends.windows(2) {
        let (command, numbers) = data[pair[0]..pair[1]].split_at(1);
        let mut numbers = numbers.split_ascii_whitespace().map_while(|number| number.parse::<f32>().ok());
        let origin = if command.starts_with(char::is_lowercase) { at } else { [0.0; 2] };
        match command.to_ascii_uppercase().as_str() {
            "M" | "L" => at = [origin[0] + numbers.next()?, origin[1] + numbers.next()?],
            "H" => at[0] = origin[0] + numbers.next()?,
            "V" => at[1] = origin[1] + numbers.next()?,
            _ => {
                path.close();
                continue;
            }
        }
        match command {
            "M" | "m" => path.move_to(at[0], at[1]),
            _ => path.line_to(at[0], at[1]),
        }
    }
    path.finish()
}
