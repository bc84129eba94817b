//! The experiments that ship, as the program carries them: what their runs read, without READMEs and pictures.

use serde::Deserialize;

/// Files below `experiments`, in order: path and bytes.
const FILES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/experiments.rs"));

/// How long runs take, by document.
const DURATIONS: &str = "durations.csv";

/// An experiment that ships.
#[derive(Debug, Clone, PartialEq)]
pub struct Shipped {
    /// Its folder.
    pub folder: &'static str,
    /// The document that stands for it, in the folder.
    pub main: &'static str,
    /// Its other documents.
    pub others: Vec<&'static str>,
    /// Title of the main document.
    pub title: String,
    /// What it shows.
    pub description: String,
    /// Seconds that a run takes on one core, if known.
    pub seconds: Option<f64>,
}

/// What the list of experiments says of a document.
#[derive(Deserialize)]
struct Head {
    title: String,
    #[serde(default)]
    description: String,
}

impl Shipped {
    /// Its files: path in the folder and bytes.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, &'static [u8])> {
        let folder = self.folder;
        FILES.iter().filter_map(move |(path, bytes)| Some((path.strip_prefix(folder)?.strip_prefix('/')?, *bytes)))
    }

    /// The document of a name without its ending, if there is one.
    pub fn document(&self, stem: &str) -> Option<&'static str> {
        let is_meant = |name: &&str| name.strip_suffix(".toml") == Some(stem);
        std::iter::once(self.main).chain(self.others.iter().copied()).find(is_meant)
    }
}

/// All experiments, by the names of their folders.
pub fn experiments() -> Vec<Shipped> {
    let mut folders: Vec<&str> = FILES.iter().filter_map(|(path, _)| Some(path.split_once('/')?.0)).collect();
    folders.dedup();
    folders.into_iter().filter_map(experiment).collect()
}

fn experiment(folder: &'static str) -> Option<Shipped> {
    let in_folder = |path: &'static str| path.strip_prefix(folder)?.strip_prefix('/');
    let documents = FILES.iter().filter_map(|(path, bytes)| {
        let name = in_folder(path).filter(|name| name.ends_with(".toml") && *name != crate::verify::CLAIMS)?;
        let table: toml::Table = std::str::from_utf8(bytes).ok()?.parse().ok()?;
        // A study is no experiment.
        table.contains_key("run").then(|| Some((name, table.try_into::<Head>().ok()?))).flatten()
    });
    let mut documents: Vec<(&str, Head)> = documents.collect();
    let first = documents.iter().position(|(name, _)| *name == "experiment.toml").unwrap_or(0);
    if documents.is_empty() {
        return None;
    }
    let (main, Head { title, description }) = documents.remove(first);
    let others = documents.into_iter().map(|(name, _)| name).collect();
    Some(Shipped { folder, main, others, title, description, seconds: seconds(folder, main) })
}

/// Seconds that a document takes on one core, if that is known.
pub fn seconds(folder: &str, document: &str) -> Option<f64> {
    let (_, table) = FILES.iter().find(|(path, _)| *path == DURATIONS)?;
    let rows = std::str::from_utf8(table).ok()?.lines();
    let row = rows.filter_map(|line| line.split_once(',')).find(|(of, _)| {
        of.strip_prefix(folder).and_then(|rest| rest.strip_prefix('/')).is_some_and(|name| name == document)
    });
    row?.1.trim().parse().ok()
}

/// "3 s", "40 s", "2 min".
pub fn about(seconds: f64) -> String {
    match seconds {
        ..1.5 => "1 s".to_owned(),
        ..10.0 => format!("{seconds:.0} s"),
        ..55.0 => format!("{:.0} s", (seconds / 5.0).round() * 5.0),
        _ => format!("{:.0} min", (seconds / 60.0).max(1.0)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_folder_of_experiments_is_carried_with_its_documents() {
        let all = experiments();
        assert!(all.len() > 30, "{}", all.len());
        let find = |name: &str| all.iter().find(|one| one.folder == name).expect("an experiment");
        assert_eq!(find("optical_tweezers").main, "red_cell.toml");
        assert_eq!(find("aggregation").others, ["small.toml", "stirred.toml"]);
        assert_eq!(find("sorting").document("apart"), Some("apart.toml"));
        let names: Vec<&str> = find("squeezed_drop").files().map(|(name, _)| name).collect();
        assert_eq!(names, ["data/drop_plates.csv", "expected.toml", "experiment.toml"]);
    }

    #[test]
    fn durations_are_told_roughly_and_belong_to_documents() {
        assert_eq!([0.2, 3.4, 47.0, 58.0, 150.0].map(about), ["1 s", "3 s", "45 s", "1 min", "2 min"]);
        let (_, table) = FILES.iter().find(|(path, _)| *path == DURATIONS).expect("the table of durations");
        for line in std::str::from_utf8(table).expect("a text").lines().skip(1) {
            let (document, _) = line.split_once(',').expect("two columns");
            assert!(FILES.iter().any(|(path, _)| *path == document), "{document} is not there");
        }
    }
}
