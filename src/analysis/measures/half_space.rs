//! Whether the surface of a gel moves as that of a half space does under the tractions on it.

use super::declared::Declared;
use super::finished::Finished;
use crate::Vec3;
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
        let mut areas = areas(&rest, &facets);
        if let (Some(within), Some(middle)) = (self.within, middle(&rest, &forces)) {
            let is_out = |at: &Vec3| (at - middle).norm() > within.value();
            areas.iter_mut().zip(&rest).filter(|(_, at)| is_out(at)).for_each(|(area, _)| *area = 0.0);
        }
        let loaded = Loaded::by_forces(rest, facets, &forces);
        let seen = Seen { areas, moved, loaded, half_space };
        seen.value(self.statistic).ok_or_else(|| {
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

/// A gel whose surface has moved.
struct Seen {
    /// What each atom has of the surface that is looked at, µm²; 0 of those that are not on it.
    areas: Vec<f64>,
    /// How far they have gone, µm.
    moved: Vec<Vec3>,
    loaded: Loaded,
    half_space: half_space::HalfSpace,
}

impl Seen {
    /// None where no traction moves anything.
    fn value(&self, statistic: HalfSpaceStatistic) -> Option<f64> {
        let (mut apart, mut size, mut largest, mut theory) = (0.0, 0.0, 0.0_f64, 0.0_f64);
        for (atom, (area, moved)) in
            self.areas.iter().zip(&self.moved).enumerate().filter(|(_, (area, _))| **area > 0.0)
        {
            let expected = self.loaded.moved(&self.half_space, atom);
            apart += area * (moved - expected).norm_squared();
            size += area * expected.norm_squared();
            largest = largest.max(moved.norm());
            theory = theory.max(expected.norm());
        }
        (size > 0.0).then(|| match statistic {
            HalfSpaceStatistic::Rms => (apart / size).sqrt(),
            HalfSpaceStatistic::Largest => largest,
            HalfSpaceStatistic::Theory => theory,
        })
    }
}
