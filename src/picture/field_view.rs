//! The field that a picture shows: the substrate's as it lies, one of the medium as a slice.

use super::colour::ColourMap;
use super::render::Sheet;
use super::ticks::Scale;
use crate::error::{Error, Fault, Result, short};
use crate::experiment::Picture;
use crate::output::{Along, FieldLayout, ResultFile};

/// A species of a field and where it is cut.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldView {
    field: FieldLayout,
    species: usize,
    /// Where a field of the medium is cut, µm; the mean height of the atoms when absent.
    height: Option<f64>,
}

impl FieldView {
    /// What a picture asks for: the field that it names, or the first one there is, or none.
    ///
    /// # Errors
    /// [`crate::error::Error::Input`] for a field that the result does not have, and for ends that are not above 0 on a logarithmic scale.
    pub fn of(result: &ResultFile, picture: &Picture) -> Result<Option<Self>> {
        let first = result.layout().fields.iter().find(|field| !field.species.is_empty() && !field.is_empty());
        let (field, species) = match (picture.field.as_deref(), first) {
            (Some("none"), _) | (None, None) => return Ok(None),
            (Some(name), _) => result.field_species(name)?,
            (None, Some(field)) => (field, 0),
        };
        if picture.field_log {
            check_decades("the colours of the field", picture.field_range)?;
        }
        Ok(Some(Self { field: field.clone(), species, height: picture.field_height.map(|height| height.value()) }))
    }

    /// Name and unit, for the colour bar.
    pub fn label(&self) -> String {
        species_label(&self.field, self.species)
    }

    /// The sheet for a frame; its colours and their range are set by who draws it.
    ///
    /// # Errors
    /// A damaged file.
    pub fn sheet(&self, result: &ResultFile, frame: usize, positions: &[[f64; 3]]) -> Result<Sheet> {
        let field = &self.field;
        let all = result.field_frame(&field.name, &field.species[self.species].0, frame)?;
        let [nx, ny, nz] = field.cells;
        let layer = |z: usize| &all[z * nx * ny..(z + 1) * nx * ny];
        let (height, values) = if field.is_flat() {
            (field.origin[2], all)
        } else {
            let mean = positions.iter().map(|level| level[2]).sum::<f64>() / positions.len().max(1) as f64;
            let (low, high) = (field.origin[2], field.origin[2] + nz as f64 * field.spacing[2]);
            let height = self.height.unwrap_or(mean).clamp(low, high);
            let level = ((height - field.centre(Along::Z, 0)) / field.spacing[2]).clamp(0.0, (nz - 1) as f64);
            let below = (level as usize).min(nz - 2);
            let share = level - below as f64;
            let between = |(a, b): (&f64, &f64)| a + share * (b - a);
            (height, layer(below).iter().zip(layer(below + 1)).map(between).collect())
        };
        Ok(Sheet {
            corner: [field.origin[0], field.origin[1], height],
            side_u: [nx as f64 * field.spacing[0], 0.0, 0.0],
            side_v: [0.0, ny as f64 * field.spacing[1], 0.0],
            size: [nx, ny],
            values,
            map: ColourMap::default(),
            range: [0.0, 1.0],
            scale: Scale::Linear,
        })
    }
}

/// Makes sure that a logarithmic scale may have these ends.
///
/// # Errors
/// [`Error::Input`] for one that is not above 0.
pub fn check_decades(what: &str, range: Option<[f64; 2]>) -> Result<()> {
    match range {
        Some([low, high]) if !(low > 0.0 && high > 0.0) => {
            let fault =
                Fault::new(format!("{what} count in powers of ten, which never reach {}", short(low.min(high))));
            Err(Error::input(fault.help("let the range begin above 0, as 0.001,1 does, or take a linear scale")))
        }
        _ => Ok(()),
    }
}

/// A species' name as a reader would say it, with its unit.
pub fn species_label(field: &FieldLayout, species: usize) -> String {
    let (name, unit) = &field.species[species];
    with_unit(&name.replace('_', " "), unit)
}

/// A name with its unit, if it has one: `cAMP (µM)`.
pub fn with_unit(name: &str, unit: &str) -> String {
    match unit_text(unit) {
        none if none.is_empty() => name.to_owned(),
        signs => format!("{name} ({signs})"),
    }
}

/// A unit in the usual signs: `uM` as µM, `1/um^2` as 1/µm²; empty for a pure number.
pub fn unit_text(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut signs = String::new();
    let mut before = ' ';
    for letter in unit.chars() {
        let starts = !before.is_alphabetic();
        match letter {
            '^' => {}
            'u' if starts => signs.push('µ'),
            '2' if before == '^' => signs.push('²'),
            '3' if before == '^' => signs.push('³'),
            '*' => signs.push('·'),
            other => signs.push(other),
        }
        before = letter;
    }
    signs
}

#[cfg(test)]
mod tests {
    use super::with_unit;

    #[test]
    fn units_are_written_in_their_usual_signs() {
        assert_eq!(with_unit("cAMP", "uM"), "cAMP (µM)");
        assert_eq!(with_unit("bound", "1/um^2"), "bound (1/µm²)");
        assert_eq!(with_unit("U", "1"), "U");
    }
}
