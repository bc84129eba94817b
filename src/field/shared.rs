//! The values of a grid, shared among threads, and columns of them that are worked on where they lie.

use std::marker::PhantomData;

use pulp::Simd;

/// Lines that are solved side by side.
pub const WIDTH: usize = 16;

/// The values of all species, shared among threads that write to parts of it that do not overlap.
pub struct Shared<'a> {
    first: *mut f64,
    len: usize,
    values: PhantomData<&'a mut [f64]>,
}

// SAFETY: the pointer is only reached through `part`, whose callers keep to parts of their own.
unsafe impl Sync for Shared<'_> {}

impl<'a> Shared<'a> {
    /// Takes the values until it is dropped.
    pub fn new(values: &'a mut [f64]) -> Self {
        Self { first: values.as_mut_ptr(), len: values.len(), values: PhantomData }
    }

    /// How many values there are.
    pub fn len(&self) -> usize {
        self.len
    }

    /// A part of the values.
    ///
    /// # Safety
    /// While the part is held nobody else holds one that overlaps it.
    #[allow(clippy::mut_from_ref)] // that is what the caller answers for
    pub unsafe fn part(&self, at: usize, len: usize) -> &mut [f64] {
        assert!(at + len <= self.len);
        // SAFETY: inside the values by the line above, and unshared by this function's contract.
        unsafe { std::slice::from_raw_parts_mut(self.first.add(at), len) }
    }

    /// Asks the memory for a value that will be needed soon. Nothing happens if there is none at this address.
    #[inline(always)]
    pub fn ask(&self, at: usize) {
        #[cfg(target_arch = "x86_64")]
        self.prefetch::<{ std::arch::x86_64::_MM_HINT_T0 }>(at);
        #[cfg(not(target_arch = "x86_64"))]
        let _ = at;
    }

    /// The same for a value that will be needed a while later: it is not to take the place of what is needed first.
    #[inline(always)]
    pub fn ask_for_later(&self, at: usize) {
        #[cfg(target_arch = "x86_64")]
        self.prefetch::<{ std::arch::x86_64::_MM_HINT_T1 }>(at);
        #[cfg(not(target_arch = "x86_64"))]
        let _ = at;
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn prefetch<const HINT: i32>(&self, at: usize) {
        // SAFETY: nothing is read; the processor ignores addresses that are not the program's.
        unsafe { std::arch::x86_64::_mm_prefetch::<HINT>(self.first.wrapping_add(at).cast()) };
    }
}

/// Sixteen columns side by side that are read and written where they lie.
#[derive(Clone, Copy)]
pub struct Columns<'a> {
    values: &'a Shared<'a>,
    first: usize,
    stride: usize,
}

impl<'a> Columns<'a> {
    /// Columns from a first box on whose boxes are `stride` apart.
    ///
    /// # Safety
    /// Nobody else holds a box of these columns.
    pub unsafe fn new(values: &'a Shared<'a>, first: usize, stride: usize) -> Self {
        Self { values, first, stride }
    }

    /// The boxes at one height.
    #[inline(always)]
    pub fn row<S: Simd>(&self, i: usize) -> &'a mut [S::f64s] {
        // SAFETY: nobody else holds these boxes, and no row is asked for while it is held.
        S::as_mut_simd_f64s(unsafe { self.values.part(self.first + i * self.stride, WIDTH) }).0
    }

    /// Asks the memory for the boxes at one height, which will be needed soon.
    #[inline(always)]
    pub fn ask(&self, i: usize) {
        self.values.ask(self.first + i * self.stride);
        self.values.ask(self.first + i * self.stride + WIDTH - 1);
    }
}

/// The lines that are solved after others, which the memory is asked for while those are solved: there is nothing to
/// wait for then. Grids beyond the cache would spend half of the time waiting.
#[derive(Clone, Copy)]
pub struct Next<'a> {
    /// All values.
    pub values: &'a Shared<'a>,
    /// Where they begin.
    pub first: usize,
    /// From sixteen of their values to the next sixteen.
    pub stride: usize,
}

impl Next<'_> {
    /// Asks the memory for sixteen values.
    #[inline(always)]
    pub fn ask(&self, i: usize) {
        self.values.ask_for_later(self.first + i * self.stride);
        self.values.ask_for_later(self.first + i * self.stride + WIDTH - 1);
    }
}
