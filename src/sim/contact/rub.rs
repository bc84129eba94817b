//! Friction of what is in contact by its area and yet touches with no atom: meshes that do not match touch with few of theirs.

use super::assemble::SHARE;
use super::laws::{Faced, Facing};
use super::rows::{Pairing, Pull, Row};
use super::scene::ContactScene;
use super::vectors::gather_corners;
use crate::Vec3;
use crate::contact::{Contacts, closest_on_facet};
use crate::sim::controls::Controls;

/// A gap that no step closes, µm: what only rubs never pushes.
const FAR: f32 = 1e6;

/// Adds rows for atoms around which surfaces are in contact, eq. (adhesion.19), and which do not touch what they face. They rub
/// and do nothing else. Their force is found anew in each step: friction is known from the motion alone.
pub fn write_rubbing(
    model: &ContactScene,
    found: &Contacts,
    controls: &Controls,
    facing: &[Facing],
    positions: &[Vec3],
    rows: &mut Vec<Row>,
    pulls: &mut Vec<Pull>,
) {
    if !model.law.cohesion().is_some_and(|table| table.has_friction()) {
        return;
    }
    for this in facing {
        let body = model.body_of(this.atom);
        let friction = rubs(model, found, this);
        if friction == 0.0 {
            continue;
        }
        let own = friction * this.area * controls.adhesion_of(body as usize) * controls.adhesion_of_atom(this.atom);
        let (atoms, coordinates, normal, pairing, friction) = match this.other {
            Faced::Body(other) => {
                let corners = gather_corners(positions, this.facet);
                let [v, w] = closest_on_facet(positions[this.atom as usize], corners).weights;
                let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).try_normalize(0.0);
                let Some(normal) = normal else { continue };
                let [i, j, k] = this.facet;
                let of_other = controls.adhesion_of(other as usize)
                    * controls.adhesion_between([i, j, k], [1.0 - v - w, v, w].map(f64::from));
                let friction = SHARE * own * of_other;
                ([this.atom, i, j, k], [v, w], normal, Pairing::AtomOnFacet, friction)
            }
            Faced::Obstacle(obstacle) => {
                let normal = model.scene.obstacles[obstacle as usize].normal(&positions[this.atom as usize]);
                ([this.atom; 4], [0.0; 2], normal, Pairing::AtomOnObstacle, own)
            }
        };
        let [x, y, z] = [normal.x, normal.y, normal.z].map(|part| part as f32);
        let coordinates = coordinates.map(|coordinate| coordinate as f32);
        rows.push(Row {
            atoms,
            coordinates,
            normal_and_gap: [x, y, z, FAR],
            friction: friction as f32,
            pairing,
            ..Row::NOTHING
        });
        pulls.push(Pull::default());
    }
}

/// The friction with which an atom rubs on what it faces where it does not touch that, pN·s/µm³; 0 where it does.
pub(super) fn rubs(model: &ContactScene, found: &Contacts, this: &Facing) -> f64 {
    let friction = model.cohesion_of(model.body_of(this.atom), this.other).map_or(0.0, |cohesive| cohesive.friction);
    if friction == 0.0 || touches(model, found, this) { 0.0 } else { friction }
}

/// Whether an atom touches what it faces.
fn touches(model: &ContactScene, found: &Contacts, this: &Facing) -> bool {
    let reach = &model.scene.reach;
    match this.other {
        Faced::Body(other) => {
            let first = found.atoms.partition_point(|near| near.atom < this.atom);
            let mut of_atom = found.atoms[first..].iter().take_while(|near| near.atom == this.atom);
            of_atom.any(|near| reach.touches(near.gap) && near.body(&model.scene) == other)
        }
        Faced::Obstacle(obstacle) => {
            let at = found.obstacles.binary_search_by_key(&(this.atom, obstacle), |near| (near.atom, near.obstacle));
            at.is_ok_and(|at| reach.touches(found.obstacles[at].gap))
        }
    }
}
