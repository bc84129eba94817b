//! What a path names that claims are about: a document, a result, or the experiments of folders.

use super::CLAIMS;
use super::beside::{claims_about, undeclared};
use crate::analysis::claims::{self, Claim, ClaimResult, check_claims};
use crate::error::{Error, Fault, Result};
use crate::experiment::Document;
use crate::output::ResultFile;
use crate::run::{Report, RunOptions, run};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Something with claims about it.
#[derive(Debug)]
pub struct Subject {
    /// The document or the result.
    pub path: PathBuf,
    /// Title of the experiment.
    pub title: String,
    /// What is claimed, at least one claim.
    pub claims: Vec<Claim>,
    /// What it is.
    pub of: Of,
}

/// What claims are held against.
#[derive(Debug)]
pub enum Of {
    /// An experiment, which has to be run.
    Document(Box<Document>),
    /// A finished result.
    Result {
        /// Why the claims may be about something else, where they may.
        notice: Option<String>,
    },
}

impl Subject {
    /// What became of the claims: those about a result are held against its measures, those about a document against the
    /// measures of a run that is made for it.
    ///
    /// # Errors
    /// As [`run`] and [`ResultFile::open`].
    pub fn verify(&self, options: &RunOptions, report: &mut dyn Report) -> Result<Vec<ClaimResult>> {
        let result = match &self.of {
            Of::Result { .. } => &self.path,
            Of::Document(document) => {
                run(document, options, report)?;
                &options.result
            }
        };
        crate::analysis::check_result(&ResultFile::open(result)?, &self.claims)
    }

    /// What is told when nothing could be measured.
    pub fn unmeasured(&self) -> Vec<ClaimResult> {
        check_claims(&self.claims, &[])
    }
}

/// What a path names, with the claims about it: a document; the documents of a folder that its claims are about; those of all
/// folders in a folder that have claims; a result. Claims come from `expected`, or from the file beside the document.
///
/// # Errors
/// [`Error::Input`] with all faults: nothing is there, documents or claims are not good, or claims and documents do not
/// belong together.
pub fn subjects(target: &Path, expected: Option<&Path>) -> Result<Vec<Subject>> {
    if target.is_dir() {
        return match expected {
            None => of_folders(target),
            Some(_) => {
                let fault =
                    Fault::new(format!("{} is a folder, whose experiments have claims of their own", target.display()));
                Err(Error::input(fault.help("name one document or result with --expected")))
            }
        };
    }
    if target.file_name().is_some_and(|name| name == CLAIMS) {
        let fault = Fault::new(format!("{} holds claims, not an experiment", target.display()));
        return Err(Error::input(fault.help("name the document that they are about, or its folder")));
    }
    let is_document = target.extension().is_some_and(|ending| ending == "toml");
    let one = if is_document { of_document(target, expected) } else { of_result(target, expected) };
    Ok(vec![one?])
}

/// The folder itself where it has claims, or else the folders in it that have.
fn of_folders(target: &Path) -> Result<Vec<Subject>> {
    let has_claims = |folder: &PathBuf| folder.join(CLAIMS).exists();
    let folders = match has_claims(&target.to_path_buf()) {
        true => vec![target.to_path_buf()],
        false => entries(target)?.into_iter().filter(has_claims).collect(),
    };
    if folders.is_empty() {
        let fault = Fault::new(format!("neither {} nor a folder in it has an {CLAIMS}", target.display()));
        return Err(Error::input(
            fault.help("name a folder with an experiment and its claims, or a document with --expected"),
        ));
    }
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for folder in &folders {
        match of_folder(folder) {
            Ok(subjects) => found.extend(subjects),
            Err(Error::Input(more)) => faults.extend(more),
            Err(other) => return Err(other),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(Error::Input(faults)) }
}

/// What lies in a folder, in order.
fn entries(folder: &Path) -> Result<Vec<PathBuf>> {
    let read = std::fs::read_dir(folder).and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect());
    let mut paths: Vec<PathBuf> = read.map_err(|error: std::io::Error| {
        let fault = Fault::new(format!("the folder {} cannot be read: {error}", folder.display()));
        Error::input(fault.help("name a folder that you may read"))
    })?;
    paths.sort();
    Ok(paths)
}

/// The documents of a folder that its claims are about.
fn of_folder(folder: &Path) -> Result<Vec<Subject>> {
    let claims = claims::read(&folder.join(CLAIMS))?;
    let documents: BTreeSet<String> = entries(folder)?
        .iter()
        .filter(|path| is_experiment(path))
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    if documents.is_empty() {
        let fault = Fault::new(format!("{} has claims and no experiment document", folder.display()));
        return Err(Error::input(fault.help("put the document beside them, such as experiment.toml")));
    }
    let mut faults = missing_documents(&claims, &documents);
    let mut found = Vec::new();
    for name in documents.iter().filter(|name| claims.iter().any(|claim| claim.is_about(name))) {
        match of_document(&folder.join(name), None) {
            Ok(subject) => found.push(subject),
            Err(Error::Input(more)) => faults.extend(more),
            Err(other) => return Err(other),
        }
    }
    if faults.is_empty() { Ok(found) } else { Err(Error::Input(faults)) }
}

/// Whether a file is taken for an experiment: studies and claims are TOML, too.
fn is_experiment(path: &Path) -> bool {
    let is_study = || {
        let table = crate::files::read_text(path).ok().and_then(|text| text.parse::<toml::Table>().ok());
        table.is_some_and(|table| table.get("experiment").is_some_and(toml::Value::is_str))
    };
    path.extension().is_some_and(|ending| ending == "toml") && !path.ends_with(CLAIMS) && !is_study()
}

/// Claims about documents that are not there.
fn missing_documents(claims: &[Claim], documents: &BTreeSet<String>) -> Vec<Fault> {
    let names = || documents.iter().map(String::as_str);
    let fault = |claim: &Claim| {
        let name = claim.document.as_ref().filter(|name| !documents.contains(*name))?;
        let help = match crate::error::words::meant(name, names()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the documents of the folder are: {}", names().collect::<Vec<_>>().join(", ")),
        };
        let fault = Fault::new(format!("there is no document `{name}` beside the claims"));
        Some(fault.at(claim.document_location.clone()).help(help))
    };
    claims.iter().filter_map(fault).collect()
}

/// A document with its claims.
fn of_document(path: &Path, expected: Option<&Path>) -> Result<Subject> {
    let document = Document::read(path, &[])?;
    let claims = claims_for(path, path, expected)?;
    let faults = undeclared(&claims, &document);
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    let title = document.experiment.title.clone();
    Ok(Subject { path: path.to_path_buf(), title, claims, of: Of::Document(Box::new(document)) })
}

/// A finished result with the claims about the document that it names.
fn of_result(path: &Path, expected: Option<&Path>) -> Result<Subject> {
    let file = ResultFile::open(path)?;
    let header = file.header();
    if !file.ending().finished {
        let fault = Fault::new(format!("{} is not finished, so that nothing is measured yet", path.display()));
        return Err(Error::input(
            fault.help(format!("wait for the run, or go on with it: pseudopod resume {}", path.display())),
        ));
    }
    let document = Path::new(&header.document);
    let claims = claims_for(path, document, expected)?;
    let is_as_written = crate::files::read_text(document).is_ok_and(|text| text == header.experiment);
    let notice = match header.sets.as_slice() {
        [] if is_as_written || expected.is_some() => None,
        [] => Some(format!("{} has changed since the run", document.display())),
        sets => {
            Some(format!("the run changed the experiment by {}, which the claims may not be about", sets.join(", ")))
        }
    };
    Ok(Subject { path: path.to_path_buf(), title: header.title.clone(), claims, of: Of::Result { notice } })
}

/// The claims about a document, at least one; `named` is what the user asked about.
fn claims_for(named: &Path, document: &Path, expected: Option<&Path>) -> Result<Vec<Claim>> {
    let file = expected.map_or_else(|| document.with_file_name(CLAIMS), Path::to_path_buf);
    if expected.is_none() && !file.exists() {
        let fault =
            Fault::new(format!("there are no claims about {}: {} is not there", named.display(), file.display()));
        return Err(Error::input(
            fault.help("write them with a [[claim]] for each, or name another file with --expected"),
        ));
    }
    let claims = claims_about(document, &file)?;
    if claims.is_empty() {
        let fault = Fault::new(format!("no claim of {} is about {}", file.display(), document.display()));
        return Err(Error::input(
            fault.help("name in `document` of a [[claim]] which document it is about, or leave it out"),
        ));
    }
    Ok(claims)
}
