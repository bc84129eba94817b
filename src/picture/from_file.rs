//! Pictures of a result file: the frames it holds, seen as the experiment asks.

use std::path::{Path, PathBuf};

use super::colour::Colour;
use super::display::Display;
use super::field_view::FieldView;
use super::image::CutOut;
use super::render::Background;
use super::shown::Shown;
use super::stage::Stage;
use super::{Image, plots};
use crate::error::Result;
use crate::experiment::{Document, Picture};
use crate::output::ResultFile;

/// Makes sure that a result has what its pictures are to be coloured by.
///
/// # Errors
/// [`Error::Input`] that lists what there is.
pub fn check_colour(result: &ResultFile, name: &str) -> Result<()> {
    Shown::named(result, name).map(drop)
}

/// Makes sure that a result has the field that its pictures are to show.
///
/// # Errors
/// [`Error::Input`] that lists what there is.
pub fn check_field(result: &ResultFile, picture: &Picture) -> Result<()> {
    FieldView::of(result, picture).map(drop)
}

/// The picture of one instant.
///
/// # Errors
/// A damaged file, or a series to colour by that it does not have.
pub fn still(result: &ResultFile, document: &Document, picture: &Picture) -> Result<Image> {
    still_as(result, document, picture, &Display::default())
}

/// The picture of one instant as a person wants it.
///
/// # Errors
/// As [`still`], and a type to hide that it does not have.
pub fn still_as(result: &ResultFile, document: &Document, picture: &Picture, display: &Display) -> Result<Image> {
    let stage = Stage::new(result, document, picture, display)?;
    stage.still(picture)
}

/// The picture of one instant without what is behind everything.
///
/// # Errors
/// As [`still_as`].
pub fn cut_out(result: &ResultFile, document: &Document, picture: &Picture, display: &Display) -> Result<CutOut> {
    let mut stage = Stage::new(result, document, picture, display)?;
    let mut over = |grey: u8| {
        stage.look.background = Background::plain(Colour([grey; 3]));
        stage.still(picture)
    };
    Ok(CutOut::between(&over(0)?, &over(255)?))
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
    keep: impl FnMut(&Image) -> Result<()>,
) -> Result<()> {
    film_as(result, document, (picture, &Display::default()), frames, keep)
}

/// The same as a person wants it.
///
/// # Errors
/// As [`film`], and a type to hide that it does not have.
pub fn film_as(
    result: &ResultFile,
    document: &Document,
    (picture, display): (&Picture, &Display),
    frames: &[usize],
    mut keep: impl FnMut(&Image) -> Result<()>,
) -> Result<()> {
    let stage = Stage::new(result, document, picture, display)?;
    let mut framing = stage.framing();
    for &frame in frames {
        framing.include(&stage.snapshot(&stage.shot(frame)?));
    }
    for &frame in frames {
        keep(&stage.draw(&stage.shot(frame)?, &framing, picture))?;
    }
    Ok(())
}

/// The path of a file beside a result: `red.h5` and `png` give `red.png`.
pub fn beside(result: &Path, ending: &str) -> PathBuf {
    result.with_extension(ending)
}

/// The paths of what [`make_defaults`] makes for a result of a document.
pub fn default_files(document: &Document, result: &Path) -> Vec<PathBuf> {
    let charts = document.experiment.plot.iter();
    let charts =
        charts.flat_map(|plot| ["svg", "png"].map(|ending| beside(result, &format!("{}.{ending}", plot.name))));
    std::iter::once(beside(result, "png")).chain(charts).collect()
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
