//! PML, the physical model language: atoms, cells that join them, and components that group both.
//!
//! The exclusive components are the model proper; the informative ones are labels, selections and surfaces to be shown.
//! Names stand as the document has them, blanks at their ends included. No unit of length is told: files are in mm as a
//! rule. Attributes that the language does not know are custom properties (`mass`, `phymulType`, `young` …).

mod make;
mod read;
mod read_structures;
mod references;
mod seen;
mod solid;
mod surface;
mod types;
mod write;

pub use make::{LENGTH_UNIT, model_of_surfaces};
pub use solid::ModelSolid;
pub use surface::{ModelSurface, Wanted};
pub use types::{CellType, Mode};

use super::{Attributes, Foreign};

/// A physical model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PhysicalModel {
    /// What it is called.
    pub name: Option<Box<str>>,
    /// Custom properties.
    pub properties: Attributes,
    /// Lists of atoms: one, as a rule.
    pub atoms: Vec<StructuralComponent>,
    /// The model proper: one multi-component, as a rule.
    pub exclusive: Vec<Component>,
    /// Labels, selections and surfaces; none where the document has no such part.
    pub informative: Option<Vec<Component>>,
    /// Elements beside these parts.
    pub foreign: Vec<Foreign>,
    /// Elements beside the lists of atoms.
    pub beside_atoms: Vec<Foreign>,
}

/// A component.
#[derive(Debug, Clone, PartialEq)]
pub enum Component {
    /// A group of components.
    Multi(MultiComponent),
    /// A group of cells or atoms.
    Structural(StructuralComponent),
    /// What the language does not know.
    Foreign(Foreign),
}

/// A group of components, in the order of the document.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MultiComponent {
    /// What it is called.
    pub name: Option<Box<str>>,
    /// Custom properties.
    pub properties: Attributes,
    /// What is in it.
    pub components: Vec<Component>,
}

/// A group of cells, or of atoms. Lists of both in one component break the rules; then either keeps its order.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StructuralComponent {
    /// What it is called.
    pub name: Option<Box<str>>,
    /// How it is shown.
    pub mode: Option<Mode>,
    /// Custom properties.
    pub properties: Attributes,
    /// Its colour.
    pub colour: Option<Colour>,
    /// Atoms that are defined here, which only the lists of atoms have.
    pub atoms: Vec<Atom>,
    /// Its cells.
    pub cells: Vec<Cell>,
    /// Atoms that are named here.
    pub references: References,
    /// Elements that the language does not know.
    pub foreign: Vec<Foreign>,
}

/// A position that cells are made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Atom {
    /// Its index, unique in the model; indices may have gaps and come in any order.
    pub index: u32,
    /// Where it is, in the unit of the document.
    pub position: [f64; 3],
    /// What it is called.
    pub name: Option<Box<str>>,
    /// Custom properties.
    pub properties: Attributes,
    /// What the element around its properties has.
    pub beyond: Beyond,
}

/// Atoms that are joined: a facet, an element, a group.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Its index, if it has one. Real files give some twice.
    pub index: Option<i64>,
    /// What its atoms make.
    pub kind: CellType,
    /// What it is called.
    pub name: Option<Box<str>>,
    /// Custom properties.
    pub properties: Attributes,
    /// Its colour.
    pub colour: Option<Box<Colour>>,
    /// Its atoms.
    pub references: References,
    /// What the element around its properties has.
    pub beyond: Beyond,
}

/// A list of atoms by their indices.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct References {
    /// The indices.
    pub atoms: Box<[u32]>,
    /// Custom properties of single references: which of them, and what.
    pub properties: Box<[(u32, Attributes)]>,
}

/// What an element has beyond the language: rarely anything.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Beyond(Option<Box<(Attributes, Vec<Foreign>)>>);

impl Beyond {
    fn new(attributes: Attributes, foreign: Vec<Foreign>) -> Self {
        let some = !attributes.is_empty() || !foreign.is_empty();
        Self(some.then(|| Box::new((attributes, foreign))))
    }

    fn attributes(&self) -> Attributes {
        self.0.as_ref().map(|beyond| beyond.0.clone()).unwrap_or_default()
    }

    fn foreign(&self) -> &[Foreign] {
        self.0.as_ref().map_or(&[], |beyond| &beyond.1)
    }
}

/// A colour, each part from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colour {
    /// Red, green, blue and opacity.
    pub rgba: [f64; 4],
}

impl References {
    /// These atoms, without properties.
    pub fn new(atoms: impl IntoIterator<Item = u32>) -> Self {
        Self { atoms: atoms.into_iter().collect(), properties: Box::default() }
    }
}

impl Cell {
    /// A cell of these atoms, and nothing more.
    pub fn new(index: Option<i64>, kind: CellType, atoms: impl IntoIterator<Item = u32>) -> Self {
        Self {
            index,
            kind,
            name: None,
            properties: Attributes::default(),
            colour: None,
            references: References::new(atoms),
            beyond: Beyond::default(),
        }
    }
}

impl Component {
    /// What it is called.
    pub fn name(&self) -> Option<&str> {
        match self {
            Self::Multi(multi) => multi.name.as_deref(),
            Self::Structural(structural) => structural.name.as_deref(),
            Self::Foreign(_) => None,
        }
    }

    /// Adds the structural components in it, itself if it is one, in the order of the document.
    fn add_structural<'a>(&'a self, to: &mut Vec<&'a StructuralComponent>) {
        match self {
            Self::Structural(structural) => to.push(structural),
            Self::Multi(multi) => multi.components.iter().for_each(|component| component.add_structural(to)),
            Self::Foreign(_) => {}
        }
    }

    /// Adds it and all that is in it.
    fn add_all<'a>(&'a self, to: &mut Vec<&'a Component>) {
        to.push(self);
        if let Self::Multi(multi) = self {
            multi.components.iter().for_each(|component| component.add_all(to));
        }
    }
}

impl PhysicalModel {
    /// All atoms, in the order of the document.
    pub fn all_atoms(&self) -> impl Iterator<Item = &Atom> {
        self.atoms.iter().flat_map(|list| &list.atoms)
    }

    /// All components, each before those in it: exclusive ones first.
    pub fn all_components(&self) -> Vec<&Component> {
        let mut all = Vec::new();
        self.exclusive
            .iter()
            .chain(self.informative.iter().flatten())
            .for_each(|component| component.add_all(&mut all));
        all
    }

    /// The components that have cells or name atoms, in the order of the document.
    pub fn structural_components(&self) -> Vec<&StructuralComponent> {
        let mut all = Vec::new();
        let parts = self.exclusive.iter().chain(self.informative.iter().flatten());
        parts.for_each(|component| component.add_structural(&mut all));
        all
    }
}
