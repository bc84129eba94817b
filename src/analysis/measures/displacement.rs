//! How far a point of a body has gone, and how far many points went from where they were measured to go.

use super::declared::Declared;
use super::finished::Finished;
use super::reduction::Reduction;
use crate::Vec3;
use crate::analysis::statistics;
use crate::analysis::table::Table;
use crate::error::{Error, Fault, Result, short};
use crate::output::ResultFile;
use crate::units::Length;
use crate::values::{LengthUnit, When};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// How far from an atom a measured point may be at the start, in parts of the widest extent of all atoms that are looked at.
const NEAR: f64 = 0.01;

/// How far an atom has gone since the first frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Displacement {
    /// A point: the atom is meant that is nearest to it in the first frame.
    pub at: [Length; 3],
    /// The direction along which it is told; how far the atom is from where it was when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The instant, or how the values at several instants become one.
    #[serde(default)]
    pub time: Reduction,
}

impl Displacement {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        self.time.check(at);
        if let Some(direction) = self.direction {
            at.direction("direction", direction);
        }
    }

    /// The displacement, µm.
    ///
    /// # Errors
    /// When there is no such type, cell or time.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let file = file_of(run)?;
        let point = Vec3::from(self.at.map(|length| length.value()));
        let start = atoms_of(run, file, self.cells.as_deref(), 0)?;
        let (atom, from) = nearest(&start, point);
        let frames: Vec<usize> = self.time.frames(&run.recording.times)?.collect();
        let mut values = Vec::new();
        for &frame in &frames {
            let gone = atoms_of(run, file, self.cells.as_deref(), frame)?[atom] - from;
            values.push(self.direction.map_or(gone.norm(), |along| gone.dot(&Vec3::from(along).normalize())));
        }
        let times: Vec<f64> = frames.iter().map(|frame| run.recording.times[*frame]).collect();
        self.time.reduce(&times, &values)
    }
}

/// Points that were measured before and after, beside the atoms that stand there, eq. (analysis.41).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct DisplacementError {
    /// The table (CSV with a line of column names), relative to the document.
    #[schemars(extend("x-text" = "file"))]
    pub table: PathBuf,
    /// Its columns of where points were before, along x, y and z: each is the atom that is nearest in the first frame.
    pub from_columns: [String; 3],
    /// Its columns of where they were after.
    pub to_columns: [String; 3],
    /// The length that a number of the table stands for.
    #[serde(default)]
    pub table_unit: LengthUnit,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The instant.
    #[serde(default)]
    pub time: When,
    /// How the errors of all points become one number.
    #[serde(default)]
    pub statistic: ErrorStatistic,
}

/// How the errors of all points become one number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum ErrorStatistic {
    /// Their mean.
    #[default]
    Mean,
    /// Their standard deviation.
    Deviation,
}

impl DisplacementError {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.when("time", self.time);
    }

    /// The mean or the deviation of the errors.
    ///
    /// # Errors
    /// When the table cannot be read or lacks a column, there is no such type, cell or time, or no atom is at a point.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let errors = self.errors(run)?;
        Ok(match self.statistic {
            ErrorStatistic::Mean => statistics::mean(&errors),
            ErrorStatistic::Deviation => statistics::standard_deviation(&errors),
        })
    }

    /// The error of each point.
    fn errors(&self, run: &Finished) -> Result<Vec<f64>> {
        let file = file_of(run)?;
        let table = Table::read(&(run.resolve)(&self.table))?;
        let [from, to] = [&self.from_columns, &self.to_columns].map(|names| self.points(&table, names));
        let (from, to) = (from?, to?);
        let end = run.recording.frame_at(self.time);
        let start = atoms_of(run, file, self.cells.as_deref(), 0)?;
        let ended = atoms_of(run, file, self.cells.as_deref(), end)?;
        let (low, high) = start.iter().fold((start[0], start[0]), |(low, high), x| (low.inf(x), high.sup(x)));
        let limit = NEAR * (high - low).max();
        let mut errors = Vec::new();
        for (row, (from, to)) in from.iter().zip(&to).enumerate() {
            let (atom, at) = nearest(&start, *from);
            if (at - from).norm() > limit {
                let found = format!(
                    "row {} of the table {}: no atom is at {}, {}, {} um at the start; the nearest is {} um away",
                    row + 1,
                    self.table.display(),
                    short(from.x),
                    short(from.y),
                    short(from.z),
                    short((at - from).norm())
                );
                let help =
                    "give the unit of the table as `table_unit`, and a mesh whose atoms are at the measured points";
                return Err(Error::input(Fault::new(found).help(help)));
            }
            errors.push((ended[atom] - to).norm() / (to - from).norm());
        }
        Ok(errors)
    }

    /// The points in three columns, µm.
    fn points(&self, table: &Table, names: &[String; 3]) -> Result<Vec<Vec3>> {
        let [x, y, z] = [table.column(&names[0])?, table.column(&names[1])?, table.column(&names[2])?];
        let unit = self.table_unit.micrometres();
        Ok((0..x.len()).map(|row| Vec3::new(x[row], y[row], z[row]) * unit).collect())
    }
}

fn file_of<'a>(run: &Finished<'a>) -> Result<&'a ResultFile> {
    run.file.ok_or_else(|| {
        let fault = Fault::new("there is no file that says where the atoms are");
        Error::input(fault.help("measure the result of a run"))
    })
}

/// Where the atoms of the cells of a type are in a frame, µm: one at least.
fn atoms_of(run: &Finished, file: &ResultFile, kind: Option<&str>, frame: usize) -> Result<Vec<Vec3>> {
    let recording = run.recording;
    let wanted = recording.cells_of(kind)?;
    let kinds: Vec<u32> = wanted.iter().map(|cell| recording.cell_types[*cell]).collect();
    let (positions, cells) = (file.positions(frame)?, file.cells(frame));
    let of_cells = cells.iter().zip(file.layout().atoms_of(&cells)).filter(|(cell, _)| kinds.contains(&cell.kind));
    let atoms: Vec<Vec3> = of_cells.flat_map(|(_, atoms)| &positions[atoms]).map(|x| Vec3::from(*x)).collect();
    if atoms.is_empty() {
        let fault = Fault::new(format!("there is no cell at {} s", recording.times[frame]));
        return Err(Error::input(fault.help("give a time at which there is one")));
    }
    Ok(atoms)
}

/// The nearest of some atoms, and where it is.
fn nearest(atoms: &[Vec3], point: Vec3) -> (usize, Vec3) {
    let away = |x: &Vec3| (x - point).norm_squared();
    let found = atoms.iter().enumerate().min_by(|a, b| away(a.1).total_cmp(&away(b.1)));
    found.map(|(number, x)| (number, *x)).expect("one atom at least")
}
