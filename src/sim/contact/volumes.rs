//! Volumes in the sweeps, to first order; exact ones come after.

use pulp::{Arch, NullaryFnOnce};

use super::change::Change;
use super::mobility::{Body, Mobility, Motion};
use super::rounds::Crew;
use super::together::Together;
use super::vectors::{V4, map};
use crate::mechanics::modes::{MODES, OfModes};

/// A volume that is kept while contacts move atoms.
#[derive(Debug, Clone, Copy)]
pub struct VolumeRow {
    /// Its first atom, counted from the first of its kind.
    pub first: usize,
    /// One behind its last atom.
    pub end: usize,
    /// Volume less target before the first sweep, less what the gradient makes of the displacement then, µm³.
    pub offset: f64,
    /// Pressure over change of volume, pN/µm⁵.
    pub inverse: f64,
    /// Displacement over force of its atoms by themselves, µm/pN.
    pub mobility: f64,
    /// Squared displacement of all its atoms over squared pressure, µm⁶/pN².
    pub swelling: f64,
    /// Where the column of its cell begins, if that moves by columns.
    pub column: Option<usize>,
    /// Its cell.
    pub body: usize,
}

/// What the gradient of a volume is in the modes of its cell, µm².
pub type InModes = [V4; MODES];

/// Volumes whose changes are added up before those of others: the sums do not depend on what threads take.
const ADDED_UP: usize = 64;

/// Atoms of the volumes that a thread takes at once, about.
const ATOMS_PER_JOB: usize = 1024;

/// Puts all volumes back to first order, eq. (adhesion.6); `gradient` are those of the volumes, µm², and `modes` what these are in modes, where
/// cells move by them.
pub fn sweep_volumes(
    (volumes, modes): (&[VolumeRow], &[InModes]),
    gradient: &[[f64; 3]],
    moved: &mut [V4],
    mobility: &mut Mobility,
    change: &mut Change,
    crew: Crew,
) {
    let Mobility { has_modes, kinds, bodies, moved: motions, changes, columns, .. } = mobility;
    let columns = &columns.values[..];
    let per_job = (ATOMS_PER_JOB * volumes.len() / moved.len().max(1)).max(1);
    let (moved, motions) = (Together::new(moved), Together::new(motions));
    changes.clear();
    changes.resize(volumes.len(), Change::default());
    let of_volumes = Together::new(changes);
    crew.each(volumes.len().div_ceil(per_job), |job| {
        let part = job * per_job..volumes.len().min((job + 1) * per_job);
        let cells = Cells { gradient, columns, kinds, bodies, moved: &moved, motions: &motions };
        // SAFETY: each volume is that of one job.
        let changes = unsafe { of_volumes.part(part.clone()) };
        if *has_modes {
            let modes = &modes[part.clone()];
            Arch::new().dispatch(SweepVolumes::<true> { volumes: &volumes[part], modes, cells, changes });
        } else {
            Arch::new().dispatch(SweepVolumes::<false> { volumes: &volumes[part], modes: &[], cells, changes });
        }
    });
    // What is worst is told of contacts alone.
    let worst = change.worst;
    if volumes.len() <= ADDED_UP {
        changes.iter().for_each(|of_volume| change.add(of_volume));
    } else {
        let sum = |changes: &[Change]| changes.iter().fold(Change::default(), Change::and);
        changes.chunks(ADDED_UP).for_each(|changes| change.add(&sum(changes)));
    }
    change.worst = worst;
}

/// What volumes move.
struct Cells<'a> {
    gradient: &'a [[f64; 3]],
    columns: &'a [V4],
    kinds: &'a [(u32, OfModes)],
    bodies: &'a [Body],
    moved: &'a Together<'a, V4>,
    motions: &'a Together<'a, Motion>,
}

struct SweepVolumes<'a, const BY_MODES: bool> {
    volumes: &'a [VolumeRow],
    modes: &'a [InModes],
    cells: Cells<'a>,
    /// What becomes of each.
    changes: &'a mut [Change],
}

impl<const BY_MODES: bool> NullaryFnOnce for SweepVolumes<'_, BY_MODES> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { volumes, modes, cells, changes } = self;
        let Cells { gradient, columns, kinds, bodies, moved, motions } = cells;
        for (number, (volume, change)) in volumes.iter().zip(changes).enumerate() {
            let gradient = &gradient[volume.first..volume.end];
            // SAFETY: each volume has atoms of its own.
            let moved = unsafe { moved.part(volume.first..volume.end) };
            let mut along = [0.0; 4];
            for (g, d) in gradient.iter().zip(&*moved) {
                let g = [g[0], g[1], g[2], 0.0];
                along = map(|i| along[i] + g[i] * d[i]);
            }
            let mut missing = volume.offset + ((along[0] + along[1]) + along[2]);
            if BY_MODES {
                let mut by_modes = [0.0; 4];
                // SAFETY: each volume has a cell of its own.
                let motion = unsafe { motions.item(volume.body) };
                for (along, part) in motion.along.iter().zip(&modes[number]) {
                    by_modes = map(|i| by_modes[i] + part[i] * along[i]);
                }
                missing += (by_modes[0] + by_modes[1]) + by_modes[2];
            }
            let pressure = -missing * volume.inverse;
            if let Some(first) = volume.column {
                let swell = &columns[first..];
                moved.iter_mut().zip(swell).for_each(|(d, s)| *d = map(|i| d[i] + pressure * s[i]));
            }
            let back = pressure * volume.mobility;
            for (d, g) in moved.iter_mut().zip(gradient) {
                let g = [g[0], g[1], g[2], 0.0];
                *d = map(|i| d[i] + back * g[i]);
            }
            if BY_MODES {
                // SAFETY: as above.
                let (response, motion) = (&kinds[bodies[volume.body].kind()].1, unsafe { motions.item(volume.body) });
                for ((along, part), response) in motion.along.iter_mut().zip(&modes[number]).zip(response) {
                    let share = pressure * response;
                    *along = map(|i| along[i] + share * part[i]);
                }
            }
            // As far as all atoms move in the mean.
            change.largest = (pressure * pressure * volume.swelling / moved.len() as f64).sqrt();
            change.work = pressure * pressure / volume.inverse;
        }
    }
}
