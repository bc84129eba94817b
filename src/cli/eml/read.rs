//! Documents of equations from files.

use crate::equations::{self, Files, Read, sbml};
use crate::error::{Error, Fault, Result, Source};
use crate::experiment::near_file;
use std::io::{ErrorKind, Read as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads a file that holds an EML document or an SBML model.
///
/// # Errors
/// [`Error::Input`] with all faults, or with the reason why there is no text.
pub fn read(path: &Path) -> Result<Read> {
    let name = path.display().to_string();
    let source = Source { text: text(path, &name)?, name };
    equations::read_in(Arc::new(source), Files::of_folder(path.parent()))
}

/// The files that a document names, all of which are read with it.
pub fn named_files(path: &Path) -> Vec<PathBuf> {
    let name = path.display().to_string();
    let Ok(text) = text(path, &name) else { return Vec::new() };
    let named = equations::named_files(Arc::new(Source { name, text }), Files::of_folder(path.parent()));
    named.into_iter().map(|file| file.path).collect()
}

/// The text of a file; a file larger than every document is not read.
fn text(path: &Path, name: &str) -> Result<String> {
    let most = sbml::LARGEST_DOCUMENT as u64;
    let too_large = |size: String| {
        let message = format!("{name} has {size} bytes; a document of equations has at most {most}");
        Error::input(Fault::new(message).help("name an EML document or an SBML model"))
    };
    let failed = |error: std::io::Error| Error::input(unreadable(path, &error));
    crate::files::check_plain(path).map_err(failed)?;
    let file = std::fs::File::open(path).map_err(failed)?;
    let size = file.metadata().map_err(failed)?.len();
    if size > most {
        return Err(too_large(size.to_string()));
    }
    // What is no plain file says nothing about its size.
    let mut bytes = Vec::new();
    file.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > most {
        return Err(too_large(format!("more than {most}")));
    }
    String::from_utf8(bytes).map_err(|error| {
        let offset = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..offset].iter().filter(|byte| **byte == b'\n').count();
        let fault = Fault::new(format!("{name}:{line}: byte {offset} is not UTF-8 text"));
        Error::input(fault.help("name an EML document or an SBML model, saved as UTF-8"))
    })
}

fn unreadable(path: &Path, error: &std::io::Error) -> Fault {
    let name = path.display();
    if path.is_dir() {
        return Fault::new(format!("{name} is a folder")).help("name a document in it");
    }
    match error.kind() {
        ErrorKind::NotFound => {
            let help = match near_file(path) {
                Some(near) => format!("did you mean {}?", near.display()),
                None => "name an EML document or an SBML model, such as eml/decay.eml".to_owned(),
            };
            Fault::new(format!("there is no file {name}")).help(help)
        }
        ErrorKind::PermissionDenied => {
            Fault::new(format!("{name} may not be read")).help("change its permissions, such as with chmod u+r")
        }
        _ => Fault::new(format!("{name} cannot be read: {error}")).help("check the file and the disk it is on"),
    }
}
