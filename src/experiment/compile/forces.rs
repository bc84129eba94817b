//! Builds the forces on a type of cells, in the order in which they are added up.

use super::super::{
    BendingRest, CellType, Document, Form, Law, LinkPattern, Linked, Membrane as MembraneText,
    Reaction as ReactionText, Rest, ShapeStrength, Spread,
};
use super::mesh::Built;
use super::select::{self, mirrored};
use super::{course, unit, vector};
use crate::Vec3;
use crate::error::Fault;
use crate::geometry::{self, Surface, Topology};
use crate::mechanics::Force;
use crate::mechanics::angles::Angles;
use crate::mechanics::attraction::Attraction;
use crate::mechanics::barrier::{Barrier, BarrierRules};
use crate::mechanics::bending::{Bending, RestAngle};
use crate::mechanics::fibres::Fibres;
use crate::mechanics::gravity::Gravity;
use crate::mechanics::load::Load;
use crate::mechanics::membrane::{Membrane, MembraneLaw};
use crate::mechanics::ordering::Ordering;
use crate::mechanics::shape_memory::{Reaction, ShapeMemory};
use crate::mechanics::shape_modulus::stiffness_of_modulus;
use crate::mechanics::springs::{Spring, Springs};
use crate::mechanics::sum;
use crate::mechanics::tension::Tension;

/// The energy scale of the barrier where the document names none: this part of the elastic energy that moves an atom
/// by an edge, so that the barrier is as stiff as the cell that it guards.
const BARRIER_SHARE: f64 = 0.1;

/// All forces on a type; the pairs of its links and fibres go to `drawn_links`, faults are what only the mesh can tell.
pub fn forces(
    document: &Document,
    key: &str,
    cell: &CellType,
    built: &Built,
    drawn_links: &mut Vec<[u32; 2]>,
    faults: &mut Vec<Fault>,
) -> Vec<Force> {
    let rest = &built.turned;
    let topology = Topology::of(rest);
    let mut forces = Vec::new();
    add_shape_memory(document, key, cell, rest, &topology, &mut forces, faults);
    if let Some(membrane) = &cell.mechanics.membrane {
        add_membrane(document, key, membrane, rest, &topology, &mut forces, faults);
    }
    if let Some(springs) = &cell.mechanics.springs {
        let springs = Springs::on_edges(&rest.positions, &topology.edges, springs.stiffness.value());
        forces.push(Force::Springs(springs));
    }
    drawn_links.extend(add_links(document, key, cell, built, &mut forces, faults));
    add_barrier(cell, rest, &topology, &mut forces);
    add_loads(document, key, cell, rest, &mut forces, faults);
    drawn_links.extend(add_fibres(document, key, cell, built, &mut forces, faults));
    let gravity = document.experiment.environment.gravity.map_or([0.0; 3], |g| g.map(|a| a.value()));
    if gravity != [0.0; 3] {
        forces.push(Force::Gravity(Gravity { acceleration: vector(gravity) }));
    }
    if let Some(attraction) = &cell.motility.attraction {
        let (to, stiffness) = (vector(attraction.to.map(|x| x.value())), attraction.stiffness.value());
        forces.push(Force::Attraction(Attraction { to, stiffness }));
    }
    forces
}

fn add_shape_memory(
    document: &Document,
    key: &str,
    cell: &CellType,
    rest: &Surface,
    topology: &Topology,
    forces: &mut Vec<Force>,
    faults: &mut Vec<Fault>,
) {
    let Some(memory) = &cell.mechanics.shape_memory else { return };
    let mut rings: Vec<Vec<u32>> = topology.rings.iter().map(|ring| ring.atoms.clone()).collect();
    let stiffness = match memory.strength {
        ShapeStrength::Stiffness(stiffness) => stiffness.value(),
        ShapeStrength::ShapeModulus(modulus) => match stiffness_of_modulus(rest, &rings, modulus.value()) {
            Some(stiffness) => stiffness,
            None => {
                let fault = Fault::new("a flat mesh has no shape modulus: its shape memory does not resist stretching")
                    .help("give shape_memory = { stiffness = \"…\" }, or use membrane or springs");
                let place = document.place(&format!("{key}.mechanics.shape_memory"), "on a flat mesh");
                faults.push(place.into_iter().fold(fault, Fault::at));
                return;
            }
        },
    };
    if let Some(only) = &memory.only {
        let chosen = select::atoms(document, &format!("{key}.mechanics.shape_memory.only"), only, rest, faults);
        // An atom without neighbours remembers nothing.
        (0..rings.len()).filter(|atom| !chosen.contains(&(*atom as u32))).for_each(|atom| rings[atom].clear());
    }
    let reaction = match memory.reaction {
        ReactionText::Exact => Reaction::Exact,
        ReactionText::Spread => Reaction::Spread,
    };
    match memory.form {
        Form::Triplets => {
            let triplets = ShapeMemory::new(&rest.positions, &rings, stiffness, reaction);
            if triplets.triplet_count() == 0 {
                let found = "no atom remembers anything: triplets take three neighbours that are not in line";
                let fault = Fault::new(found).help("use form = \"angles\", which takes two neighbours, or other atoms");
                let place = document.place(&format!("{key}.mechanics.shape_memory"), "acts on no atom of this mesh");
                faults.push(place.into_iter().fold(fault, Fault::at));
            }
            forces.push(Force::ShapeMemory(triplets));
        }
        Form::Angles => forces.push(Force::Angles(Angles::new(&rest.positions, &rings, stiffness))),
    }
}

fn add_membrane(
    document: &Document,
    key: &str,
    text: &MembraneText,
    rest: &Surface,
    topology: &Topology,
    forces: &mut Vec<Force>,
    faults: &mut Vec<Fault>,
) {
    let (shear, area) = (text.shear.value(), text.area.value());
    let law = match text.law {
        Law::Skalak => MembraneLaw::Skalak { shear, area },
        Law::NeoHookean => MembraneLaw::NeoHookean { shear, area, hardening: text.hardening },
    };
    if text.law == Law::Skalak && area < shear {
        let fault = Fault::new("Skalak's law needs an area modulus of at least the shear modulus")
            .help("raise `area`, or use law = \"neo_hookean\"");
        let place = document.place(&format!("{key}.mechanics.membrane.area"), "below the shear modulus");
        faults.push(place.into_iter().fold(fault, Fault::at));
    }
    if shear > 0.0 || area > 0.0 {
        forces.push(Force::Membrane(Membrane::new(&rest.positions, &rest.facets, law)));
    }
    if text.tension.value() != 0.0 || text.total_area.value() != 0.0 {
        let (tension, total) = (text.tension.value(), text.total_area.value());
        forces.push(Force::Tension(Tension::new(&rest.positions, &rest.facets, tension, total)));
    }
    if text.ordering.value() > 0.0 {
        if topology.is_closed() {
            let ordering = Ordering::new(rest.positions.len(), &rest.facets, text.ordering.value());
            forces.push(Force::Ordering(ordering));
        } else {
            let fault = Fault::new("a surface with a border cannot be ordered: its border would be drawn inwards")
                .help("take `ordering` out, or give the membrane a small `shear` and `area`");
            let place = document.place(&format!("{key}.mechanics.membrane.ordering"), "on an open mesh");
            faults.push(place.into_iter().fold(fault, Fault::at));
        }
    }
    if text.bending.value() > 0.0 {
        let angle = match text.bending_rest {
            BendingRest::Shape => RestAngle::Remembered,
            BendingRest::Flat => RestAngle::Flat,
        };
        let bending = Bending::new(&rest.positions, &topology.flaps, text.bending.value(), angle);
        forces.push(Force::Bending(bending));
    }
}

fn add_links(
    document: &Document,
    key: &str,
    cell: &CellType,
    built: &Built,
    forces: &mut Vec<Force>,
    faults: &mut Vec<Fault>,
) -> Vec<[u32; 2]> {
    let mut drawn = Vec::new();
    for (i, link) in cell.links.iter().enumerate() {
        let mut springs = Vec::new();
        for [from, to] in linked_pairs(document, &format!("{key}.links[{i}]"), &link.linked, built, faults) {
            let apart = (built.plain.positions[from as usize] - built.plain.positions[to as usize]).norm();
            let rest_length = match link.rest() {
                Rest::Length(length) => length.value(),
                Rest::Ratio(ratio) => ratio * apart,
            };
            springs.push(Spring { from, to, rest_length, stiffness: link.stiffness.value() });
        }
        drawn.extend(springs.iter().map(|spring| [spring.from, spring.to]));
        forces.push(Force::Springs(Springs::between(springs)));
    }
    drawn
}

/// The pairs of atoms that are linked; those that the mesh does not have are faults.
fn linked_pairs(
    document: &Document,
    key: &str,
    linked: &Linked,
    built: &Built,
    faults: &mut Vec<Fault>,
) -> Vec<[u32; 2]> {
    let mut pairs = match linked {
        Linked::Pairs(pairs) => pairs.clone(),
        Linked::Pattern(LinkPattern::Horizontal) => mirrored(&built.plain, |p| Vec3::new(-p.x, -p.y, p.z)),
        Linked::Pattern(LinkPattern::Diagonal) => mirrored(&built.plain, |p| -p),
    };
    let atoms = built.plain.positions.len();
    let mut number = 0;
    pairs.retain(|&[from, to]| {
        let exists = (from as usize) < atoms && (to as usize) < atoms && from != to;
        if !exists {
            let fault = Fault::new(format!("atoms {from} and {to} cannot be linked: the mesh has {atoms} atoms"))
                .help(format!("give two different atoms from 0 to {}", atoms - 1));
            let place = document.place(&format!("{key}.pairs[{number}]"), "not two atoms of this mesh");
            faults.push(place.into_iter().fold(fault, Fault::at));
        }
        number += 1;
        exists
    });
    pairs
}

fn add_barrier(cell: &CellType, rest: &Surface, topology: &Topology, forces: &mut Vec<Force>) {
    let text = &cell.mechanics.barrier;
    let edge = geometry::mean_edge_length(rest);
    let stiffness = match text.stiffness {
        Some(stiffness) => stiffness.value(),
        None => {
            let matrix = sum::stiffness(forces, true, &rest.positions, &rest.positions);
            BARRIER_SHARE * (0..rest.positions.len()).map(|i| matrix.diagonal(i)).fold(0.0, f64::max)
        }
    };
    if !text.active || stiffness == 0.0 {
        return;
    }
    let rules = BarrierRules { energy: stiffness * edge * edge, area_share: text.area, fold_angle: text.angle.value() };
    forces.push(Force::Barrier(Barrier::new(&rest.positions, &rest.facets, &topology.flaps, rules)));
}

fn add_loads(
    document: &Document,
    key: &str,
    cell: &CellType,
    rest: &Surface,
    forces: &mut Vec<Force>,
    faults: &mut Vec<Fault>,
) {
    let areas = geometry::atom_areas(rest);
    for (i, load) in cell.loads.iter().enumerate() {
        let atoms = select::atoms(document, &format!("{key}.loads[{i}]"), &load.selection, rest, faults);
        let heights = select::heights(&load.selection, unit(load.direction), rest);
        let weight = |atom: u32| match load.spread {
            Spread::Equal => 1.0,
            Spread::Area => areas[atom as usize],
            Spread::Tapered => areas[atom as usize] * heights[atom as usize],
        };
        let total: f64 = atoms.iter().map(|&atom| weight(atom)).sum();
        let shares = atoms.into_iter().map(|atom| (atom, weight(atom) / total)).collect();
        let load = Load::new(&load.name, shares, unit(load.direction), course(load.force.points()));
        forces.push(Force::Load(load));
    }
}

fn add_fibres(
    document: &Document,
    key: &str,
    cell: &CellType,
    built: &Built,
    forces: &mut Vec<Force>,
    faults: &mut Vec<Fault>,
) -> Vec<[u32; 2]> {
    let mut drawn = Vec::new();
    for (i, fibre) in cell.fibres.iter().enumerate() {
        let pairs = linked_pairs(document, &format!("{key}.fibres[{i}]"), &fibre.linked, built, faults);
        drawn.extend(&pairs);
        let activation = course(fibre.activation.points());
        forces.push(Force::Fibres(Fibres::new(&fibre.name, pairs, fibre.stiffness.value(), activation)));
    }
    drawn
}
