//! The study document: what is varied, how the values are combined, and how often each combination is run.

use crate::error::{Error, Fault, Location, Result, Source};
use crate::experiment::{Checked, schema_of};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A study of Pseudopod: one experiment, run with many values of its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Pseudopod study")]
pub struct Study {
    /// One line that names the study; it stands above its charts.
    pub title: String,
    /// What is asked, in a few sentences.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The experiment document, from the folder of the study.
    pub experiment: PathBuf,
    /// Designs that are drawn at random and the seeds of all runs follow from this number.
    #[serde(default)]
    #[schemars(range(max = 9_223_372_036_854_775_807_u64))]
    pub seed: u64,
    /// Runs of each point of the design, each with a seed of its own.
    #[serde(default = "once")]
    #[schemars(range(min = 1))]
    pub replicates: u32,
    /// Changes of the experiment that hold for all runs, as `--set` takes them: "run.until=100 s".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// How values of several parameters are combined; a grid when absent.
    #[serde(default)]
    pub design: Design,
    /// What is varied, in the order of the columns.
    #[schemars(length(min = 1))]
    pub parameter: Vec<Parameter>,
}

fn once() -> u32 {
    1
}

/// How values of several parameters are combined to the points of a study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Design {
    /// Each value of a parameter with each value of all others; the last parameter changes fastest.
    #[default]
    Grid,
    /// The first values of all parameters, then the second ones, and so on.
    List,
    /// Points at random, so that each of as many equal parts of each range holds one.
    LatinHypercube {
        /// Points.
        #[schemars(range(min = 2, max = 100_000))]
        number: u32,
    },
    /// Points of a scrambled Sobol sequence, which fills the ranges more evenly than chance; best are 64, 128, 256 and so on.
    Sobol {
        /// Points.
        #[schemars(range(min = 2, max = 100_000))]
        number: u32,
    },
    /// Saltelli's points for Sobol's indices, from a scrambled Sobol sequence; best are 64, 128, 256 base points and so on.
    Saltelli {
        /// Base points. Each makes two points, and one more for each parameter.
        #[schemars(range(min = 2, max = 50_000))]
        number: u32,
    },
}

impl Design {
    /// Whether its points lie anywhere in ranges.
    pub fn is_sampled(self) -> bool {
        matches!(self, Self::LatinHypercube { .. } | Self::Sobol { .. } | Self::Saltelli { .. })
    }
}

/// Something of the experiment that is varied.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Parameter {
    /// The key of the experiment, as `--set` names it: "cells.red.number".
    pub key: String,
    /// What tables and charts call it; the key when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its values, all in one unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1))]
    pub values: Option<Vec<Anything>>,
    /// The lower end of its range.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Anything>,
    /// The upper end of its range, in the same unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Anything>,
    /// How many values a range has, its ends included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 100_000))]
    pub number: Option<u32>,
    /// How values are spaced within a range.
    #[serde(default)]
    pub scale: Spacing,
    /// Whether values of a range are rounded to whole numbers.
    #[serde(default)]
    pub whole: bool,
}

impl Parameter {
    /// What tables and charts call it.
    pub fn label(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.key)
    }
}

/// How values are spaced within a range, in the unit in which the range is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// By equal differences.
    #[default]
    Linear,
    /// By equal ratios.
    Log,
}

/// What a key of an experiment may be: a number, a text, a list and so on. The experiment says what fits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Anything(pub toml::Value);

impl JsonSchema for Anything {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Anything".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({})
    }
}

/// The JSON schema of study documents, with the keys of our own that [`crate::experiment::schema()`] tells of.
pub fn schema() -> serde_json::Value {
    schema_of::<Study>()
}

/// A checked study and where its text says what.
#[derive(Debug, Clone)]
pub struct StudyDocument {
    /// The text.
    pub source: Arc<Source>,
    /// The folder that paths in it start from.
    pub folder: PathBuf,
    /// What it says.
    pub study: Study,
    checked: Checked,
}

impl StudyDocument {
    /// Reads a study along its schema. What its values mean to the experiment is not looked at.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the text in its order, or with the reason why there is no text.
    pub fn read(path: &Path) -> Result<Self> {
        let name = path.display().to_string();
        let text = crate::files::read_text(path).map_err(|error| {
            let help = match path.is_dir() {
                true => "name the study, usually study.toml in that folder",
                false => "name a study document, such as experiments/aggregation/study.toml",
            };
            Error::input(Fault::new(format!("the study {name} cannot be read: {error}")).help(help))
        })?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Self::parse(&name, &text, folder)
    }

    /// The same of a text. `name` stands in messages; paths in the text start from `folder`.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the text in its order.
    pub fn parse(name: &str, text: &str, folder: &Path) -> Result<Self> {
        Ok(Self::parse_as(name, text, folder, &schema(), Study::clone)?.1)
    }

    /// The same of a text that says more than a study, along a schema of its own: all that it says, and the study in it, whose keys stand
    /// where a study has them.
    pub(super) fn parse_as<T: DeserializeOwned>(
        name: &str,
        text: &str,
        folder: &Path,
        schema: &serde_json::Value,
        study: impl FnOnce(&T) -> Study,
    ) -> Result<(T, Self)> {
        let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
        let checked = Checked::read(&source, schema)?;
        let said: T = checked.to()?;
        let study = study(&said);
        Ok((said, Self { source, folder: folder.to_owned(), study, checked }))
    }

    /// Where the value of a key stands: `parameter[0].values[1]`.
    pub fn location(&self, path: &str, label: &str) -> Location {
        self.checked.location(path, label)
    }

    /// Where a key itself stands.
    pub fn key_location(&self, path: &str, label: &str) -> Location {
        self.checked.key_location(path, label)
    }

    /// The experiment document as the system can open it.
    pub fn experiment(&self) -> PathBuf {
        self.folder.join(&self.study.experiment)
    }
}
