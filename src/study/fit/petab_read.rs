//! PEtab problems of version 2 whose model is an experiment document, read as fits.

use super::petab::TABLES;
use super::yaml::{Yaml, parse};
use crate::error::{Error, Fault, Result, words};
use crate::study::paths::{absolute, refused, relative, write_all};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use toml::Value;

/// Reads a PEtab problem and writes it into a folder as a fit document, `fit.toml`, with a table beside it for each observable.
///
/// # Errors
/// [`Error::Input`] for what is no such problem, with what was expected; [`Error::Machine`] when the disk refuses.
pub fn read_petab(problem: &Path, folder: &Path) -> Result<Vec<PathBuf>> {
    let text = crate::files::read_text(problem).map_err(|error| {
        let message = format!("the PEtab problem {} cannot be read: {error}", problem.display());
        Error::input(Fault::new(message).help("name the YAML file of a PEtab problem"))
    })?;
    let reader = Reader {
        name: problem.display().to_string(),
        base: problem.parent().unwrap_or(Path::new("")),
        yaml: parse(&text),
    };
    let (fit, tables) = reader.fit(folder)?;
    std::fs::create_dir_all(folder).map_err(|error| refused(folder, &error))?;
    write_all([("fit.toml".to_owned(), fit)].into_iter().chain(tables), folder)
}

/// A row of a table by the titles of its columns.
type Row = BTreeMap<String, String>;

struct Reader<'a> {
    name: String,
    base: &'a Path,
    yaml: Yaml,
}

impl Reader<'_> {
    fn wrong<T>(&self, message: String, help: impl Into<String>) -> Result<T> {
        Err(Error::input(Fault::new(format!("{}: {message}", self.name)).help(help)))
    }

    /// The rows of all files that a key of the problem names.
    fn tables(&self, key: &str, columns: &[&str]) -> Result<Vec<Row>> {
        let mut rows = Vec::new();
        for name in self.yaml.get(key).map(Yaml::texts).unwrap_or_default() {
            let path = self.base.join(&name);
            let text = crate::files::read_text(&path).map_err(|error| {
                let fault = Fault::new(format!("the table {} cannot be read: {error}", path.display()));
                Error::input(fault.help(format!("`{key}` of {} names it", self.name)))
            })?;
            let mut lines =
                text.lines().filter(|line| !line.trim().is_empty()).map(|line| line.split('\t').map(str::trim));
            let titles: Vec<&str> = lines.next().map(Iterator::collect).unwrap_or_default();
            if let Some(missing) = columns.iter().find(|column| !titles.contains(column)) {
                let fault = Fault::new(format!("the table {} has no column `{missing}`", path.display()));
                return Err(Error::input(
                    fault.help(format!("{} are needed, parted by tabs", words::all_of(columns.iter().copied()))),
                ));
            }
            rows.extend(lines.map(|cells| {
                titles.iter().map(|title| (*title).to_owned()).zip(cells.map(str::to_owned)).collect::<Row>()
            }));
        }
        if rows.is_empty() && !columns.is_empty() && key != "mapping_files" {
            return self.wrong(
                format!("`{key}` names no table with rows"),
                format!("PEtab keeps them in a table like {}", TABLES.join(", ")),
            );
        }
        Ok(rows)
    }

    fn experiment(&self) -> Result<PathBuf> {
        let version = self.yaml.get("format_version").map(Yaml::text).unwrap_or_default();
        if !version.starts_with('2') {
            return self.wrong(
                format!("the version of its format is `{version}`"),
                "problems of version 2 are read: format_version: 2.0.0",
            );
        }
        let models = self.yaml.get("model_files").map(Yaml::entries).unwrap_or_default();
        let [(_, model)] = models else {
            return self.wrong(
                format!("it has {} models", models.len()),
                "give one under `model_files`, with its `location` and `language: pseudopod`",
            );
        };
        let language = model.get("language").map(Yaml::text).unwrap_or_default();
        if language != "pseudopod" {
            let help = "the model has to be an experiment document, `language: pseudopod`; SBML is brought in as equations by pseudopod eml from-sbml";
            return self.wrong(format!("the language of its model is `{language}`"), help);
        }
        if self.yaml.get("condition_files").or_else(|| self.yaml.get("experiment_files")).is_some() {
            return self
                .wrong("it has conditions".into(), "one experiment is fitted here: set what differs in its document");
        }
        Ok(self.base.join(model.get("location").map(Yaml::text).unwrap_or_default()))
    }

    /// The text of the fit, and the tables that it reads by their names.
    fn fit(&self, folder: &Path) -> Result<(String, Vec<(String, String)>)> {
        let experiment = self.experiment()?;
        let mapping: BTreeMap<String, String> = self
            .tables("mapping_files", &["petabEntityId", "modelEntityId"])?
            .into_iter()
            .filter_map(|row| Some((row.get("petabEntityId")?.clone(), row.get("modelEntityId")?.clone())))
            .collect();
        let entity = |id: &str| mapping.get(id).map_or_else(|| id.to_owned(), Clone::clone);
        let experiment = relative(&absolute(&experiment), &absolute(folder)).to_string_lossy().replace('\\', "/");
        let mut text = format!(
            "title = {}\nexperiment = {}\n",
            quoted(&format!("PEtab problem {}", self.name)),
            quoted(&experiment)
        );
        let parameters = self.tables("parameter_files", &["parameterId", "lowerBound", "upperBound", "estimate"])?;
        for row in parameters.iter().filter(|row| cell(row, "estimate") == "true") {
            self.parameter(row, &entity, &mut text)?;
        }
        if let Some(row) = parameters.iter().find(|row| cell(row, "estimate") != "true") {
            let message = format!("the parameter `{}` is not estimated", cell(row, "parameterId"));
            return self.wrong(message, "set it in the experiment, and leave its row out");
        }
        let observables = self.tables("observable_files", &["observableId", "observableFormula", "noiseFormula"])?;
        let measurements = self.tables("measurement_files", &["observableId", "measurement", "time"])?;
        if let Some(odd) = measurements
            .iter()
            .find(|row| !observables.iter().any(|one| cell(one, "observableId") == cell(row, "observableId")))
        {
            let id = cell(odd, "observableId");
            return self.wrong(
                format!("a measurement is of `{id}`, which is no observable"),
                "name an `observableId` of the table of observables",
            );
        }
        let mut tables = Vec::new();
        for row in &observables {
            self.observable(row, &measurements, &entity, &mut text, &mut tables)?;
        }
        Ok((text, tables))
    }

    fn parameter(&self, row: &Row, entity: &dyn Fn(&str) -> String, text: &mut String) -> Result<()> {
        let (id, unit) = (cell(row, "parameterId"), cell(row, "unit"));
        let value = |column: &str| -> Result<String> {
            let number = cell(row, column);
            match number.parse::<f64>() {
                Ok(found) if found.is_finite() && unit.is_empty() => Ok(number.to_owned()),
                Ok(found) if found.is_finite() => Ok(quoted(&format!("{number} {unit}"))),
                _ => self.wrong(format!("`{column}` of `{id}` is `{number}`"), "write a finite number"),
            }
        };
        let name = if cell(row, "parameterName").is_empty() { id } else { cell(row, "parameterName") };
        // Writing to a text cannot fail.
        let _ = write!(text, "\n[[parameter]]\nkey = {}\nname = {}\n", quoted(&entity(id)), quoted(name));
        let _ = write!(text, "from = {}\nto = {}\n", value("lowerBound")?, value("upperBound")?);
        if !cell(row, "nominalValue").is_empty() {
            let _ = writeln!(text, "start = {}", value("nominalValue")?);
        }
        if cell(row, "scale") == "log" {
            text.push_str("scale = \"log\"\n");
        }
        Ok(())
    }

    fn observable(
        &self,
        row: &Row,
        measurements: &[Row],
        entity: &dyn Fn(&str) -> String,
        text: &mut String,
        tables: &mut Vec<(String, String)>,
    ) -> Result<()> {
        let (id, formula) = (cell(row, "observableId"), cell(row, "observableFormula"));
        let distribution = cell(row, "noiseDistribution");
        if !distribution.is_empty() && distribution != "normal" {
            return self.wrong(
                format!("the noise of `{id}` is `{distribution}`"),
                "least squares are for noise that is `normal`",
            );
        }
        let mut rows = Vec::new();
        for of in measurements.iter().filter(|of| cell(of, "observableId") == id) {
            let noise = if cell(of, "noiseParameters").is_empty() {
                cell(row, "noiseFormula")
            } else {
                cell(of, "noiseParameters")
            };
            for (what, number) in [("measurement", cell(of, "measurement")), ("noise", noise)] {
                if number.parse::<f64>().is_err() {
                    return self.wrong(
                        format!("a {what} of `{id}` is `{number}`"),
                        "write a number: formulas and fitted noise are not read",
                    );
                }
            }
            rows.push([cell(of, "time"), cell(of, "measurement"), noise]);
        }
        let name = if cell(row, "observableName").is_empty() { id } else { cell(row, "observableName") };
        let _ = write!(text, "\n[[data]]\nname = {}\n", quoted(name));
        if cell(row, "kind") == "measure" {
            let [only] = &rows[..] else {
                return self.wrong(format!("`{id}` is a measure with {} measurements", rows.len()), "give it one");
            };
            let _ = write!(
                text,
                "measure = {}\nvalue = {}\nerror = {}\n",
                quoted(&entity(formula)),
                number(only[1]),
                number(only[2])
            );
            return Ok(());
        }
        let file = format!("{id}.csv");
        let x = if cell(row, "abscissa").is_empty() { "time" } else { cell(row, "abscissa") };
        let columns = "x_column = \"x\"\ny_column = \"measurement\"\nerror_column = \"error\"\n";
        let _ =
            write!(text, "table = {}\n{columns}x = {}\ny = {}\n", quoted(&file), quoted(x), quoted(&entity(formula)));
        if !cell(row, "cells").is_empty() {
            let _ = writeln!(text, "cells = {}", quoted(cell(row, "cells")));
        }
        let lines = rows.iter().map(|row| row.join(",") + "\n");
        tables.push((file, ["x,measurement,error\n".to_owned()].into_iter().chain(lines).collect()));
        Ok(())
    }
}

fn cell<'a>(row: &'a Row, column: &str) -> &'a str {
    row.get(column).map_or("", String::as_str)
}

/// A text as TOML writes it.
fn quoted(text: &str) -> String {
    Value::String(text.to_owned()).to_string()
}

/// A number as TOML writes it: one without a point is a whole number, which is a number, too.
fn number(text: &str) -> String {
    text.parse::<f64>().map_or_else(|_| text.to_owned(), |number| Value::Float(number).to_string())
}
