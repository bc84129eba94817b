//! How far contacts that hold yield while their forces change, and that they never return more than they took.

use super::rows::{Pull, Row};
use super::scratch::ContactScratch;
use crate::Vec3;

/// A contact that holds yields by this share of what a free one would, at most, for each change of its force in the step,
/// eq. (adhesion.5). Where many contacts hold the same atoms their forces are not determined; this picks some, and at
/// rest, when forces do not change, nothing yields.
const COMPLIANCE: f64 = 0.2;

/// The parts of a force that hold: the pull along the normal, pN, 0 where it pushes, and the shear, pN.
fn holding(row: &Row, force: Vec3) -> (f64, Vec3) {
    let (along, normal) = (force.dot(&row.normal()), row.normal());
    (along.min(0.0), force - along * normal)
}

/// Twice what is in a contact that carries this and yields by all of its compliance, pN·µm.
fn all_stored(row: &Row, along: f64, across: Vec3) -> f64 {
    f64::from(row.compliance) * along * along + f64::from(row.across) * across.norm_squared()
}

/// Sets how much of a contact's change is held where it carries this, eq. (adhesion.5). Of a spring that became softer since it
/// was loaded, as a contact in longer steps is, more would come back than went in: not so `in_account`.
pub fn set_compliance(row: &mut Row, pull: &Pull, in_account: bool) {
    if row.friction > 0.0 {
        // What rubs gives way by that, and its forces are determined.
        row.kept = 1.0;
        return;
    }
    let (along, across) = holding(row, pull.carried());
    let full = COMPLIANCE * all_stored(row, along, across);
    let returned = 2.0 * f64::from(row.stored);
    let softness = if !in_account || full <= returned { COMPLIANCE } else { COMPLIANCE * returned / full };
    row.kept = (1.0 / (1.0 + softness)) as f32;
}

/// The energy that has gone into what a contact yielded and can come back, after a step, pN·µm: that of a spring at most.
pub fn stored_after(row: &Row, pull: &Pull) -> f32 {
    let ((along, across), (along_before, across_before)) = (holding(row, pull.force()), holding(row, pull.carried()));
    let softness = 1.0 / f64::from(row.kept) - 1.0;
    let work = f64::from(row.compliance) * along * (along - along_before)
        + f64::from(row.across) * across.dot(&(across - across_before));
    let most = 0.5 * COMPLIANCE * all_stored(row, along, across);
    (f64::from(row.stored) + softness * work).clamp(0.0, most) as f32
}

/// The sum of [`stored_after`] over all contacts, pN·µm.
pub fn energy_of_compliance(s: &ContactScratch) -> f64 {
    let stored = |at: usize| f64::from(stored_after(&s.rows[at], &s.pulls[at]));
    (0..s.rows.len()).map(|number| stored(s.row_of(number))).sum()
}

#[cfg(test)]
mod tests {
    use super::super::rows::Pairing;
    use super::*;
    use crate::random::{Purpose, Stream};

    /// A contact along z of this compliance, µm/pN, with what is in it, pN·µm.
    fn row(compliance: f64, stored: f32) -> Row {
        let (atoms, coordinates) = ([0, 1, 2, 3], [0.3, 0.4]);
        let normal_and_gap = [0.0, 0.0, 1.0, 0.05];
        let (least, shear) = (-10.0, 10.0);
        let pairing = Pairing::AtomOnFacet;
        Row {
            atoms,
            coordinates,
            normal_and_gap,
            least,
            shear,
            friction: 0.0,
            compliance: compliance as f32,
            across: compliance as f32,
            kept: 1.0,
            stored,
            pairing,
        }
    }

    fn pull(carried: Vec3, force: Vec3) -> Pull {
        let short = |v: Vec3| [v.x as f32, v.y as f32, v.z as f32];
        Pull { force: short(force), carried: short(carried), ..Pull::default() }
    }

    #[test]
    fn no_course_of_forces_and_steps_brings_back_more_than_went_in() {
        for seed in 0..50 {
            let mut dice = Stream::new(seed, Purpose::Placement, 0, 0);
            let (mut force, mut stored, mut taken) = (Vec3::zeros(), 0.0, 0.0);
            for _ in 0..400 {
                let [a, b] = dice.uniform_pair();
                let [c, d] = dice.uniform_pair();
                // Steps differ by a factor of a hundred, and with them how much a contact gives.
                let mut row = row(0.001 * 100f64.powf(d), stored);
                let next = 0.9 * force + Vec3::new(a - 0.5, b - 0.5, c - 0.6);
                let step = pull(force, next);
                set_compliance(&mut row, &step, true);
                let compliance = f64::from(row.compliance) * (1.0 / f64::from(row.kept) - 1.0);
                let ((along, across), (along_before, across_before)) =
                    (holding(&row, step.force()), holding(&row, step.carried()));
                taken += compliance * (along * (along - along_before) + across.dot(&(across - across_before)));
                stored = stored_after(&row, &step);
                assert!(
                    stored >= 0.0 && f64::from(stored) <= taken * (1.0 + 1e-5) + 1e-9,
                    "{seed}: {stored} of {taken}"
                );
                force = next;
            }
        }
    }

    #[test]
    fn in_even_steps_a_contact_is_a_spring_and_a_push_gives_nothing() {
        let (force, compliance) = (Vec3::new(0.6, 0.0, -0.8), 0.01);
        let loaded = pull(Vec3::zeros(), force);
        let mut first = row(compliance, 0.0);
        set_compliance(&mut first, &loaded, true);
        let stored = stored_after(&first, &loaded);
        assert!((f64::from(stored) - 0.5 * COMPLIANCE * compliance).abs() < 1e-9, "that of a spring: {stored}");
        let mut second = row(compliance, stored);
        set_compliance(&mut second, &pull(force, force), true);
        assert!((second.kept - first.kept).abs() < 1e-7, "as soft as before");
        // In longer steps a contact may give no more than it did in short ones, while it holds what it held.
        let mut longer = row(16.0 * compliance, stored);
        set_compliance(&mut longer, &pull(force, force), true);
        assert!((1.0 / longer.kept - 1.0 - COMPLIANCE as f32 / 16.0).abs() < 1e-6);
        set_compliance(&mut longer, &pull(force, force), false);
        assert_eq!(longer.kept, first.kept, "cells that are driven are not held to account");
        assert_eq!(stored_after(&first, &pull(Vec3::zeros(), Vec3::z())), 0.0);
    }
}
