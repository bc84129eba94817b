//! Surfaces of revolution, and what is said of profiles that make none.

use super::super::Document;
use super::far::WIDTHS;
use crate::error::{Fault, short};
use crate::geometry::{Profile, ProfileFault, Surface, lathe};
use crate::units::{Dimension, Length, pretty};

/// The surface of a profile, or nothing and a fault; `key` is that of the mesh.
pub fn surface(
    document: &Document,
    key: &str,
    (profile, rounding, around): (&[[Length; 2]], Length, u32),
    faults: &mut Vec<Fault>,
) -> Option<Surface> {
    let (corners, rounding) = (corners_of(document, key, profile, faults)?, rounding.value());
    let found = lathe(Profile { corners: &corners, rounding, around });
    found.map_err(|why| faults.push(profile_fault(document, key, (&corners, rounding), why))).ok()
}

/// The corners of a profile, µm, or nothing and a fault where it is as large or small as nothing that is meant; `key` is what has it.
pub fn corners_of(
    document: &Document,
    key: &str,
    profile: &[[Length; 2]],
    faults: &mut Vec<Fault>,
) -> Option<Vec<[f64; 2]>> {
    let corners: Vec<[f64; 2]> = profile.iter().map(|corner| corner.map(|length| length.value())).collect();
    let low = |axis: usize| corners.iter().map(|corner| corner[axis]).fold(f64::INFINITY, f64::min);
    let high = |axis: usize| corners.iter().map(|corner| corner[axis]).fold(f64::NEG_INFINITY, f64::max);
    let width = (2.0 * high(0)).max(high(1) - low(1));
    if WIDTHS.contains(&width) {
        return Some(corners);
    }
    let told = |length: f64| pretty(length, Dimension::LENGTH);
    let [least, most] = [WIDTHS.start(), WIDTHS.end()].map(|width| told(*width));
    let message = format!("the profile of `{key}` is {} wide; {least} to {most} were expected", told(width));
    let location = document.location(&format!("{key}.profile"), "this profile");
    faults.push(location.into_iter().fold(Fault::new(message).help("check the units of its corners"), Fault::at));
    None
}

/// What is said of a profile that makes no body; `key` is what has it.
pub fn profile_fault(
    document: &Document,
    key: &str,
    (corners, rounding): (&[[f64; 2]], f64),
    why: ProfileFault,
) -> Fault {
    let fault = |at: &str, label: &str, message: String, help: &str| {
        let location = document.location(&format!("{key}.{at}"), label);
        location.into_iter().fold(Fault::new(message).help(help), Fault::at)
    };
    let at = |number: usize| format!("profile[{number}]");
    let side = |number: usize| format!("from corner {number} to corner {}", (number + 1) % corners.len());
    match why {
        ProfileFault::TooFew => fault(
            "profile",
            "too few corners",
            format!("`{key}.profile` has {} corners, of which no closed surface can be made", corners.len()),
            "give three corners or more; a body without a hole has its first and last on the axis, at a distance of 0",
        ),
        ProfileFault::Beyond(number) => fault(
            &at(number),
            "beyond the axis",
            format!("`{key}.profile[{number}]` is {} um from the axis", short(corners[number][0])),
            "give distances of 0 or more: the profile is turned about the axis all around",
        ),
        ProfileFault::OnAxis(number) if corners[number][0] == 0.0 => fault(
            &at(number),
            "on the axis",
            format!("`{key}.profile[{number}]` is on the axis, though it is no end of the profile"),
            "a body without a hole has its first and its last corner on the axis, and a ring none: move it, or divide the profile",
        ),
        ProfileFault::OnAxis(number) => fault(
            &at(number),
            "not on the axis",
            format!("one end of `{key}.profile` is on the axis, and `profile[{number}]`, the other, is not"),
            "put both ends on the axis, at a distance of 0, for a body without a hole, or none for a ring",
        ),
        ProfileFault::Twice(number) => fault(
            &at(number),
            "where the one before it is",
            format!("`{key}.profile[{number}]` is where the corner before it is"),
            "leave one of both out; a ring is closed from its last corner to its first without saying so",
        ),
        ProfileFault::Crosses(one, other) => fault(
            &at(other),
            "a side begins here that crosses another",
            format!("`{key}.profile` crosses itself: its side {} meets the one {}", side(other), side(one)),
            "give the corners in their order along the outline",
        ),
        ProfileFault::Slivers(number) => fault(
            &at(number),
            "facets are slivers here",
            format!("facets around `{key}.profile[{number}]` are slivers"),
            "leave out corners that are much nearer to each other than atoms around the axis are, or raise `around`",
        ),
        ProfileFault::Rounding(number, most) => fault(
            "rounding",
            "too large",
            format!(
                "`{key}.rounding` is {} um, and the sides beside `profile[{number}]` are long enough for {} um",
                short(rounding),
                short(most)
            ),
            "round less, or make these sides longer",
        ),
    }
}
