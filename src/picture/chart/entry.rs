//! What the legend of a chart names, and the sample before each name.

use std::fmt::Write;

use super::series::{dashes, write_bar, write_marker};
use super::{Chart, Marker, Series, Stroke};
use crate::picture::colour::Colour;

/// What the legend shows of one series.
pub(super) struct Entry {
    pub label: String,
    shape: Shape,
    colour: Colour,
}

enum Shape {
    Line(Stroke, f64),
    Points(Marker, bool),
    Band,
    Area,
    /// A line and its band under one name.
    LineInBand(Stroke, f64),
}

/// The named series, a line and a band of one name in one entry.
pub(super) fn entries(chart: &Chart, colours: &[Colour]) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for (series, colour) in chart.series.iter().zip(colours) {
        let label = series.label();
        if label.is_empty() {
            continue;
        }
        let shape = match series {
            Series::Line { stroke, width, .. } => Shape::Line(*stroke, *width),
            Series::Points { marker, bars, .. } => Shape::Points(*marker, !bars.is_empty()),
            Series::Band { .. } => Shape::Band,
            Series::Areas { .. } => Shape::Area,
            Series::Tracks { .. } => Shape::Line(Stroke::Solid, 1.6),
        };
        match (entries.iter_mut().find(|entry| entry.label == label), shape) {
            (Some(Entry { shape: known @ Shape::Band, .. }), Shape::Line(stroke, width)) => {
                *known = Shape::LineInBand(stroke, width);
            }
            (Some(Entry { shape: known @ Shape::Line(..), .. }), Shape::Band) => {
                if let Shape::Line(stroke, width) = *known {
                    *known = Shape::LineInBand(stroke, width);
                }
            }
            (_, shape) => entries.push(Entry { label: label.into(), shape, colour: *colour }),
        }
    }
    entries
}

/// Draws the sample of a series in the legend between two x at height `y`.
pub(super) fn write_sample(svg: &mut String, entry: &Entry, left: f64, right: f64, y: f64) {
    let colour = entry.colour.hex();
    if let Shape::Band | Shape::Area | Shape::LineInBand(..) = entry.shape {
        let opacity = if let Shape::Area = entry.shape { 0.5 } else { 0.2 };
        let _ = writeln!(
            svg,
            r#"<rect x="{left:.1}" y="{:.1}" width="{:.1}" height="11" fill="{colour}" fill-opacity="{opacity}"/>"#,
            y - 5.5,
            right - left
        );
    }
    match entry.shape {
        Shape::Line(stroke, width) | Shape::LineInBand(stroke, width) => {
            let dash = dashes(stroke, width);
            let _ = writeln!(
                svg,
                r#"<path d="M{left:.1} {y:.1}H{right:.1}" stroke="{colour}" stroke-width="{width}"{dash}/>"#
            );
        }
        Shape::Points(marker, bar) => {
            let x = 0.5 * (left + right);
            if bar {
                write_bar(svg, x, y - 8.0, y + 8.0, &colour);
            }
            write_marker(svg, marker, x, y, &colour);
        }
        Shape::Band | Shape::Area => {}
    }
}
