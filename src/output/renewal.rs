//! Takes frames into the next version of a result file.

use std::cell::Cell;
use std::path::Path;

use hdf5::File;

use super::columns::Columns;
use super::container::{self, Access, machine_error, set_number};
use super::fits::misfit;
use super::frame_log::{Found, FrameLog, Owner};
use super::layout_io::{read_header, read_layout};
use super::versions::renew;
use super::whole::whole_frames;
use super::{Frame, Layout};
use crate::error::Result;

/// Cuts the datasets of a file to its first frames and appends others. How many frames there are then.
pub(super) fn take_in(
    file: &File,
    layout: &Layout,
    keep: usize,
    frames: impl Iterator<Item = Frame>,
) -> hdf5::Result<usize> {
    let mut columns = Columns::reopen(file, layout, keep)?;
    for frame in frames {
        columns.append(file, &frame)?;
    }
    columns.write()?;
    let steps = file.group("/VTKHDF/Steps")?;
    set_number(&steps, "NSteps", columns.frames() as i64)?;
    Ok(columns.frames())
}

/// Takes the frames that a run has left in its log, because it was killed, into its result file. Nothing is done where the
/// file cannot be changed: it is then read as it is.
///
/// Whether a run goes on that writes the file.
pub(super) fn settle(path: &Path) -> bool {
    match FrameLog::look(path) {
        Found::Nothing => false,
        Found::Taken => true,
        Found::Free(mut log) => {
            if settle_from(path, &mut log).is_ok_and(|is_settled| is_settled) {
                log.remove();
            }
            false
        }
    }
}

/// Whether the log was of this file, so that all of it is in the file now.
fn settle_from(path: &Path, log: &mut FrameLog) -> Result<bool> {
    let damaged = |error: hdf5::Error| container::damaged(path, &error.to_string());
    let (layout, owner, known) = {
        let file = container::open(path, Access::Read)?;
        let read = || -> hdf5::Result<_> {
            let layout = read_layout(&file)?;
            let resumed = file.group("provenance")?.attr("resumed")?.read_scalar::<i64>()?;
            let known = whole_frames(&file, &layout)?;
            Ok((layout, Owner::of(&read_header(&file)?, resumed), known))
        };
        read().map_err(damaged)?
    };
    let replay =
        log.replay(&owner, known).map_err(|error| machine_error(path, "could not be read", &error.to_string()))?;
    // A file without a frame does not know yet what frames bring with them.
    let Some(layout) = replay.layout().filter(|found| known == 0 || **found == layout).cloned() else {
        return Ok(false);
    };
    let all_fit = Cell::new(true);
    let mut frames = replay.take_while(|frame| fits(&layout, frame, &all_fit)).peekable();
    if frames.peek().is_some() {
        renew(path, |file| take_in(file, &layout, known, frames).map_err(damaged))?;
    }
    Ok(all_fit.get())
}

/// Whether a frame of a log is one of the layout; notes it in `all` if it is not, which no program of ours has written.
pub(super) fn fits(layout: &Layout, frame: &Frame, all: &Cell<bool>) -> bool {
    let fits = misfit(layout, !frame.forces.is_empty(), frame).is_none();
    all.set(all.get() && fits);
    fits
}
