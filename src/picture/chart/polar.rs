//! The ground of a chart of directions: rings and spokes in place of a frame.

use std::fmt::Write;

use super::Chart;
use super::frame::{FINE_GRID_COLOUR, FRAME_COLOUR, Frame, GRID_COLOUR, LABEL, NUMBER, TITLE};
use crate::picture::text::{Anchor, Style, Weight, write_text};
use crate::picture::ticks::{self, Ends};

/// Spokes, degrees apart.
const SPOKES: u32 = 30;
/// Where the numbers of the rings stand, degrees: between two spokes.
const NUMBERS_AT: f64 = 75.0;

/// Draws rings at round numbers up to a radius, and spokes.
pub(super) fn write_rings(svg: &mut String, frame: &Frame, radius: f64) {
    let Some([x, y]) = frame.pixel([0.0; 2]) else { return };
    let length = |value: f64| frame.x.pixel(value) - x;
    for degrees in (0..360).step_by(SPOKES as usize) {
        let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
        let (rim, colour) = (length(radius), if degrees % 90 == 0 { GRID_COLOUR } else { FINE_GRID_COLOUR });
        let _ = writeln!(
            svg,
            r#"<path stroke="{colour}" d="M{x:.1} {y:.1}L{:.1} {:.1}"/>"#,
            x + rim * cosine,
            y - rim * sine
        );
    }
    for (value, _) in rings(radius) {
        let _ = writeln!(
            svg,
            r#"<circle cx="{x:.1}" cy="{y:.1}" r="{:.1}" fill="none" stroke="{GRID_COLOUR}"/>"#,
            length(value)
        );
    }
    let _ = writeln!(
        svg,
        r#"<circle cx="{x:.1}" cy="{y:.1}" r="{:.1}" fill="none" stroke="{FRAME_COLOUR}"/>"#,
        length(radius)
    );
}

/// The rings inside of the outermost one, with their numbers.
fn rings(radius: f64) -> Vec<(f64, String)> {
    let marks = ticks::linear(0.0, radius, 4, Ends::Exact).major;
    // Numbers of tracks are whole.
    marks.into_iter().filter(|(value, _)| *value > 0.0 && *value < 0.93 * radius && value.fract() == 0.0).collect()
}

/// Writes the numbers of the rings, the angles of the spokes, what is counted, and the title.
pub(super) fn write_names(svg: &mut String, chart: &Chart, frame: &Frame, radius: f64) {
    let Some([x, y]) = frame.pixel([0.0; 2]) else { return };
    let length = |value: f64| frame.x.pixel(value) - x;
    let style = |size, anchor, weight| Style { size, anchor, weight };
    let (sine, cosine) = NUMBERS_AT.to_radians().sin_cos();
    for (value, label) in rings(radius).into_iter().chain([(radius, format!("{radius}"))]) {
        let at = length(value);
        write_text(svg, x + at * cosine, y - at * sine - 3.0, style(NUMBER, Anchor::Middle, Weight::Soft), &label);
    }
    for degrees in (0..360_u32).step_by(SPOKES as usize) {
        let (sine, cosine) = f64::from(degrees).to_radians().sin_cos();
        let at = length(radius) + 18.0;
        let centre = y - at * sine + 0.36 * NUMBER;
        write_text(svg, x + at * cosine, centre, style(NUMBER, Anchor::Middle, Weight::Plain), &format!("{degrees}°"));
    }
    write_text(svg, x, frame.bottom + 30.0, style(LABEL, Anchor::Middle, Weight::Plain), &chart.x.label);
    if !chart.title.is_empty() {
        write_text(svg, frame.left, 28.0, style(TITLE, Anchor::Start, Weight::Strong), &chart.title);
    }
}
