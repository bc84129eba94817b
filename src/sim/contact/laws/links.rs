//! Dynamic links (Promayon, Martiel and Tracqui 2003): facets of two cells that collide are joined by springs between their
//! atoms, and let each other go when they are too far apart.

use crate::Vec3;
use crate::contact::{AtomContact, Contacts, EdgeContact, Scene};
use crate::sim::contact::state::Link;
use crate::sim::controls::Controls;

/// Which kinds are linked, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkTable {
    /// Stiffness of the spring between two atoms, pN/µm: `stiffness[kind * kinds + other]`, symmetric; 0 binds nothing.
    pub stiffness: Vec<f64>,
    /// Root mean square of the lengths of its three springs above which a link breaks, µm.
    pub range: f64,
}

/// Links of a step.
#[derive(Debug, Clone, Default)]
pub struct LinkScratch {
    /// In their order.
    pub links: Vec<Link>,
    /// Facets that have one.
    taken: Vec<bool>,
}

impl LinkScratch {
    /// No links.
    pub(super) fn clear(&mut self) {
        self.links.clear();
        self.taken.clear();
    }
}

/// Choices of partners that give each corner of a facet one of another.
const PERMUTATIONS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

impl Link {
    /// Joins two facets by the pairs of atoms that are nearest to each other taken together.
    fn between(scene: &Scene, bodies: [u32; 2], facets: [u32; 2], positions: &[Vec3]) -> Self {
        let (bodies, facets) =
            if facets[0] < facets[1] { (bodies, facets) } else { ([bodies[1], bodies[0]], [facets[1], facets[0]]) };
        let [own, other] = [0, 1].map(|side| scene.facet_atoms(bodies[side], facets[side]));
        let choices =
            PERMUTATIONS.map(|order| Self { facets, bodies, pairs: [0, 1, 2].map(|i| [own[i], other[order[i]]]) });
        let squared = |link: &Self| link.squared(positions);
        let nearest = choices.iter().min_by(|one, other| squared(one).total_cmp(&squared(other)));
        *nearest.unwrap_or(&choices[0])
    }

    /// The sum of the squared lengths of its springs, µm².
    fn squared(&self, positions: &[Vec3]) -> f64 {
        self.pairs
            .iter()
            .map(|[one, other]| (positions[*one as usize] - positions[*other as usize]).norm_squared())
            .sum()
    }
}

impl LinkTable {
    /// A table that links nothing.
    pub fn new(kinds: usize, range: f64) -> Self {
        Self { stiffness: vec![0.0; kinds * kinds], range }
    }

    /// Whether the springs of a link hold, of this summed squared length (µm²).
    fn holds(&self, squared: f64) -> bool {
        squared <= 3.0 * self.range * self.range
    }

    /// The stiffness of the springs between two bodies, pN/µm.
    fn stiffness_between(&self, scene: &Scene, bodies: [u32; 2], controls: &Controls) -> f64 {
        let [kind, other] = bodies.map(|body| scene.bodies[body as usize].shape as usize);
        let factors = bodies.map(|body| controls.adhesion_of(body as usize));
        self.stiffness[kind * scene.shapes.len() + other] * factors[0] * factors[1]
    }

    /// Finds the links at an instant: those that hold of the ones before, and new ones between facets that collide. A facet has
    /// one link at most.
    pub fn find(
        &self,
        scene: &Scene,
        controls: &Controls,
        before: &[Link],
        found: &Contacts,
        positions: &[Vec3],
        now: &mut LinkScratch,
    ) {
        let LinkScratch { links, taken } = now;
        links.clear();
        taken.clear();
        taken.resize(scene.facets, false);
        let mut add = |link: Link| {
            let free = link.facets.iter().all(|facet| !taken[*facet as usize]);
            let binds = self.stiffness_between(scene, link.bodies, controls) > 0.0;
            if free && binds && self.holds(link.squared(positions)) {
                link.facets.iter().for_each(|facet| taken[*facet as usize] = true);
                links.push(link);
            }
        };
        before.iter().for_each(|link| add(*link));
        let mut body = 0;
        for near in found.atoms.iter().filter(|near| scene.reach.touches(near.gap)) {
            while scene.bodies.get(body + 1).is_some_and(|next| next.first_atom <= near.atom) {
                body += 1;
            }
            let other = near.body(scene);
            if body as u32 != other
                && let Some(facet) = facing(scene, body as u32, near, positions)
            {
                add(Link::between(scene, [body as u32, other], [facet, near.facet], positions));
            }
        }
        let touching = found.edges.iter().filter(|near| scene.reach.touches(near.gap));
        for near in touching.filter(|near| near.bodies(scene)[0] != near.bodies(scene)[1]) {
            if let Some(facets) = facing_at_edges(scene, near, positions) {
                add(Link::between(scene, near.bodies(scene), facets, positions));
            }
        }
        links.sort_unstable();
    }

    /// Adds the forces of links to those of all atoms, eq. (adhesion.11), and returns their energy, pN·µm: less than nothing where
    /// they hold, and nothing where they break.
    pub fn add_forces(
        &self,
        scene: &Scene,
        controls: &Controls,
        links: &[Link],
        positions: &[Vec3],
        force: &mut [Vec3],
    ) -> f64 {
        self.act(scene, controls, links, positions, |atom, pull| force[atom as usize] += pull)
    }

    /// As [`add_forces`](Self::add_forces), telling each atom and the force on it.
    pub(in crate::sim::contact) fn act(
        &self,
        scene: &Scene,
        controls: &Controls,
        links: &[Link],
        positions: &[Vec3],
        mut tell: impl FnMut(u32, Vec3),
    ) -> f64 {
        let mut energy = 0.0;
        for link in links {
            let stiffness = self.stiffness_between(scene, link.bodies, controls);
            for [one, other] in link.pairs {
                let pull = stiffness * (positions[other as usize] - positions[one as usize]);
                tell(one, pull);
                tell(other, -pull);
            }
            energy += 0.5 * stiffness * (link.squared(positions) - 3.0 * self.range * self.range);
        }
        energy
    }
}

/// The normal of a facet of a body, not of unit length.
fn normal_of(scene: &Scene, body: u32, facet: u32, positions: &[Vec3]) -> Vec3 {
    let [a, b, c] = scene.facet_atoms(body, facet).map(|atom| positions[atom as usize]);
    (b - a).cross(&(c - a))
}

/// How much a facet faces a direction: −1 when it looks against it.
fn along(scene: &Scene, body: u32, facet: u32, direction: &Vec3, positions: &[Vec3]) -> f64 {
    let normal = normal_of(scene, body, facet, positions);
    normal.dot(direction) / normal.norm().max(f64::MIN_POSITIVE)
}

/// The facets around an atom of a body, numbered through the scene.
fn around(scene: &Scene, body: u32, atom: u32) -> impl Iterator<Item = u32> {
    let of = scene.bodies[body as usize];
    scene.shape(body).around((atom - of.first_atom) as usize).iter().map(move |facet| facet + of.first_facet)
}

/// The facet around an atom in contact that looks most against what it touches.
fn facing(scene: &Scene, body: u32, near: &AtomContact, positions: &[Vec3]) -> Option<u32> {
    let normal = near.normal.wide();
    let turned = |facet: &u32| along(scene, body, *facet, &normal, positions);
    let facets = around(scene, body, near.atom);
    facets.min_by(|one, other| turned(one).total_cmp(&turned(other)))
}

/// The facets beside two edges in contact that look most against each other; none at the rim of a sheet.
fn facing_at_edges(scene: &Scene, near: &EdgeContact, positions: &[Vec3]) -> Option<[u32; 2]> {
    let (bodies, normal) = (near.bodies(scene), near.normal.wide());
    let most = |side: usize, sign: f64| {
        let body = bodies[side];
        let [one, other] = scene.edge_atoms(body, near.edges[side]);
        let beside = around(scene, body, one).filter(|facet| scene.facet_atoms(body, *facet).contains(&other));
        let turned = |facet: &u32| sign * along(scene, body, *facet, &normal, positions);
        beside.min_by(|one, other| turned(one).total_cmp(&turned(other)))
    };
    Some([most(0, 1.0)?, most(1, -1.0)?])
}
