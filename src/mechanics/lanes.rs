//! Eight cells at a time: how the arrays of a block of cells look to a force, whatever the processor.
//!
//! Cells that share a rest mesh stand in blocks; the block's array is `x[atom][axis][lane]`, one lane a cell. A force
//! is written once over [`Real`] and runs on `f64` (one cell) or on [`Lane`] (as many cells as the processor's
//! registers hold; chosen at run time by [`pulp`]). No fused multiply-add is used, so that a result is the same
//! to the last bit on every processor.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use pulp::{Arch, Simd, WithSimd, bytemuck};

/// Lanes of a block of cells that share a mesh. One AVX-512 register, two AVX2 registers.
pub const LANES: usize = 8;

/// A number of one cell, or the same number of several cells side by side.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Mul<f64, Output = Self>
    + Add<f64, Output = Self>
{
    /// What lies in memory.
    type Raw: Copy;
    /// The proof that the processor has these registers; `()` for `f64`.
    type Token: Copy;
    /// The numbers of an array as registers; its length is a multiple of the lanes.
    fn view(token: Self::Token, data: &[f64]) -> &[Self::Raw];
    /// The numbers of an array as registers, to be written.
    fn view_mut(token: Self::Token, data: &mut [f64]) -> &mut [Self::Raw];
    /// From memory to register.
    fn load(token: Self::Token, raw: Self::Raw) -> Self;
    /// From register to memory.
    fn raw(self) -> Self::Raw;
    /// The same constant in all lanes.
    fn constant(token: Self::Token, value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The larger of both, lane by lane.
    fn max(self, other: Self) -> Self;
    /// The smaller of both, lane by lane.
    fn min(self, other: Self) -> Self;
    /// Whether any lane is less than the constant.
    fn any_less(self, bound: f64) -> bool;
    /// What a function makes of each lane by itself: for what is looked up, not for arithmetic.
    fn map(self, by: impl Fn(f64) -> f64) -> Self;
}

impl Real for f64 {
    type Raw = f64;
    type Token = ();
    #[inline(always)]
    fn view(_: (), data: &[f64]) -> &[f64] {
        data
    }
    #[inline(always)]
    fn view_mut(_: (), data: &mut [f64]) -> &mut [f64] {
        data
    }
    #[inline(always)]
    fn load(_: (), raw: f64) -> f64 {
        raw
    }
    #[inline(always)]
    fn raw(self) -> f64 {
        self
    }
    #[inline(always)]
    fn constant(_: (), value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        self.sqrt()
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn any_less(self, bound: f64) -> bool {
        self < bound
    }
    #[inline(always)]
    fn map(self, by: impl Fn(f64) -> f64) -> f64 {
        by(self)
    }
}

/// A register of several cells' numbers.
#[derive(Clone, Copy)]
pub struct Lane<S: Simd> {
    simd: S,
    value: S::f64s,
}

impl<S: Simd> Real for Lane<S> {
    type Raw = S::f64s;
    type Token = S;
    #[inline(always)]
    fn view(_: S, data: &[f64]) -> &[S::f64s] {
        S::as_simd_f64s(data).0
    }
    #[inline(always)]
    fn view_mut(_: S, data: &mut [f64]) -> &mut [S::f64s] {
        S::as_mut_simd_f64s(data).0
    }
    #[inline(always)]
    fn load(simd: S, value: S::f64s) -> Self {
        Self { simd, value }
    }
    #[inline(always)]
    fn raw(self) -> S::f64s {
        self.value
    }
    #[inline(always)]
    fn constant(simd: S, value: f64) -> Self {
        Self { simd, value: simd.splat_f64s(value) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { value: self.simd.sqrt_f64s(self.value), ..self }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        let mask = self.simd.greater_than_f64s(self.value, other.value);
        Self { value: self.simd.select_f64s(mask, self.value, other.value), ..self }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        let mask = self.simd.less_than_f64s(self.value, other.value);
        Self { value: self.simd.select_f64s(mask, self.value, other.value), ..self }
    }
    #[inline(always)]
    fn any_less(self, bound: f64) -> bool {
        self.simd.reduce_min_f64s(self.value) < bound
    }
    #[inline(always)]
    fn map(mut self, by: impl Fn(f64) -> f64) -> Self {
        let lanes: &mut [f64] = bytemuck::cast_slice_mut(std::slice::from_mut(&mut self.value));
        lanes.iter_mut().for_each(|lane| *lane = by(*lane));
        self
    }
}

impl<S: Simd> Add for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { value: self.simd.add_f64s(self.value, other.value), ..self }
    }
}
impl<S: Simd> Sub for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { value: self.simd.sub_f64s(self.value, other.value), ..self }
    }
}
impl<S: Simd> Mul for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { value: self.simd.mul_f64s(self.value, other.value), ..self }
    }
}
impl<S: Simd> Div for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self { value: self.simd.div_f64s(self.value, other.value), ..self }
    }
}
impl<S: Simd> Neg for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: self.simd.neg_f64s(self.value), ..self }
    }
}
impl<S: Simd> AddAssign for Lane<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<S: Simd> SubAssign for Lane<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl<S: Simd> Mul<f64> for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self { value: self.simd.mul_f64s(self.value, self.simd.splat_f64s(other)), ..self }
    }
}
impl<S: Simd> Add<f64> for Lane<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.simd.add_f64s(self.value, self.simd.splat_f64s(other)), ..self }
    }
}

/// A vector in space of one or several cells.
#[derive(Clone, Copy)]
pub struct V3<T> {
    /// Component along x.
    pub x: T,
    /// Component along y.
    pub y: T,
    /// Component along z.
    pub z: T,
}

impl<T: Real> V3<T> {
    /// The null vector.
    #[inline(always)]
    pub fn zero(token: T::Token) -> Self {
        let zero = T::constant(token, 0.0);
        Self { x: zero, y: zero, z: zero }
    }
    /// The same constant vector in all lanes.
    #[inline(always)]
    pub fn constant(token: T::Token, value: [f64; 3]) -> Self {
        Self { x: T::constant(token, value[0]), y: T::constant(token, value[1]), z: T::constant(token, value[2]) }
    }
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
    /// Vector product.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
    /// Squared length.
    #[inline(always)]
    pub fn squared(self) -> T {
        self.dot(self)
    }
    /// Times a number of each lane.
    #[inline(always)]
    pub fn times(self, factor: T) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
    /// Times the same constant in all lanes.
    #[inline(always)]
    pub fn scaled(self, factor: f64) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}

impl<T: Real> Add for V3<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}
impl<T: Real> Sub for V3<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}
impl<T: Real> Neg for V3<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}
impl<T: Real> AddAssign for V3<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl<T: Real> SubAssign for V3<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// The vectors of a block's atoms, read only: `data[(3·atom + axis)·stride + part]`.
pub struct Vectors<'a, T: Real> {
    /// The processor's token.
    pub token: T::Token,
    data: &'a [T::Raw],
    stride: usize,
    part: usize,
}

impl<'a, T: Real> Vectors<'a, T> {
    /// Sees part `part` of the `stride` registers that the lanes of a block fill.
    #[inline(always)]
    pub fn new(token: T::Token, data: &'a [T::Raw], stride: usize, part: usize) -> Self {
        Self { token, data, stride, part }
    }
    /// Number of atoms.
    #[inline(always)]
    pub fn atoms(&self) -> usize {
        self.data.len() / (3 * self.stride)
    }
    /// The vector of an atom.
    #[inline(always)]
    pub fn get(&self, atom: usize) -> V3<T> {
        let at = 3 * atom * self.stride + self.part;
        V3 {
            x: T::load(self.token, self.data[at]),
            y: T::load(self.token, self.data[at + self.stride]),
            z: T::load(self.token, self.data[at + 2 * self.stride]),
        }
    }
}

/// The vectors of a block's atoms, to be added to.
pub struct VectorsMut<'a, T: Real> {
    /// The processor's token.
    pub token: T::Token,
    data: &'a mut [T::Raw],
    stride: usize,
    part: usize,
}

impl<'a, T: Real> VectorsMut<'a, T> {
    /// Sees part `part` of the `stride` registers that the lanes of a block fill.
    #[inline(always)]
    pub fn new(token: T::Token, data: &'a mut [T::Raw], stride: usize, part: usize) -> Self {
        Self { token, data, stride, part }
    }
    /// The vector of an atom.
    #[inline(always)]
    pub fn get(&self, atom: usize) -> V3<T> {
        let at = 3 * atom * self.stride + self.part;
        V3 {
            x: T::load(self.token, self.data[at]),
            y: T::load(self.token, self.data[at + self.stride]),
            z: T::load(self.token, self.data[at + 2 * self.stride]),
        }
    }
    /// Sets the vector of an atom.
    #[inline(always)]
    pub fn set(&mut self, atom: usize, value: V3<T>) {
        let at = 3 * atom * self.stride + self.part;
        self.data[at] = value.x.raw();
        self.data[at + self.stride] = value.y.raw();
        self.data[at + 2 * self.stride] = value.z.raw();
    }
    /// Adds to the vector of an atom.
    #[inline(always)]
    pub fn add(&mut self, atom: usize, value: V3<T>) {
        self.set(atom, self.get(atom) + value);
    }
    /// Subtracts from the vector of an atom.
    #[inline(always)]
    pub fn sub(&mut self, atom: usize, value: V3<T>) {
        self.set(atom, self.get(atom) - value);
    }
}

/// Work on one block of cells, written once for any number of lanes. Everything it calls must be `#[inline(always)]`,
/// or it runs without the processor's wide registers.
pub trait BlockWork {
    /// What the work returns.
    type Output;
    /// Does the work; the lanes of the block fill `stride` registers, taken one `part` after the other.
    fn run<T: Real>(self, token: T::Token, stride: usize) -> Self::Output;
}

struct Vectorised<W>(W);

impl<W: BlockWork> WithSimd for Vectorised<W> {
    type Output = W::Output;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> W::Output {
        self.0.run::<Lane<S>>(simd, LANES / S::F64_LANES)
    }
}

/// Runs work on a block of `lanes` cells ([`LANES`] or 1) with the widest registers this processor has.
pub fn dispatch<W: BlockWork>(lanes: usize, work: W) -> W::Output {
    if lanes == 1 { work.run::<f64>((), 1) } else { Arch::new().dispatch(Vectorised(work)) }
}
