//! How the pictures of a run look.

use super::colour::{Colour, ColourMap};
use super::render::{Background, ClockUnit, Edges, Projection, ScaleBar};
use super::ticks::Scale;

/// How the pictures of a run look.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// Top left; empty for none.
    pub title: String,
    /// Colours of the types; a missing one comes from the palette.
    pub type_colours: Vec<Colour>,
    /// Colours of numbers.
    pub map: ColourMap,
    /// Lowest and highest number of the colour bar; `None` takes them from the frames that were included.
    pub range: Option<[f64; 2]>,
    /// The least difference between numbers that is more than round-off, besides a millionth of their size.
    pub least: f64,
    /// Name of the numbers with unit.
    pub label: String,
    /// Colours of a field.
    pub field_map: ColourMap,
    /// Lowest and highest number of the field's colour bar; `None` takes them from the frames that were included.
    pub field_range: Option<[f64; 2]>,
    /// How values of a field are spaced along its colours.
    pub field_scale: Scale,
    /// Name of the field with unit.
    pub field_label: String,
    /// The unit of times; that which suits the run when absent.
    pub clock: Option<ClockUnit>,
    /// Whether the edges of facets are drawn.
    pub edges: Edges,
    /// How much skins hide, 0 to 1; `None` lets them be translucent where there are links inside.
    pub opacity: Option<f32>,
    /// How far before the middle of the cells things are cut off, µm; `None` for not at all.
    pub cut: Option<f64>,
    /// From the scene towards the camera; only the direction counts.
    pub direction: [f64; 3],
    /// The direction that is up in the picture.
    pub up: [f64; 3],
    /// Parallel or perspective; the height of a parallel projection is fitted.
    pub projection: Projection,
    /// The scale bar.
    pub scale_bar: ScaleBar,
    /// Whether the time is written.
    pub time: bool,
    /// Whether it is shown which way x, y and z go.
    pub axes: bool,
    /// How much larger things are than where all of them just fit in.
    pub zoom: f64,
    /// Numbers of types that are painted in two tones, so that they are seen to turn.
    pub marked: Vec<usize>,
    /// What is behind everything.
    pub background: Background,
    /// Numbers of types that have no entry in the legend.
    pub unnamed: Vec<usize>,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            title: String::new(),
            type_colours: Vec::new(),
            map: ColourMap::default(),
            range: None,
            least: 0.0,
            label: String::new(),
            field_map: ColourMap::Ink,
            field_range: None,
            field_scale: Scale::Linear,
            field_label: String::new(),
            clock: None,
            edges: Edges::Hidden,
            opacity: None,
            cut: None,
            direction: [0.35, -1.0, 0.75],
            up: [0.0, 0.0, 1.0],
            projection: Projection::Orthographic { height: 1.0 },
            scale_bar: ScaleBar::Auto,
            time: true,
            axes: true,
            zoom: 1.0,
            marked: Vec::new(),
            background: Background::default(),
            unnamed: Vec::new(),
        }
    }
}
