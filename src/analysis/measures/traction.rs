//! How cells pull at the planes that they stand on: ahead of their middle and behind it, and where most.

use super::declared::Declared;
use super::finished::Finished;
use super::reduction::Reduction;
use crate::Vec3;
use crate::analysis::statistics;
use crate::error::{Error, Fault, Result};
use crate::output::{ResultFile, Tractions};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Half the angle of the sectors that count as front and rear: with it all four quarters are alike.
const QUARTER: f64 = 45.0;

/// How cells pull at planes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Traction {
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Which number.
    pub statistic: TractionStatistic,
    /// Where the front is; needed by all but "balance".
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// The instant, or how the values at several instants become one; those at which no cell pulls are left out.
    #[serde(default)]
    pub time: Reduction,
}

/// Which number of how cells pull, eq. (traction.3) and (traction.4): the mean over cells, of "balance" the largest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum TractionStatistic {
    /// The force along the direction of all atoms ahead of the middle of the cell, pN.
    Front,
    /// The same of those behind it, pN.
    Rear,
    /// What the quarter in front has of the sizes of all forces along the plane.
    FrontShare,
    /// What the two quarters at the sides have.
    SideShare,
    /// What the quarter behind has.
    RearShare,
    /// The angle from the front, seen from the middle of the cell, of the atom that pulls most, degrees: 0 in front, 90 at a side, 180 behind.
    LargestAngle,
    /// What is left of the sum of all forces between a cell and what is around it, over the sum of their sizes.
    Balance,
}

impl Traction {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        self.time.check(at);
        match self.direction {
            Some(direction) => at.direction("direction", direction),
            None if self.statistic != TractionStatistic::Balance => {
                let message = format!("`{}` does not say where the front is", at.path());
                at.fault("", "no direction", message, "add `direction`, such as [1, 0, 0]");
            }
            None => {}
        }
        if !at.records_tractions() {
            let message = format!("`{}` needs to know how cells pull, and that is not recorded", at.path());
            at.fault("", "not recorded", message, "add `tractions = true` to [output]");
        }
    }

    /// The number that is asked for.
    ///
    /// # Errors
    /// When the run did not record tractions, or no cell of the type pulls at a time that is asked for.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let recording = run.recording;
        let file = run.file.filter(|file| file.layout().tractions).ok_or_else(|| {
            let fault = Fault::new("the run did not record how cells pull");
            Error::input(fault.help("add `tractions = true` to [output] of its document and run it again"))
        })?;
        let wanted = recording.cells_of(self.cells.as_deref())?;
        let kinds: Vec<u32> = wanted.iter().map(|cell| recording.cell_types[*cell]).collect();
        let (mut times, mut values) = (Vec::new(), Vec::new());
        for frame in self.time.frames(&recording.times)? {
            let value = self.of_frame(file, frame, &kinds)?;
            if !value.is_nan() {
                times.push(recording.times[frame]);
                values.push(value);
            }
        }
        if values.is_empty() {
            let fault = Fault::new("no cell pulls at a plane at a time at which tractions are asked for");
            return Err(Error::input(fault.help("give a time at which cells stick to a plane")));
        }
        self.time.reduce(&times, &values)
    }

    /// The value in a frame over the cells of some types; not a number where none of them pulls.
    fn of_frame(&self, file: &ResultFile, frame: usize, kinds: &[u32]) -> Result<f64> {
        let (positions, cells) = (file.positions(frame)?, file.cells(frame));
        let Some(forces) = file.tractions(frame)? else { return Ok(f64::NAN) };
        let up = file
            .layout()
            .obstacles
            .first()
            .filter(|first| first.profile.is_empty())
            .map(|plane| Vec3::from(plane.normal));
        let of_cells = cells.iter().zip(file.layout().atoms_of(&cells));
        let values = of_cells.filter(|(cell, _)| kinds.contains(&cell.kind)).map(|(_, atoms)| match self.statistic {
            TractionStatistic::Balance => left_over(&forces, atoms),
            _ => {
                let x = positions[atoms.clone()].iter().map(|x| Vec3::from(*x)).collect();
                let pulls = forces.traction[atoms].iter().map(|force| along(up, Vec3::from(*force))).collect();
                let front = Vec3::from(self.direction.unwrap_or([1.0, 0.0, 0.0]));
                Seen { x, pulls, front, up }.value(self.statistic)
            }
        });
        let values: Vec<f64> = values.filter(|value| !value.is_nan()).collect();
        Ok(match (values.as_slice(), self.statistic) {
            ([], _) => f64::NAN,
            (_, TractionStatistic::Balance) => values.iter().copied().fold(0.0, f64::max),
            _ => statistics::mean(&values),
        })
    }
}

/// What is left of the sum of all forces on a cell, over the sum of their sizes, eq. (traction.1); not a number where there are none.
fn left_over(forces: &Tractions, atoms: std::ops::Range<usize>) -> f64 {
    let Tractions { traction, of_cells, drag, outer, inertia, held } = forces;
    let (mut left, mut size) = (Vec3::zeros(), 0.0);
    let parts = [(outer, 1.0), (held, 1.0), (drag, 1.0), (traction, -1.0), (of_cells, -1.0), (inertia, -1.0)];
    for (list, sign) in parts {
        for force in list[atoms.clone()].iter().map(|force| Vec3::from(*force)) {
            left += sign * force;
            size += force.norm();
        }
    }
    left.norm() / size
}

/// The part of a vector along what a cell stands on, whose normal is `up`.
fn along(up: Option<Vec3>, vector: Vec3) -> Vec3 {
    up.map_or(vector, |up| vector - vector.dot(&up) * up)
}

/// A cell that pulls, along what it stands on.
struct Seen {
    x: Vec<Vec3>,
    pulls: Vec<Vec3>,
    front: Vec3,
    /// The normal of what it stands on.
    up: Option<Vec3>,
}

impl Seen {
    /// Where an atom is, seen from the middle of the atoms along what the cell stands on.
    fn arm(&self, x: &Vec3, middle: &Vec3) -> Vec3 {
        along(self.up, x - middle)
    }

    fn value(&self, statistic: TractionStatistic) -> f64 {
        let total: f64 = self.pulls.iter().map(Vec3::norm).sum();
        let Some(front) = self.front.try_normalize(0.0).filter(|_| total > 0.0) else { return f64::NAN };
        let middle = self.x.iter().sum::<Vec3>() / self.x.len() as f64;
        let all = || self.x.iter().map(|x| self.arm(x, &middle)).zip(&self.pulls);
        let angle = |arm: &Vec3| {
            let across = (arm - arm.dot(&front) * front).norm();
            across.atan2(arm.dot(&front)).to_degrees()
        };
        let sum = |is_there: &dyn Fn(f64) -> bool| {
            all().filter(|(arm, _)| is_there(arm.dot(&front))).map(|(_, pull)| pull.dot(&front)).sum()
        };
        let share = |is_there: &dyn Fn(f64) -> bool| {
            all().filter(|(arm, _)| is_there(angle(arm))).map(|(_, pull)| pull.norm()).sum::<f64>() / total
        };
        match statistic {
            TractionStatistic::Front => sum(&|ahead| ahead > 0.0),
            TractionStatistic::Rear => sum(&|ahead| ahead < 0.0),
            TractionStatistic::FrontShare => share(&|angle| angle < QUARTER),
            TractionStatistic::SideShare => share(&|angle| (QUARTER..=180.0 - QUARTER).contains(&angle)),
            TractionStatistic::RearShare => share(&|angle| angle > 180.0 - QUARTER),
            TractionStatistic::LargestAngle => {
                let largest = all().max_by(|one, other| one.1.norm().total_cmp(&other.1.norm()));
                largest.map_or(f64::NAN, |(arm, _)| angle(&arm))
            }
            TractionStatistic::Balance => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use TractionStatistic::{FrontShare, LargestAngle, Rear, RearShare, SideShare};

    #[test]
    fn a_cell_that_pulls_at_its_rim_is_read_by_quarters() {
        // Around a middle at a height, with pulls of 4 in front, 3 and 2 at the sides and 1 behind, all to the middle.
        let pulled = [([1.0, 0.0], 4.0), ([0.0, 1.0], 3.0), ([0.0, -1.0], 2.0), ([-1.0, 0.0], 1.0)];
        let x = pulled.iter().map(|([x, y], _)| Vec3::new(5.0 * x, 5.0 * y, 0.0));
        let pulls = pulled.iter().map(|([x, y], size)| -size * Vec3::new(*x, *y, 0.0));
        let top = Vec3::new(0.0, 0.0, 10.0);
        let (x, pulls) = (x.chain([top]).collect(), pulls.chain([Vec3::zeros()]).collect());
        let seen = Seen { x, pulls, front: Vec3::x(), up: Some(Vec3::z()) };
        let [front, rear] = [TractionStatistic::Front, Rear].map(|part| seen.value(part));
        assert_eq!((front, rear), (-4.0, 1.0));
        let shares = [FrontShare, SideShare, RearShare].map(|part| seen.value(part));
        assert_eq!(shares, [0.4, 0.5, 0.1]);
        assert_eq!(seen.value(LargestAngle), 0.0);
        let turned = Seen { front: Vec3::y(), ..seen };
        assert_eq!(turned.value(LargestAngle), 90.0);
    }
}
