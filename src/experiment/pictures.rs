//! The picture and the charts that a run makes when it ends.

use crate::analysis::tracks::motion::Quantity;
use crate::units::{Length, Speed, Time};
use crate::values::{Axis, OneOrMany, When};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The picture made at the end of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Picture {
    /// The instant that is shown.
    pub time: When,
    /// What the colours show: "type", a series of the cells such as "volume", or a quantity of the atoms: "height",
    /// "displacement" (since the first frame), "curvature", "force" (needs `output.forces`), "traction" (needs `output.tractions`), or what is on membranes,
    /// "SYSTEM.VARIABLE".
    pub colour_by: String,
    /// The ends of the scale of colours, in base units; chosen when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colour_range: Option<[f64; 2]>,
    /// The field under or between the cells: its name, FIELD.SPECIES for another than its first species, or "none". The
    /// first field when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "field"))]
    pub field: Option<String>,
    /// The ends of the field's scale of colours, in the field's unit; chosen when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field_range: Option<[f64; 2]>,
    /// Whether the field's colours count in powers of ten, for one over decades.
    pub field_log: bool,
    /// The height at which a field of the medium is cut; the mean height of the cells when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field_height: Option<Length>,
    /// Takes away what is nearer to the eye than the middle of the cells by more than this, so that their inside is seen; less than
    /// nothing cuts behind the middle. Nothing is taken away when absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cut: Option<Length>,
    /// Shows the loads as arrows, the longest for the strongest.
    pub loads: bool,
    /// Shows the fibres that were made at run time as lines inside the cells, the thicker the more they pull.
    pub fibres: bool,
    /// Shows the dynamic links between cells as lines from centre to centre, the thicker the more there are between two cells, which are seen through.
    pub links: bool,
    /// Types of cells that are painted in two tones, by the eighths of the space around them in the first frame, so that they are seen to turn;
    /// where colours show types.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub marks: Option<OneOrMany<String>>,
    /// Where the picture is taken from.
    pub view: View,
    /// Width in pixels.
    #[schemars(range(min = 16, max = 16384))]
    pub width: u32,
    /// Height in pixels.
    #[schemars(range(min = 16, max = 16384))]
    pub height: u32,
}

impl Default for Picture {
    fn default() -> Self {
        let (width, height) = (1280, 720);
        Self {
            time: When::Last,
            colour_by: "type".into(),
            colour_range: None,
            field: None,
            field_range: None,
            field_log: false,
            field_height: None,
            cut: None,
            loads: false,
            fibres: true,
            links: false,
            marks: None,
            view: View::default(),
            width,
            height,
        }
    }
}

/// Where a picture is taken from; the distance is chosen so that all cells are in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct View {
    /// The direction from the cells to the eye.
    pub from: [f64; 3],
    /// The direction that is up in the picture.
    pub up: [f64; 3],
}

impl Default for View {
    fn default() -> Self {
        Self { from: [1.0, -2.0, 1.0], up: [0.0, 0.0, 1.0] }
    }
}

/// A chart made at the end of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(extend("unevaluatedProperties" = false))]
pub struct Plot {
    /// Names the files of the chart.
    #[schemars(extend("x-text" = "name"))]
    pub name: String,
    /// What is drawn.
    #[serde(flatten)]
    pub kind: PlotKind,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// Measured points drawn over the curves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<OneOrMany<PlotTable>>,
    /// The title above the chart; the experiment's when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// The label of the x axis; the series' name and unit when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_label: Option<String>,
    /// The label of the y axis; the series' name and unit when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_label: Option<String>,
}

/// What a chart shows. Series are named as in the result: `size_x`, `volume`, `load.pull`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum PlotKind {
    /// Series against time.
    Series {
        /// The series, one or several.
        #[schemars(extend("x-text" = "series"))]
        y: OneOrMany<String>,
        /// Draws every cell as a thin line besides the mean.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        each_cell: bool,
    },
    /// Series against another one.
    Curve {
        /// The series along x.
        #[schemars(extend("x-text" = "series"))]
        x: String,
        /// The series along y, one or several.
        #[schemars(extend("x-text" = "series"))]
        y: OneOrMany<String>,
    },
    /// The paths of the cells seen from above.
    Tracks,
    /// The mean squared displacement against the lag.
    Msd {
        /// Speed in Fürth's formula; the curve is drawn when speed and persistence are given.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-exclusive-minimum" = 0))]
        speed: Option<Speed>,
        /// Persistence in Fürth's formula.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("x-exclusive-minimum" = 0))]
        persistence: Option<Time>,
    },
    /// The persistence of each type of cells against its mean speed, with the line through their logarithms.
    SpeedPersistence,
    /// Measures of the document against a number that each belongs to, such as the speed of types against what they stick with.
    Measures {
        /// The number that each measure belongs to.
        x: Vec<f64>,
        /// Whether x is drawn on a logarithmic axis.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        log_x: bool,
        /// The curves.
        curves: Vec<MeasureCurve>,
    },
    /// Into which directions in the plane cells came, as sectors about a point, and the mean of these directions.
    Rose {
        /// Number of sectors; 16 when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 3, max = 72))]
        sectors: Option<u32>,
    },
    /// How a number that each track has is distributed, as columns.
    Histogram {
        /// The number; turning angles are those of all steps.
        quantity: Quantity,
        /// Number of columns; by the number and spread of the values when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1, max = 200))]
        bins: Option<u32>,
    },
    /// A field along an axis, a curve for each instant.
    Profile {
        /// Which field, and along which line.
        #[serde(flatten)]
        line: FieldLine,
        /// The instants, one or several; five that are spread over the run when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        times: Option<OneOrMany<When>>,
    },
    /// A field along an axis against time, as colours.
    Kymograph {
        /// Which field, and along which line.
        #[serde(flatten)]
        line: FieldLine,
        /// The ends of the scale of colours, in the field's unit; chosen when absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        range: Option<[f64; 2]>,
        /// Whether colours count in powers of ten, for a field over decades.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        log: bool,
    },
}

/// Measures that are joined by a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeasureCurve {
    /// The entry in the legend.
    #[serde(default)]
    pub label: String,
    /// The names of the measures, one for each x.
    #[schemars(extend("x-text" = "measure"))]
    pub y: OneOrMany<String>,
    /// The measures at the lower ends of bars, one for each x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "measure"))]
    pub low: Option<OneOrMany<String>>,
    /// The measures at the upper ends of bars, one for each x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "measure"))]
    pub high: Option<OneOrMany<String>>,
}

/// A field along a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FieldLine {
    /// The field's name, or FIELD.SPECIES for another than its first species; the first field when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "field"))]
    pub field: Option<String>,
    /// The axis that the line follows.
    #[serde(default = "along_x")]
    pub along: Axis,
    /// A point that the line goes through; when absent, the mean over the other axes is shown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub through: Option<[Length; 3]>,
}

fn along_x() -> Axis {
    Axis::X
}

/// Measured points from a table (CSV with a line of column names).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlotTable {
    /// The table, relative to the document.
    #[schemars(extend("x-text" = "file"))]
    pub file: PathBuf,
    /// Its column along x.
    pub x: String,
    /// What is added to its column along x, as where it counts from an instant within the run.
    #[serde(default, skip_serializing_if = "crate::elementary::is_zero")]
    pub x_shift: f64,
    /// Its columns along y, one or several.
    pub y: OneOrMany<String>,
    /// The columns with the lower ends of the bars, in the order of `y`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<OneOrMany<String>>,
    /// The columns with the upper ends of the bars, in the order of `y`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<OneOrMany<String>>,
    /// The entry in the legend.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

impl PlotKind {
    /// Whether every cell has a line of its own besides the mean.
    pub fn shows_each_cell(&self) -> bool {
        matches!(self, Self::Series { each_cell: true, .. })
    }
}
