//! Lines of text as outlines, in the font that travels inside the program.

use std::sync::OnceLock;

use tiny_skia::{Path, PathBuilder, Transform};
use ttf_parser::gpos::{PairAdjustment, PositioningSubtable};
use ttf_parser::{Face, GlyphId, OutlineBuilder, Tag};

use super::element::Element;

/// A line of text that is being read.
pub(super) struct Line {
    /// From the start of the text to the page.
    position: Transform,
    /// Share of its width that stands before the position.
    before: f32,
    size: f32,
    runs: Vec<Run>,
}

/// Letters of one size.
struct Run {
    size: f32,
    /// How far below the line they stand.
    down: f32,
    letters: String,
}

impl Line {
    /// An empty line where an element `text` has it.
    pub fn begin(element: &Element) -> Self {
        let size = element.number("font-size", 16.0);
        let before = match element.text("text-anchor") {
            "middle" => 0.5,
            "end" => 1.0,
            _ => 0.0,
        };
        let position = turned(element.text("transform"))
            .unwrap_or_else(|| Transform::from_translate(element.number("x", 0.0), element.number("y", 0.0)));
        Self { position, before, size, runs: vec![Run { size, down: 0.0, letters: String::new() }] }
    }

    /// Letters raised or lowered, of a size of their own.
    pub fn begin_run(&mut self, element: &Element) {
        let down = self.runs.last().map_or(0.0, |run| run.down) + element.number("dy", 0.0);
        self.runs.push(Run { size: element.number("font-size", self.size), down, letters: String::new() });
    }

    /// More letters. Spaces in a row are one, as XML has it.
    pub fn push(&mut self, letters: &str) {
        let mut last = self.runs.iter().rev().find_map(|run| run.letters.chars().next_back());
        let Some(run) = self.runs.last_mut() else { return };
        for letter in letters.chars() {
            let letter = if letter.is_whitespace() { ' ' } else { letter };
            if letter != ' ' || last.is_some_and(|last| last != ' ') {
                run.letters.push(letter);
            }
            last = Some(letter);
        }
    }

    /// The outlines of all letters, in units of the page.
    pub fn outline(mut self) -> Option<Path> {
        if let Some(run) = self.runs.last_mut() {
            run.letters.truncate(run.letters.trim_end().len());
        }
        let font = Font::own();
        let (mut path, mut across) = (PathBuilder::new(), 0.0);
        for run in &self.runs {
            across = font.add_letters(run, across, &mut path);
        }
        let position = self.position.pre_translate(-self.before * across, 0.0);
        path.finish()?.transform(position)
    }
}

/// A transform `translate(x y) rotate(degrees)`.
fn turned(transform: &str) -> Option<Transform> {
    let (moved, angle) = transform.strip_prefix("translate(")?.split_once(") rotate(")?;
    let (x, y) = moved.split_once(' ')?;
    let position = Transform::from_translate(x.parse().ok()?, y.parse().ok()?);
    Some(position.pre_rotate(angle.strip_suffix(')')?.parse().ok()?))
}

/// A font and what moves its letters together.
struct Font {
    face: Face<'static>,
    pairs: Vec<PairAdjustment<'static>>,
}

impl Font {
    /// The font inside the program, parsed once.
    fn own() -> &'static Self {
        static FONT: OnceLock<Font> = OnceLock::new();
        FONT.get_or_init(|| {
            let face = Face::parse(epaint_default_fonts::UBUNTU_LIGHT, 0).expect("the font inside the program is one");
            let pairs = face.tables().gpos.map_or_else(Vec::new, |table| {
                let kern = table.features.into_iter().find(|feature| feature.tag == Tag::from_bytes(b"kern"));
                let lookups = kern.into_iter().flat_map(|feature| feature.lookup_indices);
                let lookups = lookups.filter_map(|index| table.lookups.get(index));
                let parts = lookups.flat_map(|lookup| lookup.subtables.into_iter::<PositioningSubtable>());
                let pair = |part| if let PositioningSubtable::Pair(pair) = part { Some(pair) } else { None };
                parts.filter_map(pair).collect()
            });
            Self { face, pairs }
        })
    }

    /// Adds the outlines of letters from `across` on; returns where they end.
    fn add_letters(&self, run: &Run, mut across: f32, path: &mut PathBuilder) -> f32 {
        let scale = run.size / f32::from(self.face.units_per_em());
        let mut last: Option<GlyphId> = None;
        for letter in run.letters.chars() {
            // Letters that the font lacks are shown as its box.
            let glyph = self.face.glyph_index(letter).unwrap_or(GlyphId(0));
            across += scale * last.map_or(0.0, |last| self.kerning(last, glyph));
            self.face.outline_glyph(glyph, &mut Pen { path, scale, across, down: run.down });
            across += scale * f32::from(self.face.glyph_hor_advance(glyph).unwrap_or(0));
            last = Some(glyph);
        }
        across
    }

    /// How much farther right a letter stands after another, in units of the font.
    fn kerning(&self, left: GlyphId, right: GlyphId) -> f32 {
        for pair in &self.pairs {
            let Some(index) = pair.coverage().get(left) else { continue };
            let found = match pair {
                PairAdjustment::Format1 { sets, .. } => sets.get(index).and_then(|set| set.get(right)),
                PairAdjustment::Format2 { classes, matrix, .. } => {
                    matrix.get((classes.0.get(left), classes.1.get(right)))
                }
            };
            if let Some((first, _)) = found {
                return f32::from(first.x_advance);
            }
        }
        0.0
    }
}

/// Draws the outline of a letter where it stands in its line.
struct Pen<'a> {
    path: &'a mut PathBuilder,
    scale: f32,
    across: f32,
    down: f32,
}

impl Pen<'_> {
    /// Fonts count upwards, pages downwards.
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.across + self.scale * x, self.down - self.scale * y)
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
