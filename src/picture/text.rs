//! Lettering: writes text into SVG.

use std::fmt::Write;

/// What SVG files ask for; pixels are always drawn with the Ubuntu Light inside the program.
pub(crate) const FONT_FAMILY: &str = "Ubuntu, Helvetica, Arial, sans-serif";
/// Colour of titles and labels.
pub(crate) const INK: &str = "#22262c";
/// Colour of numbers along axes.
pub(crate) const SOFT_INK: &str = "#454b54";

/// Which end of a text stands at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Style {
    /// Height of the letters, px.
    pub size: f64,
    pub anchor: Anchor,
    pub weight: Weight,
}

/// How heavy the letters are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weight {
    /// Numbers.
    Soft,
    /// Labels.
    Plain,
    /// Titles.
    Strong,
}

/// Appends one line of text to an SVG document. Raised and lowered digits are set as smaller, shifted letters because
/// few fonts have all of them.
pub(crate) fn write_text(svg: &mut String, x: f64, y: f64, style: Style, text: &str) {
    write_turned_text(svg, x, y, 0.0, style, text);
}

/// The same, turned clockwise by `angle` degrees around its position.
pub(crate) fn write_turned_text(svg: &mut String, x: f64, y: f64, angle: f64, style: Style, text: &str) {
    let anchor = match style.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let (class, colour, weight) = match style.weight {
        Weight::Soft => ("soft", SOFT_INK, "400"),
        Weight::Plain => ("plain", INK, "400"),
        Weight::Strong => ("strong", INK, "600"),
    };
    let size = style.size;
    let attributes = if angle == 0.0 {
        format!(r#"x="{x:.1}" y="{y:.1}""#)
    } else {
        format!(r#"transform="translate({x:.1} {y:.1}) rotate({angle})""#)
    };
    let _ = write!(
        svg,
        r#"<text class="{class}" {attributes} font-size="{size}" text-anchor="{anchor}" fill="{colour}" font-weight="{weight}">"#
    );
    let mut shift = 0.0;
    for (run, level) in runs(text) {
        let target = match level {
            Level::Base => 0.0,
            Level::Raised => -0.36 * size,
            Level::Lowered => 0.16 * size,
        };
        let small = if level == Level::Base { size } else { 0.72 * size };
        if level == Level::Base && shift == 0.0 {
            svg.push_str(&escaped(&run));
        } else {
            let _ =
                write!(svg, r#"<tspan dy="{:.2}" font-size="{small:.2}">{}</tspan>"#, target - shift, escaped(&run));
        }
        shift = target;
    }
    svg.push_str("</text>\n");
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Level {
    Base,
    Raised,
    Lowered,
}

/// Splits a text where letters become raised or lowered.
fn runs(text: &str) -> Vec<(String, Level)> {
    let mut runs: Vec<(String, Level)> = Vec::new();
    for letter in text.chars() {
        let (shown, level) = match letter {
            '⁰' => ('0', Level::Raised),
            '¹' => ('1', Level::Raised),
            '²' => ('2', Level::Raised),
            '³' => ('3', Level::Raised),
            '⁴'..='⁹' => (char::from(b'4' + (letter as u32 - '⁴' as u32) as u8), Level::Raised),
            '⁻' => ('−', Level::Raised),
            '₀'..='₉' => (char::from(b'0' + (letter as u32 - '₀' as u32) as u8), Level::Lowered),
            other => (other, Level::Base),
        };
        match runs.last_mut() {
            Some((run, last)) if *last == level => run.push(shown),
            _ => runs.push((shown.to_string(), level)),
        }
    }
    runs
}

/// Text that XML takes as text.
pub(crate) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // XML forbids control characters even when they are escaped.
            control if control.is_control() => out.push(' '),
            other => out.push(other),
        }
    }
    out
}

/// The width that a text of the given size takes, px; a little more than the program's own font needs, so that a
/// reader's Helvetica fits as well.
pub(crate) fn text_width(text: &str, size: f64) -> f64 {
    /// Advance widths of Ubuntu Light from the space to the tilde, thousandths of the size.
    const ADVANCE: [u16; 95] = [
        228, 274, 392, 653, 564, 831, 648, 240, 310, 310, 472, 564, 246, 282, 246, 359, 564, 564, 564, 564, 564, 564,
        564, 564, 564, 564, 246, 246, 564, 564, 564, 380, 940, 641, 630, 609, 702, 555, 520, 658, 692, 248, 487, 599,
        502, 865, 709, 774, 592, 774, 618, 517, 548, 680, 624, 921, 608, 569, 560, 310, 359, 310, 564, 490, 376, 509,
        583, 460, 583, 548, 376, 573, 569, 237, 237, 495, 255, 863, 569, 582, 583, 583, 374, 428, 387, 569, 480, 775,
        499, 474, 455, 319, 262, 319, 564,
    ];
    let thousandths: f64 = runs(text)
        .iter()
        .map(|(run, level)| {
            let shrink = if *level == Level::Base { 1.0 } else { 0.72 };
            let advance = |c: char| ADVANCE.get((c as usize).wrapping_sub(32)).map_or(570.0, |a| f64::from(*a));
            shrink * run.chars().map(advance).sum::<f64>()
        })
        .sum();
    1.06 * size * thousandths / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::svg::svg_to_pixels;

    #[test]
    fn letters_of_units_and_greek_leave_ink() {
        // A missing glyph draws nothing or a box; every letter must differ from the box of a letter no font has.
        let draw = |text: &str| {
            let mut svg = String::from(r#"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40" "#);
            let _ = write!(svg, r#"font-family="{FONT_FAMILY}">"#);
            write_text(&mut svg, 8.0, 30.0, Style { size: 24.0, anchor: Anchor::Start, weight: Weight::Plain }, text);
            svg.push_str("</svg>");
            svg_to_pixels(&svg, 1.0).unwrap().take()
        };
        let missing = draw("\u{e123}");
        for text in ["µ", "μ", "²", "³", "⁻", "·", "−", "–", "α", "η", "Δ", "σ", "×", "°", "₀", "±"]
        {
            let drawn = draw(text);
            assert!(drawn.iter().any(|byte| *byte != 0), "{text} left no ink");
            assert_ne!(drawn, missing, "{text} is missing from the font");
        }
    }

    #[test]
    fn text_is_escaped_for_xml() {
        assert_eq!(escaped("a<b & \"c\"\u{7}"), "a&lt;b &amp; &quot;c&quot; ");
    }

    #[test]
    fn wider_texts_measure_wider() {
        assert!(text_width("MMM", 12.0) > 2.0 * text_width("iii", 12.0));
        assert!(text_width("10²", 12.0) < text_width("102", 12.0));
    }
}
