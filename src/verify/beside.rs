//! The claims that stand beside a document.

use super::CLAIMS;
use crate::analysis::claims::{self, Claim};
use crate::error::{Fault, Result};
use crate::experiment::Document;
use crate::output::ResultFile;
use std::path::Path;

/// The claims about a document in the file [`CLAIMS`] of its folder; none without such a file.
///
/// # Errors
/// As [`claims::read`].
pub fn claims_beside(document: &Path) -> Result<Vec<Claim>> {
    let file = document.with_file_name(CLAIMS);
    if !file.exists() {
        return Ok(Vec::new());
    }
    claims_about(document, &file)
}

/// The claims of a file that are about a document.
///
/// # Errors
/// As [`claims::read`].
pub(super) fn claims_about(document: &Path, file: &Path) -> Result<Vec<Claim>> {
    let name = document.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let mut claims = claims::read(file)?;
    claims.retain(|claim| claim.is_about(&name));
    Ok(claims)
}

/// The claims that a finished run has to keep: those beside its document. None where the run changed the document (another
/// seed or end included), or the document has changed since: then the claims are about something else.
///
/// # Errors
/// As [`claims::read`].
pub fn claims_of_run(result: &ResultFile) -> Result<Vec<Claim>> {
    let header = result.header();
    let document = Path::new(&header.document);
    let is_as_written = crate::files::read_text(document).is_ok_and(|text| text == header.experiment);
    if !header.sets.is_empty() || !is_as_written {
        return Ok(Vec::new());
    }
    claims_beside(document)
}

/// Claims about measures that a document does not declare, as faults with their places in the file of claims.
pub(super) fn undeclared(claims: &[Claim], document: &Document) -> Vec<Fault> {
    let declared = || document.experiment.measure.keys().map(String::as_str);
    let unknown = claims.iter().filter(|claim| declared().all(|name| name != claim.measure));
    let fault = |claim: &Claim| {
        let fault = Fault::new(format!("{} declares no measure `{}`", document.source.name, claim.measure));
        let help = match crate::error::words::meant(&claim.measure, declared()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if declared().next().is_none() => "declare it in the document, as in [measure.NAME]".to_owned(),
            None => format!(
                "declare it in the document, or name in `document` which other one the claim is about; there are: {}",
                declared().collect::<Vec<_>>().join(", ")
            ),
        };
        fault.at(claim.measure_location.clone()).help(help)
    };
    unknown.map(fault).collect()
}
