//! The fit document: which parameters of an experiment are fitted, within which bounds, and to which data.

use crate::error::{Error, Fault, Location, Result};
use crate::experiment::schema_of;
use crate::study::document::{Anything, Design, Parameter, Spacing, Study, StudyDocument};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A fit of Pseudopod: parameters of an experiment, so that it comes nearest to data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Pseudopod fit")]
pub struct Fit {
    /// One line that names the fit; it stands above its charts.
    pub title: String,
    /// What is asked, in a few sentences.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The experiment document, from the folder of the fit.
    pub experiment: PathBuf,
    /// Starts after the first and the seeds of runs follow from this number.
    #[serde(default)]
    #[schemars(range(max = 9_223_372_036_854_775_807_u64))]
    pub seed: u64,
    /// Runs of each evaluation, whose mean is compared; their seeds are the same in all evaluations.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1_000))]
    pub replicates: u32,
    /// Changes of the experiment that hold for all runs, as `--set` takes them: "run.until=100 s".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// From how many points the least sum of squares is sought. The first is where parameters start, the others those of a Latin
    /// hypercube.
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 1_000))]
    pub starts: u32,
    /// The confidence of intervals.
    #[serde(default = "most")]
    #[schemars(range(min = 0.5, max = 0.9999))]
    pub confidence: f64,
    /// Whether the errors of the data are what they say, or only relative to each other.
    #[serde(default)]
    pub errors: Errors,
    /// Whether intervals are found by the profile of the likelihood, too, which takes some ten runs a parameter.
    #[serde(default = "yes")]
    pub profile: bool,
    /// What is fitted.
    #[schemars(length(min = 1))]
    pub parameter: Vec<FitParameter>,
    /// What the experiment is compared with.
    #[schemars(length(min = 1))]
    pub data: Vec<Data>,
}

fn one() -> u32 {
    1
}

fn yes() -> bool {
    true
}

fn most() -> f64 {
    0.95
}

/// What is known of the errors of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Errors {
    /// They are standard deviations.
    #[default]
    Given,
    /// They say how points are weighted; how large they are is estimated from the residuals.
    Estimated,
}

/// A parameter of the experiment that is fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FitParameter {
    /// The key of the experiment, as `--set` names it: "cells.red.mechanics.membrane.shear".
    pub key: String,
    /// What tables and charts call it; the key when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its lower bound.
    pub from: Anything,
    /// Its upper bound, in the same unit.
    pub to: Anything,
    /// Where it starts, in the same unit; in the middle of its range when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<Anything>,
    /// Whether it is sought by differences or by ratios.
    #[serde(default)]
    pub scale: Spacing,
    /// How far it is changed to each side for derivatives, as a share of its range (of its logarithm, where the scale is one).
    #[serde(default = "step")]
    #[schemars(range(min = 1e-6, max = 0.1))]
    pub step: f64,
}

/// Far above the noise that adaptive steps leave in results, and so small that the third derivative does not count; docs/src/howto_fit.md
/// says what was measured.
fn step() -> f64 {
    0.01
}

/// Data beside what the experiment gives: a table beside a curve of its series, or one number beside a measure.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Data {
    /// What tables and charts call it.
    pub name: String,
    /// The table (CSV with a line of column names), from the folder of the fit; its numbers are in the units of the series.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<PathBuf>,
    /// Its column along x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub x_column: Option<String>,
    /// What is added to its column along x, as where it counts from an instant within the run.
    #[serde(default, skip_serializing_if = "crate::elementary::is_zero")]
    pub x_shift: f64,
    /// Its column along y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub y_column: Option<String>,
    /// Its column of standard deviations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_column: Option<String>,
    /// Its column with the lower ends of bars; half of a bar is one standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low_column: Option<String>,
    /// Its column with the upper ends of bars.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high_column: Option<String>,
    /// The series of the run along x; the time when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "series"))]
    pub x: Option<String>,
    /// The series of the run along y.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "series"))]
    pub y: Option<String>,
    /// The type of cells; all when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-text" = "cell type"))]
    pub cells: Option<String>,
    /// The measure of the experiment that one number is compared with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measure: Option<String>,
    /// That number, in the unit of the measure.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// The standard deviation of that number, or of each row of the table where it has no column of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
}

/// The JSON schema of fit documents.
pub fn schema() -> serde_json::Value {
    schema_of::<Fit>()
}

/// A checked fit and where its text says what.
#[derive(Debug, Clone)]
pub struct FitDocument {
    /// What it says.
    pub fit: Fit,
    /// Its parameters and its starts as a study of the same text has them: so bounds, units and keys are read, tried with the experiment
    /// and told as those of studies are.
    pub study: StudyDocument,
}

impl FitDocument {
    /// Reads a fit along its schema. What it says to the experiment is not looked at.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the text in its order, or with the reason why there is no text.
    pub fn read(path: &Path) -> Result<Self> {
        let name = path.display().to_string();
        let text = crate::files::read_text(path).map_err(|error| {
            let help = "name a fit document, such as experiments/red_cell_fit/fit.toml";
            Error::input(Fault::new(format!("the fit {name} cannot be read: {error}")).help(help))
        })?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Self::parse(&name, &text, folder)
    }

    /// The same of a text. `name` stands in messages; paths in the text start from `folder`.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the text in its order.
    pub fn parse(name: &str, text: &str, folder: &Path) -> Result<Self> {
        let (fit, study) = StudyDocument::parse_as(name, text, folder, &schema(), as_study)?;
        Ok(Self { fit, study })
    }

    /// Where the value of a key stands: `data[0].table`.
    pub fn location(&self, path: &str, label: &str) -> Location {
        self.study.location(path, label)
    }

    /// A file that the fit names as the system can open it.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.study.folder.join(path)
    }
}

/// What a study of the same parameters would say.
fn as_study(fit: &Fit) -> Study {
    let parameter = |one: &FitParameter| Parameter {
        key: one.key.clone(),
        name: one.name.clone(),
        values: None,
        from: Some(one.from.clone()),
        to: Some(one.to.clone()),
        number: None,
        scale: one.scale,
        whole: false,
    };
    Study {
        title: fit.title.clone(),
        description: fit.description.clone(),
        experiment: fit.experiment.clone(),
        seed: fit.seed,
        replicates: fit.replicates,
        set: fit.set.clone(),
        design: Design::LatinHypercube { number: fit.starts },
        parameter: fit.parameter.iter().map(parameter).collect(),
    }
}
