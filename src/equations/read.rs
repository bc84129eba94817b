//! One entrance for documents of equations: EML, and SBML models wherever an EML document can stand.

use super::files::{Files, NamedFile};
use super::{eml, sbml};
use crate::error::{Location, Result, Source};
use std::sync::Arc;

/// A document of equations as it was read.
#[derive(Debug, Clone)]
pub struct Read {
    /// What it says; an SBML model is a document of a scene, in seconds, without links.
    pub document: eml::Document,
    /// What was ignored, one sentence each.
    pub notices: Vec<String>,
    /// The SBML model that it came from, if it did.
    pub sbml: Option<sbml::Model>,
}

/// As [`read_in`], of a text that stands in no folder.
///
/// # Errors
/// As [`read_in`].
pub fn read(source: Arc<Source>) -> Result<Read> {
    read_in(source, Files::default())
}

/// The files that a document names and that are read with it: documents that it includes, tables, images and datasets. Faults are
/// left to who reads it.
pub fn named_files(source: Arc<Source>, files: Files) -> Vec<NamedFile> {
    if sbml::is_sbml(&source.text) { Vec::new() } else { eml::named_files(source, files) }
}

/// Reads an EML document or an SBML model, and the files that it names.
///
/// # Errors
/// As [`eml::read_in`] and [`sbml::read`].
pub fn read_in(source: Arc<Source>, files: Files) -> Result<Read> {
    if !sbml::is_sbml(&source.text) {
        return Ok(Read { document: eml::read_in(source, files)?, notices: Vec::new(), sbml: None });
    }
    let model = sbml::read(&source)?;
    let whole = Location { source, start: 0, length: 0, label: String::new() };
    let document = eml::Document {
        name: model.system.name.clone(),
        level: eml::Level::Scene,
        time_unit: "s".into(),
        seconds: 1.0,
        locations: vec![whole; model.system.quantities.len()],
        system: model.system.clone(),
        grid: None,
        fields: Vec::new(),
        scene: None,
        membrane: None,
        noise: Vec::new(),
        links: Vec::new(),
        solver: eml::SolverChoice::default(),
    };
    Ok(Read { document, notices: model.notices.clone(), sbml: Some(model) })
}
