//! Cells that come and go: what contacts carry keeps to the cells that stay.

use super::scene::ContactScene;
use super::state::{AdhesiveAtom, AtomBond, ContactState, EdgeBond, Faced, Link, ObstacleBond, SurfaceBonds};

/// From the numbers of before to those of now.
struct Renumbering<'a> {
    before: &'a ContactScene<'a>,
    now: &'a ContactScene<'a>,
    /// The number that each body has now; none of those that are no more.
    bodies: &'a [Option<u32>],
}

impl Renumbering<'_> {
    fn body(&self, body: u32) -> Option<u32> {
        self.bodies[body as usize]
    }

    /// A number counted from the first that a body has of them.
    fn of(&self, number: u32, body: u32, first: impl Fn(&crate::contact::Body) -> u32) -> Option<u32> {
        let now = self.body(body)?;
        let [before, now] = [(self.before, body), (self.now, now)].map(|(of, body)| &of.scene.bodies[body as usize]);
        Some(number - first(before) + first(now))
    }

    fn atom(&self, atom: u32) -> Option<u32> {
        self.of(atom, self.before.scene.body_of_atom(atom), |body| body.first_atom)
    }

    fn facet(&self, facet: u32) -> Option<u32> {
        self.of(facet, self.before.scene.body_of_facet(facet), |body| body.first_facet)
    }

    fn edge(&self, edge: u32) -> Option<u32> {
        self.of(edge, self.before.scene.body_of_edge(edge), |body| body.first_edge)
    }

    fn pair(&self, [one, other]: [u32; 2], number: impl Fn(&Self, u32) -> Option<u32>) -> Option<[u32; 2]> {
        Some([number(self, one)?, number(self, other)?])
    }

    fn surface_bonds(&self, bonds: &SurfaceBonds) -> Option<SurfaceBonds> {
        let other = match bonds.other {
            Faced::Body(body) => Faced::Body(self.body(body)?),
            obstacle @ Faced::Obstacle(_) => obstacle,
        };
        Some(SurfaceBonds { facet: self.facet(bonds.facet)?, other, ..*bonds })
    }

    fn link(&self, link: &Link) -> Option<Link> {
        let mut pairs = link.pairs;
        for pair in &mut pairs {
            *pair = self.pair(*pair, Self::atom)?;
        }
        Some(Link { facets: self.pair(link.facets, Self::facet)?, bodies: self.pair(link.bodies, Self::body)?, pairs })
    }
}

impl ContactState {
    /// What is carried between cells that stay, by the numbers of atoms, facets and edges among the cells that there are now;
    /// `bodies` are the numbers that those before have now. Numbers rise as before, so that all lists stay in order.
    pub(in crate::sim) fn renumbered(
        &self,
        before: &ContactScene,
        now: &ContactScene,
        bodies: &[Option<u32>],
    ) -> ContactState {
        let to = Renumbering { before, now, bodies };
        let atoms = self
            .atoms
            .iter()
            .filter_map(|bond| Some(AtomBond { atom: to.atom(bond.atom)?, facet: to.facet(bond.facet)?, ..*bond }));
        let edges = self
            .edges
            .iter()
            .filter_map(|bond| Some(EdgeBond { edges: to.pair(bond.edges, Renumbering::edge)?, ..*bond }));
        let obstacles =
            self.obstacles.iter().filter_map(|bond| Some(ObstacleBond { atom: to.atom(bond.atom)?, ..*bond }));
        ContactState {
            atoms: atoms.collect(),
            edges: edges.collect(),
            obstacles: obstacles.collect(),
            links: self.links.iter().filter_map(|link| to.link(link)).collect(),
            adhesives: adhesives(&to, &self.adhesives),
            released: self.released.iter().filter_map(|atom| to.atom(*atom)).collect(),
            bonds: self.bonds.iter().filter_map(|bonds| to.surface_bonds(bonds)).collect(),
        }
    }
}

/// Adhesives without the atoms of cells that are no more; each is named by the least atom that is left.
fn adhesives(to: &Renumbering, before: &[AdhesiveAtom]) -> Vec<AdhesiveAtom> {
    let mut all = Vec::new();
    for adhesive in before.chunk_by(|one, other| one.adhesive == other.adhesive) {
        let left = || adhesive.iter().filter_map(|one| Some(AdhesiveAtom { atom: to.atom(one.atom)?, ..*one }));
        let least = left().map(|one| one.atom).min();
        all.extend(left().zip(least.into_iter().cycle()).map(|(one, adhesive)| AdhesiveAtom { adhesive, ..one }));
    }
    all.sort_unstable_by_key(|one| (one.adhesive, one.atom));
    all
}
