//! Pictures of a result file: the frames it holds, seen as the experiment asks.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use super::arrows::LoadArrows;
use super::colour::Colour;
use super::field_view::FieldView;
use super::from_result::{Framing, Look, Snapshot, Values, picture_of};
use super::instant::frame_at;
use super::render::Sheet;
use super::shown::{Of, Shown};
use super::{Image, plots};
use crate::Vec3;
use crate::error::Result;
use crate::experiment::{Document, Picture};
use crate::output::{Cell, FibreRow, Obstacle, ResultFile};

/// What one frame gives to a picture.
struct Shot {
    cells: Vec<Cell>,
    positions: Vec<[f64; 3]>,
    values: Vec<f64>,
    arrows: Vec<[[f64; 3]; 2]>,
    /// Ends and tensions of fibres, where they are shown.
    fibres: Option<Vec<([[f64; 3]; 2], f64)>>,
    field: Option<Sheet>,
    time: f64,
    /// How far obstacles have gone, µm.
    gone: Vec<Vec3>,
}

/// A result and all that its pictures share.
struct Stage<'a> {
    result: &'a ResultFile,
    look: Look,
    shown: Shown,
    arrows: LoadArrows,
    /// Whether fibres are shown: the run may have made some.
    fibres: bool,
    field: Option<FieldView>,
    times: Vec<f64>,
    /// When the run was to end, s.
    until: f64,
}

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

impl<'a> Stage<'a> {
    fn new(result: &'a ResultFile, document: &Document, picture: &Picture) -> Result<Self> {
        let shown = Shown::named(result, &picture.colour_by)?;
        let mut look = look_of(result, document, picture, &shown);
        let field = FieldView::of(result, picture)?;
        look.field_range = picture.field_range;
        look.field_label = field.as_ref().map_or_else(String::new, FieldView::label);
        let arrows = if picture.loads { LoadArrows::of(document)? } else { LoadArrows::default() };
        let until = document.experiment.run.until.value();
        let fibres = picture.fibres && result.layout().fibres;
        Ok(Self { result, look, shown, arrows, fibres, field, times: result.times()?, until })
    }

    /// Nothing seen yet; times are told in the unit that suits the whole run, whichever frames are drawn.
    fn framing(&self) -> Framing {
        Framing::new(&self.look).lasting(self.until)
    }

    fn shot(&self, frame: usize) -> Result<Shot> {
        let (cells, positions) = (self.result.cells(frame), self.result.positions(frame)?);
        let values = self.shown.values(self.result, frame, &positions)?;
        let time = self.times[frame];
        let field = self.field.as_ref().map(|field| field.sheet(self.result, frame, &positions)).transpose()?;
        let arrows = self.arrows.at(time, self.result.layout(), &cells, &positions);
        let fibres = self.fibres.then(|| self.fibres_at(frame, &cells, &positions)).transpose()?;
        let gone = self.result.layout().obstacles.iter().map(|obstacle| self.gone(obstacle, frame));
        let gone = gone.collect::<Result<_>>()?;
        Ok(Shot { cells, positions, values, arrows, fibres, field, time, gone })
    }

    /// How far an obstacle has gone, µm.
    fn gone(&self, obstacle: &Obstacle, frame: usize) -> Result<Vec3> {
        let direction = Vec3::from(obstacle.direction);
        if direction == Vec3::zeros() {
            return Ok(direction);
        }
        let displacement = self.result.scene_series(&format!("tool_displacement.{}", obstacle.name))?;
        Ok(displacement.get(frame).copied().unwrap_or(0.0) * direction)
    }

    /// The ends and tensions of the fibres of a frame.
    fn fibres_at(&self, frame: usize, cells: &[Cell], positions: &[[f64; 3]]) -> Result<Vec<([[f64; 3]; 2], f64)>> {
        let firsts = cells.iter().zip(self.result.layout().atoms_of(cells)).map(|(cell, atoms)| (cell.id, atoms.start));
        let firsts: HashMap<u64, usize> = firsts.collect();
        let ends = |fibre: FibreRow| {
            let ends = fibre.atoms.map(|atom| positions[firsts[&fibre.cell] + atom as usize]);
            (ends, fibre.tension)
        };
        Ok(self.result.fibres(frame)?.into_iter().map(ends).collect())
    }

    fn snapshot<'b>(&'b self, shot: &'b Shot) -> Snapshot<'b> {
        let values = match self.shown.of() {
            Of::Types => Values::Type,
            Of::Atoms => Values::Atoms(&shot.values),
            Of::Cells => Values::Cells(&shot.values),
        };
        let layout = self.result.layout();
        let (cells, positions, arrows, field) = (&shot.cells, &shot.positions, &shot.arrows, shot.field.as_ref());
        let fibres = shot.fibres.as_deref();
        Snapshot { layout, cells, positions, time: shot.time, values, arrows, fibres, field, gone: &shot.gone }
    }

    fn draw(&self, shot: &Shot, framing: &Framing, picture: &Picture) -> Image {
        picture_of(&self.snapshot(shot), &self.look, framing, picture.width as usize, picture.height as usize)
    }
}

fn look_of(result: &ResultFile, document: &Document, picture: &Picture, shown: &Shown) -> Look {
    Look {
        title: document.experiment.title.clone(),
        type_colours: type_colours(result, document),
        range: picture.colour_range,
        label: shown.label(result),
        direction: picture.view.from,
        up: picture.view.up,
        cut: picture.cut.map(|cut| cut.value()),
        ..Look::default()
    }
}

/// The colours of the types of cells of a result: those of its document, else of the palette.
pub fn type_colours(result: &ResultFile, document: &Document) -> Vec<Colour> {
    let given = |name: &String| document.experiment.cells.get(name).and_then(|cell| cell.colour);
    let types = result.layout().type_names();
    let colour = |(i, name)| given(name).map_or_else(|| Colour::of_palette(i), |colour| Colour(colour.0));
    types.iter().enumerate().map(colour).collect()
}

/// The picture of one instant.
///
/// # Errors
/// A damaged file, or a series to colour by that it does not have.
pub fn still(result: &ResultFile, document: &Document, picture: &Picture) -> Result<Image> {
    let stage = Stage::new(result, document, picture)?;
    let shot = stage.shot(frame_at(result, picture.time)?)?;
    let mut framing = stage.framing();
    framing.include(&stage.snapshot(&shot));
    Ok(stage.draw(&shot, &framing, picture))
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
    let stage = Stage::new(result, document, picture)?;
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
