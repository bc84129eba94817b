//! Reads fields and systems of chemistry out of a result file.

use super::field_layout::FieldLayout;
use super::reader::{ResultFile, listed};
use super::systems::{SystemLayout, SystemScope};
use crate::error::{Error, Fault, Result};

impl ResultFile {
    /// The field of this name, or the first one that has a species of this name.
    ///
    /// # Errors
    /// [`Error::Input`] that lists what there is.
    pub fn field(&self, name: &str) -> Result<&FieldLayout> {
        let fields = &self.layout().fields;
        let found = fields.iter().find(|field| field.name == name);
        let found = found.or_else(|| fields.iter().find(|field| field.species_number(name).is_some()));
        found.ok_or_else(|| self.no_field(name))
    }

    /// What `text` names: `FIELD.SPECIES`, a field (its first species) or a species (of the first field with it).
    ///
    /// # Errors
    /// [`Error::Input`] that lists what there is.
    pub fn field_species(&self, text: &str) -> Result<(&FieldLayout, usize)> {
        let fields = &self.layout().fields;
        for field in fields {
            let rest = text.strip_prefix(&field.name).and_then(|rest| rest.strip_prefix('.'));
            if let Some(species) = rest.and_then(|rest| field.species_number(rest)) {
                return Ok((field, species));
            }
        }
        let field = self.field(text)?;
        let named = if field.name == text { None } else { field.species_number(text) };
        if field.species.is_empty() {
            return Err(self.no_field(text));
        }
        Ok((field, named.or_else(|| field.species_number(text)).unwrap_or(0)))
    }

    /// The values of a species in a frame, one for each box, x fastest. They were stored with seven digits.
    ///
    /// # Errors
    /// [`Error::Input`] for a field or species that is not there, or a damaged file.
    ///
    /// # Panics
    /// If there is no such frame.
    pub fn field_frame(&self, field: &str, species: &str, frame: usize) -> Result<Vec<f64>> {
        assert!(frame < self.frames(), "frame {frame} of {}", self.frames());
        let known = self.layout().fields.iter().find(|known| known.name == field);
        let known = known.filter(|known| known.species_number(species).is_some());
        let Some(known) = known else { return Err(self.no_field(&format!("{field}.{species}"))) };
        let [nx, ny, nz] = known.cells;
        let values = self.read(&format!("/fields/{field}/CellData/{species}"), |dataset| {
            dataset.read_slice::<f32, _, ndarray::Ix3>((frame, 0..nz, 0..ny, 0..nx))
        })?;
        Ok(values.iter().map(|value| f64::from(*value)).collect())
    }

    fn no_field(&self, name: &str) -> Error {
        let mut known: Vec<String> = Vec::new();
        for field in &self.layout().fields {
            known.push(field.name.clone());
            for (species, _) in field.species.iter().filter(|(species, _)| *species != field.name) {
                known.push(format!("{}.{species}", field.name));
            }
        }
        let fault = Fault::new(match known.is_empty() {
            true => format!("{} holds no fields", self.path().display()),
            false => format!("{} has no field `{name}`", self.path().display()),
        });
        Error::input(fault.help(match known.is_empty() {
            true => "give the experiment a field, or leave the option out".to_owned(),
            false => listed(name, &known, self.layout().fields.iter().flat_map(|f| f.species.iter().map(|s| &s.0))),
        }))
    }

    /// The system and quantity that a series `SYSTEM.QUANTITY` means.
    pub(super) fn quantity_of(&self, name: &str) -> Option<(&SystemLayout, &(String, String))> {
        self.layout().systems.iter().find_map(|system| {
            let rest = name.strip_prefix(&system.name)?.strip_prefix('.')?;
            Some((system, system.quantities.iter().find(|(known, _)| known == rest)?))
        })
    }

    /// Names of the series of systems inside cells, `SYSTEM.QUANTITY`.
    pub(super) fn cell_quantities(&self) -> impl Iterator<Item = String> {
        self.layout().systems.iter().filter(|system| system.scope != SystemScope::Scene).flat_map(names_of)
    }

    /// Names of the series of systems of the scene.
    pub(super) fn scene_quantities(&self) -> impl Iterator<Item = String> {
        self.layout().systems.iter().filter(|system| system.scope == SystemScope::Scene).flat_map(names_of)
    }
}

fn names_of(system: &SystemLayout) -> impl Iterator<Item = String> {
    system.quantities.iter().map(|(quantity, _)| format!("{}.{quantity}", system.name))
}
