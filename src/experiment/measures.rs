//! Numbers that are computed from a finished run and stored with it.

mod chemistry;
mod gaps;
mod sorting;

pub use chemistry::{ChemotacticIndex, FieldValue, OverBoxes, Period, Statistic, WaveSpeed, WaveStatistic, Wavelength};

pub use gaps::{GapStatistic, Gaps};
pub use sorting::{Segregation, SegregationStatistic};

use super::values::{OneOrMany, words_or_time};
use crate::units::{LineStiffness, Speed, Time, UnitError, Written};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

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
    Value {
        /// The series.
        #[schemars(extend("x-text" = "series"))]
        series: String,
        /// The type of cells; all when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-text" = "cell type"))]
        cells: Option<String>,
        /// How the values of several cells become one.
        #[serde(default)]
        over: Over,
        /// The instant, or how the values at several instants become one.
        #[serde(default)]
        time: Reduction,
    },
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
    MsdDeviation {
        /// The type of cells; all when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-text" = "cell type"))]
        cells: Option<String>,
        /// Speed in the formula.
        #[schemars(extend("x-exclusive-minimum" = 0))]
        speed: Speed,
        /// Persistence in the formula.
        #[schemars(extend("x-exclusive-minimum" = 0))]
        persistence: Time,
        /// The shortest lag.
        #[schemars(extend("x-exclusive-minimum" = 0))]
        lag_from: Time,
        /// The longest lag.
        #[schemars(extend("x-exclusive-minimum" = 0))]
        lag_to: Time,
    },
    /// The probability, by Kolmogorov and Smirnov, of durations of runs as unlike the exponential as these.
    RunLengthP {
        /// The type of cells; all when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-text" = "cell type"))]
        cells: Option<String>,
        /// Mean duration of a run.
        #[schemars(extend("x-exclusive-minimum" = 0))]
        persistence: Time,
    },
    /// A field at a place, or its mean, extremes or amount.
    FieldValue(FieldValue),
    /// How straight cells go towards a point: how much nearer they came over the length of their way, from −1 to 1.
    ChemotacticIndex(ChemotacticIndex),
    /// The mean time between upward crossings of the middle between the smallest and the largest value, s.
    Period(Period),
    /// How fast a wave leaves a point: the fit of a line to its times of arrival against distances, µm/s.
    WaveSpeed(WaveSpeed),
    /// The wavelength of a pattern in a flat field, from its spectrum, µm.
    Wavelength(Wavelength),
    /// How much cells of a type touch each other beyond chance: the segregation index, from below 0 (mixed) to 1 (apart),
    /// or what permutations of the types say of it.
    Segregation(Segregation),
    /// What the cells of the largest aggregate leave empty between them: the radius of the largest ball that fits there, µm, or the
    /// part of the inside that no cell fills.
    Gaps(Gaps),
}

/// A part of a curve to which a straight line is fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Fit {
    /// The series along x.
    #[schemars(extend("x-text" = "series"))]
    pub x: String,
    /// The series along y; of several the mean is taken.
    #[schemars(extend("x-text" = "series"))]
    pub y: OneOrMany<String>,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Only points with x from here on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_from: Option<f64>,
    /// Only points with x up to here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_to: Option<f64>,
}

/// A part of a curve of a sphere's equatorial diameter against the force at its poles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct SphereFit {
    /// The force.
    #[schemars(extend("x-text" = "series"))]
    pub x: String,
    /// The diameter; of several the mean is taken.
    #[schemars(extend("x-text" = "series"))]
    pub y: OneOrMany<String>,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Only forces up to here, pN.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_to: Option<f64>,
    /// The area modulus K of the membrane.
    #[schemars(extend("x-exclusive-minimum" = 0))]
    pub area: LineStiffness,
}

/// A simulated curve beside a measured table (CSV with a line of column names).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Comparison {
    /// The table, relative to the document.
    #[schemars(extend("x-text" = "file"))]
    pub table: PathBuf,
    /// Its column along x.
    pub x_column: String,
    /// Its column along y.
    pub y_column: String,
    /// Its column with the lower ends of the bars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low_column: Option<String>,
    /// Its column with the upper ends of the bars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high_column: Option<String>,
    /// The series along x.
    #[schemars(extend("x-text" = "series"))]
    pub x: String,
    /// The series along y.
    #[schemars(extend("x-text" = "series"))]
    pub y: String,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
}

/// How the values of several cells become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Over {
    /// Their mean.
    #[default]
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// Their sum.
    Sum,
    /// The first cell's.
    First,
}

/// How the values at several instants become one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "Written", into = "String")]
pub enum Reduction {
    /// The value in the last frame.
    #[default]
    Last,
    /// The value in the first frame.
    First,
    /// The mean over all frames.
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The largest less the smallest.
    Range,
    /// The value at this time, between frames on a straight line.
    At(Time),
}

const REDUCTIONS: [(&str, Reduction); 6] = [
    ("last", Reduction::Last),
    ("first", Reduction::First),
    ("mean", Reduction::Mean),
    ("min", Reduction::Min),
    ("max", Reduction::Max),
    ("range", Reduction::Range),
];

impl FromStr for Reduction {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let word = REDUCTIONS.iter().find(|(word, _)| *word == text);
        word.map_or_else(|| text.parse().map(Self::At), |(_, reduction)| Ok(*reduction))
    }
}

impl fmt::Display for Reduction {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self, REDUCTIONS.iter().find(|(_, reduction)| reduction == self)) {
            (Self::At(time), _) => time.fmt(f),
            (_, word) => f.write_str(word.map_or("last", |(word, _)| word)),
        }
    }
}

impl TryFrom<Written> for Reduction {
    type Error = UnitError;
    fn try_from(written: Written) -> Result<Self, UnitError> {
        written.0.parse()
    }
}

impl From<Reduction> for String {
    fn from(reduction: Reduction) -> Self {
        reduction.to_string()
    }
}

impl JsonSchema for Reduction {
    fn schema_name() -> Cow<'static, str> {
        "reduction".into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        words_or_time(&REDUCTIONS.map(|(word, _)| word))
    }
}
