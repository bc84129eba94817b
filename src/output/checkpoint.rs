//! The checkpoint: the state of a run at one instant, kept so that whatever happens, one whole checkpoint is on disk.
//!
//! While the run goes on it is a file of its own beside the result, replaced as a whole; when the run ends it moves
//! into the result file. It carries the header too, so a run can go on even if its result file is lost.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::container::{self, Access, machine_error};
use super::header::Header;
use super::replacement::{Replacement, beside};
use crate::error::{Error, Fault, Result};

/// First bytes of a checkpoint.
const MAGIC: &[u8; 8] = b"PSEUDCKP";
/// Version of the arrangement of the bytes.
const VERSION: u32 = 20;
/// Where the checkpoint of a finished run stands in the result file.
pub(super) const DATASET: &str = "/checkpoint";

/// What a checkpoint says of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckpointMeta {
    /// Steps made.
    pub step: u64,
    /// Simulated time, s.
    pub time: f64,
    /// Frames recorded up to there.
    pub frames: usize,
    /// [`Header::experiment_hash`] of the run.
    pub experiment_hash: u64,
    /// The header of the run.
    pub header: Header,
}

impl CheckpointMeta {
    /// Describes a checkpoint of the run with this header.
    pub fn new(header: &Header, step: u64, time: f64, frames: usize) -> Self {
        Self { step, time, frames, experiment_hash: header.experiment_hash(), header: header.clone() }
    }
}

/// A checkpoint as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    /// What it says of itself.
    pub meta: CheckpointMeta,
    /// The state, as the simulator encodes it.
    pub payload: Vec<u8>,
}

/// The path of the file that keeps the checkpoint of an unfinished run: `<result>.checkpoint`.
pub fn checkpoint_path(result: &Path) -> PathBuf {
    beside(result, ".checkpoint")
}

/// Replaces the checkpoint of an unfinished run. A kill at any moment leaves the old one or the new one, whole.
///
/// # Errors
/// [`Error::Machine`] if the disk refuses.
pub fn save_checkpoint(result: &Path, meta: &CheckpointMeta, payload: &[u8]) -> Result<()> {
    put(result, &encode(meta, payload))
}

/// Puts the bytes of a checkpoint beside a result.
pub(super) fn put(result: &Path, bytes: &[u8]) -> Result<()> {
    let path = checkpoint_path(result);
    let written = Replacement::of(&path).and_then(|new| {
        new.create()?.write_all(bytes)?;
        new.put()
    });
    written.map_err(|error| machine_error(&path, "could not be written", &error.to_string()))
}

/// The checkpoint of a run: from its own file, or from the finished result. `None` if there is neither.
///
/// # Errors
/// A damaged checkpoint, or a result file that cannot be opened.
pub fn load_checkpoint(result: &Path) -> Result<Option<Checkpoint>> {
    let path = checkpoint_path(result);
    match crate::files::read(&path) {
        Ok(bytes) => return decode(&bytes, &path).map(Some),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
        Err(error) => return Err(machine_error(&path, "could not be read", &error.to_string())),
    }
    let file = container::open(result, Access::Read)?;
    if !file.link_exists("checkpoint") {
        return Ok(None);
    }
    let bytes = file.dataset(DATASET).and_then(|dataset| dataset.read_raw::<u8>());
    let bytes = bytes.map_err(|error| container::damaged(result, &error.to_string()))?;
    decode(&bytes, result).map(Some)
}

/// Magic, version, length of the description, description, state, checksum of all before it.
fn encode(meta: &CheckpointMeta, payload: &[u8]) -> Vec<u8> {
    let meta = postcard::to_stdvec(meta).expect("plain numbers and texts always encode");
    let mut bytes = Vec::with_capacity(MAGIC.len() + 4 + 8 + meta.len() + payload.len() + 4);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&(meta.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&meta);
    bytes.extend_from_slice(payload);
    let sum = crc32fast::hash(&bytes);
    bytes.extend_from_slice(&sum.to_le_bytes());
    bytes
}

fn decode(bytes: &[u8], path: &Path) -> Result<Checkpoint> {
    let name = path.display();
    let damaged = |found: &str| {
        Error::input(
            Fault::new(format!("the checkpoint in {name} is damaged: {found}"))
                .help("the frames recorded so far can still be read; run the experiment again to go on"),
        )
    };
    let (body, sum) = bytes.split_last_chunk::<4>().ok_or_else(|| damaged("it is too short"))?;
    if !body.starts_with(MAGIC) {
        return Err(damaged("it does not begin like one"));
    }
    if crc32fast::hash(body) != u32::from_le_bytes(*sum) {
        return Err(damaged("its checksum is wrong"));
    }
    let (version, body) = body[MAGIC.len()..].split_first_chunk::<4>().ok_or_else(|| damaged("it is too short"))?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(Error::input(
            Fault::new(format!("the checkpoint in {name} has version {version}, this program knows {VERSION}"))
                .help("resume with the version of pseudopod that began the run"),
        ));
    }
    let (length, body) = body.split_first_chunk::<8>().ok_or_else(|| damaged("it is too short"))?;
    let length = usize::try_from(u64::from_le_bytes(*length)).unwrap_or(usize::MAX);
    let (meta, payload) = body.split_at_checked(length).ok_or_else(|| damaged("it is too short"))?;
    let meta = postcard::from_bytes(meta).map_err(|error| damaged(&error.to_string()))?;
    Ok(Checkpoint { meta, payload: payload.to_vec() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> (CheckpointMeta, Vec<u8>) {
        let header = Header::now("a.toml", "A", "title = 'A'", &["seed=3".into()], 3);
        (CheckpointMeta::new(&header, 120, 0.5, 4), (0..=255).cycle().take(5000).collect())
    }

    #[test]
    fn a_checkpoint_is_read_as_it_was_saved() {
        let folder = tempfile::tempdir().unwrap();
        let result = folder.path().join("run.h5");
        let (meta, payload) = example();
        save_checkpoint(&result, &meta, b"older").unwrap();
        save_checkpoint(&result, &meta, &payload).unwrap();
        let found = load_checkpoint(&result).unwrap().unwrap();
        assert_eq!(found, Checkpoint { meta, payload });
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file stays behind");
    }

    #[test]
    fn any_wrong_byte_and_any_cut_is_noticed() {
        let (meta, payload) = example();
        let whole = encode(&meta, &payload);
        let path = Path::new("run.h5.checkpoint");
        for at in (0..whole.len()).step_by(7) {
            let mut wrong = whole.clone();
            wrong[at] ^= 0x10;
            let error = decode(&wrong, path).unwrap_err().to_string();
            assert!(error.contains("is damaged"), "byte {at}: {error}");
            assert!(decode(&whole[..at], path).is_err(), "cut at {at}");
        }
    }
}
