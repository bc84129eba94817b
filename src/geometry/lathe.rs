//! Surfaces of revolution: pipettes, rings, tips, cones and cylinders.

use super::profile::{Profile, ProfileFault, check, divide, round};
use super::{LEAST_FACET_QUALITY, Surface, facet_qualities, volume};
use crate::Vec3;
use crate::elementary::turn;
use std::f64::consts::PI;

/// The fewest atoms of a ring around the axis.
const FEWEST: u32 = 6;

/// Turns a profile about the z axis. Rings of atoms are as far from each other as atoms of the widest one are, and have fewer atoms where they
/// are narrower, so that facets are nearly regular. Atoms are numbered ring by ring along the profile.
///
/// # Errors
/// A profile that crosses itself, or of which no closed surface can be made.
///
/// # Panics
/// When fewer than 6 atoms are wanted around.
pub fn lathe(profile: Profile) -> Result<Surface, ProfileFault> {
    let Profile { corners, rounding, around } = profile;
    assert!(around >= FEWEST, "a surface of revolution needs at least {FEWEST} atoms around");
    let is_ring = check(corners)?;
    let rounded = round(corners, is_ring, rounding)?;
    let widest = rounded.iter().map(|point| point[0]).fold(0.0, f64::max);
    let points = divide(&rounded, is_ring, 2.0 * PI * widest / f64::from(around));
    let mut surface = Surface::default();
    let rings: Vec<Ring> = points
        .iter()
        .enumerate()
        .map(|(number, &point)| Ring::new(point, number, widest, around, &mut surface.positions))
        .collect();
    for (ring, next) in rings.iter().zip(&rings[1..]) {
        ring.join(next, &mut surface.facets);
    }
    if is_ring {
        rings[rings.len() - 1].join(&rings[0], &mut surface.facets);
    }
    if volume(&surface) < 0.0 {
        surface.facets.iter_mut().for_each(|facet| facet.swap(1, 2));
    }
    match sliver(&surface) {
        None => Ok(surface),
        Some(at) => {
            let from = |corner: &[f64; 2]| (corner[0] - at[0]).hypot(corner[1] - at[1]);
            let near = (0..corners.len()).min_by(|a, b| from(&corners[*a]).total_cmp(&from(&corners[*b])));
            Err(ProfileFault::Slivers(near.unwrap_or_default()))
        }
    }
}

/// Where the worst facet is a sliver, its distance from the axis and its height.
fn sliver(surface: &Surface) -> Option<[f64; 2]> {
    let qualities = facet_qualities(surface).into_iter().enumerate();
    let (worst, quality) = qualities.min_by(|one, other| one.1.total_cmp(&other.1))?;
    let first = surface.corners(surface.facets[worst])[0];
    (quality < LEAST_FACET_QUALITY || quality.is_nan()).then(|| [first.x.hypot(first.y), first.z])
}

/// Atoms around the axis at a height.
struct Ring {
    first: u32,
    atoms: u32,
    /// The angle of the first over that between two.
    begin: f64,
}

impl Ring {
    /// Puts atoms around the axis; every other ring is turned by half the angle between two.
    fn new([r, z]: [f64; 2], number: usize, widest: f64, around: u32, positions: &mut Vec<Vec3>) -> Self {
        let wanted = (f64::from(around) * r / widest).round() as u32;
        let atoms = if r == 0.0 { 1 } else { wanted.max(FEWEST) };
        let ring =
            Self { first: positions.len() as u32, atoms, begin: if number.is_multiple_of(2) { 0.0 } else { 0.5 } };
        positions.extend((0..atoms).map(|atom| {
            let [cos, sin] = turn(ring.turns(atom));
            Vec3::new(r * cos, r * sin, z)
        }));
        ring
    }

    /// Where an atom is, in whole turns; those behind the last go on.
    fn turns(&self, atom: u32) -> f64 {
        (f64::from(atom) + self.begin) / f64::from(self.atoms)
    }

    fn atom(&self, number: u32) -> u32 {
        self.first + number % self.atoms
    }

    /// Facets to the next ring: wherever an atom of one of both comes next around.
    fn join(&self, next: &Self, facets: &mut Vec<[u32; 3]>) {
        let (mut here, mut there) = (0, 0);
        let sides = |ring: &Self| if ring.atoms == 1 { 0 } else { ring.atoms };
        while here < sides(self) || there < sides(next) {
            let goes_here = there == sides(next)
                || (here < sides(self)
                    && self.turns(here + 1) + self.turns(here) <= next.turns(there + 1) + next.turns(there));
            let [a, b] = [self.atom(here), next.atom(there)];
            if goes_here {
                here += 1;
                facets.push([a, self.atom(here), b]);
            } else {
                there += 1;
                facets.push([a, next.atom(there), b]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{SurfaceRules, Topology, area, check_surface, facet_qualities};

    const PIPETTE: [[f64; 2]; 4] = [[2.0, 0.0], [3.0, 0.0], [3.0, 9.0], [2.0, 9.0]];

    fn made(corners: &[[f64; 2]], rounding: f64, around: u32) -> Surface {
        lathe(Profile { corners, rounding, around }).unwrap_or_else(|fault| panic!("{fault:?}"))
    }

    fn fault(corners: &[[f64; 2]], rounding: f64) -> ProfileFault {
        lathe(Profile { corners, rounding, around: 12 }).expect_err("no surface")
    }

    #[test]
    fn a_ring_has_a_hole_and_the_volume_and_area_of_what_it_stands_for() {
        let errors = [16, 32, 64, 128].map(|around| {
            let ring = made(&PIPETTE, 0.0, around);
            assert_eq!(Topology::of(&ring).euler_characteristic(), 0);
            assert!(check_surface(&ring, &SurfaceRules::CELL).is_ok(), "{around}");
            (volume(&ring) - 45.0 * PI, area(&ring) - 100.0 * PI)
        });
        for (coarse, fine) in errors.iter().zip(&errors[1..]) {
            assert!((3.5..4.5).contains(&(coarse.1 / fine.1)), "second order: {errors:?}");
        }
        // What the outer wall lacks of its volume the hole lacks, too.
        assert!(errors[0].0.abs() < 0.5 && errors[2].0.abs() < 0.02, "{errors:?}");
    }

    #[test]
    fn a_profile_between_two_points_of_the_axis_makes_a_body_without_a_hole() {
        let cone = made(&[[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]], 0.0, 96);
        assert_eq!(Topology::of(&cone).euler_characteristic(), 2);
        assert!((volume(&cone) / (12.0 * PI) - 1.0).abs() < 2e-3, "{}", volume(&cone));
        assert!((area(&cone) / (24.0 * PI) - 1.0).abs() < 2e-3, "{}", area(&cone));
        let [upwards, downwards] =
            [[[0.0, 0.0], [2.0, 0.0], [2.0, 5.0], [0.0, 5.0]], [[0.0, 5.0], [2.0, 5.0], [2.0, 0.0], [0.0, 0.0]]]
                .map(|corners| volume(&made(&corners, 0.0, 48)));
        assert!(
            (upwards - downwards).abs() < 1e-9 && (upwards / (20.0 * PI) - 1.0).abs() < 5e-3,
            "{upwards} {downwards}"
        );
    }

    #[test]
    fn facets_are_nearly_regular_wherever_they_are() {
        for (corners, rounding) in [(&PIPETTE[..], 0.5), (&[[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]], 0.0)] {
            let surface = made(corners, rounding, 32);
            let worst = facet_qualities(&surface).into_iter().fold(1.0, f64::min);
            assert!(worst > 0.5, "{worst}");
        }
    }

    #[test]
    fn corners_are_rounded_by_arcs_that_touch_both_sides() {
        let rounded = made(&PIPETTE, 0.5, 64);
        let lowest = rounded.positions.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
        assert!(lowest.abs() < 1e-12, "{lowest}");
        for x in rounded.positions.iter().filter(|x| x.z < 0.5) {
            let off = (x.x.hypot(x.y) - 2.5).hypot(x.z - 0.5) - 0.5;
            assert!(off.abs() < 1e-9, "{x:?}: {off}");
        }
        // The arcs of both lips, each half a circle that turns about the axis, are a torus in place of a part of the tube.
        let exact = 2.0 * PI * 2.5 * (8.0 + PI * 0.25);
        assert!((volume(&rounded) / exact - 1.0).abs() < 1e-2, "{} {exact}", volume(&rounded));
        // A corner that looks in is filled.
        let notched = made(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0]], 0.5, 64);
        assert!(notched.positions.iter().all(|x| (x.x.hypot(x.y) - 2.0).hypot(x.z - 2.0) > 0.2));
    }

    #[test]
    fn a_corner_on_a_straight_side_changes_nothing() {
        let plain = made(&PIPETTE, 0.4, 32);
        let [a, b, c, d] = PIPETTE;
        let with_more = made(&[a, b, [3.0, 4.5], c, d], 0.4, 32);
        assert!((volume(&plain) - volume(&with_more)).abs() < 0.01 && (area(&plain) - area(&with_more)).abs() < 0.05);
        let widest = with_more.positions.iter().map(|x| x.x.hypot(x.y)).fold(0.0, f64::max);
        assert!((widest - 3.0).abs() < 1e-12, "{widest}");
    }

    #[test]
    fn what_makes_no_surface_is_told() {
        use ProfileFault::*;
        assert_eq!(fault(&[[1.0, 0.0], [2.0, 0.0]], 0.0), TooFew);
        assert_eq!(fault(&[[1.0, 0.0], [2.0, 0.0], [-1.0, 3.0]], 0.0), Beyond(2));
        assert_eq!(fault(&[[1.0, 0.0], [0.0, 1.0], [1.0, 3.0]], 0.0), OnAxis(1));
        assert_eq!(fault(&[[0.0, 0.0], [1.0, 1.0], [1.0, 3.0]], 0.0), OnAxis(2));
        assert_eq!(fault(&[[1.0, 0.0], [1.0, 0.0], [1.0, 3.0]], 0.0), Twice(1));
        assert_eq!(fault(&[[1.0, 0.0], [2.0, 0.0], [1.0, 3.0], [2.0, 3.0]], 0.0), Crosses(1, 3));
        assert_eq!(fault(&[[1.0, 0.0], [3.0, 0.0], [2.0, 0.0], [2.0, 3.0]], 0.0), Crosses(0, 1));
        assert_eq!(fault(&[[1.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 0.0]], 0.0), Crosses(0, 2));
        let Rounding(_, most) = fault(&PIPETTE, 0.6) else { panic!("too round") };
        assert!((most - 0.5).abs() < 1e-12, "{most}");
        assert_eq!(fault(&[[0.0, 0.0], [1e-7, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]], 0.0), Slivers(1));
    }
}
