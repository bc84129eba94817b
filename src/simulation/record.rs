//! Looks at the state and writes down what the result file keeps. Observers never change the state.

use super::balance::record_tractions;
use super::moved;
use super::tools;
use super::touch::Touch;
use crate::cell::pseudopods::EndedPseudopod;
use crate::geometry;
use crate::output::{
    Cell, CellRecord, CellType, FibreRow, FieldLayout, Frame, Layout, MembraneLayout, PseudopodEvent, SystemLayout,
    SystemScope,
};
use crate::recorded::{FibresRecord, OUT_OF_BALANCE, Recorded, TractionRecord, contact_quantities, names_by_type};
use crate::sim::chemistry::{Members, member_cells};
use crate::sim::contact::find_contacts;
use crate::sim::kind::Kind;
use crate::sim::observe::{mean_velocities, measure_cells};
use crate::sim::state::vector;
use crate::sim::{KindState, Model, Obstacle, State, Workspace, forces};

/// Types of cells, names and planes of a model, as the result file lists them.
pub fn layout_of(model: &Model) -> Layout {
    let mut layout = outline_of(model);
    for (known, kind) in layout.types.iter_mut().zip(&model.kinds) {
        (known.facets, known.links) = (kind.rest.facets.clone(), kind.drawn_links.clone());
    }
    layout
}

/// The same without facets and links, which take most of the memory: enough to know the series of a frame.
pub fn outline_of(model: &Model) -> Layout {
    let kind = |kind: &Kind| CellType { name: kind.name.clone(), atoms: kind.atoms() as u32, ..CellType::default() };
    let mut layout = Layout { types: model.kinds.iter().map(kind).collect(), ..Layout::default() };
    let loads = load_names(model).into_iter().map(|(name, _, _)| (name, "pN".to_owned()));
    let named = [
        moved::names(model),
        moved::names_of_traps(model),
        moved::names_of_plates(model),
        tools::names(model),
        moved::names_of_pressures(model),
        moved::names_of_torques(model),
    ];
    layout.scene_series = loads.chain(named.into_iter().flatten()).collect();
    layout.scene_series.extend(model.rest.map(|_| (OUT_OF_BALANCE.to_owned(), "pN".to_owned())));
    layout.contacts = model.contact.is_some();
    layout.tractions = model.keeps_tractions;
    layout.fibres = model.kinds.iter().any(|kind| kind.fibre_budget > 0);
    layout.linked = model.contact.as_ref().is_some_and(|contact| contact.law.series() == Recorded::WithLinks);
    layout.viscosity = model.kinds.iter().any(|kind| kind.viscosity.is_some());
    let of_contacts = model.contact.iter().flat_map(|contact| contact_quantities(contact.law.series()));
    layout.scene_series.extend(of_contacts.map(|row| (row.name.to_owned(), row.unit.to_owned())));
    let obstacle = |obstacle: &Obstacle| {
        let (point, normal) = match &obstacle.surface {
            geometry::Obstacle::Plane { point, normal } => (*point, *normal),
            geometry::Obstacle::Turned(body) => (body.point, body.axis),
        };
        let profile = match &obstacle.surface {
            geometry::Obstacle::Plane { .. } => Vec::new(),
            geometry::Obstacle::Turned(body) => body.profile(),
        };
        let direction = obstacle.going.as_ref().map_or([0.0; 3], |going| going.direction.into());
        let (name, point, normal) = (obstacle.name.clone(), point.into(), normal.into());
        crate::output::Obstacle { name, point, normal, direction, profile }
    };
    layout.obstacles = model.obstacles.iter().map(obstacle).collect();
    add_chemistry(model, &mut layout);
    layout
}

/// Grids of fields, and quantities of systems.
fn add_chemistry(model: &Model, layout: &mut Layout) {
    for field in &model.chemistry.fields {
        let (grid, units) = (field.system.grid(), field.system.units());
        let names = field.system.species().iter().map(|species| species.name.clone());
        layout.fields.push(FieldLayout {
            name: field.name.clone(),
            species: names.zip(units.iter().cloned()).collect(),
            cells: grid.cells,
            spacing: grid.spacing,
            origin: grid.origin.into(),
        });
    }
    for reactor in &model.chemistry.reactors {
        for (id, unit) in reactor.membrane.iter().flat_map(|membrane| &membrane.system.names) {
            let name = format!("{}.{id}", reactor.name);
            layout.membranes.push(MembraneLayout { name, unit: unit.clone() });
        }
        layout.systems.push(SystemLayout {
            name: reactor.name.clone(),
            scope: match &reactor.members {
                Members::Scene => SystemScope::Scene,
                Members::Kinds(_) => SystemScope::Cells,
            },
            quantities: reactor.recorded.iter().map(|(_, id, unit)| (id.clone(), unit.clone())).collect(),
        });
    }
}

/// Values of fields and systems at this instant.
fn record_chemistry(model: &Model, state: &State, frame: &mut Frame) {
    let now = &state.chemistry;
    for (reactor, field) in model.chemistry.fields.iter().zip(&now.fields) {
        let species = field.values.chunks_exact(reactor.system.grid().len());
        frame.fields.push(species.map(<[f64]>::to_vec).collect());
    }
    for ((reactor, population), time) in model.chemistry.reactors.iter().zip(&now.populations).zip(&now.times) {
        let values = reactor.recorded.iter().map(|(quantity, ..)| {
            let mut values = vec![0.0; population.cells()];
            population.observe(&reactor.program, *quantity, time / reactor.seconds, &mut values);
            match &reactor.members {
                Members::Scene => values,
                Members::Kinds(_) => {
                    let mut of_all = vec![f64::NAN; frame.cells.len()];
                    let cells = member_cells(&state.kinds, &reactor.members);
                    cells.zip(values).for_each(|(cell, value)| of_all[cell] = value);
                    of_all
                }
            }
        });
        let values = values.collect();
        frame.systems.push(values);
    }
}

/// Densities of all substances on membranes at this instant, atom after atom in the order of all cells.
fn record_membranes(model: &Model, state: &State, frame: &mut Frame) {
    for (reactor, surfaces) in model.chemistry.reactors.iter().zip(&state.chemistry.membranes) {
        let (Some(membrane), Members::Kinds(own)) = (&reactor.membrane, &reactor.members) else { continue };
        for variable in 0..membrane.system.variables() {
            let mut values = vec![f64::NAN; frame.positions.len()];
            for (&kind, cells) in own.iter().zip(&surfaces.kinds) {
                let atoms = state.kinds[kind].atoms(&model.kinds[kind]);
                let densities = (0..cells.cells()).flat_map(|cell| cells.values(cell, variable));
                values[atoms].iter_mut().zip(densities).for_each(|(to, value)| *to = value);
            }
            frame.membranes.push(values);
        }
    }
}

/// The fibres that were made at run time, one by one and summed up cell by cell.
fn record_fibres(model: &Model, state: &State, frame: &mut Frame) {
    for (kind, now) in model.kinds.iter().zip(&state.kinds) {
        for cell in 0..now.cells() {
            let record = &mut frame.records[now.first_cell + cell].fibres;
            for made in now.fibres.of_cell(kind, cell) {
                let [a, b] = made.fibre.atoms.map(|atom| now.position(kind, cell, atom as usize));
                let ((pull, energy), length) = (made.fibre.pull(b - a), (b - a).norm());
                record.count += 1.0;
                record.tension += pull.norm();
                record.length += length;
                record.energy += energy;
                let (cell, number, atoms) = (now.ids[cell], made.number, made.fibre.atoms);
                frame.fibres.push(FibreRow { cell, number, atoms, length, tension: pull.norm() });
            }
            // Of none there is no mean.
            record.length /= record.count;
        }
    }
}

/// Series name, kind and number of every load: `load.NAME`, or `load.TYPE.NAME` where several types share the name.
fn load_names(model: &Model) -> Vec<(String, usize, usize)> {
    let own = |kind: &Kind| kind.loads().map(|load| load.name.clone()).collect();
    let types: Vec<(&str, Vec<String>)> = model.kinds.iter().map(|kind| (kind.name.as_str(), own(kind))).collect();
    let numbers = types.iter().enumerate().flat_map(|(kind, (_, own))| (0..own.len()).map(move |load| (kind, load)));
    let names = names_by_type(&types).into_iter().zip(numbers);
    names.map(|(name, (kind, load))| (format!("load.{name}"), kind, load)).collect()
}

/// Makes frames; has scratch of its own, so that looking changes nothing.
pub struct Recorder {
    loads: Vec<(String, usize, usize)>,
    touch: Touch,
    force_scratch: Option<Workspace>,
}

impl Recorder {
    /// A recorder of everything but forces.
    pub fn new(model: &Model) -> Self {
        Self { loads: load_names(model), touch: Touch::default(), force_scratch: None }
    }

    /// The same that records the force on every atom, too.
    pub fn with_forces(self, model: &Model) -> Self {
        Self { force_scratch: Some(Workspace::new(model)), ..self }
    }

    /// The frame of this instant; takes the ended runs and pseudopods from the state, since they are recorded now.
    pub fn record(&mut self, model: &Model, state: &mut State, ws: &mut Workspace, dt: f64) -> Frame {
        // Contacts depend on positions alone: the pairs that steps keep lead to them at once.
        let is_there = ws.contact.suit(model, state);
        if is_there {
            self.touch.swap_detector(&mut ws.contact.detector);
        }
        let frame = self.look(model, state, ws, dt);
        if is_there {
            self.touch.swap_detector(&mut ws.contact.detector);
        }
        let pod = |(cell, end, pod): (u64, f64, EndedPseudopod)| PseudopodEvent {
            cell,
            end,
            lifetime: pod.lifetime,
            direction: pod.direction,
            turn: pod.turn.map_or(f64::NAN, f64::to_degrees),
            side: pod.side,
            alone: pod.alone,
            abandoned: pod.abandoned,
        };
        let pseudopods = std::mem::take(&mut state.ended_pseudopods).into_iter().map(pod).collect();
        Frame { runs: std::mem::take(&mut state.ended_runs), pseudopods, ..frame }
    }

    /// The frame of this instant without the runs and pseudopods that ended; `dt` is the size of the last step, s.
    pub fn look(&mut self, model: &Model, state: &State, ws: &Workspace, dt: f64) -> Frame {
        let mut frame = frame_of(model, state);
        let at = |&(_, kind, number): &(String, usize, usize)| model.kinds[kind].loads().nth(number);
        frame.scene = self.loads.iter().filter_map(at).map(|load| load.force.at(state.time)).collect();
        moved::record(model, state, &mut frame.scene);
        moved::record_traps(model, state, &mut frame.scene);
        moved::record_plates(model, state, &mut frame.scene);
        tools::record(model, state, &mut frame.scene);
        moved::record_pressures(model, state, &mut frame.scene);
        moved::record_torques(model, state, &mut frame.scene);
        frame.scene.extend(model.rest.map(|_| state.out_of_balance.unwrap_or(f64::NAN)));
        if let Some(contact) = &model.contact {
            self.touch.look(model, &contact.scene_of(&state.kinds), state, ws, dt, &mut frame);
        }
        if let Some(scratch) = &mut self.force_scratch {
            // What contacts carry is part of the state, and is read from there.
            find_contacts(model, state, scratch);
            forces::add_forces(model, state.time, state, scratch);
            for ((kind, now), w) in model.kinds.iter().zip(&state.kinds).zip(&scratch.kinds) {
                for cell in 0..now.cells() {
                    frame.forces.extend((0..kind.atoms()).map(|a| <[f64; 3]>::from(vector(kind, &w.force, cell, a))));
                }
            }
        }
        frame
    }
}

/// The cells that there are, in the order of all arrays of a frame.
fn cells_of(state: &State) -> Vec<Cell> {
    let of_kind = |(kind, now): (u32, &KindState)| -> Vec<Cell> {
        now.ids.iter().zip(&now.parents).map(|(&id, &parent)| Cell { id, kind, parent }).collect()
    };
    (0..).zip(&state.kinds).flat_map(of_kind).collect()
}

/// Positions and measures of all cells at this instant, as if they did not touch.
fn frame_of(model: &Model, state: &State) -> Frame {
    let velocities = mean_velocities(state);
    let mut frame = Frame { time: state.time, step: state.step, cells: cells_of(state), ..Frame::default() };
    for (number, (cell, velocity)) in measure_cells(model, state).into_iter().zip(velocities).enumerate() {
        frame.positions.extend(cell.positions.iter().map(|p| <[f64; 3]>::from(*p)));
        frame.records.push(CellRecord {
            position: cell.centre.into(),
            velocity: velocity.into(),
            volume: cell.volume,
            volume_error: cell.volume_error,
            area: cell.area,
            energy: cell.energy,
            dissipated: 0.0,
            size: cell.size.into(),
            principal: cell.principal,
            smallest_facet: cell.smallest_facet,
            smallest_cosine: cell.smallest_cosine,
            contact_share: 0.0,
            traction: TractionRecord::default(),
            fibres: FibresRecord::default(),
            aggregate: frame.cells[number].id as f64,
        });
    }
    if model.keeps_tractions {
        record_tractions(model, state, &mut frame);
    }
    if model.kinds.iter().any(|kind| kind.fibre_budget > 0) {
        record_fibres(model, state, &mut frame);
    }
    for now in &state.kinds {
        let own = frame.records.iter_mut().skip(now.first_cell).zip(&now.dissipated);
        own.for_each(|(record, dissipated)| record.dissipated = *dissipated);
    }
    record_chemistry(model, state, &mut frame);
    record_membranes(model, state, &mut frame);
    frame
}
