//! The charts of a document for the page: curves as numbers, so that its cursor can follow the frames, all others as drawings.

use serde_json::{Value, json};

use crate::analysis::over::Over;
use crate::analysis::recording::Recording;
use crate::error::Result;
use crate::experiment::{Document, Plot, PlotKind};
use crate::output::ResultFile;
use crate::picture::chart::{Axis, Chart, Scale, Series, Stroke, colours, to_svg};
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
    let at = match &plot.kind {
        PlotKind::Curve { x, y } => points_of_frames(result, plot, x, y.as_slice())?,
        _ => Vec::new(),
    };
    Ok(json!({
        "name": plot.name,
        "at": at,
        "title": chart.title,
        "cursor": cursor,
        "x": axis(&chart.x),
        "y": axis(&chart.y),
        "series": series(&chart),
    }))
}

/// Of each curve where its point is in each frame: curves themselves have their points in the order of x.
fn points_of_frames(result: &ResultFile, plot: &Plot, x: &str, series: &[String]) -> Result<Vec<Vec<[f64; 2]>>> {
    let names: Vec<&str> = std::iter::once(x).chain(series.iter().map(String::as_str)).collect();
    let recording = Recording::read(result, &names)?;
    let types = plot.cells.as_ref().map_or_else(|| result.layout().type_names(), |name| vec![name.clone()]);
    let mut all = Vec::new();
    for y in series {
        for kind in &types {
            let means = [x, y].map(|name| recording.series(name, Some(kind), Over::Mean));
            // A system of chemistry may live in the cells of some types only.
            if let [Ok(x), Ok(y)] = means {
                all.push(x.into_iter().zip(y).map(<[f64; 2]>::from).collect());
            }
        }
    }
    Ok(all)
}

fn axis(axis: &Axis) -> Value {
    json!({ "label": axis.label, "log": axis.scale == Scale::Log })
}

fn series(chart: &Chart) -> Vec<Value> {
    // JSON has no NaN: what is no number is null, and a line is broken there.
    let known = chart.series.iter().zip(colours(chart)).map(|(series, colour)| match series {
        Series::Line { label, points, stroke, width, .. } => json!({
            "kind": "line",
            "label": label,
            "points": points,
            "colour": colour.hex(),
            "dashed": *stroke != Stroke::Solid,
            "width": width,
        }),
        Series::Points { label, points, bars, .. } => json!({
            "kind": "points",
            "label": label,
            "points": points,
            "bars": bars,
            "colour": colour.hex(),
        }),
        Series::Band { label, points, .. } => json!({
            "kind": "band",
            "label": label,
            "points": points,
            "colour": colour.hex(),
        }),
        Series::Areas { label, .. } | Series::Tracks { label, .. } => json!({ "kind": "none", "label": label }),
    });
    known.collect()
}
