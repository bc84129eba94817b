//! The energy of adhesion: surfaces in contact release energy with their area, which spreads contacts until surfaces under
//! tension meet at the angle of eq. (adhesion.10).

use super::assemble::SHARE;
use super::laws::Strength;
use super::scene::ContactScene;
use crate::Vec3;
use crate::contact::Contacts;
use crate::sim::controls::Controls;

/// Whether any surfaces in contact release energy.
pub fn releases_energy(model: &ContactScene) -> bool {
    let releases = |strength: &Strength| strength.energy > 0.0;
    model.between.iter().chain(&model.on_obstacles).any(releases)
}

/// Adds the forces of the energy that contacts release, eq. (adhesion.9), to those of all atoms. `relief` is scratch, one number an
/// atom.
pub fn add_spreading(
    model: &ContactScene,
    found: &Contacts,
    controls: &Controls,
    positions: &[Vec3],
    relief: &mut Vec<f64>,
    force: &mut [Vec3],
) {
    if !releases_energy(model) {
        return;
    }
    relieve(model, found, controls, relief);
    for body in &model.scene.bodies {
        let shape = &model.scene.shapes[body.shape as usize];
        let atoms = body.first_atom as usize..body.first_atom as usize + shape.atoms;
        let (relief, x, force) = (&relief[atoms.clone()], &positions[atoms.clone()], &mut force[atoms]);
        if relief.iter().all(|relief| *relief == 0.0) {
            continue;
        }
        spread(&shape.facets, relief, x, force);
    }
}

/// The forces of E = −Σ A min(w_i, w_j, w_k) over facets of area A, with `relief` w kept as it is. A facet that is not in
/// contact with all its corners is pulled as those outside are: with a part of the relief it would grow without touching anything.
fn spread(facets: &[[u32; 3]], relief: &[f64], x: &[Vec3], force: &mut [Vec3]) {
    for corners in facets {
        let [i, j, k] = corners.map(|corner| corner as usize);
        let least = relief[i].min(relief[j]).min(relief[k]);
        let normal = (x[j] - x[i]).cross(&(x[k] - x[i]));
        if let Some(normal) = normal.try_normalize(1e-300).filter(|_| least > 0.0) {
            for (corner, edge) in [(i, x[k] - x[j]), (j, x[i] - x[k]), (k, x[j] - x[i])] {
                force[corner] += 0.5 * least * normal.cross(&edge);
            }
        }
    }
}

/// What the surface at each atom releases an area, pN/µm: the most of what its contacts do.
fn relieve(model: &ContactScene, found: &Contacts, controls: &Controls, relief: &mut Vec<f64>) {
    let scene = &model.scene;
    relief.clear();
    relief.resize(scene.atoms, 0.0);
    let body_of = |atom: u32| scene.body_of_atom(atom) as usize;
    for contact in &found.atoms {
        let (body, other) = (body_of(contact.atom), contact.body(scene) as usize);
        if body != other && scene.reach.touches(contact.gap) {
            let strength = model.strength_between(body, other);
            let of_atom = controls.adhesion_of_atom(contact.atom);
            let energy = SHARE * strength.energy * of_atom * controls.adhesion_of(body) * controls.adhesion_of(other);
            let relief = &mut relief[contact.atom as usize];
            *relief = relief.max(energy);
        }
    }
    for contact in found.obstacles.iter().filter(|near| scene.reach.touches(near.gap)) {
        let body = body_of(contact.atom);
        let of_atom = controls.adhesion_of_atom(contact.atom);
        let energy = model.strength_on(body, contact.obstacle).energy * of_atom * controls.adhesion_of(body);
        let relief = &mut relief[contact.atom as usize];
        *relief = relief.max(energy);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{facet_areas, icosphere};

    #[test]
    fn forces_are_the_gradient_of_the_energy_that_contacts_release() {
        let mut surface = icosphere(5.0, 1);
        let relief: Vec<f64> =
            (0..surface.positions.len()).map(|i| if i % 3 == 0 { 0.0 } else { 7.0 * (i as f64).sin().abs() }).collect();
        let energy = |surface: &crate::geometry::Surface| -> f64 {
            let areas = facet_areas(surface);
            let least = |facet: &[u32; 3]| facet.iter().map(|&i| relief[i as usize]).fold(f64::INFINITY, f64::min);
            -areas.iter().zip(&surface.facets).map(|(area, facet)| area * least(facet)).sum::<f64>()
        };
        let mut force = vec![Vec3::zeros(); surface.positions.len()];
        spread(&surface.facets, &relief, &surface.positions, &mut force);
        for (atom, axis) in [(0, 0), (7, 1), (20, 2), (41, 0)] {
            let mut at = |shift: f64| {
                surface.positions[atom][axis] += shift;
                let energy = energy(&surface);
                surface.positions[atom][axis] -= shift;
                energy
            };
            let slope = (at(1e-4) - at(-1e-4)) / 2e-4;
            // Central differences: (1e-4)² times the third derivative, and round-off of 1e3 · 1e-16 / 1e-4.
            assert!((slope + force[atom][axis]).abs() < 1e-6, "{slope} against {}", force[atom][axis]);
        }
        let sum: Vec3 = force.iter().sum();
        assert!(sum.norm() < 1e-10, "{sum}");
    }
}
