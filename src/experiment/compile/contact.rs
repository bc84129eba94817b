//! Contacts as the step knows them.

use super::super::contact::{Bonds, ContactModel as Text, Pair, Zones as ZonesText};
use super::super::{Document, Experiment};
use super::bonds::kinetics;
use crate::contact::Reach;
use crate::error::{Error, Fault, Result, short};
use crate::geometry::finest_edge_length;
use crate::sim::contact::{
    AREA_WITHIN, AdhesiveTable, CohesionTable, Cohesive, ContactModel, Law, LinkTable, Penalty, Strength, Zones,
};
use crate::sim::{Kind, Obstacle};
use crate::units::{LineStiffness, Stress, SurfaceDrag};

/// The proximity over the smallest mean edge where the user names none.
const PROXIMITY: f64 = 0.1;

/// The prediction likewise, where the proximity is not wider.
const PREDICTION: f64 = 0.2;

/// The largest of both over the smallest mean edge: above it an atom is near everything around it.
const LARGEST: f64 = 0.5;

/// How near is a contact, in an experiment that has contacts.
///
/// # Errors
/// A proximity or a prediction that does not fit the meshes, and a prediction below the proximity.
pub fn reach(document: &Document, kinds: &[Kind]) -> Result<Option<Reach>> {
    let Some(text) = &document.experiment.contact else { return Ok(None) };
    let smallest = kinds.iter().min_by(|one, other| one.edge.total_cmp(&other.edge));
    let edge = smallest.map_or(1.0, |kind| kind.edge);
    let [proximity, named] = [text.proximity, text.prediction].map(|length| length.map(|length| length.value()));
    for (key, length, share) in [("proximity", proximity, "a tenth"), ("prediction", named, "a fifth")] {
        if let (Some(kind), Some(length)) = (smallest, length.filter(|length| *length > LARGEST * edge)) {
            return Err(too_large(document, key, (length, kind), share));
        }
    }
    let proximity = proximity.unwrap_or_else(|| named.unwrap_or(f64::INFINITY).min(PROXIMITY * edge));
    let prediction = named.unwrap_or(proximity.max(PREDICTION * edge));
    if prediction < proximity {
        return Err(below_proximity(document, prediction, proximity));
    }
    let depth = if text.model == Text::Penalty { PENALTY_DEPTH * edge } else { prediction };
    Ok(Some(Reach { proximity, prediction, depth, margin: prediction.min(PROXIMITY * edge) }))
}

/// The fault of a length, by its key, that is too large for a mesh; where it is absent it is this share of the edge.
fn too_large(document: &Document, key: &str, (length, kind): (f64, &Kind), share: &str) -> Error {
    let fault = Fault::new(format!(
        "a {key} of {} um is too large for the mesh of type `{}`, whose mean edge is {} um",
        short(length),
        kind.name,
        short(kind.edge)
    ))
    .help(format!("give at most {} um, or leave it out: then it is {share} of the edge", short(LARGEST * kind.edge)));
    let location = document.location(&format!("contact.{key}"), "above half of the mean edge");
    Error::input(location.into_iter().fold(fault, Fault::at))
}

/// The fault of a step that would not see all that touches.
fn below_proximity(document: &Document, prediction: f64, proximity: f64) -> Error {
    let fault = Fault::new(format!(
        "a prediction of {} um is below the proximity, {} um: what touches would not be seen",
        short(prediction),
        short(proximity)
    ))
    .help("give at least the proximity, or leave it out: then it is a fifth of the edge, or the proximity where that is more");
    let location = document.location("contact.prediction", "below `proximity`");
    Error::input(location.into_iter().fold(fault, Fault::at))
}

/// The shortest and the longest range of attraction over the mean edge of a mesh: below the one a facet hardly sees what its neighbour
/// touches, and contacts stand where they are; beyond the other a cell is attracted through its neighbours.
const RANGES: std::ops::RangeInclusive<f64> = 0.5..=10.0;

/// Refuses a reach of areas beyond which all that a mesh has would be near everything.
///
/// # Errors
/// A reach above ten edges of a mesh.
pub fn check_area_within(document: &Document, kinds: &[Kind]) -> Result<()> {
    let Some(within) = document.experiment.contact.as_ref().and_then(|text| text.area_within) else { return Ok(()) };
    let Some(kind) = kinds.iter().min_by(|one, other| one.edge.total_cmp(&other.edge)) else { return Ok(()) };
    if within.value() <= RANGES.end() * kind.edge {
        return Ok(());
    }
    let fault = Fault::new(format!(
        "areas of contact within {} um are too wide for the mesh of type `{}`, whose mean edge is {} um",
        short(within.value()),
        kind.name,
        short(kind.edge)
    ))
    .help(format!("give at most ten edges, {} um, or leave it out", short(RANGES.end() * kind.edge)));
    let location = document.location("contact.area_within", "above ten edges");
    Err(Error::input(location.into_iter().fold(fault, Fault::at)))
}

/// The edges of a mesh where it is finest, µm, if they are less than half of the mean there: a mesh is made so where it is to touch.
fn finer_edge(kind: &Kind) -> Option<f64> {
    Some(finest_edge_length(&kind.rest)).filter(|finest| *finest < 0.5 * kind.edge)
}

/// Refuses ranges of attraction that do not fit the meshes of the cells that have them.
///
/// # Errors
/// Every pair with such a range.
pub fn check_ranges(document: &Document, kinds: &[Kind]) -> Result<()> {
    let Some(text) = document.experiment.contact.as_ref().filter(|text| text.model == Text::Cohesion) else {
        return Ok(());
    };
    let all = (String::from("contact"), (text.strength, text.energy, text.range), (0..kinds.len()).collect::<Vec<_>>());
    let pairs = text.between.iter().enumerate().map(|(index, between)| {
        let kinds = match between.pair(&document.experiment) {
            Some(Pair::Types(one, other)) => vec![one, other],
            Some(Pair::OnObstacle(kind, _)) => vec![kind],
            None => Vec::new(),
        };
        (format!("contact.between[{index}]"), (between.strength, between.energy, between.range), kinds)
    });
    let mut faults = Vec::new();
    for (path, (strength, energy, own), of) in std::iter::once(all).chain(pairs) {
        let [of_strength, work] = text.cohesive(strength, energy, own);
        let range = Cohesive { strength: of_strength, work, ..Cohesive::default() }.range();
        let of_all = text.range.is_some() && path != "contact";
        let told = match (strength, energy, own) {
            (Some(_), Some(_), _) => Told::ByEnergy(path),
            (_, _, Some(_)) => Told::Itself(path),
            (_, _, None) if of_all => Told::Itself("contact".into()),
            (None, _, None) => Told::ByDefault(format!("{path}.energy")),
            (_, _, None) => Told::ByDefault(format!("{path}.strength")),
        };
        let edge = |kind: &Kind| finer_edge(kind).unwrap_or(kind.edge);
        let coarse = of.iter().map(|kind| &kinds[*kind]).max_by(|one, other| edge(one).total_cmp(&edge(other)));
        let fine = of.iter().map(|kind| &kinds[*kind]).min_by(|one, other| one.edge.total_cmp(&other.edge));
        let (Some(coarse), Some(fine)) = (coarse, fine) else { continue };
        if range > 0.0 && range < RANGES.start() * edge(coarse) {
            faults.push(range_fault(document, &told, (range, coarse), "short", "at least half an edge"));
        } else if range > RANGES.end() * fine.edge {
            faults.push(range_fault(document, &told, (range, fine), "long", "at most ten edges"));
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
}

/// What says how far surfaces attract each other, by the table that does, or the key that sticks as far as the default.
enum Told {
    ByEnergy(String),
    Itself(String),
    ByDefault(String),
}

/// A range of attraction that does not fit a mesh.
fn range_fault(document: &Document, told: &Told, (range, kind): (f64, &Kind), too: &str, fits: &str) -> Fault {
    let is_short = too == "short";
    let (range_is, advice, key, label) = match told {
        Told::ByEnergy(path) => (
            "the range of attraction, twice the energy over the strength, is",
            if is_short { "a lower strength, more energy or a finer mesh" } else { "a higher strength or less energy" },
            format!("{path}.energy"),
            "with this and `strength`",
        ),
        Told::Itself(path) => (
            "the range of attraction is",
            if is_short { "a longer one or a finer mesh" } else { "a shorter one" },
            format!("{path}.range"),
            "with this",
        ),
        Told::ByDefault(path) => {
            ("the default range of attraction is", "another `range`", path.clone(), "sticks as far as the default")
        }
    };
    let edges = match finer_edge(kind).filter(|_| is_short) {
        Some(edge) => format!("whose edges are {} um where it is finest", short(edge)),
        None => format!("whose mean edge is {} um", short(kind.edge)),
    };
    let fault =
        Fault::new(format!("{range_is} {} um: too {too} for the mesh of type `{}`, {edges}", short(range), kind.name))
            .help(format!("take {advice}: one to two edges are best, and the range must be {fits}"));
    document.location(&key, label).into_iter().fold(fault, Fault::at)
}

/// How deep contacts are found where nothing but a penalty keeps cells apart, over the smallest mean edge.
const PENALTY_DEPTH: f64 = 0.5;

/// Contacts with the strengths of the document.
pub fn contact(experiment: &Experiment, kinds: &[Kind], obstacles: &[Obstacle], reach: Reach) -> Option<ContactModel> {
    let text = experiment.contact.as_ref()?;
    let mut model = ContactModel::new(kinds, obstacles, reach);
    let edges: Vec<f64> = kinds.iter().map(|kind| kind.edge).collect();
    let widest = RANGES.end() * edges.iter().copied().fold(f64::INFINITY, f64::min);
    let within = text.area_within.map_or(AREA_WITHIN.min(widest), |within| within.value());
    model.area = CohesionTable::alike(&edges, obstacles.len(), within);
    match text.model {
        Text::Adhesives => {}
        Text::Cohesion => model.law = Law::Cohesion(CohesionTable::new(kinds.len(), obstacles.len())),
        Text::Links => {
            model.law = Law::Links(links(experiment, kinds));
            return Some(model);
        }
        Text::Penalty => {
            let stiffness = text.penalty.map_or(0.0, |penalty| penalty.value());
            model.law = Law::Penalty(Penalty { stiffness, range: reach.proximity });
        }
        Text::VirtualAdhesives => {
            model.law = Law::VirtualAdhesives(adhesives(experiment, kinds.len(), obstacles.len()));
            return Some(model);
        }
    }
    let of_model = |strength: Option<Stress>, energy: Option<LineStiffness>, range| match text.model {
        Text::Cohesion => text.cohesive(strength, energy, range),
        _ => [strength.map_or(0.0, |strength| strength.value()), energy.map_or(0.0, |energy| energy.value())],
    };
    if text.strength.is_some() || text.energy.is_some() {
        let strength = of_model(text.strength, text.energy, text.range);
        let strength = strength_of(strength, (text.shear_strength, text.friction));
        for kind in 0..kinds.len() {
            let holds = (text.friction, text.bonds);
            (kind..kinds.len()).for_each(|other| stick(&mut model, Pair::Types(kind, other), strength, holds));
        }
    }
    for between in &text.between {
        let shear = (between.shear_strength, between.friction);
        let strength = strength_of(of_model(between.strength, between.energy, between.range), shear);
        if let Some(pair) = between.pair(experiment) {
            stick(&mut model, pair, strength, (between.friction, between.bonds));
        }
    }
    if let Law::Cohesion(table) = &mut model.law {
        table.resolve(&edges);
        table.resists =
            table.has_friction() || model.between.iter().chain(&model.on_obstacles).any(|it| it.shear > 0.0);
    }
    Some(model)
}

/// Writes how two surfaces stick where the law of contact has it. Under cohesion contacts carry only the shear.
fn stick(
    model: &mut ContactModel,
    pair: Pair,
    strength: Strength,
    (friction, bonds): (Option<SurfaceDrag>, Option<Bonds>),
) {
    let strength = match &mut model.law {
        Law::Cohesion(table) => {
            let friction = friction.map_or(0.0, |friction| friction.value());
            let bonds = bonds.map(kinetics);
            let cohesive = Cohesive { strength: strength.tensile, work: strength.energy, friction, bonds };
            match pair {
                Pair::Types(one, other) => table.stick(one, other, cohesive),
                Pair::OnObstacle(kind, obstacle) => table.stick_to_obstacle(kind, obstacle, cohesive),
            }
            Strength { tensile: 0.0, energy: 0.0, ..strength }
        }
        _ => strength,
    };
    match pair {
        Pair::Types(one, other) => model.stick(one, other, strength),
        Pair::OnObstacle(kind, obstacle) => model.stick_to_obstacle(kind, obstacle, strength),
    }
}

fn strength_of([strength, energy]: [f64; 2], (shear, friction): (Option<Stress>, Option<SurfaceDrag>)) -> Strength {
    // What rubs is not stuck as well, unless the document says so.
    let else_shear = if friction.is_some() { 0.0 } else { strength };
    Strength { tensile: strength, shear: shear.map_or(else_shear, |shear| shear.value()), energy }
}

/// Which types are glued to each other and to planes, and how well. As with strengths, cells stick to planes that are named only.
fn adhesives(experiment: &Experiment, kinds: usize, obstacles: usize) -> AdhesiveTable {
    let text = experiment.contact.as_ref();
    let all = text.and_then(|text| text.kappa).map_or(0.0, |kappa| kappa.value());
    let zones = match text.and_then(|text| text.zones).unwrap_or_default() {
        ZonesText::Merged => Zones::Merged,
        ZonesText::Pairs => Zones::Pairs,
    };
    let mut table =
        AdhesiveTable { between: vec![all; kinds * kinds], on_obstacles: vec![0.0; kinds * obstacles], zones };
    for between in text.map_or(&[][..], |text| &text.between) {
        let kappa = between.kappa.map_or(0.0, |kappa| kappa.value());
        match between.pair(experiment) {
            Some(Pair::Types(one, other)) => {
                table.between[one * kinds + other] = kappa;
                table.between[other * kinds + one] = kappa;
            }
            Some(Pair::OnObstacle(kind, obstacle)) => table.on_obstacles[kind * obstacles + obstacle] = kappa,
            None => {}
        }
    }
    table
}

/// Which types are linked, and how. The document's checks have refused links to planes.
fn links(experiment: &Experiment, kinds: &[Kind]) -> LinkTable {
    let smallest = kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
    let Some(text) = &experiment.contact else { return LinkTable::new(kinds.len(), smallest) };
    let mut table = LinkTable::new(kinds.len(), text.range.map_or(smallest, |range| range.value()));
    table.stiffness.fill(text.link.map_or(0.0, |stiffness| stiffness.value()));
    for between in &text.between {
        if let (Some(Pair::Types(one, other)), Some(stiffness)) = (between.pair(experiment), between.link) {
            table.stiffness[one * kinds.len() + other] = stiffness.value();
            table.stiffness[other * kinds.len() + one] = stiffness.value();
        }
    }
    table
}
