//! Whether a result may be made at a path.

use std::fs;
use std::path::Path;

use super::Layout;
use super::checkpoint::checkpoint_path;
use super::fields::field_view_path;
use crate::error::{Error, Fault, Result};

/// What to do with a result file that is already there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overwrite {
    /// Keep it: an error.
    Refuse,
    /// Replace it and its checkpoint.
    Replace,
}

/// Makes sure that a result may be made at the path. Nothing is touched.
///
/// # Errors
/// [`Error::Input`] if the path is a folder, or if something is there that is not to be replaced.
pub(super) fn claim(path: &Path, overwrite: Overwrite, layout: &Layout) -> Result<()> {
    let name = path.display();
    let fault = |found: String, help: &str| Err(Error::input(Fault::new(found).help(help)));
    let force = "use --force to replace it, or another -o";
    if path.is_dir() {
        return fault(format!("{name} is a folder"), "name a file in it with -o");
    }
    if overwrite == Overwrite::Replace {
        return Ok(());
    }
    // A link that leads nowhere is there, too.
    let is_there = |path: &Path| fs::symlink_metadata(path).is_ok();
    if is_there(path) {
        return fault(format!("{name} exists"), force);
    }
    let side = checkpoint_path(path);
    if is_there(&side) {
        return fault(format!("{} exists: the checkpoint of a run that can be resumed", side.display()), force);
    }
    let mut views = layout.fields.iter().map(|field| field_view_path(path, &field.name));
    match views.find(|view| is_there(view)) {
        Some(view) => fault(format!("{} exists: it would lead to a field of the result", view.display()), force),
        None => Ok(()),
    }
}
