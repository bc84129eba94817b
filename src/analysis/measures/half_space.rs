//! Whether the surface of a gel moves as that of a half space does under the tractions on it.

use super::declared::Declared;
use super::finished::Finished;
use crate::Vec3;
use crate::analysis::face_grid::FaceGrid;
use crate::analysis::gel::Gel;
use crate::analysis::half_space::{self, Loaded, areas};
use crate::error::{Error, Fault, Result};
use crate::units::{Length, Stress};
use crate::values::When;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Whether the surface of a gel moves as that of a half space does under the tractions on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct HalfSpace {
    /// The type of the gel; it has one cell.
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: String,
    /// Young's modulus of the half space.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub young: Stress,
    /// Its Poisson's ratio.
    #[schemars(range(min = -0.99, max = 0.5))]
    pub poisson: f64,
    /// The direction out of it; its length does not matter.
    #[serde(default = "upwards", skip_serializing_if = "is_upwards")]
    pub normal: [f64; 3],
    /// Only where the face was within this distance of where it is pulled; all of it when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub within: Option<Length>,
    /// Both displacements are averaged over squares of this length, as those that are found by comparing parts of images are; when absent they are those of
    /// the atoms.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub window: Option<Length>,
    /// The instant.
    #[serde(default)]
    pub time: When,
    /// Which number.
    #[serde(default)]
    pub statistic: HalfSpaceStatistic,
}

/// Which number of a gel and a half space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum HalfSpaceStatistic {
    /// How far apart the displacements of both are over the surface, over how large those of the half space are: root mean squares,
    /// eq. (traction.6).
    #[default]
    Rms,
    /// The largest displacement of the gel, µm.
    Largest,
    /// The largest displacement of the half space, µm.
    Theory,
}

fn upwards() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

fn is_upwards(normal: &[f64; 3]) -> bool {
    *normal == upwards()
}

impl HalfSpace {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.when("time", self.time);
        at.direction("normal", self.normal);
        if !at.records_tractions() {
            let message = format!("`{}` needs to know what pulls at the gel, and that is not recorded", at.path());
            at.fault("", "not recorded", message, "add `tractions = true` to [output]");
        }
    }

    /// The number that is asked for.
    ///
    /// # Errors
    /// When the run did not record tractions, has no such type or not one cell of it, whose surface has no facets across the normal, or when nothing
    /// pulls at it.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let file = run.file.filter(|file| file.layout().tractions).ok_or_else(|| {
            let fault = Fault::new("the run did not record what pulls at cells");
            Error::input(fault.help("add `tractions = true` to [output] of its document and run it again"))
        })?;
        let recording = run.recording;
        let normal = Vec3::from(self.normal).normalize();
        let Gel { rest, moved, facets, forces } = Gel::of(file, &self.cells, recording.frame_at(self.time), normal)?;
        let half_space = half_space::HalfSpace { young: self.young.value(), poisson: self.poisson, normal };
        let forces = forces.unwrap_or_default();
        let middle = middle(&rest, &forces);
        let is_near = |at: Vec3| match (self.within, middle) {
            (Some(within), Some(middle)) => (at - middle).norm() <= within.value(),
            _ => true,
        };
        let gel = Pulled { loaded: Loaded::by_forces(rest, facets, &forces), moved, half_space };
        let seen = match self.window {
            None => gel.at_atoms(is_near),
            Some(window) => gel.in_windows(window.value(), is_near)?,
        };
        value(&seen, self.statistic).ok_or_else(|| {
            let message = format!("nothing pulls at the surface of \"{}\" at that time", self.cells);
            Error::input(
                Fault::new(message)
                    .help("give a time at which cells stick to it, and the normal of the face where they do"),
            )
        })
    }
}

/// The middle of where forces act, by their sizes; none where there are none.
fn middle(points: &[Vec3], forces: &[Vec3]) -> Option<Vec3> {
    let total: f64 = forces.iter().map(Vec3::norm).sum();
    let sum = points.iter().zip(forces).map(|(at, force)| force.norm() * at).sum::<Vec3>();
    (total > 0.0).then(|| sum / total)
}

/// Points along each side of a window.
const ACROSS: usize = 2 * HALF + 1;

/// Those on one side of its middle.
const HALF: usize = 2;

/// A part of the face: its area, how far the gel has gone there and how far the half space, µm² and µm.
struct Part {
    area: f64,
    moved: Vec3,
    expected: Vec3,
}

/// A gel whose face is pulled at and has moved.
struct Pulled {
    loaded: Loaded,
    /// How far its atoms have gone, µm.
    moved: Vec<Vec3>,
    half_space: half_space::HalfSpace,
}

impl Pulled {
    /// What belongs to each atom of the face.
    fn at_atoms(&self, is_near: impl Fn(Vec3) -> bool) -> Vec<Part> {
        let areas = areas(&self.loaded.points, &self.loaded.facets);
        let atoms = self
            .loaded
            .points
            .iter()
            .zip(&self.moved)
            .zip(areas)
            .filter(|((at, _), area)| *area > 0.0 && is_near(**at));
        atoms
            .map(|((at, moved), area)| Part { area, moved: *moved, expected: self.loaded.moved(&self.half_space, *at) })
            .collect()
    }

    /// Means over windows, eq. (traction.7), around each point of a grid of which a window has five along each side; only those that are all on the face.
    fn in_windows(&self, window: f64, is_near: impl Fn(Vec3) -> bool) -> Result<Vec<Part>> {
        let Loaded { points, facets, .. } = &self.loaded;
        let spacing = window / ACROSS as f64;
        let grid = FaceGrid::over(points, facets, across(self.half_space.normal), |_| spacing)
            .map_err(|fine| fine.fault("window", ACROSS as f64))?;
        let [columns, rows] = grid.points;
        let around = |[column, row]: [usize; 2]| {
            (row - HALF..=row + HALF)
                .flat_map(move |row| (column - HALF..=column + HALF).map(move |at| row * columns + at))
        };
        let inner = |count: usize| HALF..count.saturating_sub(HALF);
        let all = inner(rows).flat_map(|row| inner(columns).map(move |column| [column, row]));
        let middles: Vec<[usize; 2]> = all.filter(|[column, row]| is_near(grid.at(*column, *row))).collect();
        let mut is_needed = vec![false; columns * rows];
        middles.iter().flat_map(|middle| around(*middle)).for_each(|number| is_needed[number] = true);
        // How far both have gone there; none where there is no facet.
        let mut samples: Vec<Option<[Vec3; 2]>> = vec![None; columns * rows];
        for facet in facets {
            grid.each_on(facet.map(|corner| points[corner]), |number, shares| {
                if is_needed[number] && samples[number].is_none() {
                    let between = |values: &[Vec3]| (0..3).map(|corner| shares[corner] * values[facet[corner]]).sum();
                    samples[number] =
                        Some([between(&self.moved), self.loaded.moved(&self.half_space, between(points))]);
                }
            });
        }
        let mean = |middle: &[usize; 2]| {
            let sum = around(*middle).try_fold([Vec3::zeros(); 2], |sum, number| {
                samples[number].map(|sample| [sum[0] + sample[0], sum[1] + sample[1]])
            });
            let count = (ACROSS * ACROSS) as f64;
            sum.map(|[moved, expected]| Part {
                area: spacing * spacing,
                moved: moved / count,
                expected: expected / count,
            })
        };
        Ok(middles.iter().filter_map(mean).collect())
    }
}

/// Two directions in a plane with this normal that are at right angles.
fn across(normal: Vec3) -> [Vec3; 2] {
    let first = if normal.x.abs() < 0.5 { Vec3::x() } else { Vec3::y() };
    let first = (first - first.dot(&normal) * normal).normalize();
    [first, normal.cross(&first)]
}

fn value(parts: &[Part], statistic: HalfSpaceStatistic) -> Option<f64> {
    let sum = |of: fn(&Part) -> Vec3| parts.iter().map(|part| part.area * of(part).norm_squared()).sum::<f64>();
    let largest = |of: fn(&Part) -> Vec3| parts.iter().map(|part| of(part).norm()).fold(0.0, f64::max);
    let size = sum(|part| part.expected);
    (size > 0.0).then(|| match statistic {
        HalfSpaceStatistic::Rms => (sum(|part| part.moved - part.expected) / size).sqrt(),
        HalfSpaceStatistic::Largest => largest(|part| part.moved),
        HalfSpaceStatistic::Theory => largest(|part| part.expected),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A face of squares of 1 µm, cut in halves, of which the one atom in the middle is pulled at.
    fn face(half: i32) -> Loaded {
        let side = 2 * half + 1;
        let at = |x: i32, y: i32| Vec3::new(f64::from(x), f64::from(y), 0.0);
        let points: Vec<Vec3> = (-half..=half).flat_map(|y| (-half..=half).map(move |x| at(x, y))).collect();
        let number = |column: i32, row: i32| (row * side + column) as usize;
        let squares = (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| (column, row)));
        let halves = squares.flat_map(|(column, row)| {
            let [a, b] = [number(column, row), number(column + 1, row)];
            let [c, d] = [number(column + 1, row + 1), number(column, row + 1)];
            [[a, b, c], [a, c, d]]
        });
        let mut forces = vec![Vec3::zeros(); points.len()];
        forces[number(half, half)] = Vec3::new(30.0, 10.0, -50.0);
        Loaded::by_forces(points, halves.collect(), &forces)
    }

    fn pulled(share: f64) -> Pulled {
        let half_space = half_space::HalfSpace { young: 1e3, poisson: 0.45, normal: Vec3::z() };
        let loaded = face(8);
        let moved = loaded.points.iter().map(|at| share * loaded.moved(&half_space, *at)).collect();
        Pulled { loaded, moved, half_space }
    }

    #[test]
    fn a_gel_that_goes_a_tenth_too_far_is_a_tenth_off_by_atoms_and_by_windows() {
        let all = |_: Vec3| true;
        for (share, off) in [(1.0, 0.0), (1.1, 0.1), (0.9, 0.1)] {
            let gel = pulled(share);
            let atoms = value(&gel.at_atoms(all), HalfSpaceStatistic::Rms).unwrap();
            assert!((atoms - off).abs() < 1e-12, "{atoms} for {off}");
            // Between atoms a gel goes straight, and the half space does not: beside the force that is felt, and less in wider windows.
            let windows = [1.0, 3.0]
                .map(|window| value(&gel.in_windows(window, all).unwrap(), HalfSpaceStatistic::Rms).unwrap() - off);
            assert!(windows[1].abs() < 0.03 && windows[1].abs() < windows[0].abs(), "{windows:?} for {off}");
        }
    }

    #[test]
    fn windows_are_means_of_what_is_in_them_and_all_on_the_face() {
        let mut gel = pulled(1.0);
        // A shear: the mean over a square is that of its middle.
        gel.moved = gel.loaded.points.iter().map(|at| Vec3::new(0.1 * at.y, 0.0, 0.02 * at.x)).collect();
        let parts = gel.in_windows(2.0, |at| at.norm() <= 3.0).unwrap();
        // Points every 0.4 um within 3 um; at the rim of 8 um windows of 2 um end 7.2 um from the middle, and none is there.
        assert_eq!(parts.len(), 177);
        let largest = value(&parts, HalfSpaceStatistic::Largest).unwrap();
        assert!((0.28..0.3 + 1e-12).contains(&largest), "{largest}");
        let all = gel.in_windows(2.0, |_| true).unwrap();
        assert_eq!(all.len(), 37 * 37);
        // A force on an atom alone goes far there, and its mean is less.
        let theory = value(&all, HalfSpaceStatistic::Theory).unwrap();
        let atom = value(&gel.at_atoms(|_| true), HalfSpaceStatistic::Theory).unwrap();
        assert!(theory < 0.8 * atom, "{theory} and {atom}");
    }

    #[test]
    fn directions_in_a_plane_are_at_right_angles_to_its_normal() {
        for normal in [Vec3::x(), Vec3::y(), Vec3::z(), -Vec3::z(), Vec3::new(1.0, -2.0, 0.5).normalize()] {
            let [one, other] = across(normal);
            assert!((one.cross(&other) - normal).norm() < 1e-14, "{normal}");
        }
    }
}
