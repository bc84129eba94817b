//! The samples of a picture: how many, and what one shows that no facet covers.

/// Samples per pixel along each side; 2 × 2 samples smooth outlines at a third of the cost of 3 × 3.
pub(super) const SAMPLES: usize = 2;
/// Rows of pixels that are worked on as one piece; its buffers fit a core's own cache.
pub(super) const BAND_ROWS: usize = 8;
/// Rows of samples above and below those of a band that it knows as well: outlines depend on neighbours.
pub(super) const BESIDE: usize = 1;

/// A sample through which nothing but the background is seen.
pub(super) const NOTHING: u32 = u32::MAX;
/// A sample through which the floor is seen.
pub(super) const FLOOR: u32 = u32::MAX - 1;
/// A sample through which the sheet is seen.
pub(super) const SHEET: u32 = u32::MAX - 2;
