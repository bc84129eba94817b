//! Reads who touches whom, and what follows from it.

use std::collections::HashSet;

use ndarray::ArrayView1;

use super::catalogue::List;
use super::changes::counts_of_changes;
use super::contacts::{self, Touching};
use super::container::damaged;
use super::{LinkedPair, ResultFile};
use crate::error::{Error, Fault, Result};

impl ResultFile {
    /// Pairs of cells that touch in a frame, ascending.
    ///
    /// # Errors
    /// A result without contacts, or a damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn pairs(&self, frame: usize) -> Result<Vec<Touching>> {
        self.touching(List::Pairs, frame, ["/contacts/pairs/first", "/contacts/pairs/second"])
    }

    /// Cells that touch planes in a frame, ascending.
    ///
    /// # Errors
    /// A result without contacts, or a damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn on_planes(&self, frame: usize) -> Result<Vec<Touching>> {
        self.touching(List::OnPlanes, frame, ["/contacts/planes/cell", "/contacts/planes/plane"])
    }

    /// Pairs of cells that dynamic links join in a frame, ascending; none in a run without such links.
    ///
    /// # Errors
    /// A damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn linked(&self, frame: usize) -> Result<Vec<LinkedPair>> {
        assert!(frame < self.frames(), "frame {frame} of {}", self.frames());
        if !self.layout().linked {
            return Ok(Vec::new());
        }
        let rows = self.rows_of(List::Links, frame..frame + 1)?;
        let integers =
            |name: &str| self.read(&format!("/links/{name}"), |data| data.read_slice_1d::<i64, _>(rows.clone()));
        let [first, second, number] = [integers("first")?, integers("second")?, integers("number")?];
        let id = |number: i64| u64::try_from(number).unwrap_or(u64::MAX);
        let pair = |row: usize| LinkedPair {
            cell: id(first[row]),
            other: id(second[row]),
            number: u32::try_from(number[row]).unwrap_or(0),
        };
        let found: Vec<LinkedPair> = (0..first.len()).map(pair).collect();
        let ids: HashSet<u64> = self.cells(frame).iter().map(|cell| cell.id).collect();
        match found.iter().all(|pair| ids.contains(&pair.cell) && ids.contains(&pair.other)) {
            true => Ok(found),
            false => Err(damaged(self.path(), "/links/first names no cell")),
        }
    }

    fn touching(&self, list: List, frame: usize, names: [&str; 2]) -> Result<Vec<Touching>> {
        assert!(frame < self.frames(), "frame {frame} of {}", self.frames());
        if !self.layout().contacts {
            let fault = Fault::new(format!("{} does not say who touches whom", self.path().display()));
            return Err(Error::input(fault.help("its cells pass through each other: add [contact] to the document")));
        }
        let rows = self.rows_of(list, frame..frame + 1)?;
        let numbers = |name: &str| self.read(name, |data| data.read_slice_1d::<i64, _>(rows.clone()));
        let (cells, numbers) = (numbers(names[0])?, numbers(names[1])?);
        let areas = self.read(list.column(), |data| data.read_slice_1d::<f64, _>(rows.clone()))?;
        let number = |number: &i64| u64::try_from(*number).unwrap_or(u64::MAX);
        let ids: HashSet<u64> = self.cells(frame).iter().map(|cell| cell.id).collect();
        let is_known = |touching: &Touching| {
            let planes = self.layout().obstacles.len() as u64;
            let other = if list == List::Pairs { ids.contains(&touching.other) } else { touching.other < planes };
            other && ids.contains(&touching.cell)
        };
        let rows = cells.iter().zip(&numbers).zip(&areas).map(|((cell, other), area)| Touching {
            cell: number(cell),
            other: number(other),
            area: *area,
        });
        let found: Vec<Touching> = rows.collect();
        match found.iter().all(is_known) {
            true => Ok(found),
            false => Err(damaged(self.path(), &format!("{} names no cell", names[0]))),
        }
    }

    /// All series of contacts in the order of [`contacts::series`], by frames; found when they are asked for the first time.
    ///
    /// # Errors
    /// A damaged file.
    pub(super) fn contact_series(&self) -> Result<&Vec<Vec<f64>>> {
        if let Some(known) = self.of_contacts.get() {
            return Ok(known);
        }
        let mut of_frames = vec![Vec::new(); contacts::series_of_frame(self.layout()).len()];
        for frame in 0..self.frames() {
            let surface = ArrayView1::from(&self.cell_values("area", frame)?).sum();
            let (cells, pairs, on_planes) = (self.cells(frame), self.pairs(frame)?, self.on_planes(frame)?);
            let values = contacts::values_of_frame(self.layout(), &cells, surface, &pairs, &on_planes);
            of_frames.iter_mut().zip(values).for_each(|(series, value)| series.push(value));
        }
        let counts = counts_of_changes(self.cell_series("aggregate")?.view());
        let found = contacts::all_series(self.layout(), of_frames, &counts);
        Ok(self.of_contacts.get_or_init(|| found))
    }
}
