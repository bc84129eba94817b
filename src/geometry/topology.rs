//! Who is whose neighbour on a surface: its edges, the ring of neighbours around every atom, and the pairs of
//! facets that share an edge.

use super::Surface;

/// The neighbours of one atom in the order in which they stand around it, counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Ring {
    /// The neighbours. A closed ring starts at the neighbour with the smallest number, an open one at the boundary.
    pub atoms: Vec<u32>,
    /// Whether the last neighbour is joined to the first by a facet; false on the boundary of an open surface.
    pub closed: bool,
}

/// Two facets that share an edge: `(a, b, c)` on its left and `(b, a, d)` on its right, with `a < b`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Flap {
    /// First atom of the shared edge.
    pub a: u32,
    /// Second atom of the shared edge.
    pub b: u32,
    /// The atom across the edge in the facet that runs from `a` to `b`.
    pub c: u32,
    /// The atom across the edge in the facet that runs from `b` to `a`.
    pub d: u32,
    /// The numbers of the two facets, the one with `c` first.
    pub facets: [u32; 2],
}

/// How the atoms of a surface hang together. It depends on the facets only, not on the positions, and its order
/// depends on nothing but the numbers of the atoms.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Topology {
    /// Every edge once, smaller atom first, sorted.
    pub edges: Vec<[u32; 2]>,
    /// The edges that belong to one facet only, in the direction of that facet, sorted. Empty on a closed surface.
    pub boundary: Vec<[u32; 2]>,
    /// One ring per atom; empty for an atom without facets.
    pub rings: Vec<Ring>,
    /// The interior edges with the facets on both sides, in the order of `edges`.
    pub flaps: Vec<Flap>,
    /// The facets around each atom in the order of its ring: facet `k` lies between neighbours `k` and `k + 1`.
    pub atom_facets: Vec<Vec<u32>>,
}

/// One side of a facet: the edge from `from` to `to`, the atom across it and the facet it belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct HalfEdge {
    pub from: u32,
    pub to: u32,
    pub across: u32,
    pub facet: u32,
}

impl HalfEdge {
    /// The edge without its direction.
    pub fn edge(&self) -> [u32; 2] {
        [self.from.min(self.to), self.from.max(self.to)]
    }
}

/// The three sides of every facet, sorted by edge; of the two sides of an edge the one from the smaller atom first.
pub(super) fn half_edges(facets: &[[u32; 3]]) -> Vec<HalfEdge> {
    let mut sides = Vec::with_capacity(3 * facets.len());
    for (number, &[a, b, c]) in facets.iter().enumerate() {
        let facet = number as u32;
        sides.push(HalfEdge { from: a, to: b, across: c, facet });
        sides.push(HalfEdge { from: b, to: c, across: a, facet });
        sides.push(HalfEdge { from: c, to: a, across: b, facet });
    }
    sides.sort_unstable_by_key(|side| (side.edge(), side.from, side.facet));
    sides
}

impl Topology {
    /// Reads the neighbourhoods off the facets of a surface.
    ///
    /// Made for surfaces that [`check_surface`](super::check_surface) accepts. Where a surface is not manifold the
    /// ring of an atom holds only its first fan of facets, and edges of three or more facets make no flap.
    ///
    /// # Panics
    /// When a facet names an atom that the surface does not have.
    pub fn of(surface: &Surface) -> Self {
        let sides = half_edges(&surface.facets);
        let mut topology = Self::default();
        for of_edge in sides.chunk_by(|left, right| left.edge() == right.edge()) {
            topology.edges.push(of_edge[0].edge());
            match of_edge {
                [only] => topology.boundary.push([only.from, only.to]),
                [left, right] if left.from != right.from => topology.flaps.push(Flap {
                    a: left.from,
                    b: left.to,
                    c: left.across,
                    d: right.across,
                    facets: [left.facet, right.facet],
                }),
                _ => {}
            }
        }
        topology.boundary.sort_unstable();

        // For atom `across`, its facet leads from neighbour `from` to neighbour `to`.
        let mut links = vec![Vec::new(); surface.positions.len()];
        for side in &sides {
            links[side.across as usize].push((side.from, side.to, side.facet));
        }
        for mut around in links {
            let (ring, facets) = walk_around(&mut around);
            topology.rings.push(ring);
            topology.atom_facets.push(facets);
        }
        topology
    }

    /// Whether the surface has no boundary.
    pub fn is_closed(&self) -> bool {
        self.boundary.is_empty()
    }

    /// Vertices − edges + facets of the atoms in use: 2 for a closed surface like a sphere, 1 for a sheet.
    pub fn euler_characteristic(&self) -> i64 {
        let atoms = self.rings.iter().filter(|ring| !ring.atoms.is_empty()).count() as i64;
        let corners: usize = self.atom_facets.iter().map(Vec::len).sum();
        atoms - self.edges.len() as i64 + (corners / 3) as i64
    }
}

/// Walks from facet to facet around one atom. `links` are its facets as (neighbour, next neighbour, facet).
fn walk_around(links: &mut [(u32, u32, u32)]) -> (Ring, Vec<u32>) {
    links.sort_unstable();
    let mut entered: Vec<u32> = links.iter().map(|link| link.1).collect();
    entered.sort_unstable();
    let has_one_before = |atom: u32| entered.binary_search(&atom).is_ok();
    let Some(start) = links.iter().find(|link| !has_one_before(link.0)).or(links.first()) else {
        return (Ring::default(), Vec::new());
    };
    let first = start.0;
    let mut ring = Ring { atoms: vec![first], closed: false };
    let mut facets = Vec::with_capacity(links.len());
    let mut here = first;
    while let Ok(found) = links.binary_search_by_key(&here, |link| link.0) {
        facets.push(links[found].2);
        here = links[found].1;
        if here == first {
            ring.closed = true;
            break;
        }
        ring.atoms.push(here);
        if facets.len() == links.len() {
            break; // the other end of the boundary, or (not manifold) a loop that does not pass through its start
        }
    }
    (ring, facets)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{icosphere, octasphere, sheet};

    #[test]
    fn a_sphere_is_closed_and_has_euler_characteristic_two() {
        for surface in [icosphere(1.0, 0), icosphere(1.0, 2), octasphere(1.0, 4)] {
            let topology = Topology::of(&surface);
            assert!(topology.is_closed());
            assert_eq!(topology.euler_characteristic(), 2);
            assert_eq!(topology.edges.len() * 2, surface.facets.len() * 3);
            assert_eq!(topology.flaps.len(), topology.edges.len());
            assert!(topology.edges.is_sorted());
        }
    }

    #[test]
    fn rings_follow_the_facets_counter_clockwise() {
        let surface = icosphere(2.0, 2);
        let topology = Topology::of(&surface);
        for (atom, ring) in topology.rings.iter().enumerate() {
            assert!(ring.closed);
            assert_eq!(ring.atoms.iter().min(), ring.atoms.first());
            assert_eq!(ring.atoms.len(), topology.atom_facets[atom].len());
            for (k, &facet) in topology.atom_facets[atom].iter().enumerate() {
                let mut corners = surface.facets[facet as usize];
                while corners[0] as usize != atom {
                    corners.rotate_left(1);
                }
                assert_eq!(corners[1], ring.atoms[k]);
                assert_eq!(corners[2], ring.atoms[(k + 1) % ring.atoms.len()]);
            }
        }
        let fives = topology.rings.iter().filter(|ring| ring.atoms.len() == 5).count();
        assert_eq!(fives, 12, "an icosphere keeps the twelve corners of the icosahedron");
    }

    #[test]
    fn flaps_name_the_two_facets_of_their_edge() {
        let surface = octasphere(1.0, 3);
        for flap in Topology::of(&surface).flaps {
            for (facet, wanted) in flap.facets.iter().zip([[flap.a, flap.b, flap.c], [flap.b, flap.a, flap.d]]) {
                let mut corners = surface.facets[*facet as usize];
                while corners[0] != wanted[0] {
                    corners.rotate_left(1);
                }
                assert_eq!(corners, wanted);
            }
        }
    }

    #[test]
    fn rings_on_a_boundary_are_open_and_start_and_end_there() {
        let surface = sheet(3.0, 2.0, 3, 2);
        let topology = Topology::of(&surface);
        assert_eq!(topology.euler_characteristic(), 1);
        assert_eq!(topology.boundary.len(), 2 * (3 + 2));
        let open = topology.rings.iter().filter(|ring| !ring.closed).count();
        assert_eq!(open, 2 * (3 + 2));
        for (atom, ring) in topology.rings.iter().enumerate().filter(|(_, ring)| !ring.closed) {
            let ends = [ring.atoms[0], *ring.atoms.last().unwrap()];
            assert!(topology.boundary.contains(&[atom as u32, ends[0]]));
            assert!(topology.boundary.contains(&[ends[1], atom as u32]));
            assert_eq!(ring.atoms.len(), topology.atom_facets[atom].len() + 1);
        }
    }

    #[test]
    fn the_order_does_not_depend_on_the_order_of_the_facets() {
        let surface = icosphere(1.0, 1);
        let mut shuffled = surface.clone();
        shuffled.facets.reverse();
        let (one, other) = (Topology::of(&surface), Topology::of(&shuffled));
        assert_eq!((one.edges, one.rings), (other.edges, other.rings));
    }

    #[test]
    fn an_atom_without_facets_has_an_empty_ring() {
        let mut surface = icosphere(1.0, 0);
        surface.positions.push(crate::Vec3::zeros());
        assert!(Topology::of(&surface).rings[12].atoms.is_empty());
    }
}
