//! Which blocks of the tangent stiffness and of its Cholesky factor are there, found once for a mesh.

use std::collections::BTreeSet;

use crate::mechanics::stiffness::StiffnessMatrix;

/// The lower triangle of a symmetric matrix of 3 × 3 blocks, an atom each, with all blocks that its factor fills, column by column in
/// the order in which atoms are eliminated. Block `atom` is that on the diagonal; those below follow.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// Atoms in the order of their elimination.
    order: Vec<u32>,
    /// When each atom is eliminated.
    rank: Vec<u32>,
    /// Where the blocks below the diagonal of each column begin, by the column's place in the order; one more at the end.
    starts: Vec<u32>,
    /// The atoms of their rows, in the order of elimination.
    rows: Vec<u32>,
    /// For every column and every pair of its blocks below the diagonal the block that their product is taken from; none of a matrix that
    /// fronts factor.
    targets: Vec<u32>,
}

impl Pattern {
    /// The pattern of a matrix with blocks where `stiffness` has entries, in an order of minimum degree.
    pub fn of(stiffness: &StiffnessMatrix) -> Self {
        let atoms = stiffness.atoms();
        let mut near: Vec<BTreeSet<u32>> = (0..atoms)
            .map(|i| stiffness.row(i).map(|(j, _)| j as u32).filter(|&j| j as usize != i).collect())
            .collect();
        let mut waiting: BTreeSet<(usize, u32)> = near.iter().zip(0..).map(|(near, atom)| (near.len(), atom)).collect();
        let mut columns: Vec<(u32, Vec<u32>)> = Vec::with_capacity(atoms);
        while let Some((_, atom)) = waiting.pop_first() {
            let left = std::mem::take(&mut near[atom as usize]);
            for &one in &left {
                waiting.remove(&(near[one as usize].len(), one));
                near[one as usize].remove(&atom);
                near[one as usize].extend(left.iter().filter(|&&other| other != one));
                waiting.insert((near[one as usize].len(), one));
            }
            columns.push((atom, left.into_iter().collect()));
        }
        let mut filled = Self::of_columns(columns);
        filled.targets = filled.products();
        filled
    }

    /// The pattern whose columns are these atoms, with the atoms of the rows below, without what a factor fills.
    pub fn of_columns(columns: Vec<(u32, Vec<u32>)>) -> Self {
        let order: Vec<u32> = columns.iter().map(|column| column.0).collect();
        let mut rank = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&atom, number)| rank[atom as usize] = number);
        let (mut starts, mut rows) = (vec![0], Vec::new());
        for (_, mut below) in columns {
            below.sort_by_key(|&row| rank[row as usize]);
            rows.extend(below);
            starts.push(rows.len() as u32);
        }
        Self { order, rank, starts, rows, targets: Vec::new() }
    }

    /// The blocks that products of pairs of blocks are taken from, column by column.
    fn products(&self) -> Vec<u32> {
        let mut targets = Vec::new();
        for column in self.columns() {
            for (number, &j) in column.rows.iter().enumerate() {
                targets.push(j);
                let below = column.rows[number + 1..].iter();
                targets.extend(below.map(|&i| self.block(i, j).expect("what a column fills").0 as u32));
            }
        }
        targets
    }

    /// Number of atoms.
    pub fn atoms(&self) -> usize {
        self.order.len()
    }

    /// Number of blocks.
    pub fn blocks(&self) -> usize {
        self.order.len() + self.rows.len()
    }

    /// The block of two atoms, and whether it stands transposed for the first as row; none where there is none.
    pub fn block(&self, i: u32, j: u32) -> Option<(usize, bool)> {
        if i == j {
            return Some((i as usize, false));
        }
        let is_turned = self.rank[i as usize] < self.rank[j as usize];
        let (row, column) = if is_turned { (j, i) } else { (i, j) };
        let number = self.rank[column as usize] as usize;
        let (begin, end) = (self.starts[number] as usize, self.starts[number + 1] as usize);
        let wanted = self.rank[row as usize];
        let at = self.rows[begin..end].binary_search_by_key(&wanted, |&row| self.rank[row as usize]).ok()?;
        Some((self.order.len() + begin + at, is_turned))
    }

    /// The columns in the order of elimination.
    pub fn columns(&self) -> impl DoubleEndedIterator<Item = Column<'_>> + ExactSizeIterator {
        self.order.iter().zip(self.starts.windows(2)).map(|(&atom, range)| Column {
            atom: atom as usize,
            rows: &self.rows[range[0] as usize..range[1] as usize],
            first: self.order.len() + range[0] as usize,
        })
    }

    /// For each column, in the order of elimination, the blocks that products of pairs of its blocks are taken from: for each block
    /// those with itself and with all after it.
    pub fn targets(&self) -> &[u32] {
        &self.targets
    }
}

/// A column of the factor.
#[derive(Debug, Clone, Copy)]
pub struct Column<'a> {
    /// Its atom, which is also the number of the block on the diagonal.
    pub atom: usize,
    /// The atoms of the blocks below.
    pub rows: &'a [u32],
    /// The number of the first of these.
    pub first: usize,
}
