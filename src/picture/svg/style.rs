//! How outlines are filled and stroked.

use std::collections::HashMap;

use tiny_skia::{
    Color, GradientStop, LineCap, LineJoin, LinearGradient, Paint, Point, Rect, Shader, SpreadMode, Stroke, StrokeDash,
    Transform,
};

use super::element::Element;
use crate::picture::colour::Colour;
use crate::picture::text::{INK, SOFT_INK};

/// What an element inherits and hands on.
#[derive(Debug, Clone)]
pub(super) struct Style {
    fill: Fill,
    fill_opacity: f32,
    stroke: Option<Colour>,
    stroke_opacity: f32,
    width: f32,
    join: LineJoin,
    cap: LineCap,
    dashes: Vec<f32>,
    /// Name of the clip.
    pub clip: Option<String>,
}

/// What an area is filled with.
#[derive(Debug, Clone)]
enum Fill {
    Nothing,
    Colour(Colour),
    /// The gradient of a name.
    Gradient(String),
}

impl Default for Style {
    fn default() -> Self {
        Self {
            fill: Fill::Colour(Colour([0; 3])),
            fill_opacity: 1.0,
            stroke: None,
            stroke_opacity: 1.0,
            width: 1.0,
            join: LineJoin::Miter,
            cap: LineCap::Butt,
            dashes: Vec::new(),
            clip: None,
        }
    }
}

impl Style {
    /// The style of an element inside another's.
    pub fn within(mut self, element: &Element) -> Self {
        // The program's only font is a light one: thin outlines in the letters' colour make it as dark as a book face.
        let letters = match element.text("class") {
            "soft" => Some((SOFT_INK, 0.2)),
            "plain" => Some((INK, 0.3)),
            "strong" => Some((INK, 0.65)),
            _ => None,
        };
        if let Some((ink, width)) = letters {
            (self.stroke, self.width) = (Colour::from_hex(ink), width);
        }
        if let Some(name) = element.reference("fill") {
            self.fill = Fill::Gradient(name.to_owned());
        } else if element.get("fill").is_some() {
            self.fill = element.colour("fill").map_or(Fill::Nothing, Fill::Colour);
        }
        if element.get("stroke").is_some() {
            self.stroke = element.colour("stroke");
        }
        self.fill_opacity = element.number("fill-opacity", self.fill_opacity);
        self.stroke_opacity = element.number("stroke-opacity", self.stroke_opacity);
        self.width = element.number("stroke-width", self.width);
        if element.get("stroke-linejoin") == Some("round") {
            self.join = LineJoin::Round;
        }
        match element.text("stroke-linecap") {
            "round" => self.cap = LineCap::Round,
            "square" => self.cap = LineCap::Square,
            _ => {}
        }
        if let Some(dashes) = element.get("stroke-dasharray") {
            self.dashes = dashes.split_ascii_whitespace().filter_map(|length| length.parse().ok()).collect();
        }
        if let Some(name) = element.reference("clip-path") {
            self.clip = Some(name.to_owned());
        }
        self
    }

    /// What an outline with these bounds is filled with.
    pub fn fill(&self, gradients: &HashMap<String, Gradient>, bounds: Rect) -> Option<Paint<'static>> {
        let shader = match &self.fill {
            Fill::Nothing => return None,
            Fill::Colour(colour) => Shader::SolidColor(with_opacity(*colour, self.fill_opacity)),
            Fill::Gradient(name) => gradients.get(name)?.shader(bounds)?,
        };
        Some(Paint { shader, anti_alias: true, ..Paint::default() })
    }

    /// With what and how an outline is stroked.
    pub fn stroke(&self) -> Option<(Paint<'static>, Stroke)> {
        let shader = Shader::SolidColor(with_opacity(self.stroke?, self.stroke_opacity));
        let stroke = Stroke {
            width: self.width,
            line_join: self.join,
            line_cap: self.cap,
            dash: StrokeDash::new(self.dashes.clone(), 0.0),
            ..Stroke::default()
        };
        Some((Paint { shader, anti_alias: true, ..Paint::default() }, stroke))
    }
}

fn with_opacity(colour: Colour, opacity: f32) -> Color {
    let [red, green, blue] = colour.0;
    Color::from_rgba8(red, green, blue, (255.0 * opacity.clamp(0.0, 1.0)).round() as u8)
}

/// Colours along a line across whatever is filled with them.
#[derive(Debug, Clone)]
pub(super) struct Gradient {
    /// Ends of the line, in widths and heights of the filled outline.
    ends: [[f32; 2]; 2],
    stops: Vec<GradientStop>,
}

impl Gradient {
    /// A gradient without colours yet.
    pub fn of(element: &Element) -> Self {
        let end = |x: &str, y: &str, usual: f32| [element.number(x, usual), element.number(y, 0.0)];
        Self { ends: [end("x1", "y1", 0.0), end("x2", "y2", 1.0)], stops: Vec::new() }
    }

    /// Adds the colour of an element `stop`.
    pub fn add_stop(&mut self, element: &Element) {
        let colour = element.colour("stop-color").unwrap_or(Colour([0; 3]));
        self.stops.push(GradientStop::new(element.number("offset", 0.0), with_opacity(colour, 1.0)));
    }

    fn shader(&self, bounds: Rect) -> Option<Shader<'static>> {
        let [from, to] = self
            .ends
            .map(|[x, y]| Point::from_xy(bounds.left() + x * bounds.width(), bounds.top() + y * bounds.height()));
        LinearGradient::new(from, to, self.stops.clone(), SpreadMode::Pad, Transform::identity())
    }
}
