//! Projected Gauss–Seidel over contacts and volumes, in a fixed order, and what makes it fast.

use super::rows::Row;
use crate::Vec3;

/// A contact that holds gives way by this share of what a free one would, for each change of its force in the step,
/// eq. (adhesion.5). Where many contacts hold the same atoms their forces are not determined; this picks some, and at
/// rest, when forces do not change, nothing gives way.
const GIVE: f64 = 0.2;

/// A volume that is kept while contacts move atoms.
#[derive(Debug, Clone, Copy)]
pub struct VolumeRow {
    /// Its first atom.
    pub first: usize,
    /// One behind its last atom.
    pub end: usize,
    /// Volume less target before the first sweep, less what the gradient makes of the displacement then, µm³.
    pub offset: f64,
    /// One over the squared gradient, 1/µm⁴.
    pub inverse: f64,
    /// Displacement over force of its atoms, µm/pN.
    pub mobility: f64,
}

/// What a sweep changed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Change {
    /// The largest correction, µm.
    pub largest: f64,
    /// The row with the largest correction of a contact.
    pub worst: usize,
    /// The work of all corrections, pN·µm.
    pub work: f64,
}

impl Row {
    /// How much farther apart displacements bring the two sides, µm.
    #[inline(always)]
    fn apart(&self, moved: &[Vec3]) -> Vec3 {
        let mut apart = Vec3::zeros();
        for (atom, weight) in self.atoms.iter().zip(self.weights) {
            apart += weight * moved[*atom as usize];
        }
        apart
    }

    /// Moves its atoms as a change of its force does.
    #[inline(always)]
    fn push(&self, change: &Vec3, moved: &mut [Vec3], mobility: &[f64]) {
        for (atom, weight) in self.atoms.iter().zip(self.weights) {
            let atom = *atom as usize;
            moved[atom] += (mobility[atom] * weight) * change;
        }
    }

    /// The normal force that this contact should carry, eq. (adhesion.3): it pushes where the gap would close, and pulls, as far
    /// as it can, where the gap would grow.
    #[inline(always)]
    fn normal_force(&self, opened: f64, along: f64, carried: f64) -> f64 {
        // Where the gap would be if the contact carried nothing.
        let free = self.gap + opened - along / self.stiffness;
        let (low, high) = (self.gap.min(0.0), self.gap.max(0.0));
        if free < low {
            (low - free) * self.stiffness
        } else {
            let held = ((high - free) * self.stiffness + GIVE * carried.min(0.0)) / (1.0 + GIVE);
            held.min(0.0).max(self.least)
        }
    }

    /// The tangential force that this contact should carry, eq. (adhesion.4): it keeps the sides from sliding as far as it can.
    #[inline(always)]
    fn tangential_force(&self, slid: &Vec3, across: &Vec3, carried: &Vec3) -> Vec3 {
        let carried = carried - carried.dot(&self.normal) * self.normal;
        let stuck = (across - self.stiffness * slid + GIVE * carried) / (1.0 + GIVE);
        let size = stuck.norm();
        if size > self.shear { stuck * (self.shear / size) } else { stuck }
    }
}

/// One sweep over all contacts.
pub fn sweep_contacts(rows: &mut [Row], carried: &[Vec3], moved: &mut [Vec3], mobility: &[f64], change: &mut Change) {
    let mut largest = 0.0;
    for (number, (row, carried)) in rows.iter_mut().zip(carried).enumerate() {
        if row.stiffness == 0.0 {
            continue;
        }
        let apart = row.apart(moved);
        let (opened, along) = (apart.dot(&row.normal), row.force.dot(&row.normal));
        let wanted = row.normal_force(opened, along, carried.dot(&row.normal));
        let mut step = (wanted - along) * row.normal;
        if row.shear > 0.0 {
            let (slid, across) = (apart - opened * row.normal, row.force - along * row.normal);
            step += row.tangential_force(&slid, &across, carried) - across;
        }
        row.force += step;
        row.push(&step, moved, mobility);
        let size = step.norm_squared() / row.stiffness;
        change.work += size;
        if size > largest * row.stiffness {
            (largest, change.worst) = (size / row.stiffness, number);
        }
    }
    change.largest = change.largest.max(largest.sqrt());
}

/// Puts all volumes back to first order, eq. (adhesion.6).
pub fn sweep_volumes(volumes: &[VolumeRow], gradient: &[Vec3], moved: &mut [Vec3], change: &mut Change) {
    for volume in volumes {
        let (gradient, moved) = (&gradient[volume.first..volume.end], &mut moved[volume.first..volume.end]);
        let along: f64 = gradient.iter().zip(&*moved).map(|(g, d)| g.dot(d)).sum();
        let back = -(volume.offset + along) * volume.inverse;
        moved.iter_mut().zip(gradient).for_each(|(d, g)| *d += back * g);
        // As far as all atoms move along a gradient that is the same for all.
        let squared = back * back / volume.inverse;
        change.largest = change.largest.max((squared / moved.len() as f64).sqrt());
        change.work += squared / volume.mobility;
    }
}

/// Pushes out what is inside, by no more than `most` (µm), and leaves no force behind: what curved ways let slip is
/// mended by place, not by force, eq. (adhesion.7). `push` is the force of each row that would do it, zero at first.
pub fn sweep_depths(rows: &[Row], push: &mut [f64], moved: &mut [Vec3], mobility: &[f64], most: f64) {
    for (row, push) in rows.iter().zip(push).filter(|(row, _)| row.stiffness > 0.0 && row.gap < 0.0) {
        let wanted = (row.gap + most).min(0.0);
        let missing = wanted - row.gap - row.apart(moved).dot(&row.normal);
        let pushed = (*push + missing * row.stiffness).max(0.0);
        row.push(&((pushed - *push) * row.normal), moved, mobility);
        *push = pushed;
    }
}

/// The conjugate directions that speed the sweeps up (Silcowitz-Hansen, Niebe and Erleben 2010): what a sweep changes
/// is taken for a gradient, and part of the last direction is added to it.
#[derive(Debug, Clone, Default)]
pub struct Momentum {
    /// Displacements and forces before the sweep.
    before: (Vec<Vec3>, Vec<Vec3>),
    /// The last direction.
    way: (Vec<Vec3>, Vec<Vec3>),
    /// The work of the last sweep.
    work: f64,
}

impl Momentum {
    /// Forgets the directions of the last projection.
    pub fn begin(&mut self, atoms: usize, rows: usize) {
        for (list, count) in [(&mut self.way.0, atoms), (&mut self.way.1, rows)] {
            list.clear();
            list.resize(count, Vec3::zeros());
        }
        self.work = 0.0;
    }

    /// Remembers where a sweep begins.
    pub fn before(&mut self, moved: &[Vec3], rows: &[Row]) {
        self.before.0.clear();
        self.before.0.extend_from_slice(moved);
        self.before.1.clear();
        self.before.1.extend(rows.iter().map(|row| row.force));
    }

    /// The displacement of an atom before the sweep.
    pub fn displacement(&self, atom: u32) -> &Vec3 {
        &self.before.0[atom as usize]
    }

    /// Goes on along the last direction after a sweep that did this work.
    pub fn go_on(&mut self, work: f64, moved: &mut [Vec3], rows: &mut [Row]) {
        let share = if self.work > 0.0 { work / self.work } else { 0.0 };
        // A sweep that changed more than the one before: start again.
        let share = if share > 1.0 { 0.0 } else { share };
        self.work = work;
        let forces = rows.iter_mut().map(|row| &mut row.force);
        for (now, (before, way)) in moved.iter_mut().zip(self.before.0.iter().zip(&mut self.way.0)) {
            advance(now, before, way, share);
        }
        for (now, (before, way)) in forces.zip(self.before.1.iter().zip(&mut self.way.1)) {
            advance(now, before, way, share);
        }
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        for list in [&mut self.before.0, &mut self.before.1, &mut self.way.0, &mut self.way.1] {
            list.fill(Vec3::repeat(f64::NAN));
        }
        self.work = f64::NAN;
    }
}

#[inline(always)]
fn advance(now: &mut Vec3, before: &Vec3, way: &mut Vec3, share: f64) {
    let change = *now - before;
    let old = share * *way;
    *now += old;
    *way = old + change;
}
