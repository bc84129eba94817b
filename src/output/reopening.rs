//! How the result of a run that was stopped, killed or finished is made ready to go on.

use std::cell::Cell;
use std::path::Path;

use hdf5::File;

use super::catalogue::FORCE;
use super::checkpoint::{self, CheckpointMeta, DATASET, checkpoint_path};
use super::container::{self, Access, failed, machine_error, set_number};
use super::frame_log::{FrameLog, Owner, frames_path};
use super::header::Header;
use super::layout_io::{read_header, read_layout};
use super::pieces::has_frames;
use super::renewal::{fits, take_in};
use super::versions::renew;
use super::whole::whole_frames;
use super::{Frame, Layout};
use crate::error::{Error, Fault, Result};

/// From where a run goes on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kept {
    /// Steps made until then: frames of later steps are removed.
    pub step: u64,
    /// Frames that there must be up to there at least.
    pub frames: usize,
}

impl Kept {
    /// All frames of the steps up to one, however many there are.
    pub fn until(step: u64) -> Self {
        Self { step, frames: 0 }
    }
}

impl From<&CheckpointMeta> for Kept {
    fn from(meta: &CheckpointMeta) -> Self {
        Self { step: meta.step, frames: meta.frames }
    }
}

/// What is known of a result that goes on.
#[derive(Debug, Default)]
pub(super) struct Reopened {
    pub owner: Owner,
    /// Steps made up to each frame.
    pub steps: Vec<u64>,
    /// Whether forces are recorded; unknown until there are atoms.
    pub forces: Option<bool>,
}

/// Takes what the log holds into the file, cuts it to what is kept, removes the end of a finished run, and empties the log.
/// None, and nothing is changed, if no frame has ever been recorded.
///
/// # Errors
/// As [`super::ResultWriter::reopen`].
pub(super) fn reopen(
    path: &Path,
    header: &Header,
    layout: &Layout,
    kept: Kept,
    log: &mut FrameLog,
) -> Result<Option<Reopened>> {
    let damaged = |error: hdf5::Error| container::damaged(path, &error.to_string());
    let refused = |error: std::io::Error| machine_error(&frames_path(path), "could not be read", &error.to_string());
    let seen = container::open(path, Access::Read)?;
    let (found, known) = (read_header(&seen).map_err(damaged)?, read_layout(&seen).map_err(damaged)?);
    check_same_run(path, &found, header)?;
    let resumed = seen.group("provenance").and_then(|group| group.attr("resumed")?.read_scalar::<i64>());
    let resumed = resumed.map_err(damaged)?;
    let owner = Owner::of(&found, resumed);
    let begun = has_frames(&seen);
    if !begun && log.replay(&owner, 0).map_err(refused)?.next().is_none() {
        return if kept.frames == 0 { Ok(None) } else { Err(lost(path, 0, kept)) };
    }
    // What frames bring with them is not known before the first.
    let agrees = if begun { known == *layout } else { known.types == layout.types && known.fields == layout.fields };
    if !agrees {
        return Err(Error::input(
            Fault::new(format!("{} holds other cells than this experiment makes", path.display()))
                .help("resume with the version of pseudopod that began the run"),
        ));
    }
    let whole = whole_frames(&seen, layout).map_err(damaged)?;
    let last = i64::try_from(kept.step).unwrap_or(i64::MAX);
    let mut steps = match begun {
        true => seen.dataset("/step").and_then(|steps| steps.read_raw::<i64>()).map_err(damaged)?,
        false => Vec::new(),
    };
    let in_file = steps[..whole].iter().take_while(|step| **step <= last).count();
    steps.truncate(in_file);
    keep_checkpoint(path, &seen)?;
    drop(seen);
    let more = log.replay(&owner, whole).map_err(refused)?;
    let all_fit = Cell::new(true);
    let wanted = |frame: &Frame| in_file == whole && frame.step <= kept.step && fits(layout, frame, &all_fit);
    let more = more.take_while(wanted);
    let more = more.inspect(|frame| steps.push(i64::try_from(frame.step).unwrap_or(i64::MAX)));
    let forces = renew(path, |file| {
        let frames =
            take_in(file, layout, in_file, more).map_err(|error| failed(path, "could not be changed", &error))?;
        if frames < kept.frames {
            return Err(lost(path, frames, kept));
        }
        remove_end(file, resumed).map_err(|error| failed(path, "could not be changed", &error))?;
        let there = |path: &str| file.dataset(path).is_ok_and(|dataset| dataset.shape()[0] > 0);
        Ok(there("/VTKHDF/Points").then(|| there(FORCE[0].path)))
    })?;
    let owner = Owner::of(&found, resumed + 1);
    log.begin(&owner, layout).map_err(|error| machine_error(path, "could not be changed", &error.to_string()))?;
    let steps = steps.into_iter().map(|step| u64::try_from(step).unwrap_or(0)).collect();
    Ok(Some(Reopened { owner, steps, forces }))
}

fn lost(path: &Path, found: usize, kept: Kept) -> Error {
    let (name, log) = (path.display(), frames_path(path));
    let missing = kept.frames - found;
    Error::input(
        Fault::new(format!(
            "{missing} of the {} frames that were recorded before the checkpoint of {name} are missing",
            kept.frames
        ))
        .help(format!(
            "put {} back beside the result if it was left elsewhere, or run the experiment again",
            log.display()
        )),
    )
}

/// A run goes on only with what it began with.
fn check_same_run(path: &Path, found: &Header, wanted: &Header) -> Result<()> {
    let differs = match () {
        () if found.experiment != wanted.experiment => "another experiment document",
        () if found.sets != wanted.sets => "other --set options",
        () if found.seed != wanted.seed => "another seed",
        () => return Ok(()),
    };
    let (name, side) = (path.display(), checkpoint_path(path));
    let (document, seed) = (&found.document, found.seed);
    Err(Error::input(
        Fault::new(format!("{name} ({document}, seed {seed}) was made with {differs} than what is to be resumed"))
            .help(format!("if {} came from another run, put the right one back or move it away", side.display())),
    ))
}

/// The checkpoint in a finished file goes back to a file of its own before the end is removed: at no moment is there none.
fn keep_checkpoint(path: &Path, file: &File) -> Result<()> {
    if !file.link_exists("checkpoint") || checkpoint_path(path).exists() {
        return Ok(());
    }
    let bytes = file.dataset(DATASET).and_then(|dataset| dataset.read_raw::<u8>());
    checkpoint::put(path, &bytes.map_err(|error| container::damaged(path, &error.to_string()))?)
}

/// Takes the end of a finished run out of its file, so that it can go on.
fn remove_end(file: &File, resumed: i64) -> hdf5::Result<()> {
    for name in ["checkpoint", "summary"] {
        if file.link_exists(name) {
            file.unlink(name)?;
        }
    }
    let group = file.group("provenance")?;
    set_number(&group, "resumed", resumed + 1)?;
    set_number(&group, "finished", 0_i64)?;
    set_number(&group, "wall_time", f64::NAN)
}
