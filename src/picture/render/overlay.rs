//! What is written over a picture: title, time, scale bar, and the legend or colour bar.

use std::fmt::Write;

use super::bars::{FieldBar, bar_width, write_colour_bar, write_standing_bar};
use super::camera::{Camera, Insets};
use super::tripod::Tripod;
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
    /// Whether it is shown which way x, y and z go: bottom left, beside the scale bar, where there is space before the key.
    pub axes: bool,
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
            (Key::None, ScaleBar::Hidden) if !self.axes => 0.04,
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
        let tripod = self.axes.then(|| Tripod::of(camera));
        let svg = self.to_svg(image.width, image.height, camera.pixels_per_micron(image.height), tripod.as_ref());
        if let Ok(mut pixels) = svg_to_pixels(&svg, 1.0) {
            image.lay_over(pixels.data_mut());
        }
    }

    /// The overlay as SVG of the picture's size.
    pub(super) fn to_svg(
        &self,
        width: usize,
        height: usize,
        pixels_per_micron: f64,
        tripod: Option<&Tripod>,
    ) -> String {
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
        let mut left = margin;
        if let Some(length) = self.bar_length(width / pixels_per_micron) {
            let pixels = length * pixels_per_micron;
            left += pixels.max(text_width(&length_text(length), 17.0 * unit)) + 22.0 * unit;
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
        // A key that needs the space has it.
        let beside = |tripod: &&Tripod| left + tripod.width(unit) + 22.0 * unit <= self.key_left(width - margin, unit);
        if let Some(tripod) = tripod.filter(beside) {
            tripod.write(&mut svg, left, height - 10.0 * unit, unit);
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

    /// Where the key begins that ends at `right`, px.
    fn key_left(&self, right: f64, unit: f64) -> f64 {
        match &self.key {
            Key::None => right,
            Key::Names(names) => right - name_rows(names, right, unit).iter().map(|row| row.wide).fold(0.0, f64::max),
            Key::Bar { label, .. } => right - bar_width(label, unit),
        }
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

/// A row of the names of a key.
struct Row<'a> {
    names: Vec<&'a (String, Colour)>,
    /// Its width, px.
    wide: f64,
}

/// Size of the letters of names, radius of their dots, and what is between two of them, for a picture 720 px high.
const NAME: f64 = 17.0;
const DOT: f64 = 7.0;
const GAP: f64 = 26.0;

fn name_width(name: &str, unit: f64) -> f64 {
    text_width(name, NAME * unit) + (2.0 * DOT + 9.0) * unit
}

/// Names in rows that take no more than a part of the picture's width.
fn name_rows(names: &[(String, Colour)], right: f64, unit: f64) -> Vec<Row<'_>> {
    let mut rows = vec![Row { names: Vec::new(), wide: 0.0 }];
    for entry in names {
        let (more, gap) = (name_width(&entry.0, unit), GAP * unit);
        let last = rows.last_mut().expect("there is a first row");
        if last.names.is_empty() {
            (last.names, last.wide) = (vec![entry], more);
        } else if last.wide + gap + more + gap > 0.62 * right {
            rows.push(Row { names: vec![entry], wide: more });
        } else {
            last.names.push(entry);
            last.wide += gap + more;
        }
    }
    rows
}

/// Dots with names in rows that end at the right margin, from the bottom upwards.
fn write_names(svg: &mut String, names: &[(String, Colour)], right: f64, bottom: f64, unit: f64) {
    let (size, dot) = (NAME * unit, DOT * unit);
    for (number, row) in name_rows(names, right, unit).iter().rev().enumerate() {
        let y = bottom - 6.0 * unit - 27.0 * unit * number as f64;
        let mut x = right - row.wide;
        for (name, colour) in &row.names {
            let _ = writeln!(
                svg,
                r#"<circle cx="{:.1}" cy="{:.1}" r="{dot:.1}" fill="{}"/>"#,
                x + dot,
                y - 0.34 * size,
                colour.hex()
            );
            let style = Style { size, anchor: Anchor::Start, weight: Weight::Plain };
            write_text(svg, x + 2.0 * dot + 8.0 * unit, y, style, name);
            x += name_width(name, unit) + GAP * unit;
        }
    }
}
