//! A regular grid over a flat face of facets, whose points go with the facets that they are on.

use crate::Vec3;
use crate::error::{Error, Fault, short};
use nalgebra::Vector2;

/// The most points that a grid may have: 2 000 along each axis, as many as a camera has pixels; a map of them, of some 150 bytes a point as text, is less
/// than a gigabyte.
const MOST: f64 = 4e6;

/// How much of a facet a point may be outside of it, for round-off.
const ROUND_OFF: f64 = 1e-9;

/// A grid from the corner of the face that is lowest along both axes on.
pub struct FaceGrid {
    /// That corner, µm, and how high the face is.
    corner: Vec3,
    /// Unit vectors along its columns and its rows.
    axes: [Vec3; 2],
    /// Between its points, µm.
    pub spacing: f64,
    /// How many points there are along each axis.
    pub points: [usize; 2],
}

impl FaceGrid {
    /// That over facets in the plane of two unit vectors, with a distance between points by the size of the face, both in µm.
    ///
    /// # Errors
    /// When there would be more than four million points.
    pub fn over(
        points: &[Vec3],
        facets: &[[usize; 3]],
        axes: [Vec3; 2],
        spacing: impl Fn(f64) -> f64,
    ) -> Result<Self, TooFine> {
        let corners = || facets.iter().flatten().map(|corner| points[*corner]);
        let range = |axis: Vec3| {
            corners()
                .map(|at| at.dot(&axis))
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)))
        };
        let normal = axes[0].cross(&axes[1]);
        let [x, y, height] = [axes[0], axes[1], normal].map(range);
        let size = Vector2::new(x.1 - x.0, y.1 - y.0);
        let spacing = spacing(size.max());
        let asked = (size.x / spacing + 1.0) * (size.y / spacing + 1.0);
        if asked > MOST {
            return Err(TooFine { spacing, asked, least: (size.x * size.y / MOST).sqrt() });
        }
        let points = [size.x, size.y].map(|size| (size / spacing * (1.0 + ROUND_OFF)).floor() as usize + 1);
        let corner = x.0 * axes[0] + y.0 * axes[1] + height.1 * normal;
        Ok(Self { corner, axes, spacing, points })
    }

    /// Where the point in a column and a row is, µm.
    pub fn at(&self, column: usize, row: usize) -> Vec3 {
        self.corner + self.spacing * (column as f64 * self.axes[0] + row as f64 * self.axes[1])
    }

    /// Where all points are, row by row.
    pub fn all(&self) -> impl Iterator<Item = Vec3> + '_ {
        (0..self.points[1]).flat_map(move |row| (0..self.points[0]).map(move |column| self.at(column, row)))
    }

    /// Calls for each point of a facet, with its number row by row and the shares of the corners of the facet there.
    pub fn each_on(&self, corners: [Vec3; 3], mut each: impl FnMut(usize, [f64; 3])) {
        let [a, b, c] = corners.map(|corner| {
            let from = corner - self.corner;
            Vector2::new(from.dot(&self.axes[0]), from.dot(&self.axes[1]))
        });
        let reach = |axis: usize| {
            let (least, most) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
            let first = (least / self.spacing - ROUND_OFF).ceil().max(0.0) as usize;
            first..((most / self.spacing + ROUND_OFF).floor() as usize + 1).min(self.points[axis])
        };
        let twice_area = (b - a).perp(&(c - a));
        for (column, row) in reach(1).flat_map(|row| reach(0).map(move |column| (column, row))) {
            let p = Vector2::new(column as f64, row as f64) * self.spacing - a;
            let (of_b, of_c) = (p.perp(&(c - a)) / twice_area, (b - a).perp(&p) / twice_area);
            let shares = [1.0 - of_b - of_c, of_b, of_c];
            if shares.iter().all(|share| *share > -ROUND_OFF) {
                each(row * self.points[0] + column, shares);
            }
        }
    }
}

/// A grid that would have too many points.
#[derive(Debug)]
pub struct TooFine {
    /// What was asked for between points, µm.
    pub spacing: f64,
    /// How many points that makes.
    pub asked: f64,
    /// The least distance between points, µm.
    pub least: f64,
}

impl TooFine {
    /// As a fault of who told a length `name` that is `times` the distance between points.
    pub fn fault(&self, name: &str, times: f64) -> Error {
        let Self { spacing, asked, least } = self;
        let every = short(*spacing);
        let message = format!("a point every {every} um makes {asked:.1e} of them, and a grid has at most {MOST:.0e}");
        let fault = Fault::new(message);
        Error::input(fault.help(format!("take a longer {name}, above {} um", short(least * times))))
    }
}
