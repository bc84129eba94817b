//! Who touches whom at a recorded instant. Contacts are found anew from the positions of the frame, so that what is
//! recorded depends on nothing else.

use crate::Vec3;
use crate::contact::{Contacts, Detector, Scene};
use crate::output::Frame;
use crate::sim::contact::ContactModel;
use crate::sim::{Model, Workspace};

/// Looks at contacts; has scratch of its own.
#[derive(Default)]
pub struct Touch {
    detector: Detector,
    found: Contacts,
    positions: Vec<Vec3>,
    /// For each cell a smaller one that it touches, or itself; at the end the smallest of its aggregate.
    first: Vec<u32>,
}

impl Touch {
    /// Fills in what the cells of a frame touch, and adds the series of contacts to those of the scene, in the order of
    /// [`CONTACT_SERIES`](crate::experiment::CONTACT_SERIES); `dt` is the last step, s, 0 when there was none.
    pub fn look(&mut self, model: &Model, contact: &ContactModel, ws: &Workspace, dt: f64, frame: &mut Frame) {
        self.positions.clear();
        self.positions.extend(frame.positions.iter().map(|p| Vec3::from(*p)));
        self.detector.detect(&contact.scene, &self.positions, &mut self.found);
        let body_of = |atom: u32| body_of(&contact.scene, atom);
        let mut touching = vec![0_u32; contact.scene.bodies.len()];
        let mut last = None;
        for near in self.found.atoms.iter().filter(|near| body_of(near.atom) != near.body) {
            // Contacts are ordered by atom: one that touches several facets counts once.
            touching[body_of(near.atom) as usize] += u32::from(last != Some(near.atom));
            last = Some(near.atom);
        }
        self.join(&contact.scene);
        for (cell, record) in frame.cells.iter_mut().enumerate() {
            record.contact_share = f64::from(touching[cell]) / contact.scene.shape(cell as u32).atoms as f64;
            record.aggregate = f64::from(self.first[cell]);
        }
        let mut sizes = vec![0_u32; self.first.len()];
        self.first.iter().for_each(|first| sizes[*first as usize] += 1);
        let sweeps = if dt > 0.0 { ws.contact.sweeps } else { 0 };
        let edge = model.kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
        frame.scene.extend([
            f64::from(sweeps),
            (-self.found.smallest_gap()).max(0.0) / edge,
            (self.found.atoms.len() + self.found.edges.len() + self.found.planes.len()) as f64,
            sizes.iter().filter(|size| **size > 0).count() as f64,
            f64::from(sizes.iter().copied().max().unwrap_or(0)),
        ]);
    }

    /// Finds the aggregates: cells that touch, and what these touch.
    fn join(&mut self, scene: &Scene) {
        self.first.clear();
        self.first.extend(0..scene.bodies.len() as u32);
        let of_atoms = self.found.atoms.iter().map(|near| [body_of(scene, near.atom), near.body]);
        for [one, other] in of_atoms.chain(self.found.edges.iter().map(|near| near.bodies)) {
            let (one, other) = (root(&mut self.first, one), root(&mut self.first, other));
            // The smaller number stays: it names the aggregate.
            self.first[one.max(other) as usize] = one.min(other);
        }
        for cell in 0..scene.bodies.len() as u32 {
            self.first[cell as usize] = root(&mut self.first, cell);
        }
    }
}

/// The body of an atom.
fn body_of(scene: &Scene, atom: u32) -> u32 {
    scene.bodies.partition_point(|body| body.first_atom <= atom) as u32 - 1
}

/// The smallest cell known of the aggregate of a cell; shortens the way to it.
fn root(first: &mut [u32], mut cell: u32) -> u32 {
    while first[cell as usize] != cell {
        first[cell as usize] = first[first[cell as usize] as usize];
        cell = first[cell as usize];
    }
    cell
}
