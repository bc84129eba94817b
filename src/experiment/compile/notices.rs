//! What is worth a word before a run though nothing is wrong: sizes that no cell has, cells that nothing keeps apart.

use super::super::{CellType, Document, LengthUnit, Mesh};
use super::model::written_unit;
use super::size::{Size, bytes};
use super::{Prepared, Schedule, bonds};
use crate::Vec3;
use crate::cell::Behaviour;
use crate::geometry::{area, bounding_box};
use crate::mechanics::Force;
use crate::mechanics::integrator::Method;
use crate::mechanics::shape_modulus::energy_that_shape_bears;
use crate::mechanics::sum::stiffness;
use crate::sim::{Kind, Model};
use crate::units::{Dimension, Stress, pretty};

/// The widths of cells, µm: from the smallest bacterium to the largest egg of a frog and more.
const WIDTHS: std::ops::RangeInclusive<f64> = 0.1..=1e4;

/// The width of most cells, µm.
const USUAL: f64 = 10.0;

/// Units in which meshes come, with their µm.
const UNITS: [(&str, f64); 5] = [("nm", 1e-3), ("um", 1.0), ("mm", 1e3), ("cm", 1e4), ("m", 1e6)];

/// What shear modulus and ordering together must be of bending rigidity over squared radius for atoms to keep their order: with a tenth
/// of it skins that are drawn out or deflated shrink facets until the barrier holds them, with three tenths they do not.
const KEPT_IN_ORDER: f64 = 0.3;

/// What there is to say about an experiment before it runs, a sentence each; empty for most.
pub fn notices(document: &Document, prepared: &Prepared) -> Vec<String> {
    let Prepared { model, centres, .. } = prepared;
    let mut notices: Vec<String> = model.kinds.iter().filter_map(|kind| unusual_width(document, kind)).collect();
    notices.extend(prepared.told.iter().cloned());
    notices.extend(large_result(&prepared.size));
    notices.extend(document.what_is_left_out());
    notices.extend(late_frames(&prepared.schedule, model.until));
    notices.extend(frames_of_lines(&prepared.schedule, model));
    notices.extend(model.kinds.iter().filter_map(|kind| unordered_skin(document, kind)));
    notices.extend(model.kinds.iter().filter_map(|kind| pushes_off_nothing(document, kind)));
    if model.contact.is_some() {
        notices.extend(model.kinds.iter().filter_map(soft_walkers));
        notices.extend((0..model.kinds.len()).filter_map(|kind| spreading_shape(model, kind)));
        notices.extend(bonds::notices(document));
        let is_implicit = matches!(model.integrator.method, Method::Implicit { .. });
        let creeps = |kind: &&Kind| is_implicit && kind.tangent.is_none() && kind.has_soft_shear();
        notices.extend(model.kinds.iter().filter(creeps).map(creeping_shear));
    } else if may_meet(model, centres) {
        let words = "nothing keeps cells apart: without [contact] they pass through each other; \
                     add that table, which may be empty, if they are to touch";
        notices.push(words.to_owned());
    }
    notices
}

/// Bytes of a result that are worth a word: more than most disks have to spare.
const LARGE_RESULT: f64 = 1e11;

/// That the result will be large.
fn large_result(size: &Size) -> Option<String> {
    (size.result > LARGE_RESULT).then(|| {
        format!(
            "the result may take {}, {:.0} frames of {}: a longer `output.every` makes it smaller",
            bytes(size.result),
            size.frames,
            bytes(size.result / size.frames)
        )
    })
}

/// That there are no frames at times that are asked for.
fn late_frames(schedule: &Schedule, until: f64) -> Option<String> {
    let late: Vec<f64> = schedule.times.iter().copied().filter(|time| *time > until).collect();
    let (first, told) = (late.first()?, |time: f64| pretty(time, Dimension::TIME));
    let times = if late.len() > 1 { format!("{} of `output.times` are", late.len()) } else { told(*first) + " is" };
    Some(format!("no frame is recorded beyond {}, where the run ends: {times} later", told(until)))
}

/// Frames in the longest step from which on the time between them is more likely a unit that was mistaken than wanted.
const FRAMES_IN_A_STEP: f64 = 100.0;

/// That many frames lie within one step, and show little but the line between its ends.
fn frames_of_lines(schedule: &Schedule, model: &Model) -> Option<String> {
    let (every, longest) = (schedule.every?, model.integrator.size.longest());
    (FRAMES_IN_A_STEP * every < longest).then(|| {
        let told = |time: f64| pretty(time, Dimension::TIME);
        format!(
            "frames are {} apart, and a step may take {}: those within a step lie on lines between its ends. For more to be seen set \
             run.integrator.max_step; for a smaller file make `output.every` longer",
            told(every),
            told(longest)
        )
    })
}

/// That the pseudopods of a kind have nothing that resists sliding to push off from.
fn pushes_off_nothing(document: &Document, kind: &Kind) -> Option<String> {
    let experiment = &document.experiment;
    let others = experiment.cells.values().map(CellType::most).sum::<usize>() > 1;
    let grips = experiment.contact.as_ref().is_some_and(|contact| {
        // Where only an energy or a range is given, a strength follows from it, and surfaces resist sliding by that.
        let resists = |shear: Option<Stress>, strength: Option<Stress>, energy: bool| {
            shear.or(strength).map_or(energy, |it| it.value() > 0.0)
        };
        let mut pairs = contact.between.iter().filter(|pair| pair.types.contains(&kind.name));
        // Nothing sticks to a plane unless the table says so; cells stick to each other by what is said of all.
        pairs.any(|pair| pair.friction.is_some() || resists(pair.shear_strength, pair.strength, pair.energy.is_some()))
            || others
                && (contact.friction.is_some()
                    || resists(contact.shear_strength, contact.strength, contact.energy.is_some()))
    });
    (kind.has_pseudopods() && !grips).then(|| {
        let name = &kind.name;
        format!(
            "pseudopods of `{name}` push off nothing: a cell pushes forward what it grips backward, and stays where it is \
             without a grip; add [[contact.between]] with `types = [\"{name}\", …]`, a plane or another type, and a `shear_strength`"
        )
    })
}

/// Which unit the coordinates of a mesh file may be in that is so wide, µm, where they are taken in another one.
pub(super) fn unit_advice(unit: LengthUnit, width: f64) -> String {
    let written = width / unit.micrometres();
    let away = |size: f64| (written * size / USUAL).ln().abs();
    let fits = UNITS.into_iter().filter(|(_, size)| WIDTHS.contains(&(written * size)));
    match fits.min_by(|one, other| away(one.1).total_cmp(&away(other.1))) {
        Some((unit, _)) => format!("write `unit = \"{unit}\"` beside the path if its coordinates are in that"),
        None => "give the `unit` of its coordinates beside the path".to_owned(),
    }
}

/// That cells of a kind are not of the size of cells: mostly a unit that was meant and not written.
fn unusual_width(document: &Document, kind: &Kind) -> Option<String> {
    let (low, high) = bounding_box(&kind.rest.positions)?;
    let width = (high - low).max();
    // A gel or a block of tissue may be as large as it likes.
    if WIDTHS.contains(&width) || !kind.tetrahedra.is_empty() {
        return None;
    }
    let advice = match &document.experiment.cells.get(&kind.name)?.mesh {
        Mesh::File { path, unit, .. } => {
            unit_advice(written_unit(document, &format!("cells.{}.mesh", kind.name), path, *unit), width)
        }
        _ => "check the sizes of its mesh and their units".to_owned(),
    };
    let told = |length: f64| pretty(length, Dimension::LENGTH);
    let (least, most) = (told(*WIDTHS.start()), told(*WIDTHS.end()));
    Some(format!(
        "cells of type `{}` are {} wide, where cells are between {least} and {most}: {advice}",
        kind.name,
        told(width)
    ))
}

/// That nothing keeps the atoms of a skin with bending where they are on it: bending at atoms resists across the surface alone.
fn unordered_skin(document: &Document, kind: &Kind) -> Option<String> {
    let membrane = document.experiment.cells.get(&kind.name)?.mechanics.membrane.as_ref()?;
    let remembers = |force: &Force| matches!(force, Force::ShapeMemory(_) | Force::Angles(_) | Force::Springs(_));
    if !kind.closed || kind.forces.iter().any(remembers) {
        return None;
    }
    let bending = membrane.bending.value();
    let scale = 4.0 * std::f64::consts::PI * bending / area(&kind.rest);
    let along = membrane.shear.value() + membrane.ordering.value();
    if along >= KEPT_IN_ORDER * scale {
        return None;
    }
    let told = |stiffness: f64| pretty(stiffness, Dimension::LINE_STIFFNESS);
    Some(format!(
        "nothing keeps the atoms of type `{0}` in their order on its surface: its bending ({1}) resists across the surface alone, and `shear` \
         and `ordering` of its membrane are {2} together, where bending over the squared radius is {3}. Where the cell deforms its facets \
         shrink and energies are no longer right: give the membrane an `ordering` of {3} or more, which leaves its shape alone, or a `shear`",
        kind.name,
        pretty(bending, Dimension::ENERGY),
        told(along),
        told(scale),
    ))
}

/// How far an atom may give way under the push of a walker, in edges: cells of 2 pN/µm that push with 6.7 pN in an aggregate give way by 0.9
/// edges, and a facet of one in 25 turned over within 1 000 s; with twice the stiffness none did.
const MOST_DENT: f64 = 0.6;

/// That cells of a kind push harder than they can bear: held by others, they fold.
fn soft_walkers(kind: &Kind) -> Option<String> {
    let speed: f64 = kind.behaviours.iter().filter_map(Behaviour::speed).sum();
    let matrix = stiffness(&kind.forces, &kind.rest.positions, &kind.rest.positions);
    let resists = (0..kind.atoms()).map(|atom| matrix.diagonal(atom)).fold(0.0, f64::max);
    let push = kind.drag * kind.atoms() as f64 * speed;
    if push <= MOST_DENT * resists * kind.edge {
        return None;
    }
    Some(format!(
        "cells of type `{}` wander with a push of {} (drag times speed), and an atom of theirs gives way by an edge under {}: where others hold \
         them, facets may fold over each other, and steps become short. Make them at least {:.1} times as stiff, or slower",
        kind.name,
        pretty(push, Dimension::FORCE),
        pretty(resists * kind.edge, Dimension::FORCE),
        push / (MOST_DENT * resists * kind.edge)
    ))
}

/// The work of separation over what a shape bears from which on packed cells fold by more than 100°, see the table at eq. (shape.7).
const FOLDS: f64 = 0.2;

/// That cells of a kind gain so much where they stick that they fold, or more than their shape costs: then they spread over each other.
fn spreading_shape(model: &Model, number: usize) -> Option<String> {
    let kind = &model.kinds[number];
    let table = model.contact.as_ref()?.law.cohesion()?;
    let kinds = model.kinds.len();
    let of_pair = &table.between[number * kinds..(number + 1) * kinds];
    let work = of_pair.iter().filter(|pair| pair.strength > 0.0).map(|pair| pair.work).fold(0.0, f64::max);
    // What is held everywhere spreads nowhere.
    let is_held = !kind.held.is_empty() && kind.held.iter().all(|factor| *factor == 0.0);
    if !kind.closed || work == 0.0 || is_held {
        return None;
    }
    // Each of the two surfaces that stick has half of the work.
    let bears = 2.0 * energy_that_shape_bears(&kind.forces, &kind.rest);
    // A surface under tension does not fold: it meets others at the angle of Young and Dupré as long as it bears the work.
    let is_tense = kind.forces.iter().any(|force| matches!(force, Force::Tension(_)));
    let least = if is_tense { bears } else { FOLDS * bears };
    (work > least).then(|| {
        let then = if work > bears { "they spread over each other until others hold them, and fold" } else { "they may fold where they are packed" };
        format!(
            "cells of type `{}` take {} to part an area of contact, and their shape bears {}: where they stick {then}. Make them {:.1} times as stiff, \
             or give them less `energy`, a shorter `range` or less `strength`",
            kind.name,
            pretty(work, Dimension::LINE_STIFFNESS),
            pretty(bears, Dimension::LINE_STIFFNESS),
            work / least
        )
    })
}

/// That cells of a kind creep: where contacts move each atom by its drag alone nothing tells the implicit step how little they resist shear.
fn creeping_shear(kind: &Kind) -> String {
    format!(
        "the membrane of type `{}` resists dilation so much more than shear that under this `model` of [contact] its cells come to rest too slowly at \
         the usual tolerance, and nothing in the run tells: take the model \"cohesion\", compare with `tolerance = 1e-5` in run.integrator, or \
         give it a lower `area`",
        kind.name
    )
}

/// Whether two cells may come to the same position; false only where that is plain to see.
fn may_meet(model: &Model, centres: &[Vec<Vec3>]) -> bool {
    let cells: usize = centres.iter().map(Vec::len).sum();
    if cells < 2 {
        return false;
    }
    let reaches: Option<Vec<f64>> = model.kinds.iter().map(|kind| reach(model, kind)).collect();
    let Some(reaches) = reaches else { return true };
    let mut boxes: Vec<[Vec3; 2]> = Vec::with_capacity(cells);
    for ((kind, centres), reach) in model.kinds.iter().zip(centres).zip(reaches) {
        let Some((low, high)) = bounding_box(&kind.rest.positions) else { continue };
        let (low, high) = (low.add_scalar(-reach), high.add_scalar(reach));
        boxes.extend(centres.iter().map(|centre| [centre + low, centre + high]));
    }
    any_two_meet(&mut boxes)
}

/// How far cells of a kind may come in the run, µm; none where forces move them or change their size.
fn reach(model: &Model, kind: &Kind) -> Option<f64> {
    let steady = kind.volume.course().is_none_or(|course| course.kinks().next().is_none());
    let driven = kind.is_biased() || !kind.forces.iter().all(Force::is_elastic);
    let still = steady && !driven && model.chemistry.is_empty();
    let speed: f64 = kind.behaviours.iter().filter_map(Behaviour::speed).sum();
    still.then_some(speed * model.until)
}

/// Whether two boxes share a point: those whose ranges along x meet are compared.
fn any_two_meet(boxes: &mut [[Vec3; 2]]) -> bool {
    boxes.sort_unstable_by(|one, other| one[0].x.total_cmp(&other[0].x));
    boxes.iter().enumerate().any(|(number, [low, high])| {
        let near = boxes[number + 1..].iter().take_while(|[other, _]| other.x <= high.x);
        near.into_iter().any(|[from, to]| (1..3).all(|axis| from[axis] <= high[axis] && low[axis] <= to[axis]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiment::prepare;
    use std::path::Path;

    fn said(cells: &str) -> Vec<String> {
        let text = format!("title = \"Notices\"\n[run]\nuntil = \"10 s\"\n{cells}");
        let document = Document::parse("notices.toml", &text, Path::new("."), &[]).expect("a good document");
        notices(&document, &prepare(&document).expect("a good experiment"))
    }

    fn balls(radius: &str, more: &str) -> String {
        format!(
            "[cells.ball]\nmesh = {{ shape = \"icosphere\", radius = \"{radius}\", level = 1 }}\n\
             mechanics = {{ drag = \"20 pN s/um\", shape_memory = {{ stiffness = \"1 pN/um\" }} }}\n{more}"
        )
    }

    const PAIR: &str = "placement = { at = [[0, 0, 0], [\"20 um\", 0, 0]] }\nnumber = 2\n";

    #[test]
    fn cells_that_may_pass_through_each_other_are_told_once() {
        let pass = |more: &str| said(&balls("5 um", more)).len();
        let pulled = "motility = { attraction = { to = [0, 0, 0], stiffness = \"1 pN/um\" } }\n";
        assert_eq!(pass(&format!("{PAIR}{pulled}")), 1, "drawn together");
        assert_eq!(pass(&format!("{PAIR}{pulled}[contact]\n")), 0, "contacts hold them apart");
        assert_eq!(pass(pulled), 0, "one cell alone");
        assert_eq!(pass(PAIR), 0, "nothing moves them");
        let walks =
            |speed: &str| format!("motility = {{ brownian = {{ speed = \"{speed}\", persistence = \"1 s\" }} }}\n");
        assert_eq!(pass(&format!("{PAIR}{}", walks("0.4 um/s"))), 0, "10 um lie between them, and each goes 4");
        assert_eq!(pass(&format!("{PAIR}{}", walks("0.6 um/s"))), 1, "each may go 6");
        let close = PAIR.replace("20 um", "9 um");
        assert_eq!(pass(&close), 1, "they overlap from the start");
    }

    #[test]
    fn walkers_that_push_harder_than_they_bear_are_told() {
        let said_of = |stiffness: &str, contact: &str| {
            let walk =
                "motility = { brownian = { speed = \"20 um/min\", persistence = \"20 s\", space = \"volume\" } }\n";
            said(&balls("5 um", &format!("{walk}{contact}")).replace("1 pN/um", stiffness))
        };
        assert_eq!(said_of("4 pN/um", "[contact]\n").len(), 0);
        assert_eq!(said_of("0.1 pN/um", "").len(), 0, "nothing holds a cell alone");
        let [notice] = &said_of("2 pN/um", "[contact]\n")[..] else { panic!("one notice") };
        assert!(notice.starts_with("cells of type `ball` wander with a push of 6.667 pN"), "{notice}");
    }

    #[test]
    fn membranes_whose_shear_creeps_in_contact_are_told() {
        const PENALTY: &str = "[contact]\nmodel = \"penalty\"\npenalty = \"100 pN/um\"\n";
        let skin = |area: &str, contact: &str| {
            said(&format!(
                "[cells.ball]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nmechanics = {{ drag = \"20 pN s/um\", \
                 membrane = {{ law = \"skalak\", shear = \"3 pN/um\", area = \"{area}\" }} }}\n{contact}"
            ))
            .len()
        };
        assert_eq!(
            [
                skin("500 pN/um", ""),
                skin("500 pN/um", "[contact]\n"),
                skin("500 pN/um", PENALTY),
                skin("6 pN/um", PENALTY)
            ],
            [0, 0, 1, 0]
        );
    }

    #[test]
    fn a_cell_of_no_size_that_cells_have_is_told() {
        for (radius, times) in [("5 um", 0), ("60 nm", 0), ("40 nm", 1), ("4 mm", 0), ("6 mm", 1)] {
            assert_eq!(said(&balls(radius, "")).len(), times, "{radius}");
        }
    }
    #[test]
    fn a_skin_whose_atoms_nothing_keeps_in_order_is_told() {
        // κ/R² is 0.008 pN/µm.
        let skin = |more: &str| {
            format!(
                "[cells.ball]\nmesh = {{ shape = \"icosphere\", radius = \"5 um\", level = 1 }}\nmechanics = {{ drag = \"20 pN s/um\", \
                 membrane = {{ law = \"neo_hookean\", area = \"0 pN/um\", bending = \"0.2 pN um\", {more} }} }}\n"
            )
        };
        let (none, some) = ("shear = \"0 pN/um\"", "shear = \"0.005 pN/um\"");
        for (more, times) in [(none, 1), (some, 0), (&format!("{none}, ordering = \"0.005 pN/um\""), 0)] {
            assert_eq!(said(&skin(more)).len(), times, "{more}");
        }
    }
}
