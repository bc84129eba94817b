//! What the forces on a type of cells are made from, and where they go.

use super::super::Document;
use super::super::selection::{LinkPattern, Linked, Selection};
use super::model::FromModel;
use super::select::{self, mirrored};
use crate::Vec3;
use crate::error::{Error, Fault};
use crate::geometry::{Surface, Topology};
use crate::mechanics::Force;
use std::path::{Path, PathBuf};

/// A surface as its mesh is made, and turned as the document says.
pub struct Built {
    /// Before it is turned: symmetric about the z axis where the shape is.
    pub plain: Surface,
    /// Turned.
    pub turned: Surface,
    /// What fills it, if anything does: then atoms inside follow those of the surface.
    pub inside: Option<Inside>,
    /// The physical model that it came from, if it did.
    pub model: Option<FromModel>,
}

/// What fills a body, see [`Solid`](crate::geometry::Solid).
#[derive(Debug)]
pub struct Inside {
    /// Its tetrahedra.
    pub tetrahedra: Vec<[u32; 4]>,
    /// Where those of each cell begin.
    pub cells: Vec<u32>,
    /// The edges of the cells.
    pub edges: Vec<[u32; 2]>,
}

/// Makes the forces on a type of cells.
pub struct Builder<'a> {
    document: &'a Document,
    /// The key of the type, `cells.NAME`.
    key: &'a str,
    built: &'a Built,
    /// The neighbours in its mesh.
    pub topology: Topology,
    /// The forces so far, in the order in which they are added up.
    pub forces: Vec<Force>,
    /// Pairs of atoms that are drawn.
    pub drawn: Vec<[u32; 2]>,
    faults: &'a mut Vec<Fault>,
}

impl<'a> Builder<'a> {
    /// For the type at this key; faults are what only its mesh can tell.
    pub fn new(document: &'a Document, key: &'a str, built: &'a Built, faults: &'a mut Vec<Fault>) -> Self {
        let topology = Topology::of(&built.turned);
        Self { document, key, built, topology, forces: Vec::new(), drawn: Vec::new(), faults }
    }

    /// The mesh at rest, turned as the document says.
    pub fn rest(&self) -> &'a Surface {
        &self.built.turned
    }

    /// The mesh at rest before it is turned.
    pub fn plain(&self) -> &'a Surface {
        &self.built.plain
    }

    /// What fills the body, if anything does.
    pub fn inside(&self) -> Option<&'a Inside> {
        self.built.inside.as_ref()
    }

    /// Tells a fault at a key of the type.
    pub fn fault(&mut self, path: &str, label: &str, found: impl Into<String>, help: impl Into<String>) {
        let location = self.document.location(&format!("{}.{path}", self.key), label);
        self.faults.push(location.into_iter().fold(Fault::new(found).help(help), Fault::at));
    }

    /// A path as the document writes it, from where it stands.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.document.resolve(path)
    }

    /// Tells the faults of a file at a key of the type that names it.
    pub fn faults_at(&mut self, path: &str, label: &str, error: Error) {
        let location = self.document.location(&format!("{}.{path}", self.key), label);
        let Error::Input(found) = error else {
            return self.fault(path, label, error.to_string(), "give another file");
        };
        self.faults.extend(found.into_iter().map(|fault| match (&fault.location, &location) {
            (None, Some(location)) => fault.at(location.clone()),
            _ => fault,
        }));
    }

    /// The atoms that the selection at a key means, each once, rising; those that the mesh does not have are faults.
    pub fn atoms(&mut self, path: &str, selection: &Selection) -> Vec<u32> {
        select::atoms(self.document, &format!("{}.{path}", self.key), selection, self.rest(), self.faults)
    }

    /// The same, and the height of every atom of the mesh in its cap, eq. (loads.1).
    pub fn atoms_and_heights(&mut self, path: &str, selection: &Selection, up: Vec3) -> (Vec<u32>, Vec<f64>) {
        (self.atoms(path, selection), select::heights(selection, up, self.rest()))
    }

    /// The pairs of atoms that are linked at a key; those that the mesh does not have are faults.
    pub fn pairs(&mut self, path: &str, linked: &Linked) -> Vec<[u32; 2]> {
        let mut pairs = match linked {
            Linked::Pairs(pairs) => pairs.clone(),
            Linked::Pattern(LinkPattern::Horizontal) => mirrored(self.plain(), |p| Vec3::new(-p.x, -p.y, p.z)),
            Linked::Pattern(LinkPattern::Diagonal) => mirrored(self.plain(), |p| -p),
        };
        let atoms = self.plain().positions.len();
        let mut number = 0;
        pairs.retain(|&[from, to]| {
            let exists = (from as usize) < atoms && (to as usize) < atoms && from != to;
            if !exists {
                let found = format!("atoms {from} and {to} cannot be linked: the mesh has {atoms} atoms");
                let help = format!("give two different atoms from 0 to {}", atoms - 1);
                self.fault(&format!("{path}.pairs[{number}]"), "not two atoms of this mesh", found, help);
            }
            number += 1;
            exists
        });
        pairs
    }
}
