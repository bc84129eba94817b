//! What colours mean, beside a picture: bars with numbers.

use std::fmt::Write;

use crate::picture::colour::ColourMap;
use crate::picture::text::{self, Anchor, Style, Weight, text_width, write_text};
use crate::picture::ticks::{self, Ends, Scale};

/// What the colours of a field mean.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldBar {
    /// The colours.
    pub map: ColourMap,
    /// Values of the first and the last colour.
    pub range: [f64; 2],
    /// How values are spaced between them.
    pub scale: Scale,
    /// Quantity with unit.
    pub label: String,
}

/// Length and thickness of a horizontal bar, and how far its end is from the margin, for a picture 720 px high.
const LONG: f64 = 270.0;
const THICK: f64 = 13.0;
const OFF: f64 = 8.0;

/// How far a horizontal bar and its label reach from the margin at its right, px.
pub(super) fn bar_width(label: &str, unit: f64) -> f64 {
    // Half the first mark's number, and a power of ten behind the label.
    (LONG * unit + 20.0 * unit).max(text_width(label, 17.0 * unit) + 60.0 * unit) + OFF * unit
}

/// A horizontal bar of colours with marks below and the quantity above, its right bottom corner at the margin.
pub(super) fn write_colour_bar(
    svg: &mut String,
    map: ColourMap,
    [low, high]: [f64; 2],
    label: &str,
    right: f64,
    bottom: f64,
    unit: f64,
) {
    let (long, thick) = (LONG * unit, THICK * unit);
    let (left, top) = (right - long - OFF * unit, bottom - 20.0 * unit - thick);
    if low == high {
        let (middle, style) =
            (left + 0.5 * long, Style { size: 15.0 * unit, anchor: Anchor::Middle, weight: Weight::Soft });
        write_box(svg, [left, top, long, thick], &map.of_value(low, [low, high]).hex(), 0.0);
        write_text(svg, middle, top + thick + 20.0 * unit, style, &ticks::constant(low, label));
        let style = Style { size: 17.0 * unit, anchor: Anchor::End, weight: Weight::Plain };
        return write_text(svg, left + long, top - 8.0 * unit, style, label);
    }
    write_gradient(svg, "bar", r#"x1="0" x2="1""#, map);
    write_box(svg, [left, top, long, thick], "url(#bar)", 0.0);
    let (low, high) = if low.is_finite() && high.is_finite() { (low, high) } else { (0.0, 1.0) };
    let ticks = ticks::linear(low.min(high), low.max(high), 4, Ends::Exact);
    for (value, text) in &ticks.major {
        let x = left + (value - ticks.low) / (ticks.high - ticks.low) * long;
        let _ = writeln!(
            svg,
            r#"<path d="M{x:.1} {:.1}v{:.1}" stroke="{}" stroke-width="{:.1}"/>"#,
            top + thick,
            4.0 * unit,
            text::SOFT_INK,
            unit.max(1.0)
        );
        let style = Style { size: 15.0 * unit, anchor: Anchor::Middle, weight: Weight::Soft };
        write_text(svg, x, top + thick + 20.0 * unit, style, text);
    }
    let label = match ticks.exponent {
        0 => label.to_string(),
        power => format!("{label}  ×{}", ticks::power_of_ten(power)),
    };
    let style = Style { size: 17.0 * unit, anchor: Anchor::End, weight: Weight::Plain };
    write_text(svg, left + long, top - 8.0 * unit, style, &label);
}

/// A box of paint, `[left, top, wide, high]`, with a rim of this width where it has one.
fn write_box(svg: &mut String, [left, top, wide, high]: [f64; 4], paint: &str, rim: f64) {
    let _ =
        write!(svg, r#"<rect x="{left:.1}" y="{top:.1}" width="{wide:.1}" height="{high:.1}" rx="2" fill="{paint}""#);
    if rim > 0.0 {
        let _ = write!(svg, r#" stroke="{}" stroke-width="{rim:.1}""#, text::SOFT_INK);
    }
    svg.push_str("/>\n");
}

/// Names a run of colours for a bar; `direction` says from where to where.
fn write_gradient(svg: &mut String, name: &str, direction: &str, map: ColourMap) {
    let _ = write!(svg, r#"<linearGradient id="{name}" {direction}>"#);
    for k in 0..=20 {
        let share = f64::from(k) / 20.0;
        let _ = write!(svg, r#"<stop offset="{share}" stop-color="{}"/>"#, map.at(share).hex());
    }
    svg.push_str("</linearGradient>\n");
}

/// A standing bar of colours with marks on its left and the quantity above, its right top corner at the margin, on a
/// light ground: the field that it explains may lie behind it.
pub(super) fn write_standing_bar(svg: &mut String, bar: &FieldBar, right: f64, top: f64, unit: f64) {
    let (long, thick, size) = (230.0 * unit, 14.0 * unit, 16.0 * unit);
    let [low, high] = bar.range;
    let (low, high) = if low.is_finite() && high.is_finite() { (low, high) } else { (0.0, 1.0) };
    let mut ticks = bar.scale.marks(low.min(high), low.max(high), 6);
    let mut paint = "url(#field)".to_owned();
    if low == high {
        (ticks.exponent, ticks.major) = (0, vec![(low, ticks::constant(low, &bar.label))]);
        paint = bar.map.of_value(low, bar.range).hex();
    }
    let label = match ticks.exponent {
        0 => bar.label.clone(),
        power => format!("{}  ×{}", bar.label, ticks::power_of_ten(power)),
    };
    let small = 15.0 * unit;
    let marks = ticks.major.iter().map(|(_, text)| text_width(text, small)).fold(0.0, f64::max) + 10.0 * unit;
    let wide = text_width(&label, size).max(marks + thick);
    let (above, margin) = (30.0 * unit, 10.0 * unit);
    let _ = writeln!(
        svg,
        r##"<rect class="ground" x="{:.1}" y="{:.1}" width="{:.1}" height="{:.1}" rx="{:.1}" fill="#ffffff" fill-opacity="0.82"/>"##,
        right - wide - margin,
        top - 4.0 * unit,
        wide + 2.0 * margin,
        above + long + 20.0 * unit,
        6.0 * unit
    );
    let style = Style { size, anchor: Anchor::End, weight: Weight::Plain };
    write_text(svg, right, top + 14.0 * unit, style, &label);
    if low < high {
        write_gradient(svg, "field", r#"x1="0" x2="0" y1="1" y2="0""#, bar.map);
    }
    let (left, top) = (right - thick, top + above);
    write_box(svg, [left, top, thick, long], &paint, 0.6 * unit);
    for (value, text) in &ticks.major {
        let y = top + long - bar.scale.share(*value, [ticks.low, ticks.high]) * long;
        let _ = writeln!(
            svg,
            r#"<path d="M{left:.1} {y:.1}h{:.1}" stroke="{}" stroke-width="{:.1}"/>"#,
            -4.0 * unit,
            text::SOFT_INK,
            unit.max(1.0)
        );
        let style = Style { size: small, anchor: Anchor::End, weight: Weight::Soft };
        write_text(svg, left - 7.0 * unit, y + 0.35 * small, style, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_of_one_number_says_it_and_invents_no_others() {
        let written = |low: f64, high: f64| {
            let mut svg = String::new();
            write_colour_bar(&mut svg, ColourMap::Viridis, [low, high], "volume (fL)", 1000.0, 700.0, 1.0);
            let bar =
                FieldBar { map: ColourMap::Ink, range: [low, high], scale: Scale::Linear, label: "oxygen (uM)".into() };
            write_standing_bar(&mut svg, &bar, 1000.0, 100.0, 1.0);
            svg
        };
        let one = written(65.0, 65.0);
        assert_eq!(one.matches(", constant").count(), 2, "{one}");
        assert!(!one.contains("linearGradient") && !one.contains(">60<") && !one.contains(">66<"), "{one}");
        assert!(written(60.0, 70.0).contains("linearGradient"));
    }

    #[test]
    fn a_bar_of_decades_has_marks_at_them_and_equal_parts_for_each() {
        let bar = FieldBar { map: ColourMap::Ink, range: [1e-3, 10.0], scale: Scale::Log, label: "cAMP (nM)".into() };
        let mut svg = String::new();
        write_standing_bar(&mut svg, &bar, 1000.0, 100.0, 1.0);
        for text in [">0.001<", ">0.01<", ">0.1<", ">1<", ">10<"] {
            assert!(svg.contains(text), "{text} in {svg}");
        }
        // From 130 px, where 10 stands, to 360.
        for y in ["130.0", "187.5", "245.0", "302.5", "360.0"] {
            assert!(svg.contains(&format!(" {y}h-4")), "{y} in {svg}");
        }
    }
}
