//! A result as a page asks for it: each request is a path such as `frame/12`, each answer some bytes.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError, RwLock};

use serde_json::{Value, json};

use super::pack::{self, Box3};
use super::{charts, describe};
use crate::Vec3;
use crate::error::Result;
use crate::experiment::Document;
use crate::output::ResultFile;
use crate::picture::arrows::LoadArrows;
use crate::picture::joined;
use crate::picture::plots::label_of;
use crate::picture::shown::{Of, Shown};

/// Frames that are looked at for the ends of a scale of colours.
const LOOKED_AT: usize = 24;

/// The strongest traction is drawn as long as this share of a typical cell.
const TRACTION_LENGTH: f64 = 0.35;

/// What a request is answered with.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// JSON.
    Text(String),
    /// Numbers, see [`pack`].
    Bytes(Vec<u8>),
}

impl Answer {
    /// The bytes of either.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Text(text) => text.as_bytes(),
            Self::Bytes(bytes) => bytes,
        }
    }
}

/// A result that answers requests.
pub struct Scene {
    path: PathBuf,
    document: Document,
    result: RwLock<ResultFile>,
    /// Ends of scales that were asked for, with the number of frames that they are of.
    ranges: Mutex<HashMap<String, (usize, [f64; 2])>>,
    loads: Mutex<Option<LoadArrows>>,
    /// The box that all frames are told in; each its own when absent.
    pub(super) within: Option<Box3>,
}

impl Scene {
    /// Opens a result, which may still grow.
    ///
    /// # Errors
    /// As [`ResultFile::open`].
    pub fn open(path: &Path) -> Result<Self> {
        let result = ResultFile::open(path)?;
        let document = crate::run::recorded_document_of(result.header(), path)?;
        let (ranges, loads) = (Mutex::default(), Mutex::default());
        Ok(Self { path: path.to_path_buf(), document, result: RwLock::new(result), ranges, loads, within: None })
    }

    /// Where the result is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Does something with the result as it is now.
    pub fn with_result<T>(&self, look: impl FnOnce(&ResultFile) -> T) -> T {
        look(&self.result.read().unwrap_or_else(PoisonError::into_inner))
    }

    /// The document of the result.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Takes in what a run has added; returns the number of frames and whether more may come.
    ///
    /// # Errors
    /// A damaged file.
    pub fn renew(&self) -> Result<(usize, bool)> {
        let newer = ResultFile::open(&self.path)?;
        let told = (newer.frames(), newer.ending().running);
        *self.result.write().unwrap_or_else(PoisonError::into_inner) = newer;
        Ok(told)
    }

    /// The answer to a request; none where there is no such thing.
    ///
    /// # Errors
    /// A damaged file.
    pub fn answer(&self, request: &str) -> Result<Option<Answer>> {
        let parts: Vec<&str> = request.split('/').collect();
        self.with_result(|result| {
            let frame = |text: &str| text.parse().ok().filter(|frame: &usize| *frame < result.frames());
            let bytes = |bytes: Vec<u8>| Ok(Some(Answer::Bytes(bytes)));
            let text = |value: Value| Ok(Some(Answer::Text(value.to_string())));
            match parts[..] {
                ["scene"] => text(describe::scene(result, &self.document)?),
                ["course"] => text(describe::course(result)?),
                ["chart", name] => match self.document.experiment.plot.iter().find(|plot| plot.name == name) {
                    Some(plot) => text(charts::chart(result, &self.document, plot).unwrap_or_else(|fault| {
                        // What a run that goes on has not yet enough of is told where its chart will be.
                        json!({ "name": name, "fault": fault.to_string() })
                    })),
                    None => Ok(None),
                },
                ["range", name] => self.range(result, name)?.map_or(Ok(None), |ends| text(json!(ends))),
                ["curve", name] => curve(result, name, None)?.map_or(Ok(None), text),
                ["curve", name, id] => match id.parse().ok().and_then(|id| result.column_of(id)) {
                    Some(column) => curve(result, name, Some(column as usize))?.map_or(Ok(None), text),
                    None => Ok(None),
                },
                [what, number, ref rest @ ..] => match (what, frame(number), rest) {
                    ("frame", Some(frame), []) => {
                        let (cells, positions) = (result.cells(frame), result.positions(frame)?);
                        let within = self.within.unwrap_or_else(|| Box3::around(&positions));
                        bytes(pack::frame(&cells, &positions, &within))
                    }
                    ("values", Some(frame), [name]) => values(result, name, frame)?.map_or(Ok(None), bytes),
                    ("field", Some(frame), [name]) => field(result, name, frame)?.map_or(Ok(None), bytes),
                    ("lines", Some(frame), [kind]) => self.lines(result, kind, frame)?.map_or(Ok(None), bytes),
                    ("cell", Some(frame), [id]) => match id.parse() {
                        Ok(id) => cell(result, id, frame)?.map_or(Ok(None), text),
                        Err(_) => Ok(None),
                    },
                    _ => Ok(None),
                },
                _ => Ok(None),
            }
        })
    }

    /// The lowest and the highest number of a quantity, or of a species of a field, over the frames, of which some stand for all.
    fn range(&self, result: &ResultFile, name: &str) -> Result<Option<[f64; 2]>> {
        let frames = result.frames();
        let known = self.ranges.lock().unwrap_or_else(PoisonError::into_inner).get(name).copied();
        if let Some((_, ends)) = known.filter(|(of, _)| *of == frames) {
            return Ok(Some(ends));
        }
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        let mut include = |values: &[f64]| {
            for value in values.iter().filter(|value| value.is_finite()) {
                ends = [ends[0].min(*value), ends[1].max(*value)];
            }
        };
        let is_field = result.layout().fields.iter().any(|field| name.starts_with(&format!("{}.", field.name)));
        let shown = if is_field { None } else { Shown::named(result, name).ok() };
        if !is_field && shown.is_none() {
            return Ok(None);
        }
        for part in 0..frames.min(LOOKED_AT) {
            let frame = part * (frames - 1) / (frames.min(LOOKED_AT) - 1).max(1);
            match &shown {
                Some(shown) => include(&shown.values(result, frame, &result.positions(frame)?)?),
                None => {
                    let (field, species) = result.field_species(name)?;
                    include(&result.field_frame(&field.name, &field.species[species].0, frame)?);
                }
            }
        }
        let ends = if ends[0] <= ends[1] { ends } else { [0.0, 1.0] };
        self.ranges.lock().unwrap_or_else(PoisonError::into_inner).insert(name.to_owned(), (frames, ends));
        Ok(Some(ends))
    }

    /// Fibres (with what they pull, pN), contacts from centre to centre (with their areas, µm²), cells that are linked (with their links), tractions (pN) or loads.
    fn lines(&self, result: &ResultFile, kind: &str, frame: usize) -> Result<Option<Vec<u8>>> {
        let layout = result.layout();
        let (cells, positions) = (result.cells(frame), result.positions(frame)?);
        let found: Vec<([[f64; 3]; 2], f64)> = match kind {
            "fibres" if layout.fibres => {
                let firsts = cells.iter().zip(layout.atoms_of(&cells)).map(|(cell, atoms)| (cell.id, atoms.start));
                let firsts: HashMap<u64, usize> = firsts.collect();
                let ends = |cell, atoms: [u32; 2]| atoms.map(|atom| positions[firsts[&cell] + atom as usize]);
                result.fibres(frame)?.into_iter().map(|row| (ends(row.cell, row.atoms), row.tension)).collect()
            }
            "contacts" if layout.contacts => joined::touching(result, frame, &cells, &positions)?,
            "linked" if layout.linked => joined::linked(result, frame, &cells, &positions)?,
            "traction" => match result.tractions(frame)? {
                Some(all) => {
                    let strongest = self.range(result, "traction")?.map_or(0.0, |ends| ends[1]);
                    let boxes =
                        layout.atoms_of(&cells).map(|atoms| Vec3::from(Box3::around(&positions[atoms]).sides).norm());
                    let typical = boxes.sum::<f64>() / cells.len().max(1) as f64;
                    tractions(&positions, &all.traction, strongest, TRACTION_LENGTH * typical)
                }
                None => return Ok(None),
            },
            "loads" => {
                let mut loads = self.loads.lock().unwrap_or_else(PoisonError::into_inner);
                if loads.is_none() {
                    // What is not there any more, such as a mesh in a file, leaves the arrows out.
                    *loads = LoadArrows::of(&self.document).ok();
                }
                let time = result.times()?[frame];
                let Some(loads) = loads.as_ref() else { return Ok(None) };
                loads.at(time, layout, &cells, &positions).into_iter().map(|ends| (ends, 1.0)).collect()
            }
            _ => return Ok(None),
        };
        Ok(Some(pack::lines(&found)))
    }
}

/// Arrows of what atoms do to planes, the strongest of the run (pN) so long (µm); those of a hundredth are left out.
fn tractions(positions: &[[f64; 3]], forces: &[[f64; 3]], strongest: f64, longest: f64) -> Vec<([[f64; 3]; 2], f64)> {
    let arrow = |(at, force): (&[f64; 3], &[f64; 3])| {
        let (at, force) = (Vec3::from(*at), Vec3::from(*force));
        let size = force.norm();
        (size > 0.01 * strongest).then(|| ([at.into(), (at + force * (longest / strongest)).into()], size))
    };
    positions.iter().zip(forces).filter_map(arrow).collect()
}

fn values(result: &ResultFile, name: &str, frame: usize) -> Result<Option<Vec<u8>>> {
    let Ok(shown) = Shown::named(result, name) else { return Ok(None) };
    let positions = if shown.of() == Of::Atoms { result.positions(frame)? } else { Vec::new() };
    Ok(Some(pack::values(&shown.values(result, frame, &positions)?)))
}

fn field(result: &ResultFile, name: &str, frame: usize) -> Result<Option<Vec<u8>>> {
    let Ok((field, species)) = result.field_species(name) else { return Ok(None) };
    Ok(Some(pack::field(&result.field_frame(&field.name, &field.species[species].0, frame)?)))
}

/// All numbers of a cell in a frame.
fn cell(result: &ResultFile, id: u64, frame: usize) -> Result<Option<Value>> {
    let cells = result.cells(frame);
    let Some(number) = cells.iter().position(|cell| cell.id == id) else { return Ok(None) };
    let cell = cells[number];
    let one = |name: String| {
        let value = result.cell_values(&name, frame)?[number];
        Ok(json!({ "name": name, "label": label_of(result, &name), "value": value }))
    };
    let numbers: Vec<Value> = result.series_names().into_iter().map(one).collect::<Result<_>>()?;
    let kind = &result.layout().types[cell.kind as usize].name;
    Ok(Some(json!({ "id": id, "type": kind, "parent": cell.parent, "numbers": numbers })))
}

/// A series over the frames: of the scene, of one cell, or the mean over the cells that have it; null where there is none.
fn curve(result: &ResultFile, name: &str, column: Option<usize>) -> Result<Option<Value>> {
    let values: Vec<f64> = if result.scene_names().iter().any(|known| known == name) {
        result.scene_series(name)?
    } else if result.series_names().iter().any(|known| known == name) {
        let all = result.cell_series(name)?;
        let of_frame = |frame: usize| match column {
            Some(column) => all[[frame, column]],
            None => {
                let there = all.row(frame).iter().copied().filter(|value| value.is_finite()).collect::<Vec<_>>();
                there.iter().sum::<f64>() / there.len() as f64
            }
        };
        (0..result.frames()).map(of_frame).collect()
    } else {
        return Ok(None);
    };
    Ok(Some(json!({ "name": name, "label": label_of(result, name), "values": values })))
}
