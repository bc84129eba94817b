//! The table of the runs of a plan, `runs.csv`: written, and read again.

use super::document::Design;
use super::facts::{Facts, Run};
use super::saltelli;
use super::variation::Column;
use crate::error::{Error, Fault, Result};
use std::path::{Path, PathBuf};

/// The table of runs.
pub fn table(columns: &[Column], runs: &[Run]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let titles = columns.iter().map(Column::title);
    let titles = ["run".to_owned()].into_iter().chain(titles).chain(["replicate", "seed", "output"].map(String::from));
    // Writing to memory cannot fail, and all rows have as many fields.
    let _ = writer.write_record(titles);
    for run in runs {
        let output = run.output.to_string_lossy().replace('\\', "/");
        let ends = [run.replicate.to_string(), run.seed.to_string(), output];
        let _ = writer.write_record([run.number.to_string()].iter().chain(&run.cells).chain(&ends));
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

/// Reads the table of runs, whose bytes are known to be those that were written.
pub fn parse(text: &str, facts: &Facts, path: &Path) -> Result<Vec<Run>> {
    let damaged = || {
        let fault = Fault::new(format!("{} does not fit the plan beside it", path.display()));
        Error::input(fault.help("plan the study again, with --force"))
    };
    let width = facts.parameters.len();
    let mut runs = Vec::new();
    for (index, record) in (0..).zip(csv::Reader::from_reader(text.as_bytes()).into_records()) {
        let record = record.map_err(|_| damaged())?;
        let field = |number: usize| record.get(number).ok_or_else(damaged);
        let number: u32 = field(0)?.parse().map_err(|_| damaged())?;
        if number != index + 1 || record.len() != width + 4 {
            return Err(damaged());
        }
        runs.push(Run {
            number,
            point: index % facts.points.max(1) + 1,
            replicate: field(width + 1)?.parse().map_err(|_| damaged())?,
            seed: field(width + 2)?.parse().map_err(|_| damaged())?,
            cells: (1..=width).map(|cell| field(cell).map(str::to_owned)).collect::<Result<_>>()?,
            output: PathBuf::from(field(width + 3)?),
        });
    }
    // Where a plan was changed by hand, its points would be others than those of the runs.
    let points = u64::from(facts.points);
    let is_whole = match facts.design {
        Design::Saltelli { number } => points == u64::from(number) * saltelli::each(width) as u64,
        _ => true,
    };
    let is_good = !runs.is_empty() && is_whole && runs.len() as u64 == points * u64::from(facts.replicates);
    if is_good { Ok(runs) } else { Err(damaged()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::paths::fingerprint;
    use crate::study::value::Kind;
    use std::collections::BTreeMap;

    #[test]
    fn a_table_is_read_as_it_was_written() {
        let column = |name: &str, kind| Column { name: name.into(), key: name.into(), kind, log: false };
        let parameters =
            vec![column("strength, of all", Kind::Quantity { unit: "pN/um^2".into() }), column("word", Kind::Text)];
        let run = |number: u32, point, replicate| Run {
            number,
            point,
            replicate,
            seed: u64::from(number) << 40,
            cells: vec!["0.1".into(), format!("a \"b\", {point}")],
            output: format!("runs/{number:05}.vtkhdf").into(),
        };
        let runs = vec![run(1, 1, 1), run(2, 2, 1), run(3, 1, 2), run(4, 2, 2)];
        let text = table(&parameters, &runs);
        assert!(text.starts_with("run,\"strength, of all (pN/um^2)\",word,replicate,seed,output\n1,0.1,"), "{text}");
        let facts = Facts {
            version: String::new(),
            title: String::new(),
            experiment: PathBuf::new(),
            sets: vec!["run.until=1 s".into()],
            seed: 0,
            design: Design::Grid,
            points: 2,
            replicates: 2,
            parameters,
            measures: Vec::new(),
            files: BTreeMap::new(),
            runs: fingerprint(text.as_bytes()),
            study: String::new(),
        };
        assert_eq!(parse(&text, &facts, Path::new("runs.csv")).unwrap(), runs);
        let wanted = ["run.until=1 s", "strength, of all=\"0.1 pN/um^2\"", "word='a \"b\", 1'", "seed=1099511627776"];
        assert_eq!(facts.sets_of(&runs[0]), wanted);
        for (points, replicates, design) in
            [(0, 2, facts.design), (3, 2, facts.design), (2, 2, Design::Saltelli { number: 1 })]
        {
            let other = Facts { points, replicates, design, ..facts.clone() };
            assert!(parse(&text, &other, Path::new("runs.csv")).is_err(), "{points} points, {replicates} times");
        }
    }
}
