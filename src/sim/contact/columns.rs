//! How contacts move cells that have a stiffness of their own: by columns of what the implicit step makes of a force, eq. (adhesion.21).
//!
//! Each side of a row has the displacement of all atoms of its cell by a unit force along the row's normal, or along x, y and z where the
//! row bears shear. Where more rows touch a cell than it has atoms that they touch, those are put together from the answers to unit forces on
//! each of these atoms.

use std::ops::Range;

use super::rows::{Pairing, Row};
use super::together::Together;
use super::vectors::{V4, map};
use crate::Vec3;

/// The columns of all cells that move by them.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    /// Whether the cells of each kind do.
    of_kind: Vec<bool>,
    /// What each side of a row moves; empty where nothing moves so.
    spans: Vec<[Span; 2]>,
    /// Rows and sides, cell by cell, and where those of each cell begin.
    pub(super) sides: Vec<(u32, u32)>,
    pub(super) first_side: Vec<u32>,
    /// Atoms that rows touch, of cells that are asked for the answer of each, and where those of each cell begin.
    touched: Vec<u32>,
    first_touched: Vec<u32>,
    /// Where the columns of each cell begin, of all numbers: that of its volume, those of rows, and the answers of atoms.
    first_value: Vec<usize>,
    /// Displacement of an atom over force, µm/pN, or over pressure, µm³/pN.
    pub(super) values: Vec<V4>,
}

/// What one side of a row moves.
#[derive(Debug, Clone, Copy, Default)]
struct Span {
    /// Where its columns begin.
    first_value: usize,
    /// The atoms of its cell.
    first_atom: u32,
    atoms: u32,
    /// One, along the normal, or three, along x, y and z; none where its cell moves otherwise.
    columns: u8,
    /// The first of its corners, and one behind the last.
    corners: [u8; 2],
}

impl Span {
    fn column(&self, number: usize) -> Range<usize> {
        let first = self.first_value + number * self.atoms as usize;
        first..first + self.atoms as usize
    }

    fn corners(&self) -> Range<usize> {
        usize::from(self.corners[0])..usize::from(self.corners[1])
    }

    fn moved(&self) -> Range<usize> {
        self.first_atom as usize..(self.first_atom + self.atoms) as usize
    }
}

/// A cell whose columns are counted.
#[derive(Debug, Clone, Copy)]
pub struct Counted {
    /// Its kind.
    pub kind: usize,
    /// Its atoms among those of all cells.
    pub first_atom: u32,
    /// How many.
    pub atoms: u32,
    /// Whether its volume is kept in the sweeps.
    pub keeps_volume: bool,
}

/// Along how many directions a row may change its force.
pub(super) fn directions(row: &Row) -> usize {
    if row.shear > 0.0 || row.friction > 0.0 { 3 } else { 1 }
}

/// The directions themselves.
pub(super) fn direction(row: &Row, number: usize) -> Vec3 {
    if directions(row) == 1 { row.normal() } else { Vec3::ith(number, 1.0) }
}

/// The corners of a side of a row: all where both sides are of one cell.
fn corners(row: &Row, side: usize, is_alone: bool) -> Range<usize> {
    match (row.pairing, side) {
        (Pairing::Rigid, _) | (Pairing::AtomOnObstacle, 1) => 0..0,
        (Pairing::AtomOnObstacle, _) => 0..1,
        _ if is_alone => {
            if side == 0 {
                0..4
            } else {
                0..0
            }
        }
        (Pairing::AtomOnFacet, 0) => 0..1,
        (Pairing::AtomOnFacet, _) => 1..4,
        (Pairing::Edges, 0) => 0..2,
        (Pairing::Edges, _) => 2..4,
    }
}

/// Sorts a list from an item on, and keeps each of these once.
fn keep_each_once(list: &mut Vec<u32>, first: usize) {
    list[first..].sort_unstable();
    let mut end = first;
    for at in first..list.len() {
        if at == first || list[at] != list[end - 1] {
            list[end] = list[at];
            end += 1;
        }
    }
    list.truncate(end);
}

impl Columns {
    /// Begins a projection in which the cells of some kinds move by columns.
    pub fn begin(&mut self, of_kind: impl Iterator<Item = bool>) {
        self.of_kind.clear();
        self.of_kind.extend(of_kind);
        self.spans.clear();
    }

    /// Writes NaN over all numbers and forgets who moves by them.
    pub fn poison(&mut self) {
        self.begin(std::iter::empty());
        self.values.as_flattened_mut().fill(f64::NAN);
    }

    /// Whether the cells of a kind move by columns.
    pub fn are_of(&self, kind: usize) -> bool {
        self.of_kind[kind]
    }

    /// The columns, where any cells move by them.
    pub fn if_there(&self) -> Option<&Self> {
        self.are_there().then_some(self)
    }

    /// Whether any cells do.
    pub fn are_there(&self) -> bool {
        self.of_kind.contains(&true)
    }

    /// Counts the columns of all rows, cell by cell: a column for the volume where it is kept, and those of the sides of rows.
    pub fn count(
        &mut self,
        rows: &[Row],
        bodies_of: impl Fn(&Row) -> [u32; 2],
        bodies: usize,
        of: impl Fn(u32) -> Counted,
    ) {
        let Self { of_kind, spans, sides, first_side, touched, first_touched, first_value, values } = self;
        first_side.clear();
        first_side.resize(bodies + 2, 0);
        let sides_of = |row: &Row| {
            let bodies = bodies_of(row);
            [0, 1].map(|side| {
                let body = bodies[side];
                let moves = !corners(row, side, bodies[0] == bodies[1]).is_empty() && of_kind[of(body).kind];
                moves.then_some(body as usize)
            })
        };
        for body in rows.iter().flat_map(sides_of).flatten() {
            first_side[body + 2] += 1;
        }
        (2..bodies + 2).for_each(|body| first_side[body] += first_side[body - 1]);
        sides.clear();
        sides.resize(first_side[bodies + 1] as usize, (0, 0));
        for (number, row) in rows.iter().enumerate() {
            for (side, body) in sides_of(row).into_iter().enumerate() {
                if let Some(body) = body {
                    let next = &mut first_side[body + 1];
                    sides[*next as usize] = (number as u32, side as u32);
                    *next += 1;
                }
            }
        }
        spans.resize(rows.len(), Default::default());
        first_touched.clear();
        touched.clear();
        first_value.clear();
        let mut end = 0;
        for body in 0..bodies {
            first_value.push(end);
            let first_of_touched = touched.len();
            first_touched.push(first_of_touched as u32);
            let Counted { kind, first_atom, atoms, keeps_volume } = of(body as u32);
            if of_kind[kind] && keeps_volume {
                end += atoms as usize;
            }
            let mut of_rows = 0;
            for &(row, side) in &sides[first_side[body] as usize..first_side[body + 1] as usize] {
                let row_bodies = bodies_of(&rows[row as usize]);
                let corners = corners(&rows[row as usize], side as usize, row_bodies[0] == row_bodies[1]);
                let columns = directions(&rows[row as usize]);
                spans[row as usize][side as usize] = Span {
                    first_value: end,
                    first_atom,
                    atoms,
                    columns: columns as u8,
                    corners: [corners.start as u8, corners.end as u8],
                };
                end += columns * atoms as usize;
                of_rows += columns;
                touched.extend(corners.map(|corner| rows[row as usize].atoms[corner]));
            }
            keep_each_once(touched, first_of_touched);
            let of_atoms = 3 * (touched.len() - first_of_touched);
            if of_atoms < of_rows {
                end += of_atoms * atoms as usize;
            } else {
                touched.truncate(first_of_touched);
            }
        }
        first_touched.push(touched.len() as u32);
        first_value.push(end);
        values.resize(end, [0.0; 4]);
    }

    /// The sides of rows of a cell, and where its columns are.
    pub(super) fn of_body(&self, body: usize) -> (Range<usize>, Range<usize>) {
        let sides = self.first_side[body] as usize..self.first_side[body + 1] as usize;
        (sides, self.first_value[body]..self.first_value[body + 1])
    }

    /// The atoms of a cell that are asked for the answer of each, in their order; none where each row is asked.
    pub(super) fn touched_of(&self, body: usize) -> &[u32] {
        &self.touched[self.first_touched[body] as usize..self.first_touched[body + 1] as usize]
    }

    /// Where the column of the volume of a cell begins, if it moves by columns.
    pub(super) fn of_volume(&self, body: usize, kind: usize) -> Option<usize> {
        self.are_of(kind).then(|| self.first_value[body])
    }

    /// The corners of a side of a row.
    pub(super) fn corners_of(&self, row: usize, side: usize) -> Range<usize> {
        self.spans[row][side].corners()
    }

    /// What the columns of both sides add to the compliance of a row, along the normal and at most across it, µm/pN.
    pub fn response(&self, number: usize, row: &Row) -> [f64; 2] {
        let Some(spans) = self.spans.get(number) else { return [0.0; 2] };
        let (weights, mut total) = (row.weights(), [[0.0; 3]; 3]);
        for span in spans {
            for column in 0..usize::from(span.columns) {
                let values = &self.values[span.column(column)];
                for corner in span.corners() {
                    let at = values[(row.atoms[corner] - span.first_atom) as usize];
                    (0..3).for_each(|axis| total[column][axis] += weights[corner] * at[axis]);
                }
            }
        }
        let normal = row.normal();
        let columns = total.map(Vec3::from);
        if directions(row) == 1 {
            return [columns[0].dot(&normal); 2];
        }
        let whole = nalgebra::Matrix3::from_columns(&columns);
        let along = normal.dot(&(whole * normal));
        let off = nalgebra::Matrix3::identity() - normal * normal.transpose();
        let across = off * whole * off;
        // The larger of two eigenvalues, from their sum and that of their squares.
        let (sum, squares) = (across.trace(), across.norm_squared());
        [along, 0.5 * sum + (0.5 * squares - 0.25 * sum * sum).max(0.0).sqrt()]
    }

    /// Moves the cells of both sides of a row as a change of its force does.
    #[inline(always)]
    pub fn push(&self, number: usize, normal: &V4, change: &V4, moved: &Together<V4>) {
        for span in &self.spans[number] {
            if span.columns == 0 {
                continue;
            }
            // SAFETY: the caller alone moves the cells of its rows.
            let moved = unsafe { moved.part(span.moved()) };
            let first = &self.values[span.column(0)];
            if span.columns == 1 {
                let along = (change[0] * normal[0] + change[1] * normal[1]) + change[2] * normal[2];
                moved.iter_mut().zip(first).for_each(|(to, by)| *to = map(|i| to[i] + along * by[i]));
            } else {
                let (second, third) = (&self.values[span.column(1)], &self.values[span.column(2)]);
                for (to, ((x, y), z)) in moved.iter_mut().zip(first.iter().zip(second).zip(third)) {
                    *to = map(|i| to[i] + ((change[0] * x[i] + change[1] * y[i]) + change[2] * z[i]));
                }
            }
        }
    }
}
