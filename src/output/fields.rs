//! Fields in the result file: one group for each grid, arranged as VTK's image data with time steps.
//!
//! VTK looks for its data under one path of a file, which the cells have. So beside the result lies a small file for each
//! field that leads to its group: `red.vtkhdf` has `red.attractant.vtkhdf`.

use std::path::{Path, PathBuf};

use hdf5::types::FixedAscii;
use hdf5::{Attribute, File, Group};

use super::Layout;
use super::container::set_number;
use super::field_column::FieldColumn;
use super::field_layout::FieldLayout;
use super::texts::{set_text, text};
use super::versions::make;
use crate::error::{Error, Fault, Result};

/// The small file beside a result by which VTK and ParaView find a field.
pub fn field_view_path(result: &Path, field: &str) -> PathBuf {
    result.with_extension(format!("{field}.vtkhdf"))
}

/// Makes the small files that lead to the fields; what was there is replaced.
pub(super) fn write_views(result: &Path, layout: &Layout) -> Result<()> {
    let Some(target) = result.file_name().and_then(|name| name.to_str()) else { return Ok(()) };
    for field in &layout.fields {
        let path = field_view_path(result, &field.name);
        // The target is looked for in the folder of the small file, so that both can be moved together.
        let link = |file: &File| file.link_external(target, &format!("/fields/{}", field.name), "VTKHDF");
        make(&path, link)?;
    }
    Ok(())
}

/// Names become parts of paths in the file, so not every text will do; and there must be something to record.
///
/// # Errors
/// An empty name, one with a slash or a zero byte, `.`, or one that is there twice; a field without boxes or species.
pub(super) fn check_layout(layout: &Layout) -> Result<()> {
    if let Some(field) = layout.fields.iter().find(|field| field.is_empty() || field.species.is_empty()) {
        let fault = Fault::new(format!("the field `{}` has no boxes or no species to record", field.name));
        return Err(Error::input(fault.help("give its grid a size and it a species, or leave it out")));
    }
    let mut lists: Vec<(&str, Vec<&str>)> = vec![
        ("field", layout.fields.iter().map(|field| field.name.as_str()).collect()),
        ("membrane", layout.membranes.iter().map(|membrane| membrane.name.as_str()).collect()),
        ("system", layout.systems.iter().map(|system| system.name.as_str()).collect()),
    ];
    lists.extend(layout.fields.iter().map(|field| ("species", field.species.iter().map(|s| s.0.as_str()).collect())));
    let quantities = |system: &super::SystemLayout| system.quantities.len();
    for system in layout.systems.iter().filter(|system| quantities(system) > 0) {
        lists.push(("quantity", system.quantities.iter().map(|quantity| quantity.0.as_str()).collect()));
    }
    for (what, names) in lists {
        for (number, name) in names.iter().enumerate() {
            let found = match () {
                () if name.is_empty() || *name == "." || name.contains(['/', '\0']) => "cannot be named",
                () if names[..number].contains(name) => "is there twice under the name",
                () => continue,
            };
            let fault = Fault::new(format!("a {what} of the result {found} `{name}`"));
            return Err(Error::input(fault.help("give it a name of its own, made of letters, digits and _")));
        }
    }
    Ok(())
}

/// The datasets of all fields, and the counters of their frames.
#[derive(Default)]
pub(super) struct FieldColumns {
    /// For each field, for each species.
    columns: Vec<Vec<FieldColumn>>,
    frame_counts: Vec<Attribute>,
}

impl FieldColumns {
    /// Makes the groups with what does not change, and the datasets.
    pub fn create(file: &File, layout: &Layout) -> hdf5::Result<Self> {
        let mut made = Self::default();
        for (order, field) in (0_i64..).zip(&layout.fields) {
            let group = create_group(file, field, order)?;
            let species = (0_i64..).zip(&field.species);
            let columns = species.map(|(order, (name, unit))| FieldColumn::create(&group, field, name, unit, order));
            made.columns.push(columns.collect::<hdf5::Result<_>>()?);
            made.frame_counts.push(group.group("Steps")?.attr("NSteps")?);
        }
        Ok(made)
    }

    /// Opens the datasets and cuts them to their first frames.
    pub fn reopen(file: &File, layout: &Layout, frames: usize) -> hdf5::Result<Self> {
        let mut found = Self::default();
        for field in &layout.fields {
            let group = file.group(&path_of(field))?;
            let columns = field.species.iter().map(|(name, _)| FieldColumn::reopen(&group, field, name, frames));
            found.columns.push(columns.collect::<hdf5::Result<_>>()?);
            found.frame_counts.push(group.group("Steps")?.attr("NSteps")?);
        }
        Ok(found)
    }

    /// Appends the values of a frame.
    ///
    /// # Panics
    /// If they do not fit the layout.
    pub fn append(&mut self, values: &[Vec<Vec<f64>>]) -> hdf5::Result<()> {
        assert_eq!(values.len(), self.columns.len(), "the fields of a frame must fit the layout");
        for (columns, species) in self.columns.iter_mut().zip(values) {
            assert_eq!(species.len(), columns.len(), "the species of a frame's field must fit the layout");
            columns.iter_mut().zip(species).try_for_each(|(column, values)| column.push(values))?;
        }
        Ok(())
    }

    /// Tells VTK how many frames there are.
    pub fn write_counts(&self, frames: usize) -> hdf5::Result<()> {
        self.frame_counts.iter().try_for_each(|count| count.write_scalar(&(frames as i64)))
    }
}

fn path_of(field: &FieldLayout) -> String {
    format!("/fields/{}", field.name)
}

/// Makes the group of a field as VTKHDF wants image data (version 2.0): a field of the substrate is one layer of boxes.
fn create_group(file: &File, field: &FieldLayout, order: i64) -> hdf5::Result<Group> {
    if file.group("fields").is_err() {
        file.create_group("fields")?;
    }
    let group = file.create_group(&path_of(field))?;
    group.new_attr_builder().with_data(&[2_i64, 0]).create("Version")?;
    let kind = FixedAscii::<9>::from_ascii("ImageData").unwrap_or_default();
    group.new_attr::<FixedAscii<9>>().create("Type")?.write_scalar(&kind)?;
    let [nx, ny, nz] = field.cells.map(|n| n as i64);
    group.new_attr_builder().with_data(&[0, nx, 0, ny, 0, nz]).create("WholeExtent")?;
    group.new_attr_builder().with_data(&field.origin).create("Origin")?;
    group.new_attr_builder().with_data(&field.spacing).create("Spacing")?;
    group.new_attr_builder().with_data(&[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]).create("Direction")?;
    set_text(&group, "length_unit", "um")?;
    set_number(&group, "order", order)?;
    group.create_group("CellData")?;
    let steps = group.create_group("Steps")?;
    set_number(&steps, "NSteps", 0_i64)?;
    // The times themselves are made with the first frame, and the link leads there from then on.
    file.link_soft("/VTKHDF/Steps/Values", &format!("{}/Steps/Values", path_of(field)))?;
    Ok(group)
}

/// Reads the layouts of the fields, in the order in which they were written.
pub(super) fn read_layouts(file: &File) -> hdf5::Result<Vec<FieldLayout>> {
    let Ok(all) = file.group("fields") else { return Ok(Vec::new()) };
    let mut found: Vec<(i64, FieldLayout)> = Vec::new();
    for name in all.member_names()? {
        let group = all.group(&name)?;
        let extent = group.attr("WholeExtent")?.read_raw::<i64>()?;
        let vector = |name: &str| -> hdf5::Result<[f64; 3]> {
            let values = group.attr(name)?.read_raw::<f64>()?;
            values.try_into().map_err(|_| format!("{name} of a field has not three components").as_str().into())
        };
        let [_, nx, _, ny, _, nz] = extent[..] else { return Err("WholeExtent of a field has not six numbers".into()) };
        let data = group.group("CellData")?;
        let mut species: Vec<(i64, String, String)> = Vec::new();
        for name in data.member_names()? {
            let dataset = data.dataset(&name)?;
            let unit = text(&dataset, "unit")?;
            species.push((dataset.attr("order")?.read_scalar()?, name, unit));
        }
        species.sort_by_key(|species| species.0);
        let layout = FieldLayout {
            name,
            species: species.into_iter().map(|(_, name, unit)| (name, unit)).collect(),
            cells: [nx, ny, nz].map(|n| usize::try_from(n).unwrap_or(0)),
            spacing: vector("Spacing")?,
            origin: vector("Origin")?,
        };
        found.push((group.attr("order")?.read_scalar()?, layout));
    }
    found.sort_by_key(|field| field.0);
    Ok(found.into_iter().map(|(_, layout)| layout).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_files_lie_beside_the_result_and_are_named_after_it() {
        assert_eq!(field_view_path(Path::new("a/red.vtkhdf"), "cAMP"), Path::new("a/red.cAMP.vtkhdf"));
        assert_eq!(field_view_path(Path::new("red"), "cAMP"), Path::new("red.cAMP.vtkhdf"));
    }
}
