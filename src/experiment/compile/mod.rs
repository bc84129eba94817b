//! From what the user wrote to what it means: a [`Model`] in µm, s and pN, and the [`State`] it starts from.

mod bonds;
mod builder;
mod chemistry;
mod contact;
mod far;
mod forces;
mod held;
mod lathe;
mod load_file;
mod mesh;
mod model;
mod notices;
mod numbers;
mod obstacles;
mod overlap;
mod population;
mod positions;
mod pseudopods;
mod schedule;
mod select;
mod size;
mod spacing;
mod start;
mod steps;

pub(super) use builder::{Builder, Inside};
pub use chemistry::load_profile;
pub use notices::notices;
pub(super) use numbers::{course, unit};
pub use schedule::Schedule;
pub use size::Size;
pub use start::{PushedApart, Settling, settle_start, settle_start_told};

use super::{CellType, Document, Solid, VolumeRule as Rule};
use crate::Vec3;
use crate::error::{Error, Fault, Result};
use crate::field::Fields;
use crate::geometry;
use crate::mechanics::Force;
use crate::mechanics::course::Course;
use crate::sim::chemistry::ChemistryState;
use crate::sim::kind::kinks;
use crate::sim::{Kind, Model, State, VolumeRule};
use builder::Built;
use numbers::vector;

/// An experiment ready to run.
#[derive(Debug, Clone)]
pub struct Compiled {
    /// What it means.
    pub model: Model,
    /// Where it starts.
    pub state: State,
    /// When it is recorded.
    pub schedule: Schedule,
}

/// An experiment whose types of cells are compiled, and whose cells are not built yet: it has the faults of the whole, and takes
/// no more memory for a million cells than for one.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// What it means.
    pub model: Model,
    /// When it is recorded.
    pub schedule: Schedule,
    /// Where the centres of the cells start, µm: `[kind][cell]`.
    pub centres: Vec<Vec<Vec3>>,
    /// How large it is, by an estimate.
    pub size: Size,
    /// What was found in models and loads of other programs, a sentence each.
    pub(crate) told: Vec<String>,
    /// Where the fields start.
    fields: Vec<Fields>,
}

impl Prepared {
    /// Builds the cells where they start.
    pub fn build(self) -> Compiled {
        let Self { model, schedule, centres, fields, .. } = self;
        let cells = model.kinds.iter().zip(&centres);
        let positions: Vec<_> = cells.map(|(kind, centres)| positions::atoms_at(kind, centres)).collect();
        let mut state = State::new(&model, &positions);
        state.chemistry = ChemistryState::new(&model, &state.counts(), &fields);
        Compiled { model, state, schedule }
    }
}

/// Compiles a checked document.
///
/// # Errors
/// As [`prepare`].
pub fn compile(document: &Document) -> Result<Compiled> {
    prepare(document).map(Prepared::build)
}

/// Compiles a checked document but for building its cells.
///
/// # Errors
/// [`Error::Input`] where it is too large to be made at all, or with every fault that shows only once meshes are built:
/// files that cannot be read, atoms that do not exist, a step that is not stable.
pub fn prepare(document: &Document) -> Result<Prepared> {
    let experiment = &document.experiment;
    let mut size = size::of_cells(document)?;
    let (mut kinds, mut faults) = (Vec::new(), Vec::new());
    let (mut counts, mut told) = (Vec::new(), Vec::new());
    for (name, cell) in &experiment.cells {
        let before = faults.len();
        let Some(surface) = mesh::surface(document, name, cell, &mut faults) else { continue };
        let kind = compile_kind(document, name, cell, surface, &mut told, &mut faults);
        if faults.len() > before {
            continue;
        }
        kinds.push(kind.for_cells(cell.most()));
        counts.push(cell.count());
    }
    // Atoms that do not exist have been told; links look at kinds and must see them all.
    let (chemistry, fields) = if faults.is_empty() {
        chemistry::chemistry(document, &counts, &mut kinds, &mut size, &mut faults)
    } else {
        Default::default()
    };
    kinds.iter_mut().for_each(Kind::bound_stiffness);
    if !faults.is_empty() {
        return Err(Error::Input(faults));
    }
    let (reach, obstacles) = (contact::reach(document, &kinds)?, obstacles::obstacles(document)?);
    obstacles::check_thickness(document, &kinds, &obstacles)?;
    contact::check_ranges(document, &kinds)?;
    contact::check_area_within(document, &kinds)?;
    let centres = match reach {
        Some(reach) => spacing::centres_apart(document, &kinds, &obstacles, reach.proximity)?,
        None => {
            let cells = experiment.cells.values().zip(&kinds).zip(positions::first_cells(experiment));
            cells.map(|((cell, kind), first)| positions::centres(experiment, cell, kind, first)).collect()
        }
    };
    anchor_plates(&mut kinds, &centres);
    let integrator = steps::integrator(document, &mut kinds)?;
    let contact = reach.and_then(|reach| contact::contact(experiment, &kinds, &obstacles, reach));
    if contact.as_ref().is_none_or(|contact| contact.law.moves_as_steps()) {
        let have_tools = contact.is_some() && kinds.iter().any(|kind| kind.rigid.is_some() || !kind.moved.is_empty());
        for kind in &mut kinds {
            // What grips a cell touches it, too.
            kind.use_tangent(have_tools || !experiment.tools.is_empty() || !kind.moved.is_empty());
        }
    }
    // What a file of loads moves is not in the document.
    let are_moved = kinds.iter().any(|kind| !kind.moved.is_empty());
    let keeps_tractions = experiment.keeps_tractions() || are_moved || chemistry.reads_tractions();
    let model = Model {
        seed: experiment.seed,
        kinks: kinks(&kinds, &obstacles),
        changes: population::changes(experiment, &kinds),
        integrator,
        contact: contact.map(|contact| contact.suited_to(integrator.size)),
        kinds,
        chemistry,
        obstacles,
        until: experiment.run.until.value(),
        rest: experiment.run.equilibrium.map(|equilibrium| equilibrium.force.value()),
        keeps_tractions,
    };
    let schedule = schedule::schedule(document);
    Ok(Prepared { model, schedule, centres, size, told, fields })
}

/// Lets plates begin where their cells do.
fn anchor_plates(kinds: &mut [Kind], centres: &[Vec<Vec3>]) {
    for (kind, centres) in kinds.iter_mut().zip(centres) {
        for force in &mut kind.forces {
            if let (Force::Plate(plate), Some(centre)) = (force, centres.first()) {
                plate.at = centre.dot(&plate.direction);
            }
        }
    }
}

fn compile_kind(
    document: &Document,
    name: &str,
    cell: &CellType,
    surface: Built,
    told: &mut Vec<String>,
    faults: &mut Vec<Fault>,
) -> Kind {
    let key = format!("cells.{name}");
    let from_file = load_file::read(document, &key, cell, &surface, faults);
    told.extend(surface.model.as_ref().and_then(|model| model.notice.clone()));
    told.extend(from_file.notices);
    let mut builder = Builder::new(document, &key, &surface, faults);
    forces::add_forces(cell, &document.experiment.environment, &mut builder);
    let Builder { mut forces, drawn, .. } = builder;
    forces.extend(from_file.loads.into_iter().map(Force::Load));
    let atoms = surface.turned.positions.len() as f64;
    let viscosity = cell.mechanics.viscosity.unwrap_or_default();
    let viscosity = viscosity.compiled(&surface.plain, surface.inside.as_ref(), cell.mechanics.solid.as_ref());
    let mut kind = Kind::new(name, surface.turned, forces);
    kind.tetrahedra = surface.inside.map_or(Vec::new(), |inside| inside.tetrahedra);
    kind.drawn_links = drawn;
    kind.drag = cell.mechanics.drag.map_or(0.0, |drag| drag.value()) / atoms;
    kind.mass = cell.mechanics.mass.map_or(0.0, |mass| mass.value()) / atoms;
    far::check(document, &key, cell, &kind.rest, kind.closed, faults);
    (kind.held, kind.moved) = held::held(document, &key, cell, &kind.rest, (&from_file.held, from_file.moved), faults);
    kind.rigid = cell.mechanics.rigid.map(|rigid| rigid.compiled());
    kind.viscosity = viscosity;
    kind.volume = volume_rule(document, &key, cell, &kind, faults);
    kind.behaviours = cell.motility.behaviours();
    let pods = pseudopods::pseudopods(document, &key, cell, &kind, faults);
    kind.behaviours.extend(pods);
    kind.fibre_budget = cell.fibre_budget();
    kind
}

fn volume_rule(document: &Document, key: &str, cell: &CellType, kind: &Kind, faults: &mut Vec<Fault>) -> VolumeRule {
    let control = &cell.mechanics.volume;
    // What fills a body may resist changes of its volume by itself.
    let has_bulk = cell.mechanics.solid.as_ref().is_some_and(Solid::has_bulk);
    let is_driven = control.target.is_some() || control.ratio.is_some();
    let usual = if kind.closed && (!has_bulk || is_driven) { Rule::Exact } else { Rule::Free };
    let rule = control.rule.unwrap_or(usual);
    if rule != Rule::Free && !kind.closed {
        let fault = Fault::new(format!("the surface of `{}` is open and encloses no volume", kind.name))
            .help("use volume = { rule = \"free\" }, or a closed mesh");
        let location = document.location(&format!("{key}.mechanics.volume"), "needs a closed surface");
        faults.push(location.into_iter().fold(fault, Fault::at));
        return VolumeRule::Free;
    }
    // What cannot move keeps its volume by itself, and has no gradient along which it could be restored.
    if kind.rigid.is_some() || kind.is_held() && kind.held.iter().all(|factor| *factor == 0.0) {
        return VolumeRule::Free;
    }
    let rest = geometry::volume(&kind.rest);
    let factor = match (&control.target, &control.ratio) {
        (Some(target), _) => course(target.points().into_iter().map(|(t, v)| (t, v / rest)).collect()),
        (None, Some(ratio)) => course(ratio.points()),
        (None, None) => Course::constant(1.0),
    };
    match rule {
        Rule::Free => VolumeRule::Free,
        Rule::Exact => VolumeRule::Exact(factor),
        Rule::Compressible => {
            VolumeRule::Compressible { modulus: control.modulus.map_or(0.0, |modulus| modulus.value()), course: factor }
        }
    }
}
