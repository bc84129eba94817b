use super::*;
use crate::cell::motility::Space;
use crate::cell::pseudopods::{Cycle, Several};
use crate::cell::turning::Turning;
use crate::geometry::icosphere;
use crate::sim::state::Inertia;

const PODS: Pseudopods = Pseudopods {
    pressure: 40.0,
    reach: f64::INFINITY,
    least_cosine: 0.7,
    contraction: 100.0,
    fibres: None,
    release: 0.8,
    cycle: Cycle { means: [1.0, 2.0, 3.0], variation: 0.5 },
    turning: Turning { split: 0.5, angle: 1.0, spread: 0.1, alternation: 0.7, space: Space::Plane },
    several: Several::ONE,
    abandon: None,
    inhibition: None,
};

/// A cell that is not round, and where its atoms are.
fn cell() -> (Kind, KindState) {
    let rest = icosphere(5.0, 2);
    let bent = |x: &Vec3| {
        Vec3::new(1.3 * x.x + 0.1 * x.y * x.y, 0.8 * x.y, x.z + 0.05 * x.x * x.y) + Vec3::new(30.0, -20.0, 10.0)
    };
    let positions: Vec<Vec3> = rest.positions.iter().map(bent).collect();
    let kind = Kind::new("cell", rest, Vec::new());
    let now = KindState::new(&kind, &[positions], 0, Inertia::OverDamped, 1);
    (kind, now)
}

/// Sum and torque about the origin of forces on the atoms, over the sum of their sizes and of those times the size of the cell.
fn sum_and_torque(positions: &Positions, forces: &[Vec3]) -> [f64; 2] {
    let centre = positions.centre();
    let size: f64 = forces.iter().map(|force| force.norm()).sum();
    let torque: Vec3 = positions.all().zip(forces).map(|(x, force)| (x - centre).cross(force)).sum();
    [forces.iter().sum::<Vec3>().norm() / size, torque.norm() / (10.0 * size)]
}

#[test]
fn a_cell_pushes_itself_with_neither_sum_nor_torque_wherever_it_grips() {
    let (kind, now) = cell();
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let low = positions.all().map(|x| x.z).fold(f64::INFINITY, f64::min);
    let grips = |is_held: &dyn Fn(usize, Vec3) -> bool| -> Vec<f64> {
        positions.all().enumerate().map(|(atom, x)| if is_held(atom, x) { 3.0 + atom as f64 } else { 0.0 }).collect()
    };
    for (grips, words) in [
        (grips(&|_, _| false), "nowhere"),
        (grips(&|_, x| x.z < low + 2.0), "below"),
        (grips(&|atom, _| atom == 17), "at one atom"),
        (grips(&|atom, _| [17, 90].contains(&atom)), "at two"),
    ] {
        for [protrusion, retraction] in [[1.0, 0.0], [0.0, 1.0], [0.3, 0.6]] {
            let mut forces = vec![Vec3::zeros(); kind.atoms()];
            // A second one at the same time, which is pushed and drawn otherwise.
            for (direction, number) in [([0.6, 0.8, 0.0], 1), ([-0.28, 0.96, 0.0], 2)] {
                let (one, other) = if number == 1 { (protrusion, retraction) } else { (retraction, protrusion) };
                let did = Activity { direction, protrusion: one, retraction: other, number };
                positions.push(&PODS, &did, &grips, &mut forces);
            }
            let [sum, torque] = sum_and_torque(&positions, &forces);
            // Round-off of some hundred terms; where one atom grips the terms that cancel are a hundred times as large, as little leaks to others.
            assert!(sum < 1e-12 && torque < 1e-12, "{words}, {protrusion} {retraction}: {sum} {torque}");
            assert!(forces.iter().any(|force| force.norm() > 1e-3), "{words}: something is pushed");
        }
    }
}

#[test]
fn what_grips_bears_what_is_pushed_in_proportion() {
    let (kind, now) = cell();
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let centre = positions.centre();
    let grips: Vec<f64> = positions.all().map(|x| if x.z < centre.z - 4.0 { 200.0 } else { 0.0 }).collect();
    let did = Activity { direction: [1.0, 0.0, 0.0], protrusion: 1.0, retraction: 0.0, number: 1 };
    let mut forces = vec![Vec3::zeros(); kind.atoms()];
    positions.push(&PODS, &did, &grips, &mut forces);
    let held: Vec3 = forces.iter().zip(&grips).filter(|(_, grip)| **grip > 0.0).map(|(force, _)| force).sum();
    let in_front = |atom: usize| positions.share(&PODS, atom, (&centre, &Vec3::x())) > 0.0;
    let pushed: Vec3 = (0..kind.atoms()).filter(|atom| in_front(*atom)).map(|atom| forces[atom]).sum();
    assert!(pushed.x > 100.0, "the front is pushed with {pushed}");
    // All but the hundredth that leaks to atoms that do not grip; these have the longest levers, and bear a part of the torque.
    let share = -held.x / pushed.x;
    assert!((0.9..=1.05).contains(&share), "{share}");
}

#[test]
fn what_grips_bears_no_more_than_it_can() {
    let (kind, now) = cell();
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let (centre, front) = (positions.centre(), Vec3::x());
    let did = Activity { direction: front.into(), protrusion: 1.0, retraction: 0.0, number: 1 };
    let is_behind = |atom: &usize| positions.share(&PODS, *atom, (&centre, &front)) == 0.0;
    let pushed = |grips: &[f64]| {
        let mut forces = vec![Vec3::zeros(); kind.atoms()];
        positions.push(&PODS, &did, grips, &mut forces);
        let [sum, torque] = sum_and_torque(&positions, &forces);
        assert!(sum < 1e-12 && torque < 1e-12, "{sum} {torque}");
        forces
    };
    let freely = pushed(&vec![0.0; kind.atoms()]);
    for grip in [0.1, 10.0] {
        let grips: Vec<f64> = positions.all().map(|x| if x.x < centre.x - 4.0 { grip } else { 0.0 }).collect();
        let held: f64 = grips.iter().sum();
        let push: f64 = (0..kind.atoms()).filter(|atom| !is_behind(atom)).map(|atom| freely[atom].x).sum();
        assert!(held < 0.5 * push, "the grips of {held} pN cannot bear {push} pN");
        let forces = pushed(&grips);
        // What an atom that grips bears more than one that does not; all others behind bear alike.
        let of = |grips_too: bool| {
            let such = (0..kind.atoms()).filter(is_behind).filter(|atom| (grips[*atom] > 0.0) == grips_too);
            let borne: Vec<f64> = such.map(|atom| -forces[atom].x).collect();
            borne.iter().sum::<f64>() / borne.len() as f64
        };
        // Levers of a mesh that is not quite the same on all sides change the mean of a few atoms by some hundredths.
        let more = of(true) - of(false);
        assert!((more - grip).abs() < 0.05 * grip + 0.05 * of(false), "{more} pN more at a grip of {grip} pN");
        assert!(of(false) > 0.5 * (push - held) / kind.atoms() as f64, "what slips is for all");
    }
}

#[test]
fn the_pressure_is_that_on_the_area_of_the_front() {
    let rest = icosphere(5.0, 3);
    let kind = Kind::new("cell", rest.clone(), Vec::new());
    let now = KindState::new(&kind, std::slice::from_ref(&rest.positions), 0, Inertia::OverDamped, 1);
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let (centre, direction) = (positions.centre(), Vec3::x());
    // The rear bears the reaction.
    let grips: Vec<f64> = rest.positions.iter().map(|x| if x.x < -3.0 { 100.0 } else { 0.0 }).collect();
    let mut forces = vec![Vec3::zeros(); kind.atoms()];
    let did = Activity { direction: direction.into(), protrusion: 1.0, retraction: 0.0, number: 1 };
    positions.push(&PODS, &did, &grips, &mut forces);
    // On a ball of 5 um with c the cosine to the axis: ∫ p (c − c₀)/(1 − c₀) c dA, dA = 2πR² dc.
    let c0 = PODS.least_cosine;
    let on_cone = ((1.0 - c0.powi(3)) / 3.0 - c0 * (1.0 - c0 * c0) / 2.0) / (1.0 - c0);
    let expected = std::f64::consts::TAU * 25.0 * PODS.pressure * on_cone;
    let in_front = |atom: &usize| positions.share(&PODS, *atom, (&centre, &direction)) > 0.0;
    let pushed: f64 = (0..kind.atoms()).filter(in_front).map(|atom| forces[atom].x).sum();
    // A hundredth of the reaction leaks, some to the border of the front; the mesh cuts (h/R)² = 2 % off at most.
    assert!((pushed / expected - 1.0).abs() < 0.03, "{pushed} for {expected}");
}

#[test]
fn the_rear_lets_go_and_the_front_holds() {
    let (kind, now) = cell();
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let mut factors = vec![1.0; kind.atoms()];
    positions.release(0.8, &Vec3::x(), &mut factors);
    let (centre, ahead) = (positions.centre(), |x: Vec3| x.x);
    let farthest = positions.all().map(|x| (x - centre).x.abs()).fold(0.0, f64::max);
    for (factor, x) in factors.iter().zip(positions.all()) {
        let along = ahead(x - centre) / farthest;
        let expected = 1.0 - 0.8 * (0.5 - along).clamp(0.0, 1.0);
        assert!((factor - expected).abs() < 1e-12, "{along}: {factor}");
        assert!(along < 0.5 || *factor == 1.0);
        assert!(along > -0.5 || (factor - 0.2).abs() < 1e-12);
    }
}

#[test]
fn pressures_at_atoms_have_neither_sum_nor_torque_and_push_out_what_they_press() {
    let (kind, now) = cell();
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let pressures: Vec<f64> = (0..kind.atoms()).map(|atom| ((atom * 7) % 5) as f64).collect();
    let grips: Vec<f64> = (0..kind.atoms()).map(|atom| ((atom * 3) % 4) as f64).collect();
    let mut forces = vec![Vec3::zeros(); kind.atoms()];
    positions.press(&pressures, &grips, &mut forces);
    let [sum, torque] = sum_and_torque(&positions, &forces);
    assert!(sum < 1e-12 && torque < 1e-12, "{sum} {torque}");
    // One pressure everywhere on a closed surface is balanced by itself: nothing is left to be borne, whatever grips.
    let nothing = vec![0.0; kind.atoms()];
    let mut areas = vec![Vec3::zeros(); kind.atoms()];
    for facet in &kind.rest.facets {
        let [a, b, c] = facet.map(|atom| positions.of(atom as usize));
        facet.iter().for_each(|atom| areas[*atom as usize] += (b - a).cross(&(c - a)) / 6.0);
    }
    for grips in [&grips, &nothing] {
        let mut even = vec![Vec3::zeros(); kind.atoms()];
        positions.press(&vec![2.0; kind.atoms()], grips, &mut even);
        for (force, area) in even.iter().zip(&areas) {
            assert!((force - 2.0 * area).norm() < 1e-12 * areas.len() as f64, "{force} instead of {}", 2.0 * area);
        }
    }
}

#[test]
fn tension_at_atoms_is_the_gradient_of_its_energy() {
    let (kind, now) = cell();
    let tensions: Vec<f64> = (0..kind.atoms()).map(|atom| 1.0 + ((atom * 5) % 7) as f64).collect();
    let energy = |now: &KindState| -> f64 {
        let positions = Positions { kind: &kind, now, cell: 0 };
        let of = |facet: &[u32; 3]| {
            let [a, b, c] = facet.map(|atom| positions.of(atom as usize));
            let tension = facet.iter().map(|atom| tensions[*atom as usize]).sum::<f64>() / 3.0;
            tension * 0.5 * (b - a).cross(&(c - a)).norm()
        };
        kind.rest.facets.iter().map(of).sum()
    };
    let positions = Positions { kind: &kind, now: &now, cell: 0 };
    let mut forces = vec![Vec3::zeros(); kind.atoms()];
    positions.tighten(&tensions, &mut forces);
    let [sum, torque] = sum_and_torque(&positions, &forces);
    assert!(sum < 1e-12 && torque < 1e-12, "{sum} {torque}");
    let step = 1e-5;
    for (atom, axis) in [(0, 0), (17, 1), (90, 2), (161, 0)] {
        let moved = |by: f64| {
            let mut now = now.clone();
            now.positions[crate::sim::state::index(&kind, 0, atom, axis)] += by;
            energy(&now)
        };
        let slope = (moved(step) - moved(-step)) / (2.0 * step);
        // Central differences err by the square of the step, and by round-off of the energy over it.
        assert!((forces[atom][axis] + slope).abs() < 1e-6, "{} and {}", forces[atom][axis], -slope);
    }
}

#[test]
fn a_front_pushes_less_the_farther_it_is_ahead() {
    let rest = icosphere(5.0, 3);
    let kind = Kind::new("cell", rest.clone(), Vec::new());
    let pods = Pseudopods { reach: 4.0, ..PODS };
    let pushed = |stretch: f64, pods: &Pseudopods| -> f64 {
        // Drawn out along x, with the same volume.
        let across = stretch.sqrt().recip();
        let drawn: Vec<Vec3> =
            rest.positions.iter().map(|x| Vec3::new(stretch * x.x, across * x.y, across * x.z)).collect();
        let now = KindState::new(&kind, std::slice::from_ref(&drawn), 0, Inertia::OverDamped, 1);
        let mut forces = vec![Vec3::zeros(); kind.atoms()];
        // Where nothing grips, what is in front bears the less the more it belongs to it: the axis nothing.
        let did = Activity { direction: [1.0, 0.0, 0.0], protrusion: 1.0, retraction: 0.0, number: 1 };
        Positions { kind: &kind, now: &now, cell: 0 }.push(pods, &did, &vec![0.0; kind.atoms()], &mut forces);
        forces.iter().map(|force| force.norm()).sum()
    };
    let of = |stretch: f64| pushed(stretch, &pods) / pushed(stretch, &PODS);
    assert_eq!(of(1.0), 1.0, "a ball is not yet ahead of itself");
    for stretch in [1.6, 2.2] {
        // The front's middle by the midpoint rule over the latitudes of the ball that was drawn out.
        let rings = (0..10_000).map(|ring| -1.0 + (f64::from(ring) + 0.5) / 5_000.0);
        let (whole, ahead) = rings.fold((0.0, 0.0), |(whole, ahead), sine| {
            let (x, across) = (5.0 * stretch * sine, 5.0 * ((1.0 - sine * sine) / stretch).sqrt());
            let share = ((x / x.hypot(across) - PODS.least_cosine) / (1.0 - PODS.least_cosine)).max(0.0);
            (whole + share, ahead + share * x)
        });
        let expected = 1.0 - (ahead / whole - 5.0) / pods.reach;
        assert!((of(stretch) - expected).abs() < 0.01, "{} for {expected}", of(stretch));
    }
    assert_eq!(of(3.2), 0.0);
}
