//! How the face of a gel has moved under cells, on a regular grid, as programs for traction force microscopy read it.

use super::gel::Gel;
use super::half_space::Loaded;
use crate::Vec3;
use crate::error::{Error, Fault, Result, short};
use crate::output::ResultFile;
use std::fmt::Write;

/// Points along an axis when no distance between them is named.
const POINTS: f64 = 64.0;

/// The most points that a map may have: 2 000 along each axis, as many as a camera has pixels; with its text, of some 150 bytes a point, less than a gigabyte.
const MOST: f64 = 4e6;

/// How much of a facet a point may be outside of it, for round-off.
const ROUND_OFF: f64 = 1e-9;

/// The displacements of a flat face that looks upwards at the points of a grid.
pub struct DisplacementMap {
    /// Between points along x and y, µm.
    pub spacing: f64,
    /// Row by row, y after y.
    pub points: Vec<Point>,
    /// Whether the run recorded what pulls at the face.
    pub has_tractions: bool,
}

/// A point of the grid.
pub struct Point {
    /// Where it was in the first frame, µm.
    pub at: [f64; 2],
    /// How far it has gone since, µm.
    pub moved: Vec3,
    /// What pulls at it, pN/µm².
    pub traction: Vec3,
}

impl DisplacementMap {
    /// That of the one body of a type in a frame; a distance between points is chosen when none is given. Between atoms displacements and tractions go on
    /// straight lines; where the face has no facet they are 0.
    ///
    /// # Errors
    /// When there is no such type, not one body of it, or no face of it that looks upwards, or when there would be more than four million points; a
    /// damaged file.
    pub fn of(file: &ResultFile, name: &str, frame: usize, spacing: Option<f64>) -> Result<Self> {
        let Gel { rest, moved, facets, forces } = Gel::of(file, name, frame, Vec3::z())?;
        let has_tractions = forces.is_some();
        let forces = forces.unwrap_or_else(|| vec![Vec3::zeros(); rest.len()]);
        let corners = || facets.iter().flatten().map(|corner| rest[*corner]);
        let low = corners().fold(Vec3::repeat(f64::INFINITY), |low, at| low.inf(&at));
        let high = corners().fold(Vec3::repeat(f64::NEG_INFINITY), |high, at| high.sup(&at));
        let size = (high - low).xy();
        let spacing = spacing.unwrap_or(size.max() / POINTS);
        let asked = (size.x / spacing + 1.0) * (size.y / spacing + 1.0);
        if asked > MOST {
            let least = (size.x * size.y / MOST).sqrt();
            let message = format!(
                "a point every {} um makes {asked:.1e} of them, and a map has at most {MOST:.0e}",
                short(spacing)
            );
            let fault = Fault::new(message).help(format!("take a longer spacing, above {} um", short(least)));
            return Err(Error::input(fault));
        }
        let along = |axis: usize| (size[axis] / spacing * (1.0 + ROUND_OFF)).floor() as usize;
        let (columns, rows) = (along(0), along(1));
        let at = |column: usize, row: usize| [low.x + column as f64 * spacing, low.y + row as f64 * spacing];
        let all = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (column, row)));
        let mut points: Vec<Point> = all
            .map(|(column, row)| Point { at: at(column, row), moved: Vec3::zeros(), traction: Vec3::zeros() })
            .collect();
        let loaded = Loaded::by_forces(rest, facets, &forces);
        for facet in &loaded.facets {
            let [a, b, c] = facet.map(|corner| loaded.points[corner].xy() - low.xy());
            let reach = |axis: usize, last: usize| {
                let (least, most) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
                let first = (least / spacing - ROUND_OFF).ceil().max(0.0) as usize;
                first..=((most / spacing + ROUND_OFF).floor() as usize).min(last)
            };
            let twice_area = (b - a).perp(&(c - a));
            for (column, row) in reach(1, rows).flat_map(|row| reach(0, columns).map(move |column| (column, row))) {
                let p = nalgebra::Vector2::new(column as f64, row as f64) * spacing - a;
                let (of_b, of_c) = (p.perp(&(c - a)) / twice_area, (b - a).perp(&p) / twice_area);
                let shares = [1.0 - of_b - of_c, of_b, of_c];
                if shares.iter().all(|share| *share > -ROUND_OFF) {
                    let between = |values: &[Vec3]| (0..3).map(|corner| shares[corner] * values[facet[corner]]).sum();
                    let point = &mut points[row * (columns + 1) + column];
                    (point.moved, point.traction) = (between(&moved), between(&loaded.tractions));
                }
            }
        }
        Ok(Self { spacing, points, has_tractions })
    }

    /// As a table: positions, displacements, and tractions where they are known.
    pub fn as_csv(&self) -> String {
        let tractions = if self.has_tractions { ",tx_Pa,ty_Pa,tz_Pa" } else { "" };
        let mut text = format!("x_um,y_um,ux_um,uy_um,uz_um{tractions}\n");
        for Point { at: [x, y], moved, traction } in &self.points {
            write!(text, "{x},{y},{},{},{}", moved.x, moved.y, moved.z).expect("text takes it");
            if self.has_tractions {
                write!(text, ",{},{},{}", traction.x, traction.y, traction.z).expect("text takes it");
            }
            text.push('\n');
        }
        text
    }

    /// As plain rows x, y, ux, uy and the size of the latter two, in pixels of this size (µm), from the corner on: as the plugins PIV and FTTC of ImageJ
    /// read it (Tseng et al. 2012, Martiel et al. 2015), which know no exponents and no header.
    pub fn in_pixels(&self, pixel: f64) -> String {
        let mut text = String::new();
        let first = self.points.first().map_or([0.0; 2], |point| point.at);
        for Point { at, moved, .. } in &self.points {
            let [x, y] = [0, 1].map(|axis| ((at[axis] - first[axis]) / pixel).round());
            let [ux, uy] = [moved.x / pixel, moved.y / pixel];
            writeln!(text, "{x} {y} {ux:.6} {uy:.6} {:.6}", ux.hypot(uy)).expect("text takes it");
        }
        text
    }
}
