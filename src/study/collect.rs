//! What the runs of a study measured, in one table.

use super::facts::Run;
use super::one::{Files, difference};
use super::plan::Plan;
use super::table::{Cells, TableColumn};
use super::value::Kind;
use super::variation::titled;
use crate::error::Error;
use crate::output::{ResultFile, checkpoint_path};

/// A plan with what came out of its runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Collected {
    /// The plan.
    pub plan: Plan,
    /// A row for each run, by number.
    pub rows: Vec<Row>,
}

/// What came out of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// How far it is.
    pub status: Status,
    /// The measures of the plan; none where the run has none.
    pub values: Vec<Option<f64>>,
    /// Version of the program that ran it.
    pub version: Option<String>,
    /// Wall time of its last stretch, s.
    pub wall_time: Option<f64>,
    /// Why it failed, or in what its inputs differ.
    pub note: Option<String>,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Status {
    /// It came to its end.
    Complete,
    /// It is begun and can go on.
    Partial,
    /// It ended with an error.
    Failed,
    /// Its result was made from other inputs than those of the plan.
    Differs,
    /// It is not begun.
    Missing,
}

impl Status {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Complete, Self::Partial, Self::Failed, Self::Differs, Self::Missing];

    /// The word of tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::Partial => "partial",
            Self::Failed => "failed",
            Self::Differs => "differs",
            Self::Missing => "missing",
        }
    }
}

/// Looks at the results of all runs of a plan.
pub fn collect(plan: Plan) -> Collected {
    let rows = plan.runs.iter().map(|run| row(&plan, run)).collect();
    Collected { plan, rows }
}

fn row(plan: &Plan, run: &Run) -> Row {
    let files = Files::of(plan, run);
    let nothing = |status, note| Row {
        status,
        values: vec![None; plan.facts.measures.len()],
        version: None,
        wall_time: None,
        note,
    };
    if !files.result.exists() {
        let trouble = std::fs::read_to_string(&files.trouble).ok();
        return match trouble {
            Some(words) => nothing(Status::Failed, Some(words.trim().to_owned())),
            None if files.partial.exists() || checkpoint_path(&files.partial).exists() => {
                nothing(Status::Partial, None)
            }
            None => nothing(Status::Missing, None),
        };
    }
    let read = || -> Result<Row, Error> {
        let file = ResultFile::open(&files.result)?;
        if let Some(what) = difference(plan, run, file.header()) {
            return Ok(nothing(Status::Differs, Some(what)));
        }
        let found = file.summary()?;
        let value = |name: &str| found.iter().find(|measure| measure.name == name).map(|measure| measure.value);
        let (version, wall_time) = (Some(file.header().version.clone()), file.ending().wall_time);
        let values = plan.facts.measures.iter().map(|measure| value(&measure.name)).collect();
        Ok(Row { status: Status::Complete, values, version, wall_time, note: None })
    };
    // A damaged file is made again once it is removed, which the note says.
    read().unwrap_or_else(|error| nothing(Status::Failed, Some(error.to_string())))
}

impl Collected {
    /// How many runs there are of each status.
    pub fn counts(&self) -> impl Iterator<Item = (Status, usize)> + '_ {
        let count = |status| self.rows.iter().filter(|row| row.status == status).count();
        Status::ALL.into_iter().map(move |status| (status, count(status)))
    }

    /// The table: a row for each run, with its parameters, its seed, its status and what it measured.
    pub fn columns(&self) -> Vec<TableColumn> {
        let Plan { facts, runs, .. } = &self.plan;
        let column = |title: &str, cells| TableColumn { title: title.to_owned(), cells };
        let whole =
            |of: &dyn Fn(&Run) -> u64| Cells::Whole(runs.iter().map(|run| i64::try_from(of(run)).ok()).collect());
        let mut columns = vec![column("run", whole(&|run| run.number.into()))];
        for (index, parameter) in facts.parameters.iter().enumerate() {
            let cells = runs.iter().map(|run| &run.cells[index]);
            columns.push(column(
                &parameter.title(),
                match parameter.kind {
                    Kind::Quantity { .. } | Kind::Number => {
                        Cells::Numbers(cells.map(|cell| cell.parse().ok()).collect())
                    }
                    Kind::Text | Kind::Other => Cells::Words(cells.map(|cell| Some(cell.clone())).collect()),
                },
            ));
        }
        columns.push(column("replicate", whole(&|run| run.replicate.into())));
        columns.push(column("seed", whole(&|run| run.seed)));
        let words = |of: &dyn Fn(&Row) -> Option<String>| Cells::Words(self.rows.iter().map(of).collect());
        columns.push(column("status", words(&|row| Some(row.status.word().to_owned()))));
        for (index, measure) in facts.measures.iter().enumerate() {
            let cells = self.rows.iter().map(|row| row.values[index]).collect();
            columns.push(column(&titled(&measure.name, Some(&measure.unit)), Cells::Numbers(cells)));
        }
        columns.push(column("version", words(&|row| row.version.clone())));
        columns.push(column("wall_time (s)", Cells::Numbers(self.rows.iter().map(|row| row.wall_time).collect())));
        columns
    }
}
