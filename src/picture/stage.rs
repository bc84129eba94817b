//! Frames of a result made ready to be drawn: what they show, in which look.

use std::collections::HashMap;

use super::Image;
use super::arrows::LoadArrows;
use super::display::{Display, known};
use super::documented::{clock_of, type_colours};
use super::field_view::FieldView;
use super::from_result::{Framing, Look, Snapshot, Values, picture_of};
use super::instant::frame_at;
use super::joined::{Joint, linked};
use super::quantities::LEAST;
use super::render::{Edges, ScaleBar, Sheet};
use super::shown::{Of, Shown};
use super::ticks::Scale;
use super::tools::gone;
use crate::Vec3;
use crate::error::Result;
use crate::experiment::{Document, OneOrMany, Picture};
use crate::output::{Cell, FibreRow, ResultFile};

/// What one frame gives to a picture.
pub struct Shot {
    cells: Vec<Cell>,
    positions: Vec<[f64; 3]>,
    values: Vec<f64>,
    arrows: Vec<[[f64; 3]; 2]>,
    /// Ends and tensions of fibres, where they are shown.
    fibres: Option<Vec<([[f64; 3]; 2], f64)>>,
    /// Which cells are linked, where that is shown.
    links: Option<Vec<Joint>>,
    field: Option<Sheet>,
    time: f64,
    /// How far obstacles have gone, µm.
    gone: Vec<Vec3>,
}

/// A result and all that its pictures share.
pub struct Stage<'a> {
    result: &'a ResultFile,
    /// How all of them look.
    pub look: Look,
    shown: Shown,
    arrows: LoadArrows,
    /// Whether fibres are shown: the run may have made some.
    fibres: bool,
    /// Whether links between cells are shown: contacts may have made some.
    links: bool,
    field: Option<FieldView>,
    times: Vec<f64>,
    /// When the run was to end, s.
    until: f64,
    /// Which types of cells are shown.
    types: Vec<bool>,
    /// The first cell of each type where there is one in the first frame, µm.
    rest: Vec<Vec<[f64; 3]>>,
    /// How far each obstacle has gone in each frame, µm; nothing of what stands.
    gone: Vec<Vec<Vec3>>,
}

impl<'a> Stage<'a> {
    /// Of a result, as its document, its picture and a person want it.
    pub fn new(result: &'a ResultFile, document: &Document, picture: &Picture, display: &Display) -> Result<Self> {
        let shown = Shown::named(result, &picture.colour_by)?;
        let types = display.shown(&result.layout().type_names())?;
        let mut look = dressed(look_of(result, document, picture, &shown), display);
        look.unnamed = (0..types.len()).filter(|kind| !types[*kind]).collect();
        look.marked = numbers_of(&picture.marks, &result.layout().type_names())?;
        let field = FieldView::of(result, picture)?;
        look.field_range = picture.field_range;
        look.field_scale = if picture.field_log { Scale::Log } else { Scale::Linear };
        look.field_label = field.as_ref().map_or_else(String::new, FieldView::label);
        let arrows = if picture.loads { LoadArrows::of(document)? } else { LoadArrows::default() };
        let until = document.experiment.run.until.value();
        let fibres = picture.fibres && result.layout().fibres;
        let links = picture.links && result.layout().linked;
        Ok(Self {
            result,
            look,
            shown,
            arrows,
            fibres,
            links,
            field,
            times: result.times()?,
            until,
            types,
            rest: first_of_types(result)?,
            gone: result.layout().obstacles.iter().map(|obstacle| gone(result, obstacle)).collect::<Result<_>>()?,
        })
    }

    /// Nothing seen yet; times are told in the unit that suits the whole run, whichever frames are drawn.
    pub fn framing(&self) -> Framing {
        Framing::new(&self.look).lasting(self.until)
    }

    /// What a frame shows.
    pub fn shot(&self, frame: usize) -> Result<Shot> {
        let (cells, positions) = (self.result.cells(frame), self.result.positions(frame)?);
        let values = self.shown.values(self.result, frame, &positions)?;
        let time = self.times[frame];
        // The height of a slice is that of all cells, seen or not.
        let field = self.field.as_ref().map(|field| field.sheet(self.result, frame, &positions)).transpose()?;
        let (cells, positions, values) = self.seen(cells, positions, values);
        let arrows = self.arrows.at(time, self.result.layout(), &cells, &positions);
        let fibres = self.fibres.then(|| self.fibres_at(frame, &cells, &positions)).transpose()?;
        let links = self.links.then(|| linked(self.result, frame, &cells, &positions)).transpose()?;
        let gone = self.gone.iter().map(|gone| gone.get(frame).copied().unwrap_or_else(Vec3::zeros)).collect();
        Ok(Shot { cells, positions, values, arrows, fibres, links, field, time, gone })
    }

    /// What is left of a frame without the cells that are hidden.
    fn seen(
        &self,
        cells: Vec<Cell>,
        positions: Vec<[f64; 3]>,
        values: Vec<f64>,
    ) -> (Vec<Cell>, Vec<[f64; 3]>, Vec<f64>) {
        if self.types.iter().all(|shown| *shown) {
            return (cells, positions, values);
        }
        let of_atoms = self.shown.of() == Of::Atoms;
        let (mut left, mut at, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
        for (number, (cell, atoms)) in cells.iter().zip(self.result.layout().atoms_of(&cells)).enumerate() {
            if self.types[cell.kind as usize] {
                left.push(*cell);
                at.extend_from_slice(&positions[atoms.clone()]);
                let own = if of_atoms { atoms } else { number..number + 1 };
                numbers.extend_from_slice(values.get(own).unwrap_or_default());
            }
        }
        (left, at, numbers)
    }

    /// The ends and tensions of the fibres of a frame.
    fn fibres_at(&self, frame: usize, cells: &[Cell], positions: &[[f64; 3]]) -> Result<Vec<([[f64; 3]; 2], f64)>> {
        let firsts = cells.iter().zip(self.result.layout().atoms_of(cells)).map(|(cell, atoms)| (cell.id, atoms.start));
        let firsts: HashMap<u64, usize> = firsts.collect();
        let ends = |fibre: FibreRow| {
            let first = firsts.get(&fibre.cell)?;
            Some((fibre.atoms.map(|atom| positions[first + atom as usize]), fibre.tension))
        };
        Ok(self.result.fibres(frame)?.into_iter().filter_map(ends).collect())
    }

    /// The same as what is drawn.
    pub fn snapshot<'b>(&'b self, shot: &'b Shot) -> Snapshot<'b> {
        let values = match self.shown.of() {
            Of::Types => Values::Type,
            Of::Atoms => Values::Atoms(&shot.values),
            Of::Cells => Values::Cells(&shot.values),
        };
        let layout = self.result.layout();
        let (cells, positions, arrows, field) = (&shot.cells, &shot.positions, &shot.arrows, shot.field.as_ref());
        let (fibres, links) = (shot.fibres.as_deref(), shot.links.as_deref());
        let (rest, gone) = (&self.rest, &shot.gone);
        Snapshot { layout, cells, positions, time: shot.time, values, arrows, fibres, links, field, rest, gone }
    }

    /// The picture of the instant that is asked for, alone.
    pub fn still(&self, picture: &Picture) -> Result<Image> {
        let shot = self.shot(frame_at(self.result, picture.time)?)?;
        let mut framing = self.framing();
        framing.include(&self.snapshot(&shot));
        Ok(self.draw(&shot, &framing, picture))
    }

    /// The picture of a frame, framed together with others.
    pub fn draw(&self, shot: &Shot, framing: &Framing, picture: &Picture) -> Image {
        picture_of(&self.snapshot(shot), &self.look, framing, picture.width as usize, picture.height as usize)
    }
}

fn look_of(result: &ResultFile, document: &Document, picture: &Picture, shown: &Shown) -> Look {
    Look {
        title: document.experiment.title.clone(),
        type_colours: type_colours(result, document),
        clock: clock_of(document),
        range: picture.colour_range,
        least: if matches!(shown, Shown::Atoms(_)) { LEAST } else { 0.0 },
        label: shown.label(result),
        direction: picture.view.from,
        up: picture.view.up,
        cut: picture.cut.map(|cut| cut.value()),
        ..Look::default()
    }
}

/// The atoms of one cell of each type in the first frame, µm; none where there is no such cell.
fn first_of_types(result: &ResultFile) -> Result<Vec<Vec<[f64; 3]>>> {
    let mut rest = vec![Vec::new(); result.layout().types.len()];
    if result.frames() > 0 {
        let (cells, positions) = (result.cells(0), result.positions(0)?);
        for (cell, atoms) in cells.iter().zip(result.layout().atoms_of(&cells)) {
            let known: &mut Vec<[f64; 3]> = &mut rest[cell.kind as usize];
            if known.is_empty() {
                known.extend_from_slice(&positions[atoms]);
            }
        }
    }
    Ok(rest)
}

/// The numbers of types by their names.
///
/// # Errors
/// [`crate::error::Error::Input`] for one that is none of them.
fn numbers_of(names: &Option<OneOrMany<String>>, types: &[String]) -> Result<Vec<usize>> {
    let names = names.as_ref().map_or(&[][..], OneOrMany::as_slice);
    names.iter().try_for_each(|name| known(name, types))?;
    Ok((0..types.len()).filter(|kind| names.contains(&types[*kind])).collect())
}

/// A look with what a person wants of it.
fn dressed(look: Look, display: &Display) -> Look {
    Look {
        title: display.title.clone().unwrap_or(look.title),
        label: display.label.clone().unwrap_or(look.label),
        zoom: display.zoom,
        scale_bar: if display.scale_bar { look.scale_bar } else { ScaleBar::Hidden },
        time: display.time,
        axes: display.axes,
        edges: if display.edges { Edges::Thin } else { look.edges },
        ..look
    }
}
