//! Numbers that are computed from a finished run and stored with it.
//!
//! [`MeasureKind`] is the one list of them. Each has a file, which holds what documents say of it, which series it reads, what must
//! hold between its keys, and how it is computed. What several of them share lies beside them.

mod chemotactic_index;
mod comparison;
mod declared;
mod displacement;
mod distance;
mod engulfment;
mod field_value;
mod finished;
mod fit;
mod forward_index;
mod fronts;
mod gaps;
mod half_space;
mod msd_deviation;
mod msd_exponent;
mod period;
mod persistence;
mod pseudopods;
mod rayleigh;
mod recovery_time;
mod reduction;
mod run_length;
mod segregation;
mod speed_persistence;
mod sphere_fit;
mod statistic;
mod successive;
#[cfg(test)]
mod test_recordings;
#[cfg(test)]
mod test_results;
mod track_average;
mod traction;
mod value;
mod velocity_correlation;
mod wave_speed;
mod wavelength;

pub use super::fields::OverBoxes;
pub use super::over::Over;
pub use crate::analysis::relaxation::Law as RecoveryLaw;
pub use chemotactic_index::ChemotacticIndex;
pub use comparison::Comparison;
pub use declared::Declared;
pub use displacement::{Displacement, DisplacementError, ErrorStatistic};
pub use distance::Distance;
pub use engulfment::{Engulfment, EngulfmentStatistic};
pub use field_value::FieldValue;
pub use finished::Finished;
pub use fit::Fit;
pub use forward_index::{ForwardIndex, ForwardPart};
pub use fronts::Fronts;
pub use gaps::{GapStatistic, Gaps};
pub use half_space::{HalfSpace, HalfSpaceStatistic};
pub use msd_deviation::MsdDeviation;
pub use msd_exponent::MsdExponent;
pub use period::Period;
pub use persistence::{Persistence, PersistenceStatistic};
pub use pseudopods::PseudopodTurns;
pub use rayleigh::{Rayleigh, RayleighStatistic};
pub use recovery_time::{RecoveryStatistic, RecoveryTime};
pub use reduction::Reduction;
pub use run_length::RunLength;
pub use segregation::{Segregation, SegregationStatistic};
pub use speed_persistence::{SpeedPersistence, SpeedPersistenceStatistic};
pub use sphere_fit::SphereFit;
pub use statistic::Statistic;
pub use successive::SuccessiveStatistic;
pub use track_average::TrackAverage;
pub use traction::{Traction, TractionStatistic};
pub use value::Value;
pub use velocity_correlation::VelocityCorrelation;
pub use wave_speed::{WaveSpeed, WaveStatistic};
pub use wavelength::Wavelength;

use super::tracks::motion::Quantity;
use crate::error::Result;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A number computed from the finished run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Measure {
    /// What is computed.
    #[serde(flatten)]
    pub kind: MeasureKind,
    /// The unit shown with the number.
    #[serde(default)]
    pub unit: String,
    /// What the number means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// A factor that the number is multiplied by.
    #[serde(default = "one")]
    pub scale: f64,
}

fn one() -> f64 {
    1.0
}

impl Measure {
    /// A measure of this kind, without a unit.
    pub fn new(kind: MeasureKind) -> Self {
        Self { kind, unit: String::new(), description: None, scale: 1.0 }
    }
}

/// What a measure computes. Series are named as in the result: `size_x`, `volume`, `load.pull`,
/// `chemistry.SYSTEM.QUANTITY`; units are µm, s, pN, and those of their documents for chemistry and fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum MeasureKind {
    /// A series at one instant, or its mean or extremes in time.
    Value(Value),
    /// The slope of the straight line fitted to y against x.
    Slope(Fit),
    /// R² of the straight line fitted to y against x.
    RSquared(Fit),
    /// The shear modulus of a spherical membrane, read from the slope of its equatorial diameter against the force at
    /// its poles (Hénon et al. 1999).
    SphereShear(SphereFit),
    /// Root mean square of the relative distance between a measured table and the curve y(x).
    TableRms(Comparison),
    /// The number of rows of a measured table whose bars hold the curve y(x).
    TableBars(Comparison),
    /// The mean ratio of the curve y(x) to a measured table.
    TableRatio(Comparison),
    /// The largest distance, in standard errors, between the mean squared displacement and Fürth's formula.
    MsdDeviation(MsdDeviation),
    /// The power of the lag with which the mean squared displacement grows.
    MsdExponent(MsdExponent),
    /// The persistence time, s, by the fit of Fürth's formula to the mean squared displacement, or its interval, or the speed.
    Persistence(Persistence),
    /// Whether faster types of cells go straighter: the line through the logarithms of their persistence against their mean speed.
    SpeedPersistence(SpeedPersistence),
    /// The length of the path over its duration, µm/s.
    MeanSpeed(TrackAverage),
    /// How straight cells go: net displacement over the length of the path, from 0 to 1.
    Directness(TrackAverage),
    /// The mean angle between steps that follow each other, degrees from 0 to 180.
    TurningAngle(TrackAverage),
    /// How well cells go along a cue: the net displacement along it, or across, over the length of the path.
    ForwardIndex(ForwardIndex),
    /// How far cells go on as they went some time ago: the autocorrelation of their velocities.
    VelocityCorrelation(VelocityCorrelation),
    /// Whether net displacements point anywhere more than elsewhere: the probability by Rayleigh's test, the length of their mean, or where it points.
    Rayleigh(Rayleigh),
    /// The probability, by Kolmogorov and Smirnov, of durations of runs as unlike the exponential as these.
    RunLengthP(RunLength),
    /// A field at a point, or its mean, extremes or amount.
    FieldValue(FieldValue),
    /// How straight cells go towards a point: how much nearer they came over the length of their path, from −1 to 1.
    ChemotacticIndex(ChemotacticIndex),
    /// How far the centres of the cells of two types are apart, µm.
    Distance(Distance),
    /// How far the atom that was nearest to a point has gone, µm.
    Displacement(Displacement),
    /// How far atoms are from where points were measured to go, over how far those went.
    DisplacementError(DisplacementError),
    /// The mean time between upward crossings of the middle between the smallest and the largest value, s.
    Period(Period),
    /// How fast a wave leaves a point: the fit of a line to its times of arrival against distances, µm/s.
    WaveSpeed(WaveSpeed),
    /// The time in which a series, or a column of a measured table, comes to rest, s.
    RecoveryTime(RecoveryTime),
    /// The wavelength of a pattern in a flat field, from its spectrum, µm.
    Wavelength(Wavelength),
    /// How much cells of a type touch each other beyond chance: the segregation index, from below 0 (mixed) to 1 (apart),
    /// or what permutations of the types say of it.
    Segregation(Segregation),
    /// Whether cells of a type are inside those of others: how near to the middle, from 1 (the innermost) over 0 (at random) to below 0
    /// (outside), or the segregation index that they would have there.
    Engulfment(Engulfment),
    /// How the pseudopods of `[cells.NAME.pseudopods]` follow each other: how many, per second and cell, or another number of them.
    Pseudopods(PseudopodTurns),
    /// How regions of the surface where a substance on membranes is above a threshold come and go: how many begin, per second and cell, or another
    /// number of them.
    Fronts(Fronts),
    /// What the cells of the largest aggregate leave empty between them: the radius of the largest ball that fits there, µm, or the
    /// part of the inside that no cell fills.
    Gaps(Gaps),
    /// How cells pull at the planes that they stand on: the sums of the forces ahead and behind, their dipole, or where they pull most.
    Traction(Traction),
    /// Whether the surface of a gel moves as that of an elastic half space does under the tractions on it: how far both are apart, or how far
    /// they go.
    HalfSpace(HalfSpace),
}

impl MeasureKind {
    /// Names of the series that [`evaluate`](Self::evaluate) asks a recording for, besides `time`.
    pub fn series(&self) -> Vec<&str> {
        let names = match self {
            Self::Value(value) => value.series(),
            Self::Slope(fit) | Self::RSquared(fit) => fit.series(),
            Self::SphereShear(fit) => fit.series(),
            Self::TableRms(table) | Self::TableBars(table) | Self::TableRatio(table) => table.series(),
            Self::MsdDeviation(msd) => msd.series(),
            Self::MsdExponent(msd) => msd.series(),
            Self::Persistence(fit) => fit.series(),
            Self::SpeedPersistence(line) => line.series(),
            Self::MeanSpeed(tracks) | Self::Directness(tracks) | Self::TurningAngle(tracks) => tracks.series(),
            Self::ForwardIndex(index) => index.series(),
            Self::VelocityCorrelation(lag) => lag.series(),
            Self::Rayleigh(directions) => directions.series(),
            Self::ChemotacticIndex(index) => index.series(),
            Self::Distance(distance) => distance.series(),
            Self::Period(period) => period.series(),
            Self::RecoveryTime(recovery) => recovery.series(),
            Self::WaveSpeed(wave) => wave.series(),
            Self::RunLengthP(_) | Self::FieldValue(_) | Self::Wavelength(_) | Self::Segregation(_) => Vec::new(),
            Self::Engulfment(_) | Self::Displacement(_) | Self::DisplacementError(_) => Vec::new(),
            Self::Fronts(_) | Self::Gaps(_) | Self::Pseudopods(_) | Self::Traction(_) => Vec::new(),
            Self::HalfSpace(_) => Vec::new(),
        };
        names.into_iter().filter(|name| *name != "time").collect()
    }

    /// Tells what does not hold between the keys, and what the run of the document does not have.
    pub fn check(&self, at: &mut dyn Declared) {
        match self {
            Self::Value(value) => value.check(at),
            Self::Slope(fit) | Self::RSquared(fit) => fit.check(at),
            Self::TableBars(table) => table.check_bars(at),
            Self::MsdDeviation(msd) => msd.check(at),
            Self::MsdExponent(msd) => msd.check(at),
            Self::Persistence(fit) => fit.check(at),
            Self::SpeedPersistence(line) => line.check(at),
            Self::MeanSpeed(tracks) | Self::Directness(tracks) | Self::TurningAngle(tracks) => tracks.check(at),
            Self::ForwardIndex(index) => index.check(at),
            Self::VelocityCorrelation(lag) => lag.check(at),
            Self::Rayleigh(directions) => directions.check(at),
            Self::FieldValue(value) => value.check(at),
            Self::ChemotacticIndex(index) => index.check(at),
            Self::Distance(distance) => distance.check(at),
            Self::Displacement(gone) => gone.check(at),
            Self::DisplacementError(error) => error.check(at),
            Self::Period(period) => period.check(at),
            Self::RecoveryTime(recovery) => recovery.check(at),
            Self::WaveSpeed(wave) => wave.check(at),
            Self::Wavelength(pattern) => pattern.check(at),
            Self::Segregation(segregation) => segregation.check(at),
            Self::Engulfment(engulfment) => engulfment.check(at),
            Self::Pseudopods(pods) => pods.check(at),
            Self::Fronts(fronts) => fronts.check(at),
            Self::Gaps(gaps) => gaps.check(at),
            Self::Traction(traction) => traction.check(at),
            Self::HalfSpace(gel) => gel.check(at),
            Self::SphereShear(_) | Self::TableRms(_) | Self::TableRatio(_) | Self::RunLengthP(_) => {}
        }
    }

    /// Computes the number, in base units: µm, s, pN.
    ///
    /// # Errors
    /// When a series, type, column or table is not there, or does not reach where it is asked for.
    pub fn evaluate(&self, run: &Finished) -> Result<f64> {
        match self {
            Self::Value(value) => value.evaluate(run.recording),
            Self::Slope(fit) => fit.slope(run.recording),
            Self::RSquared(fit) => fit.r_squared(run.recording),
            Self::SphereShear(fit) => fit.evaluate(run.recording),
            Self::TableRms(table) => table.rms(run),
            Self::TableBars(table) => table.bars(run),
            Self::TableRatio(table) => table.ratio(run),
            Self::MsdDeviation(msd) => msd.evaluate(run.recording),
            Self::MsdExponent(msd) => msd.evaluate(run.recording),
            Self::Persistence(fit) => fit.evaluate(run),
            Self::SpeedPersistence(line) => line.evaluate(run),
            Self::MeanSpeed(tracks) => tracks.evaluate(run.recording, Quantity::MeanSpeed),
            Self::Directness(tracks) => tracks.evaluate(run.recording, Quantity::Directness),
            Self::TurningAngle(tracks) => tracks.evaluate(run.recording, Quantity::TurningAngle),
            Self::ForwardIndex(index) => index.evaluate(run.recording),
            Self::VelocityCorrelation(lag) => lag.evaluate(run.recording),
            Self::Rayleigh(directions) => directions.evaluate(run.recording),
            Self::RunLengthP(runs) => runs.evaluate(run.recording),
            Self::FieldValue(value) => value.evaluate(run),
            Self::ChemotacticIndex(index) => index.evaluate(run.recording),
            Self::Distance(distance) => distance.evaluate(run.recording),
            Self::Displacement(gone) => gone.evaluate(run),
            Self::DisplacementError(error) => error.evaluate(run),
            Self::Period(period) => period.evaluate(run.recording),
            Self::RecoveryTime(recovery) => recovery.evaluate(run),
            Self::WaveSpeed(wave) => wave.evaluate(run),
            Self::Wavelength(pattern) => pattern.evaluate(run),
            Self::Segregation(segregation) => segregation.evaluate(run),
            Self::Engulfment(engulfment) => engulfment.evaluate(run),
            Self::Pseudopods(pods) => pods.evaluate(run),
            Self::Fronts(fronts) => fronts.evaluate(run),
            Self::Gaps(gaps) => gaps.evaluate(run),
            Self::Traction(traction) => traction.evaluate(run),
            Self::HalfSpace(gel) => gel.evaluate(run),
        }
    }
}
