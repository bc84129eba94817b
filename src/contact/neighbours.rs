//! Which bodies may touch: a grid of boxes as wide as a typical body, and the bodies that share one.

use super::boxes::Bounds;

/// A body takes no more cells of the grid than this on average; a wider grid is taken where large bodies would.
const ENTRIES_PER_BODY: usize = 32;

/// For every body the bodies whose boxes meet its own, in ascending order and itself among them, and the scratch to find them. What is large
/// (a sheet) takes many cells of the grid, what is small takes one to eight, so the cost is linear in the bodies.
#[derive(Debug, Clone, Default)]
pub(super) struct Neighbours {
    first: Vec<u32>,
    bodies: Vec<u32>,
    entries: Vec<(u64, u32)>,
    widths: Vec<f32>,
}

/// The cell of the grid along each axis. Numbers wrap at 2²¹: bodies that far apart are told apart by their boxes.
fn grid_cell(point: [f32; 3], width: f32) -> [i64; 3] {
    point.map(|x| (f64::from(x) / f64::from(width)).floor().clamp(-1e6, 1e6) as i64)
}

fn key(position: [i64; 3]) -> u64 {
    position.iter().fold(0, |key, &index| key << 21 | (index + (1 << 20)) as u64)
}

fn grid_cells_of(bounds: &Bounds, width: f32) -> [std::ops::RangeInclusive<i64>; 3] {
    let (low, high) = (grid_cell(bounds.low, width), grid_cell(bounds.high, width));
    [0, 1, 2].map(|axis| low[axis]..=high[axis])
}

/// Calls `found` once for every two bodies whose boxes meet; `entries` are sorted.
fn for_each_pair(points: &[(u64, u32)], bounds: &[Bounds], width: f32, mut found: impl FnMut(u32, u32)) {
    for together in points.chunk_by(|left, right| left.0 == right.0) {
        for (index, &(here, first)) in together.iter().enumerate() {
            for &(_, second) in &together[index + 1..] {
                let (one, other) = (&bounds[first as usize], &bounds[second as usize]);
                // Two boxes may share many cells of the grid: the lowest corner of what they share lies in one only.
                let corner = [0, 1, 2].map(|axis| one.low[axis].max(other.low[axis]));
                if one.meets(other) && key(grid_cell(corner, width)) == here {
                    found(first, second);
                }
            }
        }
    }
}

impl Neighbours {
    /// The bodies whose boxes meet that of a body, ascending, itself among them.
    pub fn of(&self, body: u32) -> &[u32] {
        &self.bodies[self.first[body as usize] as usize..self.first[body as usize + 1] as usize]
    }

    /// Finds all neighbours of the bodies with these boxes.
    pub fn find(&mut self, bounds: &[Bounds]) {
        let width = self.width(bounds);
        self.entries.clear();
        for (body, bounds) in bounds.iter().enumerate() {
            let [x, y, z] = grid_cells_of(bounds, width);
            for i in x {
                for j in y.clone() {
                    self.entries.extend(z.clone().map(|k| (key([i, j, k]), body as u32)));
                }
            }
        }
        self.entries.sort_unstable();
        // Counted at first, so that no list of pairs is held beside that of neighbours.
        self.first.clear();
        self.first.resize(bounds.len() + 1, 0);
        (1..=bounds.len()).for_each(|body| self.first[body] = 1);
        for_each_pair(&self.entries, bounds, width, |one, other| {
            self.first[one as usize + 1] += 1;
            self.first[other as usize + 1] += 1;
        });
        (0..bounds.len()).for_each(|body| self.first[body + 1] += self.first[body]);
        self.bodies.clear();
        self.bodies.resize(self.first[bounds.len()] as usize, 0);
        let (first, bodies) = (&mut self.first, &mut self.bodies);
        let mut add = |body: u32, other: u32| {
            bodies[first[body as usize] as usize] = other;
            first[body as usize] += 1;
        };
        (0..bounds.len() as u32).for_each(|body| add(body, body));
        for_each_pair(&self.entries, bounds, width, |one, other| {
            add(one, other);
            add(other, one);
        });
        // The entry of the next neighbour is by now that of the next body's first.
        self.first.rotate_right(1);
        self.first[0] = 0;
        for body in 0..bounds.len() {
            let own = self.first[body] as usize..self.first[body + 1] as usize;
            self.bodies[own].sort_unstable();
        }
    }

    /// The median of the longest extents of bodies, doubled until large bodies do not fill the grid: without end where a box has none, and then
    /// all bodies share a cell of the grid.
    fn width(&mut self, bounds: &[Bounds]) -> f32 {
        let extent = |bounds: &Bounds| (0..3).map(|axis| bounds.high[axis] - bounds.low[axis]).fold(0.0, f32::max);
        self.widths.clear();
        self.widths.extend(bounds.iter().map(extent).filter(|width| width.is_finite() && *width > 0.0));
        let middle = self.widths.len() / 2;
        let mut width = match self.widths.as_mut_slice() {
            [] => 1.0,
            widths => *widths.select_nth_unstable_by(middle, f32::total_cmp).1,
        };
        let entries = |width: f32| -> f64 {
            let count = |along: &std::ops::RangeInclusive<i64>| (along.end() - along.start() + 1).max(0) as f64;
            bounds.iter().map(|bounds| grid_cells_of(bounds, width).iter().map(count).product::<f64>()).sum()
        };
        while entries(width) > (ENTRIES_PER_BODY * bounds.len() + 64) as f64 {
            width *= 2.0;
        }
        width
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        4 * (self.first.capacity() + self.bodies.capacity() + self.widths.capacity()) + 16 * self.entries.capacity()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_without_end_take_no_more_of_the_grid_than_others() {
        let boxed = |low: f32, high: f32| Bounds { low: [low; 3], high: [high; 3] };
        let bounds = [boxed(f32::NEG_INFINITY, f32::INFINITY), boxed(0.0, 1.0), boxed(5.0, 6.0)];
        let mut neighbours = Neighbours::default();
        neighbours.find(&bounds);
        assert_eq!([0, 1, 2].map(|body| neighbours.of(body)), [&[0, 1, 2][..], &[0, 1], &[0, 2]]);
    }
}
