//! Recruits atoms to virtual adhesives: who touches what sticks is cloned, and joins what it touches and its neighbours.

use super::scratch::{AdhesiveScratch, NONE, Role};
use super::table::{AdhesiveTable, Zones};
use crate::contact::{AtomContact, Contacts, ObstacleContact, Scene};
use crate::sim::contact::state::ContactState;
use crate::sim::controls::Controls;

/// How well surfaces are glued, with the factors that chemistry sets.
pub(super) struct Glue<'a> {
    pub(super) scene: &'a Scene,
    pub(super) table: &'a AdhesiveTable,
    pub(super) controls: &'a Controls,
}

impl Glue<'_> {
    /// The atom and the corners of the facet that it touches.
    pub(super) fn corners(&self, near: &AtomContact) -> [u32; 4] {
        let [i, j, k] = self.scene.facet_atoms(near.body(self.scene), near.facet);
        [near.atom, i, j, k]
    }

    /// The bodies of an atom and of the facet that it touches, and how well the two are glued, if it touches; a body not to itself.
    pub(super) fn kappa_of(&self, near: &AtomContact) -> ([u32; 2], f64) {
        let body = self.scene.body_of_atom(near.atom);
        let other = near.body(self.scene);
        let [kind, kind_of_other] = [body, other].map(|body| self.kind_of(body));
        let factors = self.controls.adhesion_of(body as usize) * self.controls.adhesion_of(other as usize);
        let kappa = self.table.between[kind * self.scene.shapes.len() + kind_of_other] * factors;
        ([body, other], if body == other || !self.scene.reach.touches(near.gap) { 0.0 } else { kappa })
    }

    /// How well an atom is glued to an obstacle that it touches.
    pub(super) fn kappa_on(&self, near: &ObstacleContact) -> f64 {
        if !self.scene.reach.touches(near.gap) {
            return 0.0;
        }
        let body = self.scene.body_of_atom(near.atom);
        let kappa = self.table.on_obstacles[self.kind_of(body) * self.scene.obstacles.len() + near.obstacle as usize];
        kappa * self.controls.adhesion_of(body as usize)
    }

    fn kind_of(&self, body: u32) -> usize {
        self.scene.bodies[body as usize].shape as usize
    }
}

impl AdhesiveScratch {
    /// Who touches what sticks, how well, and in which pair.
    pub(super) fn clone_atoms(&mut self, glue: &Glue, before: &ContactState, found: &Contacts) {
        let (scene, count) = (glue.scene, glue.scene.atoms);
        reset(&mut self.roles, count, Role::Far);
        reset(&mut self.kappa, count, 0.0);
        reset(&mut self.pair, count, ([NONE; 2], f64::INFINITY));
        reset(&mut self.grounded, count, false);
        let mut add = |atom: u32, kappa: f64, pair: [u32; 2], gap: f64, pressed: bool| {
            let i = atom as usize;
            self.kappa[i] = self.kappa[i].max(kappa);
            if (gap, pair) < (self.pair[i].1, self.pair[i].0) {
                self.pair[i] = (pair, gap);
            }
            let released = !pressed && before.released.binary_search(&atom).is_ok();
            if !released {
                self.roles[i] = Role::Cloned;
            } else if self.roles[i] == Role::Far {
                self.roles[i] = Role::Released;
            }
        };
        for near in &found.atoms {
            let ([body, other], kappa) = glue.kappa_of(near);
            if kappa > 0.0 {
                let at = before.atoms.partition_point(|bond| bond.atom < near.atom);
                let mut bonds = before.atoms[at..].iter().take_while(|bond| bond.atom == near.atom);
                let pressed = bonds.any(|bond| bond.body(scene) == other && bond.force != [0.0; 3]);
                let pair = [body.min(other), body.max(other)];
                glue.corners(near).into_iter().for_each(|atom| add(atom, kappa, pair, near.gap, pressed));
            }
        }
        for near in &found.obstacles {
            let kappa = glue.kappa_on(near);
            if kappa > 0.0 {
                let at =
                    before.obstacles.partition_point(|bond| (bond.atom, bond.obstacle) < (near.atom, near.obstacle));
                let same =
                    before.obstacles.get(at).filter(|bond| (bond.atom, bond.obstacle) == (near.atom, near.obstacle));
                let pressed = same.is_some_and(|bond| bond.force != [0.0; 3]);
                let pair = [scene.body_of_atom(near.atom), scene.bodies.len() as u32 + near.obstacle];
                add(near.atom, kappa, pair, near.gap, pressed);
                self.grounded[near.atom as usize] = true;
            }
        }
    }

    /// Joins atoms that touch each other, that were in one adhesive, and that are neighbours on a mesh.
    pub(super) fn join(&mut self, glue: &Glue, before: &ContactState, found: &Contacts) {
        let (scene, zones) = (glue.scene, glue.table.zones);
        self.parent.clear();
        self.parent.extend(0..scene.atoms as u32);
        let (roles, pair, parent) = (&self.roles, &self.pair, &mut self.parent);
        let cloned = |atom: u32| roles[atom as usize] == Role::Cloned;
        let mut unite = |one: u32, other: u32| {
            let alike = || zones == Zones::Merged || pair[one as usize].0 == pair[other as usize].0;
            if cloned(one) && cloned(other) && alike() {
                let (one, other) = (root(parent, one), root(parent, other));
                parent[one.max(other) as usize] = one.min(other);
            }
        };
        for near in found.atoms.iter().filter(|near| glue.kappa_of(near).1 > 0.0) {
            let [first, others @ ..] = glue.corners(near);
            others.into_iter().for_each(|other| unite(first, other));
        }
        for adhesive in before.adhesives.chunk_by(|one, other| one.adhesive == other.adhesive) {
            // Those of one adhesive may be of several pairs: each is joined with the next that is of its own.
            for (number, one) in adhesive.iter().enumerate() {
                let mut others = adhesive[number + 1..].iter().map(|other| other.atom).filter(|atom| cloned(*atom));
                let alike = |atom: &u32| zones == Zones::Merged || pair[*atom as usize].0 == pair[one.atom as usize].0;
                if let Some(other) = others.find(alike) {
                    unite(one.atom, other);
                }
            }
        }
        for body in &scene.bodies {
            let shape = &scene.shapes[body.shape as usize];
            for [one, other] in &shape.edges {
                unite(body.first_atom + one, body.first_atom + other);
            }
        }
    }
}

/// The least atom joined with one; shortens the path to it.
pub(super) fn root(parent: &mut [u32], mut atom: u32) -> u32 {
    while parent[atom as usize] != atom {
        parent[atom as usize] = parent[parent[atom as usize] as usize];
        atom = parent[atom as usize];
    }
    atom
}

/// Makes a list as long as this, all alike.
pub(super) fn reset<T: Clone>(list: &mut Vec<T>, count: usize, value: T) {
    list.clear();
    list.resize(count, value);
}
