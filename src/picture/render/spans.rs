//! Which samples a facet may cover: those whose middles lie in its bounding box, and within a row those between its edges.

use std::ops::Range;

/// A sample on an edge may miss both neighbours by rounding; an overlap of a ten-thousandth closes the gap.
pub(super) const SLACK: f32 = -1e-4;

/// Those of the `count` samples from `from` on whose middles lie between two positions; often none, since facets may be narrower than a
/// sample.
pub(super) fn samples_between(low: f32, high: f32, from: usize, count: usize) -> Range<usize> {
    let first = (low - 0.5).ceil().max(from as f32) as usize;
    // One beyond the last: as a number without a sign it would have no value before sample 0.
    let end = ((high - 0.5).floor().min((from + count) as f32 - 1.0) + 1.0) as usize;
    first..end.max(first)
}

/// The columns, counted from the start of a row of `count`, where all three weights of a triangle's corners can be at
/// least `least`, given the weights at column 0 and their change per column; a column too many at either end, so that
/// the exact test stays with the caller. Thin slanted triangles would otherwise cost their whole bounding box.
pub(super) fn row_span(starts: [f32; 3], steps: [f32; 3], least: f32, count: usize) -> Range<usize> {
    let (mut from, mut to) = (0.0f32, count as f32);
    for (start, step) in starts.into_iter().zip(steps) {
        let crossing = (least - start) / step;
        if step > 0.0 {
            from = from.max(crossing - 1.0);
        } else if step < 0.0 {
            to = to.min(crossing + 2.0);
        } else if start < least {
            return 0..0;
        }
    }
    let from = from.max(0.0) as usize;
    from..(to.max(0.0) as usize).min(count).max(from)
}

#[cfg(test)]
mod tests {
    use super::samples_between;

    #[test]
    fn samples_are_those_whose_middles_lie_between() {
        assert_eq!(samples_between(0.4, 2.6, 0, 10), 0..3);
        assert_eq!(samples_between(0.6, 2.4, 0, 10), 1..2);
        assert_eq!(samples_between(-3.0, 30.0, 0, 10), 0..10);
        assert_eq!(samples_between(-3.0, 30.0, 16, 8), 16..24);
        assert_eq!(samples_between(2.5, 2.5, 0, 10), 2..3, "both ends belong to it");
    }

    #[test]
    fn what_lies_between_two_middles_or_beside_the_picture_covers_none() {
        for (low, high) in [(0.1, 0.3), (3.6, 4.4), (-2.0, -1.0), (-0.4, 0.4), (9.6, 20.0), (12.0, 13.0)] {
            let samples = samples_between(low, high, 0, 10);
            assert_eq!(samples.len(), 0, "{low} to {high}: {samples:?}");
        }
        assert!(samples_between(3.0, 5.0, 16, 8).is_empty(), "above the band");
        assert!(samples_between(30.0, 35.0, 16, 8).is_empty(), "below the band");
    }
}
