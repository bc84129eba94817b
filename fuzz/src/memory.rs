//! No input takes more than a gigabyte: an allocator that counts, and ends the program where there is more. libFuzzer's own limit sees
//! only memory that was written to, and too late where a length in a file is believed.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicIsize, Ordering};

/// The most bytes that may be held at a time.
const MOST: isize = 1_000_000_000;

static HELD: AtomicIsize = AtomicIsize::new(0);

/// The system's allocator with a limit.
pub struct Limited;

#[global_allocator]
static LIMITED: Limited = Limited;

/// Counts bytes that are asked for.
fn take(bytes: usize) {
    let bytes = isize::try_from(bytes).unwrap_or(isize::MAX);
    let held = HELD.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
    if held > MOST {
        // No more is counted, so that what tells of it can allocate.
        HELD.store(isize::MIN / 2, Ordering::Relaxed);
        panic!("{bytes} bytes were asked for, which makes {held} at once: more than {MOST}");
    }
}

// SAFETY: all is done by the system's allocator; a panic in here ends the program, since the hook of libFuzzer aborts.
unsafe impl GlobalAlloc for Limited {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        HELD.fetch_sub(layout.size() as isize, Ordering::Relaxed);
        take(size);
        // SAFETY: as the caller promises.
        unsafe { System.realloc(old, layout, size) }
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size() as isize, Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(old, layout) }
    }
}
