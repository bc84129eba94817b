//! What is written over a picture: title, time, scale bar, and the legend or colour bar.

use std::fmt::Write;

use super::bars::{FieldBar, write_colour_bar, write_standing_bar};
use super::camera::{Camera, Insets};
use crate::picture::Image;
use crate::picture::colour::{Colour, ColourMap};
use crate::picture::svg::svg_to_pixels;
use crate::picture::text::{self, Anchor, Style, Weight, text_width, write_text};
use crate::picture::ticks::{self, nice_below, short};

/// The lettering of a picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Overlay {
    /// Top left; empty for none.
    pub title: String,
    /// Top right, usually from [`time_text`]; empty for none.
    pub time: String,
    /// Bottom left.
    pub scale_bar: ScaleBar,
    /// Bottom right.
    pub key: Key,
    /// Right, standing.
    pub field: Option<FieldBar>,
}

/// The line that says how long a µm is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ScaleBar {
    /// A round length, about a sixth of the picture's width.
    #[default]
    Auto,
    /// This length, µm.
    Length(f64),
    /// None.
    Hidden,
}

/// What the colours mean.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Key {
    /// Nothing that needs words.
    #[default]
    None,
    /// Kinds of cells.
    Names(Vec<(String, Colour)>),
    /// A number per box.
    Bar {
        /// The colours.
        map: ColourMap,
        /// Value of the first colour.
        low: f64,
        /// Value of the last colour.
        high: f64,
        /// Quantity with unit.
        label: String,
    },
}

/// The units of times in pictures: their names in documents, what they are in s, and how they are written.
const UNITS: [(&str, f64, &str); 6] = [
    ("us", 1e-6, "µs"),
    ("ms", 1e-3, "ms"),
    ("s", 1.0, "s"),
    ("min", 60.0, "min"),
    ("h", 3600.0, "h"),
    ("d", 86_400.0, "d"),
];

/// A unit of times: what it is in s, and its name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockUnit(pub f64, pub &'static str);

impl ClockUnit {
    /// The unit that a document calls so, where a clock that goes up to `longest` (s) shows more than nothing in it.
    pub fn named(name: &str, longest: f64) -> Option<Self> {
        let found = UNITS.iter().find(|(known, ..)| *known == name)?;
        (longest >= 0.1 * found.1).then_some(Self(found.1, found.2))
    }

    /// The unit that suits times up to `longest`, s.
    pub fn fitting(longest: f64) -> Self {
        match longest {
            _ if longest < 1e-3 => Self(1e-6, "µs"),
            _ if longest < 1.0 => Self(1e-3, "ms"),
            _ if longest < 600.0 => Self(1.0, "s"),
            _ if longest < 36_000.0 => Self(60.0, "min"),
            _ => Self(3600.0, "h"),
        }
    }
}

/// A time for a picture or a frame of a movie that lasts until `longest` (both s), in a unit that stays the same for
/// the whole movie, that which suits it when absent: "t = 12.0 s", "t = 3.5 min", "t = 2.00 h".
pub fn time_text(time: f64, longest: f64, unit: Option<ClockUnit>) -> String {
    let longest = longest.abs().max(time.abs());
    let ClockUnit(unit, name) = unit.unwrap_or_else(|| ClockUnit::fitting(longest));
    let digits = (2.0 - (longest / unit * 1.000_001).log10().floor()).clamp(0.0, 2.0);
    let digits = if longest == 0.0 { 1.0 } else { digits };
    format!("t = {} {name}", ticks::plain(time / unit, 10f64.powf(-digits)))
}

impl Overlay {
    /// Margin that the lettering needs around the scene, for [`Camera::fit`].
    pub fn insets(&self) -> Insets {
        let above = if self.title.is_empty() && self.time.is_empty() { 0.04 } else { 0.085 };
        let below = match (&self.key, self.scale_bar) {
            (Key::Bar { .. }, _) => 0.12,
            (Key::None, ScaleBar::Hidden) => 0.04,
            _ => 0.095,
        };
        let right = if self.field.is_some() { 0.17 } else { 0.0 };
        Insets { sides: 0.045, right, top: above, bottom: below }
    }

    /// Writes the overlay over a picture taken with a camera. A picture too small for letters stays as it is.
    pub(super) fn lay_over(&self, image: &mut Image, camera: &Camera) {
        if image.width < 80 || image.height < 60 {
            return;
        }
        let svg = self.to_svg(image.width, image.height, camera.pixels_per_micron(image.height));
        if let Ok(mut pixels) = svg_to_pixels(&svg, 1.0) {
            image.lay_over(pixels.data_mut());
        }
    }

    /// The overlay as SVG of the picture's size.
    pub(super) fn to_svg(&self, width: usize, height: usize, pixels_per_micron: f64) -> String {
        let (width, height) = (width as f64, height as f64);
        // Lengths below are for a picture 720 px high; a tall narrow one is measured by its width.
        let unit = (height / 720.0).min(width / 720.0).max(0.45);
        let mut svg = String::new();
        let _ = writeln!(
            svg,
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="{}">"#,
            text::FONT_FAMILY
        );
        let margin = 28.0 * unit;
        let style = |size: f64, anchor, weight| Style { size: size * unit, anchor, weight };
        if !self.title.is_empty() {
            let style = style(21.0, Anchor::Start, Weight::Strong);
            write_text(&mut svg, margin, margin + 15.0 * unit, style, &self.title);
        }
        if !self.time.is_empty() {
            let style = style(19.0, Anchor::End, Weight::Plain);
            write_text(&mut svg, width - margin, margin + 15.0 * unit, style, &self.time);
        }
        if let Some(length) = self.bar_length(width / pixels_per_micron) {
            let pixels = length * pixels_per_micron;
            let (y, thick) = (height - margin - 1.0 * unit, (4.0 * unit).max(2.0).round());
            let _ = writeln!(
                svg,
                r#"<rect class="scale" x="{margin:.1}" y="{:.1}" width="{pixels:.3}" height="{thick}" fill="{}"/>"#,
                (y - thick).round(),
                text::INK
            );
            let style = style(17.0, Anchor::Middle, Weight::Plain);
            write_text(&mut svg, margin + 0.5 * pixels, y - thick - 8.0 * unit, style, &length_text(length));
        }
        match &self.key {
            Key::None => {}
            Key::Names(names) => write_names(&mut svg, names, width - margin, height - margin, unit),
            Key::Bar { map, low, high, label } => {
                write_colour_bar(&mut svg, *map, [*low, *high], label, width - margin, height - margin, unit);
            }
        }
        if let Some(bar) = &self.field {
            let top = margin + 15.0 * unit + if self.time.is_empty() { 0.0 } else { 36.0 * unit };
            write_standing_bar(&mut svg, bar, width - margin, top, unit);
        }
        svg.push_str("</svg>\n");
        svg
    }

    /// Length of the scale bar in a picture that is `across` µm wide.
    fn bar_length(&self, across: f64) -> Option<f64> {
        match self.scale_bar {
            _ if !(across.is_finite() && across > 0.0) => None,
            ScaleBar::Hidden => None,
            ScaleBar::Auto => Some(nice_below(0.2 * across)),
            ScaleBar::Length(length) => (length > 0.0 && length < across).then_some(length),
        }
    }
}

/// "20 µm", "500 nm", "2 mm".
fn length_text(length: f64) -> String {
    let (value, name) = match length {
        _ if length >= 999.99 => (length * 1e-3, "mm"),
        _ if length >= 0.999 => (length, "µm"),
        _ => (length * 1e3, "nm"),
    };
    format!("{} {name}", short(value))
}

/// Dots with names in rows that end at the right margin, from the bottom upwards.
fn write_names(svg: &mut String, names: &[(String, Colour)], right: f64, bottom: f64, unit: f64) {
    let (size, dot, gap) = (17.0 * unit, 7.0 * unit, 26.0 * unit);
    let wide = |name: &str| text_width(name, size) + 2.0 * dot + 9.0 * unit;
    let mut rows: Vec<Vec<&(String, Colour)>> = vec![Vec::new()];
    let mut used = 0.0;
    for entry in names {
        let more = wide(&entry.0) + gap;
        if used + more > 0.62 * right && used > 0.0 {
            rows.push(Vec::new());
            used = 0.0;
        }
        used += more;
        rows.last_mut().expect("there is a first row").push(entry);
    }
    for (number, row) in rows.iter().rev().enumerate() {
        let y = bottom - 6.0 * unit - 27.0 * unit * number as f64;
        let total: f64 = row.iter().map(|(name, _)| wide(name)).sum::<f64>() + gap * row.len().saturating_sub(1) as f64;
        let mut x = right - total;
        for (name, colour) in row {
            let _ = writeln!(
                svg,
                r#"<circle cx="{:.1}" cy="{:.1}" r="{dot:.1}" fill="{}"/>"#,
                x + dot,
                y - 0.34 * size,
                colour.hex()
            );
            let style = Style { size, anchor: Anchor::Start, weight: Weight::Plain };
            write_text(svg, x + 2.0 * dot + 8.0 * unit, y, style, name);
            x += wide(name) + gap;
        }
    }
}
