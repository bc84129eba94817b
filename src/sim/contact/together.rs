//! Numbers that several threads change at once, each its own.

use std::marker::PhantomData;

/// A list of which several threads hold items of their own.
pub struct Together<'a, T> {
    first: *mut T,
    len: usize,
    items: PhantomData<&'a mut [T]>,
}

// SAFETY: items are only reached through `item` and `part`, whose callers keep to items of their own.
unsafe impl<T: Send> Sync for Together<'_, T> {}

impl<'a, T> Together<'a, T> {
    /// Takes the list until it is dropped.
    pub fn new(items: &'a mut [T]) -> Self {
        Self { first: items.as_mut_ptr(), len: items.len(), items: PhantomData }
    }

    /// An item.
    ///
    /// # Safety
    /// While it is held nobody else holds it.
    ///
    /// # Panics
    /// When there is none of this number.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)] // that is what the caller answers for
    pub unsafe fn item(&self, at: usize) -> &mut T {
        assert!(at < self.len);
        // SAFETY: inside the list by the line above, and unshared by this function's contract.
        unsafe { &mut *self.first.add(at) }
    }

    /// A part of the list.
    ///
    /// # Safety
    /// While it is held nobody else holds an item of it.
    ///
    /// # Panics
    /// When it ends beyond the list.
    #[inline(always)]
    #[allow(clippy::mut_from_ref)] // that is what the caller answers for
    pub unsafe fn part(&self, range: std::ops::Range<usize>) -> &mut [T] {
        assert!(range.start <= range.end && range.end <= self.len);
        // SAFETY: inside the list by the line above, and unshared by this function's contract.
        unsafe { std::slice::from_raw_parts_mut(self.first.add(range.start), range.len()) }
    }
}
