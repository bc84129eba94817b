//! Charts of measured and simulated numbers: curves, points with error bars, bands and tracks, as SVG and PNG.
//!
//! A [`Chart`] says what is shown; [`to_svg`] decides ranges, marks and the position of the legend so that labels do not
//! meet and data stay visible. Values that are not finite, or not positive on a logarithmic axis, are left out, and
//! a line is broken there.

mod draw;
mod entry;
mod frame;
mod heat;
mod legend;
mod polar;
mod series;
mod stacked;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use super::colour::Colour;
use super::image::write_file;
use super::svg::svg_to_pixels;
use crate::error::Result;

pub use super::ticks::Scale;
pub use draw::{colours, to_svg};
pub use heat::{Heat, Shading};
pub use stacked::save_stacked;

/// One chart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Chart {
    /// Line above the chart; empty for none.
    pub title: String,
    /// The axis along the bottom.
    pub x: Axis,
    /// The axis along the left side.
    pub y: Axis,
    /// What is drawn, later series over earlier ones.
    pub series: Vec<Series>,
    /// Numbers as colours over the whole area, below the series.
    pub heat: Option<Heat>,
    /// Where the names of the series stand.
    pub legend: Legend,
    /// How lengths along x and y relate.
    pub aspect: Aspect,
    /// What the data are drawn on.
    pub ground: Ground,
}

/// One axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Name with unit, e.g. `Diameter (µm)`.
    pub label: String,
    /// From where to where.
    pub range: Range,
    /// How values are spaced.
    pub scale: Scale,
    /// Marks with words in place of round numbers, as many as there is space for; empty for round numbers.
    pub names: Vec<(f64, String)>,
}

/// From where to where an axis goes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Range {
    /// From the data, widened to round numbers.
    #[default]
    Auto,
    /// As [`Range::Auto`], and zero is shown too (linear axes only).
    FromZero,
    /// These ends, in the axis' unit.
    Fixed(f64, f64),
}

/// How lengths along x and y relate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Aspect {
    /// Both axes fill the chart.
    #[default]
    Free,
    /// One unit is as long along x as along y, for maps and tracks (linear axes only).
    Equal,
}

/// What the data are drawn on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Ground {
    /// A frame with two axes.
    #[default]
    Frame,
    /// Rings about the origin and spokes, for directions; with equal aspect and ranges about the origin.
    Polar {
        /// Radius of the outermost ring, in the unit of the axes.
        radius: f64,
    },
}

/// Where the names of the series stand. Series without a label have none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Legend {
    /// In the corner where it covers no data, or right of the chart when there is none.
    #[default]
    Auto,
    /// In this corner.
    At(Corner),
    /// Right of the chart.
    Beside,
    /// Not shown.
    Hidden,
}

/// A corner of the chart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Top left.
    TopLeft,
    /// Top right.
    TopRight,
    /// Bottom left.
    BottomLeft,
    /// Bottom right.
    BottomRight,
}

/// Something drawn from data. A colour of `None` takes the next of the palette.
#[derive(Debug, Clone, PartialEq)]
pub enum Series {
    /// A curve through points `[x, y]`.
    Line {
        /// Name in the legend; empty for none.
        label: String,
        /// Points in the order they are joined.
        points: Vec<[f64; 2]>,
        /// Colour.
        colour: Option<Colour>,
        /// Solid or dashed.
        stroke: Stroke,
        /// Width, px.
        width: f64,
    },
    /// Separate points, with error bars if given.
    Points {
        /// Name in the legend; empty for none.
        label: String,
        /// Points `[x, y]`.
        points: Vec<[f64; 2]>,
        /// Lower and upper end of the error bar of each point, as values of y; empty for none.
        bars: Vec<[f64; 2]>,
        /// Colour.
        colour: Option<Colour>,
        /// Shape.
        marker: Marker,
    },
    /// A shaded area between two curves, `[x, lower y, upper y]`.
    Band {
        /// Name in the legend; empty for none.
        label: String,
        /// Its borders.
        points: Vec<[f64; 3]>,
        /// Colour; drawn faint.
        colour: Option<Colour>,
    },
    /// Areas with an outline each: columns of a histogram, sectors of a rose.
    Areas {
        /// Name in the legend; empty for none.
        label: String,
        /// The corners of each, in order.
        outlines: Vec<Vec<[f64; 2]>>,
        /// Colour; areas of several series show through each other.
        colour: Option<Colour>,
    },
    /// The paths of many cells, each with a dot at its end.
    Tracks {
        /// Name in the legend; empty for none.
        label: String,
        /// One list of points `[x, y]` per cell.
        tracks: Vec<Vec<[f64; 2]>>,
        /// One colour for all; `None` gives every track its own.
        colour: Option<Colour>,
    },
}

/// How a curve is stroked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stroke {
    /// Unbroken.
    #[default]
    Solid,
    /// Dashes.
    Dashed,
    /// Dots.
    Dotted,
}

/// The shape of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Marker {
    /// A filled disc.
    #[default]
    Disc,
    /// A circle, white inside.
    Circle,
    /// A filled square.
    Square,
    /// A diamond, white inside.
    Diamond,
    /// A filled triangle.
    Triangle,
}

impl Axis {
    /// A linear axis over the range of the data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// A logarithmic axis over the range of the data.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log, ..Self::default() }
    }

    /// An axis with words at 0, 1, 2 and so on, which stand in the middle of boxes of length 1.
    pub fn named(label: impl Into<String>, names: impl IntoIterator<Item = String>) -> Self {
        let names: Vec<(f64, String)> = names.into_iter().enumerate().map(|(at, name)| (at as f64, name)).collect();
        let range = Range::Fixed(-0.5, names.len().max(1) as f64 - 0.5);
        Self { names, range, ..Self::linear(label) }
    }

    /// The same axis over another range.
    pub fn range(self, range: Range) -> Self {
        Self { range, ..self }
    }
}

impl Series {
    /// A solid curve.
    pub fn line(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::Line { label: label.into(), points, colour: None, stroke: Stroke::Solid, width: 2.2 }
    }

    /// A thin dashed curve, for theory and guides.
    pub fn dashed(label: impl Into<String>, points: Vec<[f64; 2]>) -> Self {
        Self::Line { label: label.into(), points, colour: None, stroke: Stroke::Dashed, width: 1.6 }
    }

    /// Measured points, `bars` with the lower and upper end of every error bar or empty.
    pub fn measured(label: impl Into<String>, points: Vec<[f64; 2]>, bars: Vec<[f64; 2]>) -> Self {
        Self::Points { label: label.into(), points, bars, colour: None, marker: Marker::Disc }
    }

    /// A shaded area, `[x, lower, upper]`.
    pub fn band(label: impl Into<String>, points: Vec<[f64; 3]>) -> Self {
        Self::Band { label: label.into(), points, colour: None }
    }

    /// Paths of cells, each in its own colour.
    pub fn tracks(tracks: Vec<Vec<[f64; 2]>>) -> Self {
        Self::Tracks { label: String::new(), tracks, colour: None }
    }

    /// The same series in a colour of choice.
    pub fn coloured(mut self, wish: Colour) -> Self {
        let (Self::Line { colour, .. }
        | Self::Points { colour, .. }
        | Self::Band { colour, .. }
        | Self::Areas { colour, .. }
        | Self::Tracks { colour, .. }) = &mut self;
        *colour = Some(wish);
        self
    }

    /// The same points with another shape; other series stay as they are.
    pub fn marked(mut self, shape: Marker) -> Self {
        if let Self::Points { marker, .. } = &mut self {
            *marker = shape;
        }
        self
    }

    /// Name in the legend; empty when it has none.
    pub fn label(&self) -> &str {
        match self {
            Self::Line { label, .. }
            | Self::Points { label, .. }
            | Self::Band { label, .. }
            | Self::Areas { label, .. }
            | Self::Tracks { label, .. } => label,
        }
    }
}

/// The bytes of a PNG picture of a drawing that [`to_svg`] made, `scale` pixels for each of its units, on white. Other SVG is
/// drawn as far as it is made of the same elements.
///
/// # Errors
/// When the text is not SVG or its size is zero or enormous.
pub fn svg_to_png(svg: &str, scale: f32) -> Result<Vec<u8>> {
    svg_to_image(svg, scale)?.to_png()
}

/// The same as pixels.
fn svg_to_image(svg: &str, scale: f32) -> Result<super::Image> {
    let mut pixels = svg_to_pixels(svg, scale)?;
    let mut image = super::Image::filled(pixels.width() as usize, pixels.height() as usize, Colour([255; 3]));
    image.lay_over(pixels.data_mut());
    Ok(image)
}

/// Writes the chart as `path.svg` and `path.png` (720 × 480, the PNG with twice as many pixels; square charts for equal
/// aspect, 860 × 600 for rings) and returns both paths.
///
/// # Errors
/// When a file cannot be written.
pub fn save_chart(chart: &Chart, path_without_extension: &Path) -> Result<Vec<PathBuf>> {
    let (width, height) = match (chart.ground, chart.aspect) {
        // Beside the rings there is space for the legend, which would cover them.
        (Ground::Polar { .. }, _) => (860.0, 600.0),
        (_, Aspect::Equal) => (600.0, 600.0),
        _ => (720.0, 480.0),
    };
    let svg = to_svg(chart, width, height);
    let with = |extension: &str| {
        let mut name = path_without_extension.as_os_str().to_owned();
        name.push(extension);
        PathBuf::from(name)
    };
    let paths = vec![with(".svg"), with(".png")];
    write_file(&paths[0], svg.as_bytes())?;
    write_file(&paths[1], &draw::to_image(chart, &svg, [width, height], 2.0)?.to_png()?)?;
    Ok(paths)
}
