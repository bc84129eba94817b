//! Flat sheets, such as an elastic substrate.

use super::Surface;
use crate::Vec3;

/// A flat rectangle in the plane z = 0, centred on the origin, facing +z: `length` µm along x in `along_x` divisions
/// and `width` µm along y in `along_y` divisions. Each division is cut in two facets along alternating diagonals, so
/// that the sheet prefers no direction.
///
/// Atoms are numbered row by row, x fastest: (`along_x` + 1) (`along_y` + 1) atoms, 2 `along_x` `along_y` facets.
///
/// # Panics
/// When a number of divisions is 0.
pub fn sheet(length: f64, width: f64, along_x: u32, along_y: u32) -> Surface {
    assert!(along_x > 0 && along_y > 0, "a sheet needs at least one division along x and along y");
    let mut surface = Surface::default();
    for j in 0..=along_y {
        for i in 0..=along_x {
            let x = length * (f64::from(i) / f64::from(along_x) - 0.5);
            let y = width * (f64::from(j) / f64::from(along_y) - 0.5);
            surface.positions.push(Vec3::new(x, y, 0.0));
        }
    }
    for j in 0..along_y {
        for i in 0..along_x {
            let corner = j * (along_x + 1) + i;
            let square = [corner, corner + 1, corner + along_x + 2, corner + along_x + 1];
            surface.facets.extend(cut_square(square, i + j));
        }
    }
    surface
}

/// Cuts a square (corners counter-clockwise seen from outside) along one diagonal if `parity` is even, else the other.
pub(super) fn cut_square([a, b, c, d]: [u32; 4], parity: u32) -> [[u32; 3]; 2] {
    if parity.is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::area;

    #[test]
    fn a_sheet_covers_its_rectangle() {
        let surface = sheet(4.0, 3.0, 8, 5);
        assert_eq!((surface.positions.len(), surface.facets.len()), (9 * 6, 2 * 8 * 5));
        assert!((area(&surface) - 12.0).abs() < 1e-13); // round-off of 80 terms
        assert_eq!(surface.positions[0], Vec3::new(-2.0, -1.5, 0.0));
    }
}
