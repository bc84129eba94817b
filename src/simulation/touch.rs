//! Who touches whom at a recorded instant. Contacts are found anew from the positions of the frame, so that what is
//! recorded depends on nothing else.

use crate::Vec3;
use crate::contact::{Contacts, Detector, Scene};
use crate::output::{Frame, LinkedPair, Touching, clusters};
use crate::recorded::{ContactSeries, contact_quantities};
use crate::sim::contact::{AreaScratch, CohesionScratch, ContactScene, Earlier, LinkScratch, Touching as Instant};
use crate::sim::{Model, State, Workspace};

/// How many aggregates there are, and cells of the largest.
struct Aggregates {
    number: usize,
    largest: usize,
}

/// Looks at contacts; has scratch of its own.
#[derive(Default)]
pub struct Touch {
    detector: Detector,
    found: Contacts,
    positions: Vec<Vec3>,
    /// What each atom touches: the atom, then another body, or the number of bodies and that of a plane.
    partners: Vec<(u32, u32)>,
    links: LinkScratch,
    cohesion: CohesionScratch,
    area: AreaScratch,
    /// Energy of surfaces that attract each other, pN·µm.
    energy: f64,
    /// Bonds of surfaces that are closed.
    bonds: f64,
    /// A cell, what it touches in the same way, and an area.
    areas: Vec<(u32, u32, f64)>,
}

impl Touch {
    /// Looks with another detector, which may have been used for the same surfaces alone; the one there was comes back.
    pub fn swap_detector(&mut self, detector: &mut Detector) {
        std::mem::swap(&mut self.detector, detector);
    }

    /// Fills in what the cells of a frame touch, and adds the series of contacts to those of the scene, as
    /// [`CONTACTS`](crate::recorded::CONTACTS) lists them; `dt` is the last step, s, 0 when there was none.
    pub fn look(
        &mut self,
        model: &Model,
        contact: &ContactScene,
        state: &State,
        ws: &Workspace,
        dt: f64,
        frame: &mut Frame,
    ) {
        self.positions.clear();
        self.positions.extend(frame.positions.iter().map(|p| Vec3::from(*p)));
        self.detector.detect(&contact.scene, &self.positions, &mut self.found);
        self.found.keep_touching(&contact.scene.reach);
        let bodies = contact.scene.bodies.len();
        self.find_partners(&contact.scene);
        let mut touching = vec![0_u32; bodies];
        for of_atom in self.partners.chunk_by(|one, other| one.0 == other.0) {
            // A plane stands after all bodies.
            touching[contact.scene.body_of_atom(of_atom[0].0) as usize] += u32::from((of_atom[0].1 as usize) < bodies);
        }
        self.measure_areas(contact, state, frame);
        let Self { found, positions, links, .. } = self;
        let now = Instant { scene: &contact.scene, controls: &state.chemistry.controls, found, positions };
        // Where links bind, cells that merely touch do not belong together.
        let first = match contact.law.links_at(now, &state.contact, links) {
            Some(at) => {
                let pairs = at.links.iter().map(|link| link.bodies.map(|body| frame.cells[body as usize].id));
                let mut pairs: Vec<[u64; 2]> = pairs.map(|[one, other]| [one.min(other), one.max(other)]).collect();
                pairs.sort_unstable();
                let alike = pairs.chunk_by(|one, other| one == other);
                frame.links.extend(alike.map(|alike| LinkedPair {
                    cell: alike[0][0],
                    other: alike[0][1],
                    number: alike.len() as u32,
                }));
                clusters(bodies, at.links.iter().map(|link| link.bodies))
            }
            None => {
                clusters(bodies, self.areas.iter().filter(|area| area.1 < bodies as u32).map(|area| [area.0, area.1]))
            }
        };
        let mut smallest: Vec<u64> = frame.cells.iter().map(|cell| cell.id).collect();
        for (cell, first) in frame.cells.iter().zip(&first) {
            let known = &mut smallest[*first as usize];
            *known = (*known).min(cell.id);
        }
        for (cell, record) in frame.records.iter_mut().enumerate() {
            record.contact_share = f64::from(touching[cell]) / contact.scene.shape(cell as u32).atoms as f64;
            record.aggregate = smallest[first[cell] as usize] as f64;
        }
        let mut sizes = vec![0_u32; first.len()];
        first.iter().for_each(|first| sizes[*first as usize] += 1);
        let aggregates = Aggregates {
            number: sizes.iter().filter(|size| **size > 0).count(),
            largest: sizes.iter().copied().max().unwrap_or(0) as usize,
        };
        let sweeps = if dt > 0.0 { ws.contact.sweeps } else { 0 };
        let edge = model.kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
        let value = |series| self.value(series, state, &aggregates, f64::from(sweeps), edge);
        frame.scene.extend(contact_quantities(contact.law.series()).map(|row| value(row.series)));
    }

    /// The value of a series of contacts; `edge` is the smallest mean edge of all types, µm.
    fn value(&self, series: ContactSeries, state: &State, aggregates: &Aggregates, sweeps: f64, edge: f64) -> f64 {
        let adhesives = || state.contact.adhesives.chunk_by(|one, other| one.adhesive == other.adhesive);
        let count = match series {
            ContactSeries::Sweeps => return sweeps,
            ContactSeries::Deepest => return (-self.found.smallest_gap()).max(0.0) / edge,
            ContactSeries::Energy => return state.contact.stored() + self.energy,
            ContactSeries::Bonds => return self.bonds,
            ContactSeries::Count => self.found.atoms.len() + self.found.edges.len() + self.found.obstacles.len(),
            ContactSeries::Aggregates => aggregates.number,
            ContactSeries::LargestAggregate => aggregates.largest,
            ContactSeries::Links => self.links.links.len(),
            ContactSeries::Adhesives => adhesives().count(),
            ContactSeries::LargestAdhesive => adhesives().map(<[_]>::len).max().unwrap_or(0),
        };
        count as f64
    }

    /// Finds what each atom touches, its own cell left out; one that touches several facets of a cell counts once.
    fn find_partners(&mut self, scene: &Scene) {
        let bodies = scene.bodies.len() as u32;
        self.partners.clear();
        let others = self.found.atoms.iter().filter(|near| scene.body_of_atom(near.atom) != near.body(scene));
        self.partners.extend(others.map(|near| (near.atom, near.body(scene))));
        self.partners.extend(self.found.obstacles.iter().map(|near| (near.atom, bodies + near.obstacle)));
        self.partners.sort_unstable();
        self.partners.dedup();
    }

    /// Measures the areas of contact, eq. (adhesion.8). Bodies that touch with an atom or an edge belong together even without an area.
    fn measure_areas(&mut self, contact: &ContactScene, state: &State, frame: &mut Frame) {
        let bodies = contact.scene.bodies.len() as u32;
        let Self { cohesion, area, positions, areas, partners, energy, bonds, .. } = self;
        areas.clear();
        areas.extend(partners.chunk_by(|one, other| one.0 == other.0).flat_map(|of_atom| {
            let cell = contact.scene.body_of_atom(of_atom[0].0);
            of_atom.iter().map(move |&(_, other)| (cell.min(other), cell.max(other), 0.0))
        }));
        contact.area.add_areas(&contact.scene, positions, area, areas);
        *energy = contact.law.cohesion().map_or(0.0, |table| {
            let before = Earlier { bonds: &state.contact.bonds, time: state.time };
            table.find(&contact.scene, &state.chemistry.controls, before, positions, cohesion);
            *bonds = table.closed_bonds(&contact.scene, cohesion, positions);
            table.energy(&contact.scene, cohesion, positions)
        });
        // Edges have no area, and yet they join.
        let of_edges =
            self.found.edges.iter().map(|near| near.bodies(&contact.scene)).filter(|[one, other]| one != other);
        self.areas.extend(of_edges.map(|[one, other]| (one.min(other), one.max(other), 0.0)));
        self.areas.sort_by_key(|area| (area.0, area.1));
        let ids: Vec<u64> = frame.cells.iter().map(|cell| cell.id).collect();
        let id = |cell: u32| ids[cell as usize];
        for alike in self.areas.chunk_by(|one, other| (one.0, one.1) == (other.0, other.1)) {
            let (cell, other, area) = (alike[0].0, alike[0].1, alike.iter().map(|one| one.2).sum());
            match other.checked_sub(bodies) {
                None => {
                    let (one, other) = (id(cell), id(other));
                    frame.pairs.push(Touching { cell: one.min(other), other: one.max(other), area });
                }
                Some(plane) => {
                    frame.on_planes.push(Touching { cell: id(cell), other: u64::from(plane), area });
                }
            }
        }
        frame.pairs.sort_by_key(|pair| (pair.cell, pair.other));
        frame.on_planes.sort_by_key(|touching| (touching.cell, touching.other));
    }
}
