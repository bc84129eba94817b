//! Pictures of a result file: the frames it holds, seen as the experiment asks.

use std::path::{Path, PathBuf};

use super::colour::Colour;
use super::from_result::{Framing, Look, Snapshot, Values, picture_of};
use super::{Image, plots};
use crate::error::Result;
use crate::experiment::{Document, Picture, When};
use crate::output::ResultFile;

/// What one frame gives to a picture.
struct Shot {
    positions: Vec<[f64; 3]>,
    values: Vec<f64>,
    time: f64,
}

/// The frame that an instant means.
fn frame_at(result: &ResultFile, when: When) -> Result<usize> {
    let last = result.frames().saturating_sub(1);
    Ok(match when {
        When::First => 0,
        When::Last => last,
        When::At(time) => {
            let away = |t: &f64| (t - time.value()).abs();
            let times = result.times()?;
            (0..times.len()).min_by(|&a, &b| away(&times[a]).total_cmp(&away(&times[b]))).unwrap_or(last)
        }
    })
}

fn shot(result: &ResultFile, picture: &Picture, frame: usize) -> Result<Shot> {
    let values = if picture.colour_by == "type" {
        Vec::new()
    } else {
        result.cell_series(&picture.colour_by)?.row(frame).to_vec()
    };
    Ok(Shot { positions: result.positions(frame)?, values, time: result.times()?[frame] })
}

fn look_of(result: &ResultFile, document: &Document, picture: &Picture) -> Result<Look> {
    let types = &result.layout().types;
    let palette = |i: usize| super::colour::PALETTE[i % super::colour::PALETTE.len()];
    let colour = |(i, name): (usize, &String)| {
        let given = document.experiment.cells.get(name).and_then(|cell| cell.colour);
        given.map_or_else(|| palette(i), |colour| Colour(colour.0))
    };
    let label = if picture.colour_by == "type" { String::new() } else { plots::label_of(result, &picture.colour_by) };
    Ok(Look {
        title: document.experiment.title.clone(),
        type_colours: types.iter().enumerate().map(colour).collect(),
        range: picture.colour_range,
        label,
        direction: picture.view.from,
        ..Look::default()
    })
}

fn snapshot<'a>(result: &'a ResultFile, shot: &'a Shot) -> Snapshot<'a> {
    let values = if shot.values.is_empty() { Values::Type } else { Values::Cells(&shot.values) };
    Snapshot { layout: result.layout(), positions: &shot.positions, time: shot.time, values, arrows: &[] }
}

/// The picture of one instant.
///
/// # Errors
/// A damaged file, or a series to colour by that it does not have.
pub fn still(result: &ResultFile, document: &Document, picture: &Picture) -> Result<Image> {
    let look = look_of(result, document, picture)?;
    let shot = shot(result, picture, frame_at(result, picture.time)?)?;
    let mut framing = Framing::new(&look);
    framing.include(&snapshot(result, &shot));
    Ok(picture_of(&snapshot(result, &shot), &look, &framing, picture.width as usize, picture.height as usize))
}

/// Calls `keep` with the picture of every frame that `frames` names, all with the same camera and colours.
///
/// # Errors
/// As [`still`], and whatever `keep` returns.
pub fn film(
    result: &ResultFile,
    document: &Document,
    picture: &Picture,
    frames: &[usize],
    mut keep: impl FnMut(&Image) -> Result<()>,
) -> Result<()> {
    let look = look_of(result, document, picture)?;
    let mut framing = Framing::new(&look);
    for &frame in frames {
        framing.include(&snapshot(result, &shot(result, picture, frame)?));
    }
    for &frame in frames {
        let shot = shot(result, picture, frame)?;
        keep(&picture_of(&snapshot(result, &shot), &look, &framing, picture.width as usize, picture.height as usize))?;
    }
    Ok(())
}

/// The path of a file beside a result: `red.h5` and `png` give `red.png`.
pub fn beside(result: &Path, ending: &str) -> PathBuf {
    result.with_extension(ending)
}

/// Makes the picture and the charts that the experiment of a result asks for, beside it; returns their paths.
///
/// # Errors
/// As [`still`] and [`plots::chart_of`]; [`crate::error::Error::Machine`] when a file cannot be written.
pub fn make_defaults(path: &Path) -> Result<Vec<PathBuf>> {
    let result = ResultFile::open(path)?;
    let document = crate::run::document_of(result.header(), path)?;
    let picture = beside(path, "png");
    still(&result, &document, &document.experiment.picture)?.save_png(&picture)?;
    let mut made = vec![picture];
    for plot in &document.experiment.plot {
        let chart = plots::chart_of(&result, &document, plot)?;
        made.extend(super::chart::save_chart(&chart, &beside(path, &plot.name))?);
    }
    Ok(made)
}
