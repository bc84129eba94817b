//! How the face of a gel has moved under cells, on a regular grid, as programs for traction force microscopy read it.

use super::face_grid::FaceGrid;
use super::gel::Gel;
use super::half_space::Loaded;
use crate::Vec3;
use crate::error::Result;
use crate::output::ResultFile;
use std::fmt::Write;

/// Points along an axis when no distance between them is named.
const POINTS: f64 = 64.0;

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
        let grid = FaceGrid::over(&rest, &facets, [Vec3::x(), Vec3::y()], |size| spacing.unwrap_or(size / POINTS))
            .map_err(|fine| fine.fault("spacing", 1.0))?;
        let still = |at: Vec3| Point { at: [at.x, at.y], moved: Vec3::zeros(), traction: Vec3::zeros() };
        let mut points: Vec<Point> = grid.all().map(still).collect();
        let loaded = Loaded::by_forces(rest, facets, &forces);
        for facet in &loaded.facets {
            grid.each_on(facet.map(|corner| loaded.points[corner]), |number, shares| {
                let between = |values: &[Vec3]| (0..3).map(|corner| shares[corner] * values[facet[corner]]).sum();
                let point = &mut points[number];
                (point.moved, point.traction) = (between(&moved), between(&loaded.tractions));
            });
        }
        let spacing = grid.spacing;
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
