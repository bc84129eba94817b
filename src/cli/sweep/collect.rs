//! `pseudopod sweep collect`: what the runs of a study measured, as tables and charts.

use crate::cli::report::{Report, path_text, paths};
use crate::error::{Result, say};
use crate::picture::save_chart;
use crate::study::table::csv_text;
use crate::study::{
    Collected, Plan, Sensitivity, Status, charts, collect, refused, sensitivities, sensitivity_columns, write_all,
};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Writes what the runs of a study measured: summary.csv, summary.parquet, sensitivity.csv for Saltelli's points, and a chart of each
/// measure in figures/.
#[derive(Debug, Clone, clap::Args)]
pub struct CollectArgs {
    /// The folder of the plan.
    pub folder: PathBuf,
    /// Makes no charts.
    #[arg(long)]
    pub no_pictures: bool,
    /// Prints what was done as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command. Tables and charts that are there are replaced: they follow from the results.
///
/// # Errors
/// [`Error::Input`] for a folder without a plan; [`Error::Machine`] when the disk refuses.
pub fn run(args: &CollectArgs) -> Result<Report> {
    let collected = collect(Plan::read(&args.folder)?);
    let found = sensitivities(&collected);
    let mut files = write_tables(&collected, &found, &args.folder)?;
    if !args.no_pictures {
        let folder = args.folder.join("figures");
        std::fs::create_dir_all(&folder).map_err(|error| refused(&folder, &error))?;
        for (name, chart) in charts::charts(&collected) {
            files.extend(save_chart(&chart, &folder.join(name))?);
        }
    }
    for row in collected.rows.iter().zip(&collected.plan.runs) {
        if let (Status::Differs | Status::Failed, (row, run)) = (row.0.status, row) {
            let note = row.note.as_deref().unwrap_or_default().lines().next().unwrap_or_default();
            say(&format!("{} {}: {note}", run.told(&collected.plan.facts.parameters), row.status.word()));
        }
    }
    found.iter().flat_map(|one| one.notes(&collected)).for_each(|note| say(&note));
    let counts: Vec<(Status, usize)> = collected.counts().filter(|(_, count)| *count > 0).collect();
    let told = counts.iter().map(|(status, count)| format!("{count} {}", status.word())).collect::<Vec<_>>().join(", ");
    let mut words = format!("{} runs: {told}\n", collected.rows.len());
    for path in &files {
        let _ = writeln!(words, "{}", path.display());
    }
    let facts: serde_json::Map<_, _> =
        counts.iter().map(|(status, count)| (status.word().to_owned(), (*count).into())).collect();
    let report = Report { words, ..Report::default() }.fact("folder", path_text(&args.folder));
    Ok(report.fact("files", paths(&files)).fact("runs", collected.rows.len()).fact("statuses", facts))
}

fn write_tables(collected: &Collected, found: &[Sensitivity], folder: &Path) -> Result<Vec<PathBuf>> {
    let columns = collected.columns();
    let mut tables = vec![
        ("summary.csv", csv_text(&columns).into_bytes()),
        #[cfg(feature = "parquet")]
        ("summary.parquet", crate::study::table::parquet_bytes(&columns)?),
    ];
    if !found.is_empty() {
        tables.push(("sensitivity.csv", csv_text(&sensitivity_columns(collected, found)).into_bytes()));
    }
    write_all(tables, folder)
}
