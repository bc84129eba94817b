//! The charts of a document for the page: curves as numbers, so that its cursor can follow the frames, all others as drawings.

use serde_json::{Value, json};

use crate::error::Result;
use crate::experiment::{Document, Plot, PlotKind};
use crate::output::ResultFile;
use crate::picture::chart::{Axis, Chart, Scale, Series, Stroke, to_svg};
use crate::picture::plots::chart_of;

/// Size of the drawings.
const SIZE: [f64; 2] = [560.0, 380.0];

/// The chart of a plot. Where its x is the time the cursor is at the time of the frame, on a curve of one series over another at the
/// point of the frame.
///
/// # Errors
/// As [`chart_of`].
pub fn chart(result: &ResultFile, document: &Document, plot: &Plot) -> Result<Value> {
    let mut chart = chart_of(result, document, plot)?;
    let cursor = match &plot.kind {
        PlotKind::Series { .. } => Some("time"),
        PlotKind::Curve { .. } => Some("frame"),
        _ => None,
    };
    let Some(cursor) = cursor else {
        let title = std::mem::take(&mut chart.title);
        let svg = to_svg(&chart, SIZE[0], SIZE[1]);
        return Ok(json!({ "name": plot.name, "title": title, "svg": svg }));
    };
    Ok(json!({
        "name": plot.name,
        "title": chart.title,
        "cursor": cursor,
        "x": axis(&chart.x),
        "y": axis(&chart.y),
        "series": series(&chart),
    }))
}

fn axis(axis: &Axis) -> Value {
    json!({ "label": axis.label, "log": axis.scale == Scale::Log })
}

fn series(chart: &Chart) -> Vec<Value> {
    // JSON has no NaN: what is no number is null, and a line is broken there.
    let known = chart.series.iter().map(|series| match series {
        Series::Line { label, points, colour, stroke, width } => json!({
            "kind": "line",
            "label": label,
            "points": points,
            "colour": colour.map(|colour| colour.hex()),
            "dashed": *stroke != Stroke::Solid,
            "width": width,
        }),
        Series::Points { label, points, bars, colour, .. } => json!({
            "kind": "points",
            "label": label,
            "points": points,
            "bars": bars,
            "colour": colour.map(|colour| colour.hex()),
        }),
        Series::Band { label, points, colour } => json!({
            "kind": "band",
            "label": label,
            "points": points,
            "colour": colour.map(|colour| colour.hex()),
        }),
        Series::Areas { label, .. } | Series::Tracks { label, .. } => json!({ "kind": "none", "label": label }),
    });
    known.collect()
}
