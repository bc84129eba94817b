//! Systems of chemistry in the result file: one group for each, one dataset for each quantity. Those inside cells are
//! quantities of cells like others, NaN for a cell without the system.

use hdf5::File;
use serde::{Deserialize, Serialize};

use super::container::set_number;
use super::texts::{set_text, text};

/// A system of chemistry whose quantities are recorded.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SystemLayout {
    /// Name of the system, and of its group in the file.
    pub name: String,
    /// Where it lives.
    pub scope: SystemScope,
    /// Names and units of its quantities.
    pub quantities: Vec<(String, String)>,
}

/// Where a system lives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum SystemScope {
    /// There is one of it, in the scene.
    #[default]
    Scene,
    /// There is one of it in each of some cells.
    Cells,
}

/// The attribute of a group that says where its system lives.
const SCOPE: &str = "in";
const SCENE: &str = "scene";
const CELLS: &str = "cells";

impl SystemLayout {
    /// The path of a quantity in the file.
    pub(super) fn path(&self, quantity: &str) -> String {
        format!("/chemistry/{}/{quantity}", self.name)
    }
}

/// Makes the groups of the systems.
pub(super) fn create_groups(file: &File, systems: &[SystemLayout]) -> hdf5::Result<()> {
    for (order, system) in (0_i64..).zip(systems) {
        let path = format!("/chemistry/{}", system.name);
        if file.group("chemistry").is_err() {
            file.create_group("chemistry")?;
        }
        let group = file.create_group(&path)?;
        set_number(&group, "order", order)?;
        set_text(&group, SCOPE, if system.scope == SystemScope::Scene { SCENE } else { CELLS })?;
    }
    Ok(())
}

/// Reads the layouts of the systems, in the order in which they were written.
pub(super) fn read_layouts(file: &File) -> hdf5::Result<Vec<SystemLayout>> {
    let Ok(all) = file.group("chemistry") else { return Ok(Vec::new()) };
    let mut found: Vec<(i64, SystemLayout)> = Vec::new();
    for name in all.member_names()? {
        let group = all.group(&name)?;
        let mut quantities: Vec<(i64, String, String)> = Vec::new();
        for name in group.member_names()? {
            let dataset = group.dataset(&name)?;
            let unit = text(&dataset, "unit")?;
            quantities.push((dataset.attr("order")?.read_scalar()?, name, unit));
        }
        quantities.sort_by_key(|quantity| quantity.0);
        let quantities = quantities.into_iter().map(|(_, name, unit)| (name, unit)).collect();
        let scope = if text(&group, SCOPE)? == CELLS { SystemScope::Cells } else { SystemScope::Scene };
        found.push((group.attr("order")?.read_scalar()?, SystemLayout { name, scope, quantities }));
    }
    found.sort_by_key(|system| system.0);
    Ok(found.into_iter().map(|(_, layout)| layout).collect())
}
