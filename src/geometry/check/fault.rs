//! What can be wrong with a surface, in words.

use crate::error::Fault;
use std::fmt;

/// One thing that is wrong with a surface. Atoms and facets are counted from 0, as in the arrays of a [`Surface`].
///
/// [`Surface`]: crate::geometry::Surface
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum MeshFault {
    /// The surface has no facets.
    Empty,
    /// A facet names an atom that does not exist.
    AtomOutOfRange {
        /// The facet.
        facet: u32,
        /// Its atoms.
        atoms: [u32; 3],
        /// How many atoms there are.
        count: usize,
    },
    /// A position is NaN or infinite.
    NotFinite {
        /// The atom.
        atom: u32,
        /// Its position, µm.
        position: [f64; 3],
    },
    /// A facet names an atom twice.
    RepeatedAtom {
        /// The facet.
        facet: u32,
        /// Its atoms.
        atoms: [u32; 3],
    },
    /// An atom belongs to no facet.
    UnusedAtom {
        /// The atom.
        atom: u32,
    },
    /// Two atoms stand at the same point.
    DuplicateAtoms {
        /// The two atoms.
        atoms: [u32; 2],
        /// Their position, µm.
        position: [f64; 3],
    },
    /// An edge is shared by three facets or more.
    CrowdedEdge {
        /// The ends of the edge.
        edge: [u32; 2],
        /// The facets that share it.
        facets: Vec<u32>,
    },
    /// Two neighbouring facets face to opposite sides.
    OpposedFacets {
        /// The ends of the edge that both run along in the same direction.
        edge: [u32; 2],
        /// The two facets.
        facets: [u32; 2],
    },
    /// The surface has a hole, where it must be closed.
    BoundaryEdge {
        /// The ends of the edge.
        edge: [u32; 2],
        /// The only facet at this edge.
        facet: u32,
    },
    /// Facets meet at an atom in several separate fans.
    PinchedAtom {
        /// The atom.
        atom: u32,
        /// How many fans meet there.
        fans: usize,
    },
    /// The facets fall into several surfaces that do not touch.
    SeparateSurfaces {
        /// How many.
        count: usize,
        /// One facet of each of the first ten.
        facets: Vec<u32>,
    },
    /// A facet is too thin to compute with.
    Sliver {
        /// The facet.
        facet: u32,
        /// Its atoms.
        atoms: [u32; 3],
        /// Its quality, see [`facet_qualities`](crate::geometry::facet_qualities).
        quality: f64,
        /// The least quality that is accepted.
        least: f64,
    },
    /// The facets of a closed surface face inwards.
    Inverted {
        /// Its negative volume, µm³.
        volume: f64,
    },
    /// A closed surface encloses nothing.
    ZeroVolume {
        /// Its volume, µm³.
        volume: f64,
        /// Its area, µm².
        area: f64,
    },
    /// Two faults of a kind or more.
    Several {
        /// How many.
        count: usize,
        /// Of what, in the plural ("slivers").
        what: &'static str,
        /// The first few of them.
        first: Vec<MeshFault>,
    },
}

impl fmt::Display for MeshFault {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(out, "the mesh has no facets"),
            Self::AtomOutOfRange { facet, atoms, count } => {
                write!(
                    out,
                    "facet {facet} (atoms {}) names an atom that the mesh, with {count} atoms, does not have",
                    list(atoms)
                )
            }
            Self::NotFinite { atom, position: [x, y, z] } => {
                write!(out, "the position of atom {atom} is not a number: ({x}, {y}, {z})")
            }
            Self::RepeatedAtom { facet, atoms } => {
                write!(out, "facet {facet} (atoms {}) names an atom twice", list(atoms))
            }
            Self::UnusedAtom { atom } => write!(out, "atom {atom} belongs to no facet"),
            Self::DuplicateAtoms { atoms: [one, other], position: [x, y, z] } => {
                write!(out, "atoms {one} and {other} stand at the same place, ({x}, {y}, {z}) um")
            }
            Self::CrowdedEdge { edge: [a, b], facets } => {
                write!(
                    out,
                    "the edge between atoms {a} and {b} is shared by {} facets ({})",
                    facets.len(),
                    list(facets)
                )
            }
            Self::OpposedFacets { edge: [a, b], facets: [one, other] } => {
                write!(out, "facets {one} and {other} face to opposite sides: both run from atom {a} to atom {b}")
            }
            Self::BoundaryEdge { edge: [a, b], facet } => {
                write!(
                    out,
                    "the mesh is open: facet {facet} has no neighbour across the edge from atom {a} to atom {b}"
                )
            }
            Self::PinchedAtom { atom, fans } => write!(out, "{fans} separate fans of facets meet at atom {atom}"),
            Self::SeparateSurfaces { count, facets } => {
                write!(out, "the mesh is made of {count} separate surfaces (facets {}, one in each)", list(facets))
            }
            Self::Sliver { facet, atoms, quality, least } => {
                write!(
                    out,
                    "facet {facet} (atoms {}) is a sliver: its quality is {quality:.1e}, the least accepted {least}",
                    list(atoms)
                )
            }
            Self::Inverted { volume } => {
                write!(out, "the mesh is inverted: its facets are oriented inwards (volume {volume:.4} um^3)")
            }
            Self::ZeroVolume { volume, area } => {
                write!(out, "the mesh encloses no volume ({volume:.1e} um^3 inside an area of {area:.4} um^2)")
            }
            Self::Several { count, what, first } => {
                let open = if matches!(first[..], [Self::BoundaryEdge { .. }, ..]) { "is open: it " } else { "" };
                let positions = first.iter().map(Self::position).collect::<Vec<_>>().join("; ");
                let more = if *count > first.len() { "; …" } else { "" };
                write!(out, "the mesh {open}has {count} {what}: {positions}{more}")
            }
        }
    }
}

impl std::error::Error for MeshFault {}

impl MeshFault {
    /// Where it is, in the fewest words.
    fn position(&self) -> String {
        match self {
            Self::AtomOutOfRange { facet, atoms, .. } | Self::RepeatedAtom { facet, atoms } => {
                format!("facet {facet} (atoms {})", list(atoms))
            }
            Self::NotFinite { atom, .. } | Self::UnusedAtom { atom } | Self::PinchedAtom { atom, .. } => {
                format!("atom {atom}")
            }
            Self::DuplicateAtoms { atoms: [one, other], .. } => format!("atoms {one} and {other}"),
            Self::CrowdedEdge { edge: [a, b], .. } => format!("from atom {a} to atom {b}"),
            Self::OpposedFacets { facets: [one, other], .. } => format!("facets {one} and {other}"),
            Self::BoundaryEdge { edge: [a, b], facet } => format!("of facet {facet}, from atom {a} to atom {b}"),
            Self::Sliver { facet, atoms, quality, .. } => {
                format!("facet {facet} (atoms {}), of quality {quality:.1e}", list(atoms))
            }
            Self::Empty
            | Self::SeparateSurfaces { .. }
            | Self::Inverted { .. }
            | Self::ZeroVolume { .. }
            | Self::Several { .. } => self.to_string(),
        }
    }

    /// What was expected and what to do about it.
    pub fn help(&self) -> &'static str {
        match self {
            Self::Empty => "give at least one triangle; a closed cell has at least 4",
            Self::AtomOutOfRange { .. } => "check the facets against the list of positions",
            Self::NotFinite { .. } => "give finite coordinates",
            Self::RepeatedAtom { .. } => "the three corners must differ; remove the facet",
            Self::UnusedAtom { .. } => "remove atoms without facets: nothing would hold them",
            Self::DuplicateAtoms { .. } => "merge points that coincide (\"merge by distance\" in a mesh editor)",
            Self::CrowdedEdge { .. } => "at most 2 facets may share an edge; remove inner walls and doubled facets",
            Self::OpposedFacets { .. } => {
                "orient all facets alike, counter-clockwise from outside (\"recalculate normals\" in a mesh editor)"
            }
            Self::BoundaryEdge { .. } => "a cell encloses a volume: close the hole, and merge points that coincide",
            Self::PinchedAtom { .. } => "facets around an atom must form one fan; give each fan an atom of its own",
            Self::SeparateSurfaces { .. } => "give one surface per mesh; a second cell is a mesh of its own",
            Self::Sliver { .. } => "quality is 4 sqrt(3) area / (sum of squared edges), 1 at best; remesh that region",
            Self::Inverted { .. } => "flip the orientation of all facets (\"flip normals\" in a mesh editor)",
            Self::ZeroVolume { .. } => "give a body with an inside, not a folded sheet",
            Self::Several { first, .. } => first.first().map_or("", Self::help),
        }
    }

    /// The fault as bad input of the mesh `mesh`, named as the user knows it ("mesh `cell.obj`").
    pub fn into_fault(self, mesh: &str) -> Fault {
        let (fault, help) = (Fault::new(format!("{mesh}: {self}")), self.help());
        match self {
            Self::Empty | Self::Inverted { .. } | Self::ZeroVolume { .. } => fault.help(help),
            // Mesh formats count from 1 or not at all.
            _ => fault.help(format!("{help}; atoms and facets are counted from 0")),
        }
    }
}

/// Numbers with commas; the first ten of them.
fn list(numbers: &[u32]) -> String {
    let mut text = numbers.iter().take(10).map(u32::to_string).collect::<Vec<_>>().join(", ");
    if numbers.len() > 10 {
        text.push_str(" …");
    }
    text
}
