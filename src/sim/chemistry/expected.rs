//! What numbers that links carry must be.

use super::links::{AtomControl, Control, Target};
use crate::cell::ends::PodSetting;
use crate::mechanics::CONTROLLED;

/// What a target expects, if it cannot be set to a number.
pub fn missed(target: Target, value: f64) -> Option<&'static str> {
    if !value.is_finite() {
        return Some("a finite number");
    }
    match target {
        Target::Cell(_, Control::MotilitySpeed | Control::Stiffness | Control::Adhesion) if value < 0.0 => {
            Some("a number not below 0")
        }
        Target::Cell(_, Control::Atoms(what)) if value < 0.0 && !matches!(what, AtomControl::Secretion(_)) => {
            Some("a number not below 0")
        }
        Target::Cell(_, Control::Pseudopods(PodSetting::Protrusion | PodSetting::Retraction))
            if !(0.0..=1.0).contains(&value) =>
        {
            Some("a number from 0 to 1")
        }
        Target::Cell(_, Control::Force(handle, _)) if !CONTROLLED[handle].allows(value) => {
            Some(CONTROLLED[handle].expected)
        }
        Target::Cell(_, Control::RestVolume | Control::RestVolumeRatio) if value <= 0.0 => Some("a number above 0"),
        _ => None,
    }
}
