//! The log of a run: frames that are recorded and not yet in the result file, in a file beside it, `<result>.frames`.
//!
//! Frames are appended with one write each, and nothing that stands in the log is touched until all of it is in the
//! result file. So a kill at any moment leaves every frame but the one that was being written, and that one is known by
//! its checksum. Who writes a result holds the lock of its log for as long as the run goes.
//!
//! The log begins with [`MAGIC`], the version, and whose it is with the layout of its frames; this and the frames are
//! blocks: length (8 bytes), CRC-32 (4 bytes), and what it is in postcard.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufReader, Read, Seek as _, SeekFrom, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::container::machine_error;
use super::header::Header;
use super::replacement::beside;
use super::{Frame, Layout};
use crate::error::{Error, Fault, Result};

/// First bytes of a log.
const MAGIC: &[u8; 8] = b"PSEUDLOG";
/// Version of the frames in it.
const VERSION: u32 = 3;
/// Length and checksum before a block.
const BLOCK_HEAD: usize = 12;
/// How long another program that reads or ends with the result is waited for.
const PATIENCE: Duration = Duration::from_secs(2);

/// The path of the log of a result: `<result>.frames`.
pub fn frames_path(result: &Path) -> PathBuf {
    beside(result, ".frames")
}

/// Whose frames a log holds: one run between two resumes of one result file.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(super) struct Owner {
    experiment: u64,
    started: String,
    resumed: i64,
}

impl Owner {
    /// The run with this header that was resumed so often.
    pub fn of(header: &Header, resumed: i64) -> Self {
        Self { experiment: header.experiment_hash(), started: header.started.clone(), resumed }
    }
}

/// The log of a result, locked by whoever has it.
pub(super) struct FrameLog {
    path: PathBuf,
    file: File,
    /// Length of what stands before the frames.
    head: u64,
    /// Length up to the last whole frame.
    length: u64,
}

/// What is found where the log of a result may be.
pub(super) enum Found {
    Nothing,
    /// Frames that wait for somebody to take them into the file.
    Free(FrameLog),
    /// The log of a run that goes on.
    Taken,
}

/// Why a log could not be had.
enum Refusal {
    /// Another has it.
    Taken,
    System(io::Error),
}

impl FrameLog {
    /// Makes or opens the log of a result and takes its lock.
    ///
    /// # Errors
    /// [`Error::Input`] if another run writes the result, or the path is a link; [`Error::Machine`] if the disk refuses.
    pub fn take(result: &Path) -> Result<Self> {
        let began = Instant::now();
        loop {
            match Self::lock(frames_path(result), true) {
                Ok(log) => return Ok(log),
                Err(Refusal::Taken) if began.elapsed() < PATIENCE => std::thread::sleep(PATIENCE / 40),
                Err(Refusal::Taken) => {
                    let fault = Fault::new(format!("{} is being written by a running simulation", result.display()));
                    let help = "wait until it has ended, or stop it with Ctrl-C: it can be resumed";
                    return Err(Error::input(fault.help(help)));
                }
                Err(Refusal::System(error)) => return Err(cannot_make(result, &error)),
            }
        }
    }

    /// Looks for the log of a result.
    pub fn look(result: &Path) -> Found {
        match Self::lock(frames_path(result), false) {
            Ok(log) => Found::Free(log),
            Err(Refusal::Taken) => Found::Taken,
            Err(Refusal::System(_)) => Found::Nothing,
        }
    }

    fn lock(path: PathBuf, make: bool) -> std::result::Result<Self, Refusal> {
        if fs::symlink_metadata(&path).is_ok_and(|known| !known.is_file()) {
            let words = format!("{} is a link or a device, no log of frames", path.display());
            return Err(Refusal::System(io::Error::new(io::ErrorKind::InvalidInput, words)));
        }
        let file = OpenOptions::new().read(true).write(true).create(make).truncate(false).open(&path);
        let file = file.map_err(Refusal::System)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(Refusal::Taken),
            // Some file systems know no locks. There a run is written all the same, but nobody else's frames are touched.
            Err(TryLockError::Error(_)) if make => {}
            Err(TryLockError::Error(error)) => return Err(Refusal::System(error)),
        }
        let log = Self { path, file, head: 0, length: 0 };
        // Whoever had it before may have removed it in between.
        if log.is_there() { Ok(log) } else { Err(Refusal::Taken) }
    }

    /// Whether the file at the path is still this one.
    pub fn is_there(&self) -> bool {
        let Ok(own) = self.file.metadata() else { return false };
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt as _;
            fs::metadata(&self.path).is_ok_and(|found| (found.dev(), found.ino()) == (own.dev(), own.ino()))
        }
        #[cfg(not(unix))]
        {
            let _ = own;
            self.path.exists()
        }
    }

    /// Empties the log for the frames of a run with this layout.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn begin(&mut self, owner: &Owner, layout: &Layout) -> io::Result<()> {
        let mut head = MAGIC.to_vec();
        head.extend_from_slice(&VERSION.to_le_bytes());
        head.extend_from_slice(&block(&(owner, layout)));
        self.file.set_len(0)?;
        self.file.seek(SeekFrom::Start(0))?;
        self.file.write_all(&head)?;
        (self.head, self.length) = (head.len() as u64, head.len() as u64);
        Ok(())
    }

    /// Removes all frames, which are in the file by now.
    ///
    /// # Errors
    /// If the disk refuses; the frames are then passed over by whoever reads the log.
    pub fn clear(&mut self) -> io::Result<()> {
        self.file.set_len(self.head)?;
        self.length = self.head;
        Ok(())
    }

    /// Appends the frame of this number. After an error the log is as it was before.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn append(&mut self, number: usize, frame: &Frame) -> io::Result<()> {
        let block = block(&(number as u64, frame));
        let written = self.file.seek(SeekFrom::Start(self.length)).and_then(|_| self.file.write_all(&block));
        if let Err(error) = written {
            // The rest of a frame is known by its checksum, should this fail, too.
            let _ = self.file.set_len(self.length);
            return Err(error);
        }
        self.length += block.len() as u64;
        Ok(())
    }

    /// Waits until the disk itself has all frames.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_data()
    }

    /// The frames from this number on that follow each other, if the log is of this run. They end where the log does, or
    /// where a frame is not whole.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn replay(&mut self, owner: &Owner, first: usize) -> io::Result<Replay<'_>> {
        let length = self.file.metadata()?.len();
        self.file.seek(SeekFrom::Start(0))?;
        let mut replay = Replay { log: BufReader::new(&self.file), left: length, next: first as u64, layout: None };
        let mut head = [0; MAGIC.len() + 4];
        if replay.fill(&mut head) && head[..8] == *MAGIC && head[8..] == VERSION.to_le_bytes() {
            let found = replay.block::<(Owner, Layout)>().filter(|(found, _)| found == owner);
            replay.layout = found.map(|(_, layout)| layout);
        }
        Ok(replay)
    }

    /// Removes the log.
    pub fn remove(&self) {
        if self.is_there() {
            let _ = fs::remove_file(&self.path);
        }
    }

    /// Removes a log in which nothing was ever written.
    pub fn remove_if_new(&self) {
        if self.file.metadata().is_ok_and(|known| known.len() == 0) {
            self.remove();
        }
    }
}

/// See [`FrameLog::replay`].
pub(super) struct Replay<'a> {
    log: BufReader<&'a File>,
    /// Bytes that are left: a length beyond them is that of no block.
    left: u64,
    next: u64,
    /// None once the frames are over, or if they are of another run.
    layout: Option<Layout>,
}

impl Replay<'_> {
    /// The layout of the frames; none if the log is of another run.
    pub fn layout(&self) -> Option<&Layout> {
        self.layout.as_ref()
    }

    fn fill(&mut self, bytes: &mut [u8]) -> bool {
        let wanted = bytes.len() as u64;
        let is_read = wanted <= self.left && self.log.read_exact(bytes).is_ok();
        self.left = self.left.saturating_sub(wanted);
        is_read
    }

    fn block<T: DeserializeOwned>(&mut self) -> Option<T> {
        let mut head = [0; BLOCK_HEAD];
        if !self.fill(&mut head) {
            return None;
        }
        let (length, sum) = head.split_first_chunk::<8>()?;
        let length = u64::from_le_bytes(*length);
        if length > self.left {
            return None;
        }
        let mut bytes = vec![0; usize::try_from(length).ok()?];
        let is_whole = self.fill(&mut bytes) && crc32fast::hash(&bytes).to_le_bytes() == *sum;
        if is_whole { postcard::from_bytes(&bytes).ok() } else { None }
    }
}

impl Iterator for Replay<'_> {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        while self.layout.is_some() {
            match self.block::<(u64, Frame)>() {
                // Frames that came to the file before the log was emptied.
                Some((number, _)) if number < self.next => {}
                Some((number, frame)) if number == self.next => {
                    self.next += 1;
                    return Some(frame);
                }
                _ => self.layout = None,
            }
        }
        None
    }
}

fn block<T: Serialize>(of: &T) -> Vec<u8> {
    let mut bytes = vec![0; BLOCK_HEAD];
    bytes = postcard::to_extend(of, bytes).expect("plain numbers and texts always encode");
    let (length, sum) = ((bytes.len() - BLOCK_HEAD) as u64, crc32fast::hash(&bytes[BLOCK_HEAD..]));
    bytes[..8].copy_from_slice(&length.to_le_bytes());
    bytes[8..BLOCK_HEAD].copy_from_slice(&sum.to_le_bytes());
    bytes
}

/// Why no file can be made beside a result, and so no result either.
fn cannot_make(result: &Path, error: &io::Error) -> Error {
    let name = result.display();
    let fault = |found: String, help: &str| Error::input(Fault::new(found).help(help));
    match error.kind() {
        io::ErrorKind::NotFound => fault(
            format!("{name} could not be made: its folder does not exist"),
            "make the folder first, or use another -o",
        ),
        io::ErrorKind::PermissionDenied => {
            fault(format!("{name} may not be written: permission denied"), "write to a folder that is yours with -o")
        }
        io::ErrorKind::NotADirectory => {
            fault(format!("{name} could not be made: a part of its path is a file, not a folder"), "use another -o")
        }
        io::ErrorKind::InvalidInput => {
            fault(format!("{name} could not be made: {error}"), "remove what is there, or use another -o")
        }
        _ => machine_error(result, "could not be made", &error.to_string()),
    }
}

#[cfg(test)]
#[path = "frame_log_tests.rs"]
mod tests;
