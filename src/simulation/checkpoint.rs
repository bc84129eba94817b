//! Checkpoints: a simulation at one instant as bytes, and back.
//!
//! Magic, version, fingerprint of the model, the state, checksum of all before it.

use super::error::{CheckpointFault, SimulationError};
use super::fingerprint::fingerprint;
use super::fits::check_fits;
use super::stepping::Simulation;
use crate::sim::{State, Workspace};

/// First bytes of a checkpoint.
const MAGIC: &[u8; 8] = b"PSEUDSIM";
/// Version of the arrangement of the bytes, the state's included.
const VERSION: u32 = 11;

impl Simulation {
    /// The simulation at this instant as bytes: [`Simulation::restore`] goes on from them along the same course, to the last
    /// bit, in this process or another. What [`Simulation::keep`] kept is not in them.
    ///
    /// ```
    /// # use pseudopod::simulation::{Simulation, EXAMPLE};
    /// let mut simulation = Simulation::from_text("example", EXAMPLE)?;
    /// simulation.run_until(1.0)?;
    /// let saved = simulation.checkpoint();
    /// simulation.run_until(2.0)?;
    /// let energy = simulation.series("energy")?;
    ///
    /// let mut other = Simulation::from_text("example", EXAMPLE)?;
    /// other.restore(&saved)?;
    /// assert_eq!(other.time(), 1.0);
    /// other.run_until(2.0)?;
    /// assert_eq!(other.series("energy")?, energy);
    /// # Ok::<(), pseudopod::simulation::SimulationError>(())
    /// ```
    pub fn checkpoint(&self) -> Vec<u8> {
        self.checkpoint_of(&self.state)
    }

    /// The same with another state of this model.
    pub(crate) fn checkpoint_of(&self, state: &State) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&self.fingerprint().to_le_bytes());
        let mut bytes = postcard::to_extend(state, bytes).expect("plain numbers always encode");
        let sum = crc32fast::hash(&bytes);
        bytes.extend_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// Goes back to, or on from, a checkpoint. What was [kept](Simulation::keep) of later times is dropped.
    ///
    /// # Errors
    /// [`SimulationError::Checkpoint`] for bytes that are damaged, no checkpoint, of another version, or of a model that
    /// differs in anything; the simulation is then as it was.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), SimulationError> {
        let state = decode(bytes, self.fingerprint())?;
        check_fits(&self.model, &state).map_err(|_| CheckpointFault::Foreign)?;
        self.state = state;
        self.scratch = Workspace::new(&self.model);
        self.last_step = 0.0;
        self.forget_after(self.state.time);
        Ok(())
    }

    fn fingerprint(&self) -> u64 {
        *self.fingerprint.get_or_init(|| fingerprint(&self.model))
    }
}

fn decode(bytes: &[u8], expected: u64) -> Result<State, CheckpointFault> {
    let damaged = |found: &str| CheckpointFault::Damaged(found.to_owned());
    let (body, sum) = bytes.split_last_chunk::<4>().ok_or(CheckpointFault::NotACheckpoint)?;
    let rest = body.strip_prefix(MAGIC).ok_or(CheckpointFault::NotACheckpoint)?;
    if crc32fast::hash(body) != u32::from_le_bytes(*sum) {
        return Err(damaged("its checksum is wrong"));
    }
    let (version, rest) = rest.split_first_chunk::<4>().ok_or_else(|| damaged("it is too short"))?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(CheckpointFault::Version { found: version, known: VERSION });
    }
    let (found, rest) = rest.split_first_chunk::<8>().ok_or_else(|| damaged("it is too short"))?;
    if u64::from_le_bytes(*found) != expected {
        return Err(CheckpointFault::Foreign);
    }
    postcard::from_bytes(rest).map_err(|error| damaged(&error.to_string()))
}
