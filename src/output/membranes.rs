//! Substances on membranes in the result file: one number for each atom, beside the other quantities of atoms, so that ParaView
//! colours the surfaces by them.

use hdf5::File;
use serde::{Deserialize, Serialize};

use super::texts::text;

/// A substance on membranes that is recorded.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MembraneLayout {
    /// Its name in the file, `SYSTEM.VARIABLE`.
    pub name: String,
    /// The unit of its density.
    pub unit: String,
}

/// Where quantities of atoms stand, and where a frame begins in each.
const VALUES: &str = "/VTKHDF/PointData";
const OFFSETS: &str = "/VTKHDF/Steps/PointDataOffsets";
/// The attribute that tells a substance from other quantities of atoms, and its place among them.
pub(super) const ORDER: &str = "membrane";

impl MembraneLayout {
    /// The path of its numbers.
    pub(super) fn path(&self) -> String {
        format!("{VALUES}/{}", self.name)
    }

    /// The path of the list that says where a frame begins: a second name of another.
    pub(super) fn offsets(&self) -> String {
        format!("{OFFSETS}/{}", self.name)
    }
}

/// Reads which substances there are, in the order in which they were written.
pub(super) fn read_layouts(file: &File) -> hdf5::Result<Vec<MembraneLayout>> {
    let Ok(group) = file.group(VALUES) else { return Ok(Vec::new()) };
    let mut found: Vec<(i64, MembraneLayout)> = Vec::new();
    for name in group.member_names()?.into_iter().filter(|name| name.contains('.')) {
        let dataset = group.dataset(&name)?;
        let order = dataset.attr(ORDER)?.read_scalar()?;
        found.push((order, MembraneLayout { unit: text(&dataset, "unit")?, name }));
    }
    found.sort_by_key(|membrane| membrane.0);
    Ok(found.into_iter().map(|(_, membrane)| membrane).collect())
}
