//! A page with a result in it.

use super::args::ExportArgs;
use crate::cli::memory::bytes_of;
use crate::error::{Error, Result};
use crate::picture::shown::Shown;
use crate::view::{Film, Scene, page};
use std::path::Path;

/// What a page may take, unless the user says else.
const SIZE: &str = "20 MB";

/// Writes the page; returns a line about what is in it.
///
/// # Errors
/// A quantity that the result does not have, a size that is none, a file that cannot be written.
pub fn write_page(args: &ExportArgs, path: &Path) -> Result<String> {
    let size = bytes_of("--size", args.size.as_deref().unwrap_or(SIZE))?;
    let mut scene = Scene::open(&args.result)?;
    scene.with_result(|result| args.colours.iter().try_for_each(|name| Shown::named(result, name).map(drop)))?;
    // The page itself is there whatever is in it.
    let rest = usize::try_from(size).unwrap_or(usize::MAX).saturating_sub(page::self_contained(&Film::default()).len());
    let film = Film::of(&mut scene, &args.colours, rest)?;
    let text = page::self_contained(&film);
    std::fs::write(path, &text).map_err(|error| Error::Machine {
        message: format!("{} could not be written: {error}", path.display()),
        help: "name a file that you may write to".into(),
    })?;
    let taken = text.len() as f64 / 1e6;
    if text.len() as u64 > size {
        let frames = film.frames;
        return Ok(format!("{frames} of {} frames, {taken:.1} MB: no page is smaller\n", film.of));
    }
    Ok(match film.frames == film.of {
        true => format!("{} frames, {taken:.1} MB\n", film.frames),
        false => format!("{} of {} frames, {taken:.1} MB: --size lets it take more\n", film.frames, film.of),
    })
}
