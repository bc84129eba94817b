//! The surfaces in a model: facets of its components, whatever part they stand in.
//!
//! Who is whose neighbour follows from the facets: lists of neighbours that a model may have are not relied on. Which side
//! of a facet is outside is not told by the language, so facets are turned outwards.

use super::{Atom, Cell, CellType, Component, PhysicalModel, StructuralComponent};
use crate::Vec3;
use crate::error::{Fault, words};
use crate::geometry::{Surface, orient_outwards};
use std::collections::HashMap;

/// Which facets are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted<'a> {
    /// Those of the one component whose facets are a closed surface, or of the only one that has facets.
    TheOnly,
    /// Those of the components with these names, and of all in them.
    Named(&'a [String]),
}

/// A surface, and the indices that its atoms have in the model.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelSurface {
    /// The surface, in the unit of the model: its atoms are those of the facets, in the order of the document.
    pub surface: Surface,
    /// The index of each atom.
    pub indices: Vec<u32>,
}

/// Cells of which something is made, for those who look for it and for messages.
pub(super) struct Sought {
    /// What they are called.
    pub words: &'static str,
    /// Whether a component has some.
    pub is_in: fn(&StructuralComponent) -> bool,
    /// The components that have some.
    pub listed: fn(&[&StructuralComponent]) -> String,
    /// What is made of cells of which types.
    pub made_of: &'static str,
}

const FACETS: Sought = Sought {
    words: "facets",
    is_in: has_facets,
    listed: |all| listed(all.iter().copied().filter(|component| has_facets(component))),
    made_of: "the surface of a cell is made of cells of type TRIANGLE or QUAD",
};

/// So many components are listed in a message.
const LISTED: usize = 12;

impl PhysicalModel {
    /// The surface of some components of the model of a file. Quadrilaterals are cut from their corner of the lowest
    /// index, whatever corner they begin with.
    ///
    /// # Errors
    /// No component has the name, has facets, or is the only one; then the message lists those that there are.
    pub fn surface(&self, file: &str, wanted: Wanted) -> Result<ModelSurface, Fault> {
        let chosen = match wanted {
            Wanted::TheOnly => vec![self.only_surface(file)?],
            Wanted::Named(names) => self.named(file, names, &FACETS)?,
        };
        let facets: Vec<[u32; 3]> = chosen.iter().flat_map(|component| facets_of(component)).collect();
        let mut used: HashMap<u32, u32> = facets.iter().flatten().map(|atom| (*atom, 0)).collect();
        let atoms: Vec<&Atom> = self.all_atoms().filter(|atom| used.contains_key(&atom.index)).collect();
        for (number, atom) in atoms.iter().enumerate() {
            used.insert(atom.index, number as u32);
        }
        let facets = facets.iter().map(|facet| facet.map(|atom| used[&atom])).collect();
        let positions = atoms.iter().map(|atom| Vec3::from(atom.position)).collect();
        let mut surface = Surface { positions, facets };
        orient_outwards(&mut surface);
        Ok(ModelSurface { surface, indices: atoms.iter().map(|atom| atom.index).collect() })
    }

    fn only_surface(&self, file: &str) -> Result<&StructuralComponent, Fault> {
        let with_facets: Vec<&StructuralComponent> =
            self.structural_components().into_iter().filter(|component| has_facets(component)).collect();
        let closed: Vec<&StructuralComponent> =
            with_facets.iter().copied().filter(|component| is_closed(component)).collect();
        match (closed.as_slice(), with_facets.as_slice()) {
            ([only], _) | ([], [only]) => Ok(only),
            ([], []) => Err(self.none_of(&FACETS, format!("PML file `{file}` has no facets"))),
            (several, all) => {
                let found = match several.len() {
                    0 => format!("{} components with facets, none of them closed", all.len()),
                    count => format!("{count} components that are closed surfaces"),
                };
                let list = if several.is_empty() { all } else { several };
                let first = list[0].name.as_deref().unwrap_or_default().trim();
                let help = format!(
                    "choose by `component = \"{first}\"` or a list of names beside the path; there are {}",
                    listed(list.iter().copied())
                );
                Err(Fault::new(format!("PML file `{file}` has {found}")).help(help))
            }
        }
    }

    /// The components with these names and all in them that have such cells, each once.
    pub(super) fn named(
        &self,
        file: &str,
        names: &[String],
        what: &Sought,
    ) -> Result<Vec<&StructuralComponent>, Fault> {
        let all = self.all_components();
        let mut chosen: Vec<&StructuralComponent> = Vec::new();
        for name in names {
            let before = chosen.len();
            let same = |component: &&&Component| component.name().is_some_and(|own| own.trim() == name.trim());
            let found: Vec<&&Component> = all.iter().filter(same).collect();
            if found.is_empty() {
                let known = all.iter().filter_map(|component| component.name()).map(str::trim);
                let meant =
                    words::meant(name, known).map_or(String::new(), |meant| format!("did you mean `{meant}`? "));
                let help =
                    format!("{meant}with {} there are {}", what.words, (what.listed)(&self.structural_components()));
                return Err(Fault::new(format!("PML file `{file}` has no component `{name}`")).help(help));
            }
            for component in found {
                let mut within = Vec::new();
                component.add_structural(&mut within);
                chosen.extend(within.into_iter().filter(|component| (what.is_in)(component)));
            }
            if chosen.len() == before {
                return Err(
                    self.none_of(what, format!("component `{name}` of PML file `{file}` has no {}", what.words))
                );
            }
        }
        // A component that is named itself and by a group around it is meant once.
        let mut unique: Vec<&StructuralComponent> = Vec::new();
        for component in chosen {
            if !unique.iter().any(|own| std::ptr::eq(*own, component)) {
                unique.push(component);
            }
        }
        Ok(unique)
    }

    /// The fault of cells that are missing: which components have some, or what kinds of cells there are instead.
    pub(super) fn none_of(&self, what: &Sought, message: String) -> Fault {
        let all = self.structural_components();
        if all.iter().any(|component| (what.is_in)(component)) {
            return Fault::new(message).help(format!("with {} there are {}", what.words, (what.listed)(&all)));
        }
        let mut kinds: Vec<&str> = Vec::new();
        for cell in all.iter().flat_map(|component| &component.cells) {
            if !kinds.contains(&cell.kind.word()) {
                kinds.push(cell.kind.word());
            }
        }
        Fault::new(message).help(format!("{}; the model has {}", what.made_of, words::all_of(kinds)))
    }
}

fn has_facets(component: &StructuralComponent) -> bool {
    component.cells.iter().any(is_facet)
}

/// Whether a cell is a facet. Those with another number of atoms than their type has are none.
fn is_facet(cell: &Cell) -> bool {
    matches!(cell.kind, CellType::Triangle | CellType::Quad) && cell.kind.atoms() == Some(cell.references.atoms.len())
}

/// The facets of a component, cut into triangles.
fn facets_of(component: &StructuralComponent) -> impl Iterator<Item = [u32; 3]> {
    component.cells.iter().filter(|cell| is_facet(cell)).flat_map(|cell| {
        let corners = &cell.references.atoms;
        // Triangles keep their corners as they are: what is written reads back as the same mesh.
        let cut_from = if corners.len() > 3 { 0..corners.len() } else { 0..1 };
        let lowest = cut_from.min_by_key(|corner| corners[*corner]).unwrap_or_default();
        let corner = move |step: usize| corners[(lowest + step) % corners.len()];
        (2..corners.len()).map(move |last| [corner(0), corner(last - 1), corner(last)])
    })
}

/// Whether each edge of the facets of a component belongs to two of them.
fn is_closed(component: &StructuralComponent) -> bool {
    let mut edges: HashMap<[u32; 2], u32> = HashMap::new();
    for [a, b, c] in facets_of(component) {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            *edges.entry([from.min(to), from.max(to)]).or_default() += 1;
        }
    }
    edges.values().all(|facets| *facets == 2)
}

/// Components with how many facets they have, for a message.
fn listed<'a>(components: impl Iterator<Item = &'a StructuralComponent>) -> String {
    let mut told: Vec<String> = Vec::new();
    let mut more = 0;
    for component in components {
        if told.len() == LISTED {
            more += 1;
            continue;
        }
        let name = component.name.as_deref().map_or("(no name)".to_owned(), |name| format!("`{}`", name.trim()));
        let shape = if is_closed(component) { "closed" } else { "open" };
        told.push(format!("{name} ({} facets, {shape})", facets_of(component).count()));
    }
    if more > 0 {
        told.push(format!("{more} more"));
    }
    if told.is_empty() { "none".to_owned() } else { told.join(", ") }
}
