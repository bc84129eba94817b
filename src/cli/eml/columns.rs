//! The columns of a solution, and the table that is written row by row.

use crate::equations::Read;
use crate::equations::tree::{QuantityId, Role};
use crate::error::words::{any_of, meant};
use crate::error::{Error, Fault, Result};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::Path;

/// The name of the time among columns.
const TIME: &str = "time";

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    /// Its title, as asked for.
    pub(super) title: String,
    /// What it holds; the time when there is none.
    pub(super) quantity: Option<QuantityId>,
    /// In which unit; empty where the document has none.
    pub(super) unit: String,
}

impl Column {
    /// Its value in a row.
    pub(super) fn value(&self, time: f64, values: &[f64]) -> f64 {
        self.quantity.map_or(time, |quantity| values[quantity as usize])
    }
}

/// The columns with some names; without any the time and all variables. A species of an SBML model is its amount, in
/// brackets its concentration. The first `time` is the clock, another one a quantity of that name, if there is one.
pub(super) fn columns(names: &[String], read: &Read, faults: &mut Vec<Fault>) -> Vec<Column> {
    let system = &read.document.system;
    let unit = |quantity: Option<QuantityId>| {
        quantity.map_or(String::new(), |number| system.quantities[number as usize].unit.clone())
    };
    if names.is_empty() {
        let variables = system.variables().into_iter();
        let named = variables.map(|number| (system.quantities[number as usize].id.clone(), Some(number)));
        let all = std::iter::once((TIME.to_owned(), None)).chain(named);
        return all.map(|(title, quantity)| Column { title, unit: unit(quantity), quantity }).collect();
    }
    let mut found: Vec<Column> = Vec::new();
    // A model of SBML may have a quantity of that name.
    let clock = |found: &[Column]| found.iter().all(|column| column.title != TIME) || system.find(TIME).is_none();
    for name in names {
        let title = name.trim().to_owned();
        if title == TIME && clock(&found) {
            found.push(Column { title, quantity: None, unit: String::new() });
        } else if let Some(number) = system.find(&title) {
            found.push(Column { title, quantity: Some(number), unit: unit(Some(number)) });
        } else {
            let ids = || std::iter::once(TIME).chain(system.quantities.iter().map(|quantity| quantity.id.as_str()));
            let near = meant(&title, ids()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
            let fault = Fault::new(format!("{} has no column `{title}`", read.document.name));
            faults.push(fault.help(format!("{near}there are: {}", any_of(ids()).replace(" or ", ", "))));
        }
    }
    found
}

/// Puts values in the place of the document's: each of `sets` is `id=value`.
pub(super) fn set(sets: &[String], read: &mut Read, faults: &mut Vec<Fault>) {
    for set in sets {
        if let Err(fault) = set_one(set, read) {
            faults.push(fault);
        }
    }
}

fn set_one(set: &str, read: &mut Read) -> std::result::Result<(), Fault> {
    use crate::equations::tree::{Binary, Expr};
    let help = "write --set id=number, such as --set k=0.2";
    let (id, text) = set.split_once('=').ok_or_else(|| Fault::new(format!("--set {set} says no value")).help(help))?;
    let (id, text) = (id.trim(), text.trim());
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
    let value = value.ok_or_else(|| Fault::new(format!("--set {set}: \"{text}\" is not a number")).help(help))?;
    let system = &mut read.document.system;
    let Some(number) = system.find(id) else {
        let settable = || {
            let known = system.quantities.iter().filter(|quantity| !matches!(quantity.role, Role::Defined { .. }));
            known.map(|quantity| quantity.id.as_str())
        };
        let near = meant(id, settable()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let fault = Fault::new(format!("--set {set}: {} has no quantity `{id}`", read.document.name));
        return Err(fault.help(format!("{near}it has {}", any_of(settable()).replace(" or ", " and "))));
    };
    let is_defined = |number: QuantityId| matches!(system.quantities[number as usize].role, Role::Defined { .. });
    let mut target = number;
    let mut initial = Expr::Number(value);
    if is_defined(number) {
        // Of amount and concentration of a species one follows from the other: that one is set.
        let species = read.sbml.iter().flat_map(|model| &model.species);
        let twin = species
            .filter_map(|species| match number {
                _ if number == species.amount => Some((species.concentration, Binary::Div, species.compartment)),
                _ if number == species.concentration => Some((species.amount, Binary::Mul, species.compartment)),
                _ => None,
            })
            .find(|(twin, ..)| !is_defined(*twin));
        let Some((twin, operator, size)) = twin else {
            let fault = Fault::new(format!("--set {set}: `{id}` follows from its definition"));
            return Err(fault.help("set what the definition uses"));
        };
        (target, initial) = (twin, initial.binary(operator, Expr::Quantity(size)));
    }
    system.quantities[target as usize].initial = initial;
    Ok(())
}

/// A table on its way to a file or to the terminal.
pub(super) struct Table<'a> {
    columns: &'a [Column],
    out: Box<dyn Write>,
    name: String,
    failed: Option<std::io::Error>,
    /// Rows written.
    pub(super) rows: usize,
}

impl<'a> Table<'a> {
    /// A table with its titles, in a file or else on standard output.
    ///
    /// # Errors
    /// The file cannot be made.
    pub(super) fn new(columns: &'a [Column], path: Option<&Path>) -> Result<Self> {
        let (out, name): (Box<dyn Write>, String) = match path {
            Some(path) => {
                let name = path.display().to_string();
                let file = std::fs::File::create(path).map_err(|error| unwritable(&name, &error))?;
                (Box::new(file), name)
            }
            None => (Box::new(std::io::stdout()), "standard output".to_owned()),
        };
        let out = Box::new(BufWriter::new(out));
        let mut table = Self { columns, out, name, failed: None, rows: 0 };
        let titles: Vec<&str> = columns.iter().map(|column| column.title.as_str()).collect();
        table.line(&titles.join(","));
        Ok(table)
    }

    /// Writes a row; a failure is told at the end.
    pub(super) fn row(&mut self, time: f64, values: &[f64]) {
        let cells: Vec<String> = self.columns.iter().map(|column| number(column.value(time, values))).collect();
        self.line(&cells.join(","));
        self.rows += 1;
    }

    fn line(&mut self, line: &str) {
        if self.failed.is_none() {
            self.failed = writeln!(self.out, "{line}").err();
        }
    }

    /// Writes what is left.
    ///
    /// # Errors
    /// What could not be written; a reader that has gone away (`| head`) is no error.
    pub(super) fn finish(mut self) -> Result<usize> {
        let flushed = self.out.flush();
        match self.failed.or(flushed.err()) {
            Some(error) if error.kind() != ErrorKind::BrokenPipe => Err(unwritable(&self.name, &error)),
            _ => Ok(self.rows),
        }
    }
}

fn unwritable(name: &str, error: &std::io::Error) -> Error {
    Error::Machine {
        message: format!("{name} cannot be written: {error}"),
        help: "free some space, or name a file in a folder that you may write to with -o".into(),
    }
}

/// A number in the fewest digits that are read as the same number.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_short_and_read_back() {
        for (value, text) in
            [(1.0, "1"), (0.1, "0.1"), (-2.5e-300, "-2.5e-300"), (1e22, "1e22"), (1.0 / 3.0, "0.3333333333333333")]
        {
            assert_eq!(number(value), text);
            assert_eq!(text.parse(), Ok(value));
        }
    }
}
