//! Blocks of a tangent stiffness of several cells side by side, to which forces add.

use super::pattern::Pattern;
use crate::mechanics::lanes::{Real, V3};

/// A 3 × 3 matrix of one cell or of several side by side, by rows.
pub type Block<T> = [V3<T>; 3];

/// The blocks of a matrix with this pattern, `values[(9·block + 3·row + column)·stride + part]`.
pub struct Blocks<'a, T: Real> {
    /// The processor's token.
    pub token: T::Token,
    pattern: &'a Pattern,
    values: &'a mut [T::Raw],
    stride: usize,
    part: usize,
}

impl<'a, T: Real> Blocks<'a, T> {
    /// Sees part `part` of the `stride` registers that the lanes of a block of cells fill.
    #[inline(always)]
    pub fn new(token: T::Token, pattern: &'a Pattern, values: &'a mut [T::Raw], stride: usize, part: usize) -> Self {
        Self { token, pattern, values, stride, part }
    }

    /// Sets all to zero.
    #[inline(always)]
    pub fn clear(&mut self) {
        let zero = T::constant(self.token, 0.0).raw();
        for value in self.values.iter_mut().skip(self.part).step_by(self.stride) {
            *value = zero;
        }
    }

    /// A block.
    #[inline(always)]
    pub fn get(&self, block: usize) -> Block<T> {
        read(self.token, self.values, self.stride, self.part, block)
    }

    /// Sets a block.
    #[inline(always)]
    pub fn set(&mut self, block: usize, [a, b, c]: Block<T>) {
        let numbers = [a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z];
        if self.stride == 1 {
            let slots = &mut self.values.as_chunks_mut::<9>().0[block];
            for k in 0..9 {
                slots[k] = numbers[k].raw();
            }
        } else {
            let slots = &mut self.values[9 * block * self.stride..9 * (block + 1) * self.stride];
            for k in 0..9 {
                slots[k * self.stride + self.part] = numbers[k].raw();
            }
        }
    }

    /// Adds the block of the atoms i (row) and j (column), which is that of j and i transposed: each pair is added once.
    ///
    /// # Panics
    /// When the pattern has no such block.
    #[inline(always)]
    pub fn add(&mut self, i: u32, j: u32, rows: Block<T>) {
        let (block, is_turned) = self.pattern.block(i, j).expect("the pattern has all blocks that forces add to");
        let rows = if is_turned { transposed(rows) } else { rows };
        let [a, b, c] = self.get(block);
        self.set(block, [a + rows[0], b + rows[1], c + rows[2]]);
    }

    /// Adds a number to the diagonal of a block of the atoms i and j.
    #[inline(always)]
    pub fn add_isotropic(&mut self, i: u32, j: u32, value: T) {
        let zero = T::constant(self.token, 0.0);
        let row = |x, y, z| V3 { x, y, z };
        self.add(i, j, [row(value, zero, zero), row(zero, value, zero), row(zero, zero, value)]);
    }

    /// Adds `weight` times the square of a linear measure of the positions of some atoms, of which these are the gradients.
    #[inline(always)]
    pub fn add_square<const N: usize>(&mut self, atoms: [u32; N], gradient: [V3<T>; N], weight: T) {
        for i in 0..N {
            for j in 0..=i {
                self.add_product(atoms[i], atoms[j], [gradient[i], gradient[j]], weight);
            }
        }
    }

    /// Adds the block of two atoms of `weight` times the square of a linear measure of positions, whose gradients by the first and by the
    /// second atom these are. Each pair is added once.
    #[inline(always)]
    pub fn add_product(&mut self, i: u32, j: u32, [on_i, on_j]: [V3<T>; 2], weight: T) {
        let g = on_i.times(weight);
        self.add(i, j, [on_j.times(g.x), on_j.times(g.y), on_j.times(g.z)]);
    }

    /// Adds what of the stiffness of a tension in a facet acts along its unit normal, where `sides` are those across from its atoms and
    /// `weight` is the tension over four times the area (pN/µm³).
    #[inline(always)]
    pub fn add_tension(&mut self, facet: [u32; 3], sides: [V3<T>; 3], normal: V3<T>, weight: T) {
        for i in 0..3 {
            for j in 0..=i {
                let across = normal.times(sides[i].dot(sides[j]) * weight);
                let rows = [across.times(normal.x), across.times(normal.y), across.times(normal.z)];
                self.add(facet[i], facet[j], rows);
            }
        }
    }

    /// Takes what is held out of the matrix: one factor an atom and axis, 0 where held. Rows and columns of it become those of the
    /// identity.
    #[inline(always)]
    pub fn hold(&mut self, held: &[f64]) {
        let pattern = self.pattern;
        let held = held.as_chunks::<3>().0;
        for column in pattern.columns() {
            let across = held[column.atom];
            let mut diagonal = self.get(column.atom);
            for k in 0..3 {
                diagonal[k] = kept(diagonal[k], across, across[k]);
            }
            diagonal[0].x += T::constant(self.token, 1.0 - across[0]);
            diagonal[1].y += T::constant(self.token, 1.0 - across[1]);
            diagonal[2].z += T::constant(self.token, 1.0 - across[2]);
            self.set(column.atom, diagonal);
            for (&row, number) in column.rows.iter().zip(column.first..) {
                let ([a, b, c], along) = (self.get(number), held[row as usize]);
                self.set(number, [kept(a, across, along[0]), kept(b, across, along[1]), kept(c, across, along[2])]);
            }
        }
    }

    /// Multiplies all blocks by a number of each lane.
    #[inline(always)]
    pub fn scale(&mut self, factor: T) {
        for value in self.values.iter_mut().skip(self.part).step_by(self.stride) {
            *value = (T::load(self.token, *value) * factor).raw();
        }
    }
}

/// A row of a block whose columns are held or not, times whether the row is. (A closure in its place is not compiled for wide registers.)
#[inline(always)]
fn kept<T: Real>(row: V3<T>, [x, y, z]: [f64; 3], factor: f64) -> V3<T> {
    V3 { x: row.x * (x * factor), y: row.y * (y * factor), z: row.z * (z * factor) }
}

/// Blocks that are only read.
pub struct Seen<'a, T: Real> {
    token: T::Token,
    values: &'a [T::Raw],
    stride: usize,
    part: usize,
}

impl<'a, T: Real> Seen<'a, T> {
    /// Sees part `part` of the `stride` registers that the lanes of a block of cells fill.
    #[inline(always)]
    pub fn new(token: T::Token, values: &'a [T::Raw], stride: usize, part: usize) -> Self {
        Self { token, values, stride, part }
    }
}

/// Blocks of a factor that is only read.
pub trait BlockSource<T: Real> {
    /// A block.
    fn get(&self, block: usize) -> Block<T>;
}

impl<T: Real> BlockSource<T> for Seen<'_, T> {
    #[inline(always)]
    fn get(&self, block: usize) -> Block<T> {
        read(self.token, self.values, self.stride, self.part, block)
    }
}

/// Blocks of one cell, the same in all lanes.
pub struct Spread<'a, T: Real> {
    token: T::Token,
    values: &'a [f64],
}

impl<'a, T: Real> Spread<'a, T> {
    /// Sees the blocks of a cell that stands alone.
    #[inline(always)]
    pub fn new(token: T::Token, values: &'a [f64]) -> Self {
        Self { token, values }
    }
}

impl<T: Real> BlockSource<T> for Spread<'_, T> {
    #[inline(always)]
    fn get(&self, block: usize) -> Block<T> {
        let [a, b, c, d, e, f, g, h, i] = self.values.as_chunks::<9>().0[block];
        [V3::constant(self.token, [a, b, c]), V3::constant(self.token, [d, e, f]), V3::constant(self.token, [g, h, i])]
    }
}

/// A block of values. Where registers hold all lanes its nine numbers stand side by side and are looked up at once.
#[inline(always)]
fn read<T: Real>(token: T::Token, values: &[T::Raw], stride: usize, part: usize, block: usize) -> Block<T> {
    if stride == 1 {
        let [a, b, c, d, e, f, g, h, i] = values.as_chunks::<9>().0[block];
        [loaded(token, a, b, c), loaded(token, d, e, f), loaded(token, g, h, i)]
    } else {
        let slots = &values[9 * block * stride..9 * (block + 1) * stride];
        let mut rows = [V3::zero(token); 3];
        for (k, row) in rows.iter_mut().enumerate() {
            let at = 3 * k * stride + part;
            *row = loaded(token, slots[at], slots[at + stride], slots[at + 2 * stride]);
        }
        rows
    }
}

/// A vector of three registers.
#[inline(always)]
fn loaded<T: Real>(token: T::Token, x: T::Raw, y: T::Raw, z: T::Raw) -> V3<T> {
    V3 { x: T::load(token, x), y: T::load(token, y), z: T::load(token, z) }
}

/// A block by its columns.
#[inline(always)]
pub fn transposed<T: Real>([a, b, c]: Block<T>) -> Block<T> {
    [V3 { x: a.x, y: b.x, z: c.x }, V3 { x: a.y, y: b.y, z: c.y }, V3 { x: a.z, y: b.z, z: c.z }]
}
