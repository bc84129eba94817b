//! A physical model in place of a mesh.

use super::super::Document;
use crate::Vec3;
use crate::error::{Error, Fault, Result};
use crate::geometry::{Solid, SolidFault, Surface, SurfaceRules, check_surface};
use crate::physical_model::Read;
use crate::physical_model::pml::{Component, LENGTH_UNIT, PhysicalModel, Wanted};
use crate::values::{LengthUnit, OneOrMany};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The unit of models that tell none.
const USUAL_UNIT: LengthUnit = LengthUnit::of_micrometres(1e3);

/// What of a physical model is still known of the mesh that was made of it: what its atoms are called there.
#[derive(Debug)]
pub struct FromModel {
    /// The numbers of atoms of the mesh by their indices in the model.
    pub numbers: BTreeMap<u32, u32>,
    /// All indices of the model.
    pub indices: BTreeSet<u32>,
    /// The indices of atoms by the names of components, cells and atoms.
    pub named: BTreeMap<String, BTreeSet<u32>>,
    /// What was found in its file though it could be read, in a sentence.
    pub notice: Option<String>,
}

/// Whether a mesh file is a physical model.
pub fn is_model(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("pml"))
}

/// The unit that a mesh file at a key is taken in where that can be known without reading it.
pub fn written_unit(document: &Document, key: &str, path: &Path, unit: LengthUnit) -> LengthUnit {
    if is_model(path) && !document.says(&format!("{key}.unit")) { USUAL_UNIT } else { unit }
}

/// The surface of a model, µm, as all cells of a type have it at rest.
///
/// # Errors
/// As [`PhysicalModel::open`] and [`PhysicalModel::surface`], a unit in the model that is none, and every fault of the surface.
pub fn surface(
    path: &Path,
    unit: Option<LengthUnit>,
    component: Option<&OneOrMany<String>>,
    rules: &SurfaceRules,
) -> Result<(Surface, FromModel)> {
    let read = PhysicalModel::open(path)?;
    let file = path.display().to_string();
    let mut chosen = read.document.surface(&file, wanted(component)).map_err(Error::input)?;
    let unit = unit_of(&read.document, unit, &file)?;
    chosen.surface.positions.iter_mut().for_each(|position| *position *= unit.micrometres());
    let mesh = format!("the surface in PML file `{file}`");
    check_surface(&chosen.surface, rules)
        .map_err(|faults| Error::Input(faults.into_iter().map(|fault| fault.into_fault(&mesh)).collect()))?;
    let numbers = chosen.indices.iter().copied().zip(0..).collect();
    Ok((chosen.surface, FromModel::of(&read, numbers, &file)))
}

/// The filled body of a model, µm, as all cells of a type have it at rest.
///
/// # Errors
/// As [`PhysicalModel::open`] and [`PhysicalModel::solid`], a unit in the model that is none, and every fault of the cells and of the surface around
/// them.
pub fn solid(
    path: &Path,
    unit: Option<LengthUnit>,
    component: Option<&OneOrMany<String>>,
) -> Result<(Solid, FromModel)> {
    let read = PhysicalModel::open(path)?;
    let file = path.display().to_string();
    let chosen = read.document.solid(&file, wanted(component)).map_err(Error::input)?;
    let unit = unit_of(&read.document, unit, &file)?;
    let positions: Vec<Vec3> = chosen.positions.iter().map(|position| position * unit.micrometres()).collect();
    let told = |fault: SolidFault| {
        let fault = fault.renumbered(|atom| chosen.indices[atom as usize]);
        Fault::new(format!("the body in PML file `{file}`: {fault}")).help(fault.help())
    };
    let (solid, numbers) = Solid::of_cells(&positions, &chosen.cells)
        .map_err(|faults| Error::Input(faults.into_iter().map(told).collect()))?;
    let mut around = solid.surface.clone();
    around.positions.truncate(solid.outer_atoms());
    let mesh = format!("the surface around the body in PML file `{file}`");
    check_surface(&around, &SurfaceRules::CELL)
        .map_err(|faults| Error::Input(faults.into_iter().map(|fault| fault.into_fault(&mesh)).collect()))?;
    let numbers = chosen.indices.iter().zip(numbers).filter_map(|(index, number)| Some((*index, number?))).collect();
    Ok((solid, FromModel::of(&read, numbers, &file)))
}

fn wanted(component: Option<&OneOrMany<String>>) -> Wanted<'_> {
    component.map_or(Wanted::TheOnly, |names| Wanted::Named(names.as_slice()))
}

/// The unit of a model's coordinates: as a document says, or as the model does.
fn unit_of(model: &PhysicalModel, told: Option<LengthUnit>, file: &str) -> Result<LengthUnit> {
    match (told, model.properties.get(LENGTH_UNIT)) {
        (Some(unit), _) => Ok(unit),
        (None, None) => Ok(USUAL_UNIT),
        (None, Some(text)) => text.parse::<LengthUnit>().map_err(|error| {
            let message = format!("`{LENGTH_UNIT}` of PML file `{file}` is no unit of length: {}", error.message);
            Error::input(Fault::new(message).help("give the `unit` beside the path"))
        }),
    }
}

impl FromModel {
    fn of(read: &Read<PhysicalModel>, numbers: BTreeMap<u32, u32>, file: &str) -> Self {
        Self {
            numbers,
            indices: read.document.all_atoms().map(|atom| atom.index).collect(),
            named: named(&read.document),
            notice: read.warnings.in_a_sentence(file),
        }
    }
}

/// The atoms of all that has a name; blanks at the ends of names do not count.
fn named(model: &PhysicalModel) -> BTreeMap<String, BTreeSet<u32>> {
    let mut named: BTreeMap<String, BTreeSet<u32>> = BTreeMap::new();
    let mut add = |name: &str, atoms: &BTreeSet<u32>| named.entry(name.trim().to_owned()).or_default().extend(atoms);
    for component in model.all_components() {
        if let Some(name) = component.name() {
            add(name, &atoms_of(component));
        }
        if let Component::Structural(own) = component {
            for cell in &own.cells {
                if let Some(name) = &cell.name {
                    add(name, &cell.references.atoms.iter().copied().collect());
                }
            }
        }
    }
    for atom in model.all_atoms() {
        if let Some(name) = &atom.name {
            add(name, &BTreeSet::from([atom.index]));
        }
    }
    named
}

fn atoms_of(component: &Component) -> BTreeSet<u32> {
    match component {
        Component::Foreign(_) => BTreeSet::new(),
        Component::Multi(multi) => multi.components.iter().flat_map(atoms_of).collect(),
        Component::Structural(own) => {
            let of_cells = own.cells.iter().flat_map(|cell| cell.references.atoms.iter());
            own.references.atoms.iter().chain(of_cells).copied().collect()
        }
    }
}
