//! The factor of one large body, by dense fronts along a tree of groups of atoms (the multifrontal method: Duff and Reid, ACM Trans. Math.
//! Softw. 9, 302, 1983): what a column at a time does with one block, tiles do with all columns of a group.

use std::collections::{BTreeMap, BTreeSet};

use super::dense::{TILE, WIDTH};
use super::dissection::dissect;
use super::pattern::Pattern;
use crate::Vec3;

/// What stands for no number: padding.
pub const NOTHING: u32 = u32::MAX;

/// The fronts of a matrix, each after those whose parent it is, and where their numbers stand.
#[derive(Debug, Clone, PartialEq)]
pub struct Fronts {
    pub(super) fronts: Vec<Front>,
    /// For the blocks below the diagonal of the pattern, column by column, where the row's atom begins in the front of the column's.
    pub(super) entries: Vec<u32>,
    /// Numbers of all panels.
    panels: usize,
    /// Numbers of the two stacks of updates: those of groups an even and an odd number of steps below the last.
    pub(super) stacks: [usize; 2],
}

/// A dense part of the matrix: the columns of a group of atoms, and the rows of these and of all atoms that they touch thereafter.
#[derive(Debug, Clone, PartialEq)]
pub struct Front {
    /// The first of its columns in the order of elimination, and the one after the last.
    pub columns: [usize; 2],
    /// Strips of rows of its own atoms, and of the atoms after.
    pub strips: [usize; 2],
    /// The number (three an atom) that each row of the strips is of, or [`NOTHING`].
    pub numbers: Vec<u32>,
    /// Where each row of the strips of atoms after is in the front of the parent, or [`NOTHING`].
    pub lifts: Vec<u32>,
    /// Fronts whose parent it is.
    pub children: Vec<usize>,
    /// Where its panel begins.
    pub panel: usize,
    /// In which stack its update is, and where that begins.
    pub update: (usize, usize),
}

impl Front {
    /// Where a strip of the panel begins in it.
    pub fn strip(&self, number: usize) -> usize {
        let own = self.strips[0];
        if number < own { packed(number) } else { packed(own) + (number - own) * own * TILE }
    }

    /// Numbers of its panel.
    pub fn panel_len(&self) -> usize {
        self.strip(self.strips[0] + self.strips[1])
    }

    /// Numbers of its update.
    pub fn update_len(&self) -> usize {
        packed(self.strips[1])
    }
}

/// Where a strip of a packed lower triangle begins.
pub fn packed(strip: usize) -> usize {
    strip * (strip + 1) / 2 * TILE
}

impl Fronts {
    /// The fronts of a matrix in which atoms with these neighbours have blocks, at these positions (µm), and the pattern of the matrix itself.
    pub fn of(near: &[Vec<u32>], x: &[Vec3]) -> (Self, Pattern) {
        let groups = dissect(near, x);
        let order: Vec<u32> = groups.iter().flat_map(|group| &group.atoms).copied().collect();
        let mut rank = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&atom, number)| rank[atom as usize] = number);
        let later = |atom: u32| {
            let own = rank[atom as usize];
            near[atom as usize].iter().copied().filter(|&one| rank[one as usize] > own).collect()
        };
        let pattern = Pattern::of_columns(order.iter().map(|&atom| (atom, later(atom))).collect());
        let parents: Vec<Option<usize>> = groups.iter().map(|group| group.parent).collect();
        let mut children = vec![Vec::new(); groups.len()];
        for (number, parent) in parents.iter().enumerate() {
            parent.iter().for_each(|&parent| children[parent].push(number));
        }
        let mut made = Self { fronts: Vec::new(), entries: Vec::new(), panels: 0, stacks: [0; 2] };
        let (mut rows, mut begin): (Vec<Vec<u32>>, usize) = (Vec::new(), 0);
        for ((number, group), children) in groups.iter().enumerate().zip(children) {
            let end = begin + group.atoms.len();
            let touched = group.atoms.iter().flat_map(|&atom| near[atom as usize].iter().copied());
            let touched = touched.chain(children.iter().flat_map(|&child| rows[child].iter().copied()));
            let later: BTreeSet<usize> = touched.map(|atom| rank[atom as usize]).filter(|&rank| rank >= end).collect();
            rows.push(later.into_iter().map(|rank| order[rank]).collect());
            made.push([begin, end], children, &group.atoms, &rows[number]);
            begin = end;
        }
        made.lift(&parents);
        made.enter(&pattern);
        made.stack(&parents);
        (made, pattern)
    }

    /// Numbers that a factor takes: panels, then the stacks in which it is made.
    pub fn len(&self) -> usize {
        self.panels + self.stacks[0] + self.stacks[1]
    }

    /// Numbers of all panels.
    pub fn panels(&self) -> usize {
        self.panels
    }

    fn push(&mut self, columns: [usize; 2], children: Vec<usize>, own: &[u32], later: &[u32]) {
        let mut numbers = Vec::new();
        let strips = [own, later].map(|atoms| {
            numbers.extend(atoms.iter().flat_map(|&atom| 3 * atom..3 * atom + 3));
            numbers.resize(numbers.len().next_multiple_of(WIDTH), NOTHING);
            (3 * atoms.len()).div_ceil(WIDTH)
        });
        let front = Front { columns, strips, numbers, lifts: Vec::new(), children, panel: self.panels, update: (0, 0) };
        self.panels += front.panel_len();
        self.fronts.push(front);
    }

    /// Finds where rows of each front are in that of its parent.
    fn lift(&mut self, parents: &[Option<usize>]) {
        for (number, parent) in parents.iter().enumerate() {
            let Some(parent) = *parent else { continue };
            let (first, last) = self.fronts.split_at_mut(parent);
            let (front, parent) = (&mut first[number], &last[0]);
            let positions: BTreeMap<u32, u32> = parent.numbers.iter().copied().zip(0..).collect();
            let later = &front.numbers[front.strips[0] * WIDTH..];
            front.lifts = later.iter().map(|row| if *row == NOTHING { NOTHING } else { positions[row] }).collect();
        }
    }

    /// Finds where the blocks of the pattern are in the fronts.
    fn enter(&mut self, pattern: &Pattern) {
        let mut columns = pattern.columns();
        for front in &self.fronts {
            let positions: BTreeMap<u32, u32> = front.numbers.iter().copied().zip(0..).collect();
            for column in columns.by_ref().take(front.columns[1] - front.columns[0]) {
                self.entries.extend(column.rows.iter().map(|row| positions[&(3 * row)]));
            }
        }
    }

    /// Finds where updates stand: those of the children of a front are the last of one stack when it is made, and its own goes to the other.
    fn stack(&mut self, parents: &[Option<usize>]) {
        let mut depth = vec![0; parents.len()];
        for number in (0..parents.len()).rev() {
            depth[number] = parents[number].map_or(0, |parent: usize| depth[parent] + 1);
        }
        let mut tops = [0; 2];
        for number in 0..self.fronts.len() {
            let side = depth[number] % 2;
            if let Some(&first) = self.fronts[number].children.first() {
                tops[1 - side] = self.fronts[first].update.1;
            }
            let front = &mut self.fronts[number];
            front.update = (side, tops[side]);
            tops[side] += front.update_len();
            self.stacks[side] = self.stacks[side].max(tops[side]);
        }
    }
}
