//! Makes a model of surfaces.

use super::{
    Atom, Attributes, Beyond, Cell, CellType, Component, Mode, MultiComponent, PhysicalModel, References,
    StructuralComponent,
};
use crate::geometry::{Surface, Topology};

/// The custom property of a model that tells the unit of its lengths.
pub const LENGTH_UNIT: &str = "lengthUnit";

/// A model of surfaces with names, in `unit`: of each an exclusive component with one cell of all its atoms, and two
/// informative ones, the neighbours of each atom in the order in which they stand around it, and the facets. Atoms are
/// numbered from surface to surface.
///
/// # Panics
/// When a facet names an atom that its surface does not have.
pub fn model_of_surfaces(name: &str, unit: &str, surfaces: &[(String, Surface)]) -> PhysicalModel {
    let (mut atoms, mut regions, mut neighbours) = (Vec::new(), Vec::new(), Vec::new());
    let mut informative = Vec::new();
    let total: usize = surfaces.iter().map(|(_, surface)| surface.positions.len()).sum();
    // Cells are numbered through the whole model: regions, then neighbourhoods, then facets.
    let mut facet_index = (surfaces.len() + total) as i64;
    for (number, (own, surface)) in surfaces.iter().enumerate() {
        let first = atoms.len() as u32;
        let count = surface.positions.len() as u32;
        atoms.extend(surface.positions.iter().zip(first..).map(|(position, index)| Atom {
            index,
            position: (*position).into(),
            name: None,
            properties: Attributes::default(),
            beyond: Beyond::default(),
        }));
        regions.push(component(
            format!("Region #{number} {own}"),
            vec![Cell::new(Some(number as i64), CellType::PolyVertex, first..first + count)],
            Some(Mode::Points),
        ));
        for (atom, ring) in Topology::of(surface).rings.iter().enumerate() {
            let index = first + atom as u32;
            let around = ring.atoms.iter().map(|atom| first + atom);
            let cell = Cell::new(Some(surfaces.len() as i64 + i64::from(index)), CellType::PolyVertex, around);
            // An atom without facets has no neighbours, and a cell has atoms.
            if !ring.atoms.is_empty() {
                neighbours.push(Cell { name: Some(format!("E#{index}").into()), ..cell });
            }
        }
        let facets = surface.facets.iter().zip(facet_index..);
        let facets =
            facets.map(|(facet, index)| Cell::new(Some(index), CellType::Triangle, facet.map(|atom| first + atom)));
        let shown = Some(Mode::WireframeAndSurface);
        informative.push(component(format!("Facet of region #{number} ({own})"), facets.collect(), shown));
        facet_index += surface.facets.len() as i64;
    }
    informative.insert(0, component("Element Neighborhoods".into(), neighbours, None));
    let list = StructuralComponent { atoms, ..named("element list".into(), None) };
    PhysicalModel {
        name: Some(name.into()),
        properties: [(LENGTH_UNIT, unit)].into_iter().collect(),
        atoms: vec![list],
        exclusive: vec![group("Regions", regions)],
        informative: Some(vec![group("Informative Components", informative)]),
        foreign: Vec::new(),
        beside_atoms: Vec::new(),
    }
}

fn group(name: &str, components: Vec<Component>) -> Component {
    Component::Multi(MultiComponent { name: Some(name.into()), properties: Attributes::default(), components })
}

fn component(name: String, cells: Vec<Cell>, mode: Option<Mode>) -> Component {
    Component::Structural(StructuralComponent { cells, ..named(name, mode) })
}

fn named(name: String, mode: Option<Mode>) -> StructuralComponent {
    let references = References::default();
    StructuralComponent { name: Some(name.into()), mode, references, ..StructuralComponent::default() }
}
