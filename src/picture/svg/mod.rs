//! Turns drawings into pixels. Drawings are written in a small part of SVG and exactly that is read here: groups, rectangles,
//! circles, paths of straight lines, lines of text, clips by a rectangle and gradients along an axis; all else is passed over.

mod element;
mod letters;
mod outline;
mod style;

use std::collections::HashMap;

use tiny_skia::{FillRule, Mask, Path, Pixmap, Transform};

use self::element::{Element, undrawable};
use self::letters::Line;
use self::style::{Gradient, Style};
use crate::error::{Error, Result};
use crate::xml::{Event, Limits, Reader, Trouble, What};

/// How much of a drawing is read: all of any that is written here.
const LIMITS: Limits = Limits { bytes: u32::MAX as usize, depth: 16, nodes: 0, attributes: 64 };

/// Draws an SVG document, `scale` pixels for each of its units; pixels it leaves free stay transparent.
///
/// # Errors
/// When the text is not SVG or its size is zero or enormous.
pub(crate) fn svg_to_pixels(svg: &str, scale: f32) -> Result<Pixmap> {
    let mut reader = Reader::new(svg, LIMITS).map_err(unread)?;
    let mut painter: Option<Painter> = None;
    while let Some(event) = reader.event().map_err(unread)? {
        match (&mut painter, event) {
            (None, Event::Start(start)) => {
                painter = Some(Painter::new(&Element { name: start.name, attributes: reader.attributes() }, scale)?);
            }
            (Some(painter), Event::Start(start)) => {
                painter.begin(&Element { name: start.name, attributes: reader.attributes() });
            }
            (Some(painter), Event::Text { text, .. }) => painter.letters(&text),
            (Some(painter), Event::End { .. }) => painter.end(),
            (None, _) => {}
        }
    }
    painter.map(|painter| painter.pixels).ok_or_else(|| undrawable("it has no element"))
}

fn unread(trouble: Trouble) -> Error {
    match trouble.what {
        What::Malformed { message, .. } => undrawable(&message),
        what => undrawable(&format!("{what:?}")),
    }
}

/// The pixels so far, and what the elements read before mean for those to come.
struct Painter {
    pixels: Pixmap,
    scale: Transform,
    /// Name and style of each open element, the innermost last.
    open: Vec<(String, Style)>,
    gradients: HashMap<String, Gradient>,
    clips: HashMap<String, Path>,
    /// The definition that is open: the name of a gradient or a clip.
    defined: String,
    /// The text that is open.
    line: Option<Line>,
}

impl Painter {
    /// Clear pixels for a page.
    fn new(page: &Element, scale: f32) -> Result<Self> {
        let [width, height] = ["width", "height"].map(|side| (page.number(side, 0.0) * scale).round() as u32);
        let pixels = Pixmap::new(width, height).ok_or_else(|| undrawable(&format!("{width}×{height} pixels")))?;
        Ok(Self {
            pixels,
            scale: Transform::from_scale(scale, scale),
            open: vec![(page.name.to_owned(), Style::default().within(page))],
            gradients: HashMap::new(),
            clips: HashMap::new(),
            defined: String::new(),
            line: None,
        })
    }

    /// An element begins.
    fn begin(&mut self, element: &Element) {
        let style = self.open.last().map(|(_, style)| style.clone()).unwrap_or_default().within(element);
        match element.name {
            "linearGradient" => {
                self.defined = element.text("id").to_owned();
                self.gradients.insert(self.defined.clone(), Gradient::of(element));
            }
            "stop" => {
                if let Some(gradient) = self.gradients.get_mut(&self.defined) {
                    gradient.add_stop(element);
                }
            }
            "clipPath" => self.defined = element.text("id").to_owned(),
            "rect" if !self.defined.is_empty() => {
                self.clips.extend(outline::rectangle(element).map(|path| (self.defined.clone(), path)));
            }
            "rect" => self.paint(outline::rectangle(element), &style),
            "circle" => self.paint(outline::circle(element), &style),
            "path" => self.paint(outline::lines(element.text("d")), &style),
            "text" => self.line = Some(Line::begin(element)),
            "tspan" => {
                if let Some(line) = &mut self.line {
                    line.begin_run(element);
                }
            }
            _ => {}
        }
        self.open.push((element.name.to_owned(), style));
    }

    /// The innermost element ends.
    fn end(&mut self) {
        let Some((name, style)) = self.open.pop() else { return };
        match name.as_str() {
            "linearGradient" | "clipPath" => self.defined.clear(),
            "text" => {
                let line = self.line.take().and_then(Line::outline);
                self.paint(line, &style);
            }
            _ => {}
        }
    }

    /// Letters of the text that is open; between other elements they are the space that orders the file.
    fn letters(&mut self, letters: &str) {
        if let Some(line) = &mut self.line {
            line.push(letters);
        }
    }

    /// Fills and strokes an outline.
    fn paint(&mut self, outline: Option<Path>, style: &Style) {
        let Some(outline) = outline else { return };
        let mask = style.clip.as_ref().and_then(|name| self.clips.get(name)).and_then(|clip| {
            let mut mask = Mask::new(self.pixels.width(), self.pixels.height())?;
            mask.fill_path(clip, FillRule::Winding, true, self.scale);
            Some(mask)
        });
        if let Some(paint) = style.fill(&self.gradients, outline.bounds()) {
            self.pixels.fill_path(&outline, &paint, FillRule::Winding, self.scale, mask.as_ref());
        }
        if let Some((paint, stroke)) = style.stroke() {
            self.pixels.stroke_path(&outline, &paint, &stroke, self.scale, mask.as_ref());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(body: &str) -> Pixmap {
        svg_to_pixels(&format!(r#"<svg width="20" height="10" fill="none">{body}</svg>"#), 1.0).unwrap()
    }

    fn pixel(pixels: &Pixmap, x: u32, y: u32) -> [u8; 4] {
        let colour = pixels.pixel(x, y).unwrap();
        [colour.red(), colour.green(), colour.blue(), colour.alpha()]
    }

    #[test]
    fn shapes_are_filled_and_stroked_where_they_stand() {
        let pixels = drawn(
            r##"<rect x="2" y="2" width="4" height="4" fill="#ff0000"/><circle cx="12" cy="5" r="3" fill="#00ff00"/>
                <path d="M0 9H20" stroke="#0000ff" stroke-width="2"/><path d="M16 0v4h4V0Z" fill="#ffffff" fill-opacity="0.5"/>"##,
        );
        assert_eq!(pixel(&pixels, 3, 3), [255, 0, 0, 255]);
        assert_eq!(pixel(&pixels, 12, 5), [0, 255, 0, 255]);
        assert_eq!(pixel(&pixels, 10, 8), [0, 0, 255, 255]);
        assert_eq!(pixel(&pixels, 17, 1), [128, 128, 128, 128]);
        assert_eq!(pixel(&pixels, 8, 1), [0; 4]);
    }

    #[test]
    fn a_group_clips_and_hands_its_style_on() {
        let pixels = drawn(
            r##"<clipPath id="left"><rect x="0" y="0" width="10" height="10"/></clipPath>
                <g clip-path="url(#left)" fill="#ff0000"><rect x="0" y="0" width="20" height="10"/></g>"##,
        );
        assert_eq!(pixel(&pixels, 9, 5), [255, 0, 0, 255]);
        assert_eq!(pixel(&pixels, 11, 5), [0; 4]);
    }

    #[test]
    fn a_gradient_runs_from_its_first_to_its_last_stop() {
        let pixels = drawn(
            r##"<linearGradient id="up" x1="0" x2="0" y1="1" y2="0"><stop offset="0" stop-color="#000000"/>
                <stop offset="1" stop-color="#ff0000"/></linearGradient><rect x="0" y="0" width="20" height="10" fill="url(#up)"/>"##,
        );
        assert!(pixel(&pixels, 5, 0)[0] > 230 && pixel(&pixels, 5, 9)[0] < 25);
    }

    #[test]
    fn what_is_no_drawing_is_refused_with_its_fault() {
        for (svg, words) in [("", "NotXml"), ("<svg/>", "0×0 pixels"), ("<svg width='3' height='3'><a", "")] {
            let error = svg_to_pixels(svg, 1.0).unwrap_err().to_string();
            assert!(error.contains("could not be turned into pixels") && error.contains(words), "{error}");
        }
    }
}
