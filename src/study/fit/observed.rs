//! What a fit is compared with: the data, and the numbers of a finished run that stand beside them.

use super::document::{Data, FitDocument};
use crate::analysis::recording::Recording;
use crate::analysis::table::Table;
use crate::error::{Error, Fault, Result, words};
use crate::experiment::Document;
use crate::output::ResultFile;
use crate::simulation::{SeriesInfo, Simulation};

/// A number that was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Datum {
    /// Where, in the unit of the series along x; 0 beside a measure.
    pub x: f64,
    /// The number.
    pub y: f64,
    /// Its standard deviation, positive.
    pub error: f64,
}

/// What of a run the data stand beside.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Beside {
    /// The curve of two series, means over the cells of a type or over all.
    Curve {
        /// The series along x.
        x: String,
        /// The series along y.
        y: String,
        /// The type of cells.
        cells: Option<String>,
    },
    /// A measure.
    Measure(String),
}

/// Data with what they stand beside.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// Their name.
    pub name: String,
    /// The data.
    pub data: Vec<Datum>,
    /// What they stand beside.
    pub beside: Beside,
    /// The units of x and y.
    pub units: [String; 2],
}

impl Observed {
    /// The points that a finished run has beside the data: of its curve all that there are, of a measure one at 0.
    ///
    /// # Errors
    /// A series, a type of cells or a measure that the run does not have; a damaged file.
    pub fn course(&self, file: &ResultFile) -> Result<Vec<[f64; 2]>> {
        match &self.beside {
            Beside::Curve { x, y, cells } => {
                Ok(Recording::read(file, &[x, y])?.curve(x, y, cells.as_deref())?.points().collect())
            }
            Beside::Measure(name) => Ok(vec![[0.0, measured(file, name)?]]),
        }
    }

    /// The numbers of a finished run beside the data.
    ///
    /// # Errors
    /// As [`Observed::course`], and when the run does not reach a datum.
    pub fn predicted(&self, file: &ResultFile) -> Result<Vec<f64>> {
        match &self.beside {
            Beside::Curve { x, y, cells } => {
                let curve = Recording::read(file, &[x, y])?.curve(x, y, cells.as_deref())?;
                let at = |x| curve.at(x).map_err(|error| self.told(error));
                self.data.iter().map(|datum| at(datum.x)).collect()
            }
            Beside::Measure(name) => Ok(vec![measured(file, name)?]),
        }
    }

    /// What is wrong with which data.
    fn told(&self, error: Error) -> Error {
        let Error::Input(faults) = error else { return error };
        let named = |fault: Fault| Fault { message: format!("data `{}`: {}", self.name, fault.message), ..fault };
        Error::Input(faults.into_iter().map(named).collect())
    }
}

fn measured(file: &ResultFile, name: &str) -> Result<f64> {
    let summary = file.summary()?;
    summary.iter().find(|measure| measure.name == name).map(|measure| measure.value).ok_or_else(|| {
        let fault = Fault::new(format!("the measure `{name}` could not be taken of a run"));
        Error::input(fault.help("run the experiment by itself, which says why: pseudopod run"))
    })
}

/// Reads the data of a fit, and makes sure that the experiment has what they stand beside.
///
/// # Errors
/// [`Error::Input`] with all faults: keys that do not go together, a table or a column that is not there, errors that are not positive, a
/// series, a measure or a type of cells that the experiment does not have, fewer data than parameters.
pub fn observed(document: &FitDocument, experiment: &Document) -> Result<Vec<Observed>> {
    let simulation = Simulation::builder().threads(1).document(experiment).map_err(Error::from)?;
    let known = simulation.series_infos();
    drop(simulation);
    let (mut found, mut faults) = (Vec::<Observed>::new(), Vec::new());
    for (number, data) in document.fit.data.iter().enumerate() {
        let reader = Reader { document, experiment, known: &known, data, path: format!("data[{number}]") };
        if found.iter().any(|other| other.name == data.name) {
            let message = format!("two data are called `{}`", data.name);
            faults.push(reader.fault("name", "once more", message, "give each a name of its own"));
            continue;
        }
        match reader.read() {
            Ok(observed) => found.push(observed),
            Err(Error::Input(more)) => faults.extend(more),
            Err(other) => return Err(other),
        }
    }
    let (data, parameters) = (found.iter().map(|one| one.data.len()).sum::<usize>(), document.fit.parameter.len());
    if faults.is_empty() && data < parameters {
        let message = format!("{parameters} parameters cannot be determined from fewer measured numbers: {data}");
        let location = document.location("data", "too few");
        faults.push(Fault::new(message).at(location).help("fit fewer parameters, or add data"));
    }
    if faults.is_empty() { Ok(found) } else { Err(Error::Input(faults)) }
}

struct Reader<'a> {
    document: &'a FitDocument,
    experiment: &'a Document,
    known: &'a [SeriesInfo],
    data: &'a Data,
    path: String,
}

impl Reader<'_> {
    fn fault(&self, key: &str, label: &str, message: String, help: impl Into<String>) -> Fault {
        let path = if key.is_empty() { self.path.clone() } else { format!("{}.{key}", self.path) };
        Fault::new(message).at(self.document.location(&path, label)).help(help)
    }

    fn wrong<T>(&self, key: &str, label: &str, message: String, help: impl Into<String>) -> Result<T> {
        Err(Error::input(self.fault(key, label, message, help)))
    }

    fn read(&self) -> Result<Observed> {
        match (&self.data.y, &self.data.measure) {
            (Some(y), None) => self.curve(y),
            (None, Some(measure)) => self.number(measure),
            (Some(_), Some(_)) => {
                let message = format!("`{}` stands beside a series and a measure", self.data.name);
                self.wrong("measure", "not beside `y`", message, "keep `y` for a table or `measure` for one number")
            }
            (None, None) => {
                let message = format!("the data `{}` name nothing that the experiment gives", self.data.name);
                let help = "add the series that they stand beside, y = \"size_x\", or a measure of the experiment, measure = \"NAME\"";
                self.wrong("name", "beside what?", message, help)
            }
        }
    }

    /// Keys that have no meaning here.
    fn without(&self, keys: &[(&str, bool)], beside: &str) -> Result<()> {
        match keys.iter().find(|(_, is_there)| *is_there) {
            None => Ok(()),
            Some((key, _)) => {
                let message = format!("`{key}` does not go with `{beside}`");
                self.wrong(key, "without meaning", message, "leave it out")
            }
        }
    }

    fn number(&self, measure: &str) -> Result<Observed> {
        let Data { table, x_column, y_column, error_column, low_column, high_column, x, cells, .. } = self.data;
        let texts = [("x_column", x_column), ("y_column", y_column), ("error_column", error_column), ("x", x)];
        let mut unwanted: Vec<(&str, bool)> = texts.iter().map(|(key, text)| (*key, text.is_some())).collect();
        unwanted.extend([("table", table.is_some()), ("low_column", low_column.is_some())]);
        unwanted.extend([("high_column", high_column.is_some()), ("cells", cells.is_some())]);
        self.without(&unwanted, "measure")?;
        let measures = &self.experiment.experiment.measure;
        let Some(declared) = measures.get(measure) else {
            let names: Vec<&str> = measures.keys().map(String::as_str).collect();
            return self.unknown("measure", ["measure", "measures"], measure, &names);
        };
        let (Some(y), Some(error)) = (self.data.value, self.data.error) else {
            let message = format!("the data `{}` lack a number with its error", self.data.name);
            return self.wrong(
                "measure",
                "and what was measured?",
                message,
                "add value = 1.5 and error = 0.1, in the unit of the measure",
            );
        };
        self.positive("error", error)?;
        let unit = if declared.unit.is_empty() { "1".to_owned() } else { declared.unit.clone() };
        Ok(Observed {
            name: self.data.name.clone(),
            data: vec![Datum { x: 0.0, y, error }],
            beside: Beside::Measure(measure.to_owned()),
            units: ["1".to_owned(), unit],
        })
    }

    fn positive(&self, key: &str, error: f64) -> Result<()> {
        if error > 0.0 && error.is_finite() {
            return Ok(());
        }
        let message = format!("an error of `{}` is {error}", self.data.name);
        self.wrong(
            key,
            "must be above 0",
            message,
            "errors are standard deviations; leave out data that have none, or give them one",
        )
    }

    fn curve(&self, y: &str) -> Result<Observed> {
        self.without(&[("value", self.data.value.is_some())], "y")?;
        let x = self.data.x.as_deref().unwrap_or("time");
        let units = [self.unit("x", x)?, self.unit("y", y)?];
        if let Some(cells) = &self.data.cells {
            let types: Vec<&str> = self.experiment.experiment.cells.keys().map(String::as_str).collect();
            if !types.contains(&cells.as_str()) {
                return self.unknown("cells", ["type of cells", "types of cells"], cells, &types);
            }
        }
        let beside = Beside::Curve { x: x.to_owned(), y: y.to_owned(), cells: self.data.cells.clone() };
        Ok(Observed { name: self.data.name.clone(), data: self.rows()?, beside, units })
    }

    /// The unit of a series that the experiment gives.
    fn unit(&self, key: &str, series: &str) -> Result<String> {
        let stored = series.strip_prefix("chemistry.").unwrap_or(series);
        if let Some(info) = self.known.iter().find(|info| info.name == series || info.name == stored) {
            return Ok(info.unit.clone());
        }
        // What changes from frame to frame is of results alone.
        if series.starts_with("contact.") {
            return Ok("1".to_owned());
        }
        let names: Vec<&str> = self.known.iter().map(|info| info.name.as_str()).collect();
        self.unknown(key, ["series", "series"], series, &names)
    }

    fn unknown<T>(&self, key: &str, [what, all]: [&str; 2], name: &str, known: &[&str]) -> Result<T> {
        let message = format!(
            "the data `{}` name an observable that is not there: the experiment has no {what} `{name}`",
            self.data.name
        );
        let list = match known {
            [] => format!("the experiment has no {what} at all"),
            known => format!("its {all} are {}", known.join(", ")),
        };
        let (label, help) = match words::meant(name, known.iter().copied()) {
            Some(near) => (format!("did you mean `{near}`?"), list),
            None => ("not in the experiment".to_owned(), list),
        };
        self.wrong(key, &label, message, help)
    }

    /// That there is no table is told where it is named; what is wrong in it is told in it.
    fn at_the_table(&self, error: Error) -> Error {
        let Error::Input(faults) = error else { return error };
        let named = |fault: Fault| match fault.location {
            Some(_) => fault,
            None => fault.at(self.document.location(&format!("{}.table", self.path), "this table")),
        };
        Error::Input(faults.into_iter().map(named).collect())
    }

    /// The rows of the table that have all numbers.
    fn rows(&self) -> Result<Vec<Datum>> {
        let Data { table, x_column, y_column, error_column, low_column, high_column, error, name, .. } = self.data;
        let (Some(table), Some(x_column), Some(y_column)) = (table, x_column, y_column) else {
            let message = format!("the data `{name}` lack a table");
            return self.wrong("y", "and what was measured?", message, "add `table`, `x_column` and `y_column`");
        };
        let mut read = Table::read(&self.document.resolve(table)).map_err(|error| self.at_the_table(error))?;
        read.shift(x_column, self.data.x_shift)?;
        let (x, y) = (read.column(x_column)?, read.column(y_column)?);
        let errors: Vec<f64> = match (error_column, low_column, high_column, error) {
            (Some(column), None, None, None) => read.column(column)?.to_vec(),
            (None, Some(low), Some(high), None) => {
                read.column(low)?.iter().zip(read.column(high)?).map(|(low, high)| 0.5 * (high - low)).collect()
            }
            (None, None, None, Some(error)) => vec![*error; x.len()],
            _ => {
                let message = format!("the errors of `{name}` are not known");
                let help = "give `error_column`, or `low_column` and `high_column`, or one `error` for all rows";
                return self.wrong("y_column", "with which errors?", message, help);
            }
        };
        let rows: Vec<Datum> = (0..x.len())
            .map(|row| Datum { x: x[row], y: y[row], error: errors[row] })
            .filter(|datum| !datum.x.is_nan() && !datum.y.is_nan() && !datum.error.is_nan())
            .collect();
        let key = if error_column.is_some() {
            "error_column"
        } else if error.is_some() {
            "error"
        } else {
            "low_column"
        };
        rows.iter().try_for_each(|datum| self.positive(key, datum.error))?;
        if rows.is_empty() {
            let message = format!("no row of the table of `{name}` has all numbers");
            return self.wrong("table", "nothing to compare with", message, "name columns that hold numbers");
        }
        Ok(rows)
    }
}
