//! Sixteen lines of boxes, or fewer, along one axis: from the grid to where they are solved and back.

use super::shared::{Columns, Next, Shared};
use super::sweep::WIDTH;
use super::transpose::{transpose_in, transpose_out};

/// Sixteen lines or fewer, as they lie in memory.
#[derive(Clone, Copy)]
pub enum Lines {
    /// `count` rows of `n` boxes along x, one after the other.
    Rows { first: usize, n: usize, count: usize },
    /// `count` columns side by side, whose boxes are `stride` apart.
    Columns { first: usize, n: usize, stride: usize, count: usize },
}

impl Lines {
    /// The lines as columns to work on where they lie, if they are, and as many as there are lanes.
    ///
    /// # Safety
    /// Nobody else holds a box of these lines.
    #[inline(always)]
    pub unsafe fn in_place<'a>(self, values: &'a Shared<'a>) -> Option<Columns<'a>> {
        match self {
            // SAFETY: this function's contract.
            Self::Columns { first, stride, count: WIDTH, .. } => Some(unsafe { Columns::new(values, first, stride) }),
            _ => None,
        }
    }

    /// The lines after these, if they are as many.
    #[inline(always)]
    pub fn next<'a>(self, values: &'a Shared<'a>) -> Next<'a> {
        match self {
            Self::Rows { first, n, count } => Next { values, first: first + n * count, stride: WIDTH },
            Self::Columns { first, stride, count, .. } => Next { values, first: first + count, stride },
        }
    }

    /// Copies the lines to `[box][line]`, and zeros into lanes without a line.
    ///
    /// # Safety
    /// Nobody else holds a box of these lines.
    #[inline(always)]
    pub unsafe fn gather(self, values: &Shared, to: &mut [f64]) {
        let (rows, _) = to.as_chunks_mut::<WIDTH>();
        match self {
            Self::Rows { first, n, count } => {
                // SAFETY: the boxes are the caller's alone.
                let from = unsafe { values.part(first, n * count) };
                transpose_in(from, [n, count], rows);
            }
            Self::Columns { first, n, stride, count } => {
                for (i, row) in rows[..n].iter_mut().enumerate() {
                    // SAFETY: the boxes are the caller's alone.
                    let from = unsafe { values.part(first + i * stride, count) };
                    if let Ok(from) = <&[f64; WIDTH]>::try_from(&*from) {
                        *row = *from;
                    } else {
                        row[..count].copy_from_slice(from);
                        row[count..].fill(0.0);
                    }
                }
            }
        }
    }

    /// Copies the lines back.
    ///
    /// # Safety
    /// Nobody else holds a box of these lines.
    #[inline(always)]
    pub unsafe fn scatter(self, values: &Shared, from: &[f64]) {
        let (rows, _) = from.as_chunks::<WIDTH>();
        match self {
            Self::Rows { first, n, count } => {
                // SAFETY: the boxes are the caller's alone.
                let to = unsafe { values.part(first, n * count) };
                transpose_out(rows, [n, count], to);
            }
            Self::Columns { first, n, stride, count } => {
                for (i, row) in rows[..n].iter().enumerate() {
                    // SAFETY: the boxes are the caller's alone.
                    let to = unsafe { values.part(first + i * stride, count) };
                    if let Ok(to) = <&mut [f64; WIDTH]>::try_from(&mut *to) {
                        *to = *row;
                    } else {
                        to.copy_from_slice(&row[..count]);
                    }
                }
            }
        }
    }
}
