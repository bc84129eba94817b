//! A chart whose area is an image: numbers over two axes as colours, with a bar beside that says what they mean.

use std::fmt::Write;

use super::frame::{Frame, LABEL, NUMBER};
use crate::picture::Image;
use crate::picture::colour::{Colour, ColourMap};
use crate::picture::text::{self, Anchor, Style, Weight, text_width, write_text, write_turned_text};
use crate::picture::ticks::{self, Scale};

/// Width of the colour bar and its distance from the frame, px.
const BAR: f64 = 16.0;
const GAP: f64 = 16.0;

/// Numbers in equal boxes over the whole area of a chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Heat {
    /// Ends of the area along x, in the axis' unit.
    pub x: [f64; 2],
    /// Ends along y.
    pub y: [f64; 2],
    /// Boxes along x and y.
    pub size: [usize; 2],
    /// A number for each box, x fastest, the lowest row first; NaN grey.
    pub values: Vec<f64>,
    /// What is shown between the centres of boxes.
    pub shading: Shading,
    /// Colours.
    pub map: ColourMap,
    /// Numbers of the first and the last colour.
    pub range: [f64; 2],
    /// How numbers are spaced between them.
    pub scale: Scale,
    /// Quantity with unit.
    pub label: String,
}

/// What is shown between the centres of boxes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shading {
    /// Numbers in between, for what is known everywhere, such as a field.
    #[default]
    Smooth,
    /// The number of the box, for what was measured at the centres alone.
    Boxes,
}

impl Heat {
    /// Width that the colour bar needs on the right, px.
    pub(super) fn width(&self) -> f64 {
        let ticks = self.ticks();
        let widest = ticks.major.iter().map(|mark| text_width(&mark.1, NUMBER)).fold(0.0, f64::max);
        GAP + BAR + 10.0 + widest + if self.label.is_empty() { 0.0 } else { 10.0 + 1.4 * LABEL }
    }

    fn ticks(&self) -> ticks::Ticks {
        let [low, high] = self.range;
        let (low, high) = if low.is_finite() && high.is_finite() { (low, high) } else { (0.0, 1.0) };
        let ticks = self.scale.marks(low.min(high), low.max(high), 7);
        match low == high {
            true => ticks::Ticks { major: vec![(low, ticks::constant(low, &self.label))], exponent: 0, ..ticks },
            false => ticks,
        }
    }

    /// The area as pixels.
    pub(super) fn image(&self, width: usize, height: usize) -> Image {
        let mut image = Image::filled(width, height, Colour([0xff; 3]));
        let [nx, ny] = self.size;
        if nx == 0 || ny == 0 || self.values.len() != nx * ny {
            return image;
        }
        let between = |pixel: usize, pixels: usize, boxes: usize| {
            let centred = (pixel as f64 + 0.5) / pixels as f64 * boxes as f64 - 0.5;
            let at = match self.shading {
                Shading::Smooth => centred,
                Shading::Boxes => centred.round(),
            };
            let at = at.clamp(0.0, (boxes - 1) as f64);
            (at as usize, (at as usize + 1).min(boxes - 1), at.fract())
        };
        for row in 0..height {
            let (below, above, t) = between(height - 1 - row, height, ny);
            for column in 0..width {
                let (left, right, s) = between(column, width, nx);
                let at = |x: usize, y: usize| self.values[y * nx + x];
                let mixed =
                    |y: usize| if s == 0.0 { at(left, y) } else { at(left, y) + s * (at(right, y) - at(left, y)) };
                let value = if t == 0.0 { mixed(below) } else { mixed(below) + t * (mixed(above) - mixed(below)) };
                let start = 3 * (row * width + column);
                image.rgb[start..start + 3].copy_from_slice(&self.map.at(self.scale.share(value, self.range)).0);
            }
        }
        image
    }

    /// Writes the image into a drawing, for programs that show pictures in drawings.
    pub(super) fn write_image(&self, svg: &mut String, frame: &Frame) {
        let (width, height) = (frame.right - frame.left, frame.bottom - frame.top);
        // A picture of that size can always be packed.
        let png = self.image(width.round().max(1.0) as usize, height.round().max(1.0) as usize).to_png();
        let _ = writeln!(
            svg,
            r#"<image x="{:.1}" y="{:.1}" width="{width:.1}" height="{height:.1}" preserveAspectRatio="none" href="data:image/png;base64,{}"/>"#,
            frame.left,
            frame.top,
            base64(&png.unwrap_or_default())
        );
    }

    /// Writes the colour bar beside the frame.
    pub(super) fn write_bar(&self, svg: &mut String, frame: &Frame) {
        let (left, top, long) = (frame.right + GAP, frame.top, frame.bottom - frame.top);
        let [low, high] = self.range;
        svg.push_str(r#"<linearGradient id="heat" x1="0" x2="0" y1="1" y2="0">"#);
        for k in 0..=20 {
            let share = f64::from(k) / 20.0;
            let colour = if low == high { self.map.of_value(low, self.range) } else { self.map.at(share) };
            let _ = write!(svg, r#"<stop offset="{share}" stop-color="{}"/>"#, colour.hex());
        }
        let _ = writeln!(
            svg,
            r##"</linearGradient><rect class="bar" x="{left:.1}" y="{top:.1}" width="{BAR}" height="{long:.1}" fill="url(#heat)"/>"##
        );
        let ticks = self.ticks();
        let mut widest: f64 = 0.0;
        for (value, text) in &ticks.major {
            let y = top + long - self.scale.share(*value, [ticks.low, ticks.high]) * long;
            let _ = writeln!(
                svg,
                r#"<path d="M{:.1} {y:.1}h4" stroke="{}" stroke-width="1.1"/>"#,
                left + BAR,
                text::SOFT_INK
            );
            let style = Style { size: NUMBER, anchor: Anchor::Start, weight: Weight::Soft };
            write_text(svg, left + BAR + 8.0, y + 0.36 * NUMBER, style, text);
            widest = widest.max(text_width(text, NUMBER));
        }
        if !self.label.is_empty() {
            let label = match ticks.exponent {
                0 => self.label.clone(),
                power => format!("{}  ×{}", self.label, ticks::power_of_ten(power)),
            };
            let style = Style { size: LABEL, anchor: Anchor::Middle, weight: Weight::Plain };
            write_turned_text(svg, left + BAR + 8.0 + widest + 10.0 + LABEL, top + 0.5 * long, -90.0, style, &label);
        }
    }
}

/// Bytes as text (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(4 * bytes.len().div_ceil(3));
    for three in bytes.chunks(3) {
        let byte = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            let letter = char::from(LETTERS[(bits >> (18 - 6 * k) & 63) as usize]);
            text.push(if k <= three.len() { letter } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_written_as_the_standard_says() {
        for (bytes, text) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }

    #[test]
    fn boxes_have_one_colour_each() {
        let shading = Shading::Boxes;
        let heat = Heat { size: [2, 1], values: vec![0.0, 1.0], range: [0.0, 1.0], shading, ..Heat::default() };
        let image = heat.image(8, 2);
        let colours: Vec<Colour> = (0..8).map(|x| image.pixel(x, 0)).collect();
        assert_eq!(colours, [[heat.map.at(0.0); 4], [heat.map.at(1.0); 4]].concat());
    }

    #[test]
    fn the_lowest_row_is_at_the_bottom() {
        let heat = Heat { size: [2, 2], values: vec![0.0, 0.0, 1.0, 1.0], range: [0.0, 1.0], ..Heat::default() };
        let image = heat.image(8, 8);
        assert_eq!(image.pixel(0, 0), heat.map.at(1.0));
        assert_eq!(image.pixel(7, 7), heat.map.at(0.0));
    }
    #[test]
    fn a_field_that_is_the_same_everywhere_has_one_colour_and_one_number() {
        let heat = Heat {
            size: [2, 1],
            values: vec![5.0; 2],
            range: [5.0; 2],
            label: "oxygen (µM)".into(),
            ..Heat::default()
        };
        assert_eq!(heat.image(4, 1).pixel(3, 0), heat.map.at(0.5));
        let marks: Vec<String> = heat.ticks().major.into_iter().map(|mark| mark.1).collect();
        assert_eq!(marks, ["5.00 µM, constant"]);
    }
}
