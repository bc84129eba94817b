//! How the numbers of a frame go to the page: little-endian, positions in 65 536 parts of the box around them.

use crate::output::Cell;

/// A box around all positions of a frame, or of several: its lowest corner and its sides, µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    /// The lowest corner, µm.
    pub low: [f64; 3],
    /// The sides, µm; none is 0.
    pub sides: [f64; 3],
}

/// The largest number of 16 bits.
const MOST: f64 = 65_535.0;

/// What stands for a number that is none among those of 16 bits.
const NONE: u16 = u16::MAX;

impl Box3 {
    /// The box around finite positions; one of 1 µm where there is none.
    pub fn around<'a>(positions: impl IntoIterator<Item = &'a [f64; 3]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for position in positions {
            for axis in 0..3 {
                if position[axis].is_finite() {
                    (low[axis], high[axis]) = (low[axis].min(position[axis]), high[axis].max(position[axis]));
                }
            }
        }
        let sides = [0, 1, 2].map(|axis| if high[axis] > low[axis] { high[axis] - low[axis] } else { 1.0 });
        Self { low: low.map(|low| if low.is_finite() { low } else { 0.0 }), sides }
    }

    /// The box around two.
    pub fn joined(self, other: Self) -> Self {
        let high = |of: &Self| [0, 1, 2].map(|axis| of.low[axis] + of.sides[axis]);
        Self::around(&[self.low, other.low, high(&self), high(&other)])
    }
}

/// The cells of a frame and where their atoms are: u32 cells, u32 atoms, f32 low\[3\], f32 sides\[3\], f64 id\[cells\], u32 type\[cells\], then u16 x, y and z of all atoms,
/// one axis after the other.
pub fn frame(cells: &[Cell], positions: &[[f64; 3]], within: &Box3) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(32 + 12 * cells.len() + 6 * positions.len());
    bytes.extend((cells.len() as u32).to_le_bytes());
    bytes.extend((positions.len() as u32).to_le_bytes());
    within.low.iter().chain(&within.sides).for_each(|number| bytes.extend((*number as f32).to_le_bytes()));
    cells.iter().for_each(|cell| bytes.extend((cell.id as f64).to_le_bytes()));
    cells.iter().for_each(|cell| bytes.extend(cell.kind.to_le_bytes()));
    for axis in 0..3 {
        let parts = |at: f64| ((at - within.low[axis]) / within.sides[axis] * MOST).round().clamp(0.0, MOST) as u16;
        positions.iter().for_each(|position| bytes.extend(parts(position[axis]).to_le_bytes()));
    }
    bytes
}

/// Numbers as f32.
pub fn values(values: &[f64]) -> Vec<u8> {
    values.iter().flat_map(|value| (*value as f32).to_le_bytes()).collect()
}

/// The values of a field: f32 lowest, f32 highest, and u16 in equal parts between them, the last for what is no number.
pub fn field(values: &[f64]) -> Vec<u8> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    let scale = if high > low { (MOST - 1.0) / (high - low) } else { 0.0 };
    let part = |value: f64| if value.is_finite() { ((value - low) * scale).round() as u16 } else { NONE };
    let ends = [low as f32, high as f32].into_iter().flat_map(f32::to_le_bytes);
    ends.chain(values.iter().flat_map(|value| part(*value).to_le_bytes())).collect()
}

/// Lines with a number each: u32 how many, then f32 from\[3\], to\[3\], number.
pub fn lines(lines: &[([[f64; 3]; 2], f64)]) -> Vec<u8> {
    let mut bytes = (lines.len() as u32).to_le_bytes().to_vec();
    for ([from, to], number) in lines {
        from.iter().chain(to).chain([number]).for_each(|number| bytes.extend((*number as f32).to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn u16_at(bytes: &[u8], at: usize) -> f64 {
        f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]))
    }

    #[test]
    fn positions_are_within_half_a_part_of_their_box() {
        let positions = [[-3.0, 0.1, 2.0], [17.0, 0.2, 2.0], [4.123, 0.17, 2.0]];
        let cells = [Cell { id: 5, kind: 1, parent: None }];
        let within = Box3::around(&positions);
        let bytes = frame(&cells, &positions, &within);
        assert_eq!(bytes.len(), 32 + 12 + 18);
        for axis in 0..3 {
            for (atom, position) in positions.iter().enumerate() {
                let part = u16_at(&bytes, 44 + 6 * axis + 2 * atom);
                let found = within.low[axis] + part / MOST * within.sides[axis];
                assert!((found - position[axis]).abs() <= 0.5001 * within.sides[axis] / MOST);
            }
        }
    }

    #[test]
    fn what_is_no_number_is_told_apart() {
        let bytes = field(&[1.0, f64::NAN, 3.0, 2.0]);
        assert_eq!([8, 10, 12, 14].map(|at| u16_at(&bytes, at)), [0.0, MOST, MOST - 1.0, (MOST - 1.0) / 2.0]);
        assert_eq!(field(&[f64::NAN])[..8], [0; 8]);
        assert_eq!(Box3::around(&[]), Box3 { low: [0.0; 3], sides: [1.0; 3] });
    }

    #[test]
    fn joined_boxes_hold_both() {
        let joined = Box3::around(&[[0.0; 3], [1.0; 3]]).joined(Box3::around(&[[4.0; 3], [6.0; 3]]));
        assert_eq!(joined, Box3 { low: [0.0; 3], sides: [6.0; 3] });
    }
}
