//! Loads of a file in LML on the cells of a type: forces, and atoms that are held or moved.
//!
//! A load acts with its value on each of its atoms, whereas a load of a document is shared by them: the total is the value
//! times the number of atoms, or, for a pressure, times their area at rest.

use super::super::{CellType, Document, Method};
use super::builder::Built;
use super::numbers::course;
use crate::Vec3;
use crate::error::{Error, Fault};
use crate::geometry;
use crate::mechanics::load::Load;
use crate::mechanics::moved::{Moved, Translation};
use crate::physical_model::lml::{self, Component, LoadKind, Loads, Target};
use std::collections::BTreeSet;
use std::path::Path;

/// What a file of loads does to the cells of a type.
#[derive(Debug, Default)]
pub struct FromFile {
    /// Forces.
    pub loads: Vec<Load>,
    /// Atoms that are held, and the axes along which they are.
    pub held: Vec<(u32, usize)>,
    /// Atoms that are moved on courses, and the axes along which nothing else moves them.
    pub moved: Vec<(Moved, Vec<usize>)>,
    /// What was found in the file though it could be read, a sentence each.
    pub notices: Vec<String>,
}

/// A jump of a course takes this share of the time at which it is: a step ends before it and another behind it.
const JUMP: f64 = 1e-6;

/// Reads the file of loads of a type; what cannot be done is a fault.
pub fn read(document: &Document, key: &str, cell: &CellType, built: &Built, faults: &mut Vec<Fault>) -> FromFile {
    let Some(path) = &cell.applied.loads_file else { return FromFile::default() };
    let file = document.resolve(path);
    let located = |fault: Fault| match (&fault.location, document.location(&format!("{key}.loads_file"), "this file")) {
        (None, Some(location)) => fault.at(location),
        _ => fault,
    };
    let (loads, notice) = match Loads::open(&file) {
        Ok(read) => (read.document.loads, read.warnings.in_a_sentence(&file.display().to_string())),
        Err(Error::Input(found)) => {
            faults.extend(found.into_iter().map(located));
            return FromFile::default();
        }
        Err(other) => {
            faults.push(Fault::new(other.to_string()));
            return FromFile::default();
        }
    };
    let done = FromFile { notices: notice.into_iter().collect(), ..FromFile::default() };
    let method = document.experiment.run.integrator.method;
    let mut target = On { file: &file, cell, built, method, areas: geometry::atom_areas(&built.turned), done };
    for (number, load) in loads.iter().enumerate() {
        if let Err(fault) = target.apply(number, load) {
            faults.push(located(fault));
        }
    }
    target.done
}

/// The cells of a type, on which loads are put one after the other.
struct On<'a> {
    file: &'a Path,
    cell: &'a CellType,
    built: &'a Built,
    method: Method,
    /// The area around each atom at rest, µm².
    areas: Vec<f64>,
    done: FromFile,
}

impl On<'_> {
    fn apply(&mut self, number: usize, load: &lml::Load) -> Result<(), Fault> {
        match load.kind {
            LoadKind::Other(_) => {
                let help = "loads are Translation, Rotation, Force, Pressure and Acceleration";
                return Err(self.fault(load, "is of no known kind", help));
            }
            LoadKind::Rotation => {
                let help = "turn them by `moved` with a `rotation` in the document, which says about which axis; turn the mesh at the start by `orientation`";
                return Err(self.fault(load, "turns atoms, and does not say about which point", help));
            }
            _ => {}
        }
        let atoms = self.atoms(load)?;
        if atoms.is_empty() {
            let (file, line, kind) = (self.file.display(), load.line.0, load.kind.word());
            let words = format!("{file}:{line}: the load ({kind}) acts on no atom of the surface and is left out");
            self.done.notices.push(words);
            return Ok(());
        }
        let components = load.direction.as_ref().map_or([Component::Free; 3], |direction| direction.components);
        if load.direction.as_ref().is_some_and(|direction| direction.toward.is_some()) {
            let help = "give a direction by x, y and z, or draw atoms together by `fibres` of the document";
            return Err(self.fault(load, "acts toward an atom, which no load here can", help));
        }
        let unit = load.unit_value().ok_or_else(|| {
            let unit = load.unit.as_deref().unwrap_or_default();
            self.fault(
                load,
                &format!("has the unit \"{unit}\", which is none of it"),
                "write a unit of its kind, such as pN or mm",
            )
        })?;
        let held = |component: &Component| match component {
            Component::Null => true,
            // A displacement of nothing holds as well.
            Component::Number(along) => {
                load.kind == LoadKind::Translation && load.events.iter().all(|event| along * event.value == 0.0)
            }
            Component::Free => false,
        };
        let along = Vec3::from(components.map(|component| match component {
            Component::Number(number) => number,
            _ => 0.0,
        }));
        let acts = along != Vec3::zeros() && load.events.iter().any(|event| event.value != 0.0);
        if acts && load.kind == LoadKind::Translation {
            return self.displace(number, load, &atoms, (along * unit, components));
        }
        for axis in (0..3).filter(|axis| held(&components[*axis])) {
            self.done.held.extend(atoms.iter().map(|atom| (*atom, axis)));
        }
        match load.kind {
            LoadKind::Pressure if load.direction.is_none() => {
                let help = "give the direction of the traction by x, y and z, or put `pressures` into the document, which act along normals";
                Err(self.fault(load, "has no direction, and does not tell on which side the pressure is higher", help))
            }
            _ if !acts => Ok(()),
            LoadKind::Force => {
                self.push(number, load, &atoms, along * unit, |_| 1.0);
                Ok(())
            }
            LoadKind::Pressure => {
                let areas = self.areas.clone();
                self.push(number, load, &atoms, along * unit, |atom| areas[atom as usize]);
                Ok(())
            }
            LoadKind::Acceleration => {
                let Some(mass) = self.cell.mechanics.mass else {
                    let help = "give `mechanics.mass` of the type, or the force in place of the acceleration";
                    return Err(self.fault(load, "accelerates cells that have no mass", help));
                };
                let of_atom = mass.value() / self.built.turned.positions.len() as f64;
                self.push(number, load, &atoms, along * unit * of_atom, |_| 1.0);
                Ok(())
            }
            // Displacements that act are made above, and the others are refused there.
            LoadKind::Translation | LoadKind::Rotation | LoadKind::Other(_) => Ok(()),
        }
    }

    /// Moves atoms along a direction on the course of a load; along axes that it leaves free they are free.
    fn displace(
        &mut self,
        number: usize,
        load: &lml::Load,
        atoms: &BTreeSet<u32>,
        (along, components): (Vec3, [Component; 3]),
    ) -> Result<(), Fault> {
        if self.method != Method::Implicit {
            let help = "remove run.integrator.method; in other schemes atoms can be held, and pulled by forces";
            return Err(self.fault(load, "moves atoms, which only the implicit scheme does", help));
        }
        let points: Vec<(f64, f64)> =
            course_of(load).into_iter().map(|(date, value)| (date, value * along.norm())).collect();
        let displacement = course(points);
        if displacement.at(0.0) != 0.0 {
            let help = "atoms begin where the mesh has them: let the value be 0 at the date 0, and rise from there";
            return Err(self.fault(load, "has moved atoms already at the start", help));
        }
        let (name, atoms) = (format!("lml{}", number + 1), atoms.iter().copied().collect());
        let axes = (0..3).filter(|axis| components[*axis] != Component::Free).collect();
        let translation = Some(Translation { direction: along.normalize(), displacement });
        self.done.moved.push((Moved { name, atoms, translation, rotation: None }, axes));
        Ok(())
    }

    /// Adds a force; `weight` is what an atom has of it.
    fn push(
        &mut self,
        number: usize,
        load: &lml::Load,
        atoms: &BTreeSet<u32>,
        along: Vec3,
        weight: impl Fn(u32) -> f64,
    ) {
        let total: f64 = atoms.iter().map(|atom| weight(*atom)).sum();
        let shares = atoms.iter().map(|atom| (*atom, weight(*atom) / total)).collect();
        let points = course_of(load).into_iter().map(|(date, value)| (date, value * total * along.norm())).collect();
        let name = format!("lml{}", number + 1);
        self.done.loads.push(Load::new(&name, shares, along.normalize(), course(points)));
    }

    /// The atoms of the mesh that a load acts on. Those of a physical model that are not on its surface are left out.
    fn atoms(&self, load: &lml::Load) -> Result<BTreeSet<u32>, Fault> {
        let mut chosen = BTreeSet::new();
        for target in &load.applied_to {
            let (first, last) = match target {
                Target::Index(index) => (*index, *index),
                Target::Range(first, last) => (*first, *last),
                Target::Name(name) => {
                    chosen.extend(self.named(load, name)?);
                    continue;
                }
            };
            match &self.built.model {
                None => {
                    let count = self.built.turned.positions.len() as u32;
                    if last >= count {
                        let help = format!("the mesh has atoms from 0 to {}", count.saturating_sub(1));
                        return Err(self.fault(load, &format!("acts on atom {last}, which is not there"), &help));
                    }
                    chosen.extend(first..=last);
                }
                Some(model) => {
                    // As many as the range has, if none is missing.
                    let there = model.indices.range(first..=last).count() as u64;
                    if there != u64::from(last - first) + 1 {
                        let missing = (first..=last).find(|index| !model.indices.contains(index)).unwrap_or(first);
                        let help = "give atoms that the PML file of the mesh defines";
                        return Err(self.fault(load, &format!("acts on atom {missing}, which is not there"), help));
                    }
                    chosen.extend(model.numbers.range(first..=last).map(|(_, number)| *number));
                }
            }
        }
        Ok(chosen)
    }

    fn named(&self, load: &lml::Load, name: &str) -> Result<Vec<u32>, Fault> {
        let Some(model) = &self.built.model else {
            let help = "names are those of components of a PML file; give atoms of the mesh by their numbers";
            return Err(self.fault(load, &format!("acts on `{name}`, and the mesh has no names"), help));
        };
        let Some(indices) = model.named.get(name.trim()) else {
            let meant = crate::error::words::meant(name, model.named.keys().map(String::as_str));
            let help = meant.map_or("give a component, a cell or an atom of the PML file".to_owned(), |meant| {
                format!("did you mean `{meant}`?")
            });
            return Err(self.fault(
                load,
                &format!("acts on `{name}`, which the PML file of the mesh does not have"),
                &help,
            ));
        };
        Ok(indices.iter().filter_map(|index| model.numbers.get(index)).copied().collect())
    }

    fn fault(&self, load: &lml::Load, what: &str, help: &str) -> Fault {
        let message = format!("{}:{}: the load ({}) {what}", self.file.display(), load.line.0, load.kind.word());
        Fault::new(message).help(help)
    }
}

/// The course of a load with rising times: nothing before the first date, and a steep rise in place of a jump.
fn course_of(load: &lml::Load) -> Vec<(f64, f64)> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for (date, value) in load.course() {
        let before = points.last().map_or(0.0, |(_, value)| *value);
        let is_jump = points.last().map_or(date > 0.0 && value != 0.0, |(last, _)| *last == date);
        if is_jump {
            let start = date - JUMP * date.abs().max(JUMP);
            if let Some(last) = points.last_mut() {
                last.0 = start;
            } else {
                points.push((start, before));
            }
        }
        points.push((date, value));
    }
    // Several jumps at a date are one.
    points.dedup_by(|next, last| next.0 <= last.0);
    points
}
