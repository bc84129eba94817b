//! Systems of chemistry in the result file: one group for each, one dataset for each quantity.

use std::borrow::Cow;

use hdf5::File;

use super::Layout;
use super::column::{Column, Number, PackedColumn, Plan, push_frames, write_integers};
use super::columns::MANY_CELLS;
use super::container::{set_number, text};

/// A system of chemistry whose quantities are recorded.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SystemLayout {
    /// Name of the system, and of its group in the file.
    pub name: String,
    /// Where it lives.
    pub scope: SystemScope,
    /// Names and units of its quantities.
    pub quantities: Vec<(String, String)>,
}

/// Where a system lives.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum SystemScope {
    /// There is one of it, in the scene.
    #[default]
    Scene,
    /// There is one of it in each of these cells, by their numbers in [`Layout::cells`].
    Cells(Vec<u32>),
}

impl SystemLayout {
    /// How many of it there are.
    pub fn members(&self) -> usize {
        match &self.scope {
            SystemScope::Scene => 1,
            SystemScope::Cells(cells) => cells.len(),
        }
    }

    /// The path of a quantity in the file.
    pub(super) fn path(&self, quantity: &str) -> String {
        format!("/chemistry/{}/{quantity}", self.name)
    }

    /// The path of the list of cells. It stands apart, since a quantity may have any name.
    fn cells_path(&self) -> String {
        format!("/chemistry_cells/{}", self.name)
    }
}

/// The datasets of all systems: for each system, for each quantity.
#[derive(Default)]
pub(super) struct SystemColumns {
    columns: Vec<Vec<SystemColumn>>,
}

enum SystemColumn {
    Small(Column),
    Large(PackedColumn),
}

impl SystemColumns {
    /// Makes the datasets.
    pub fn create(file: &File, layout: &Layout) -> hdf5::Result<Self> {
        let mut made = Self::default();
        for (order, system) in (0_i64..).zip(&layout.systems) {
            if let SystemScope::Cells(cells) = &system.scope {
                let description = "Cells that have a system of their own, in the order of its datasets.";
                let plan = Plan { path: &system.cells_path(), number: Number::Integer, unit: "1", description };
                write_integers(file, &plan, cells.len(), |i| i64::from(cells[i]))?;
            }
            for parent in ["chemistry", &format!("chemistry/{}", system.name)] {
                if file.group(parent).is_err() {
                    file.create_group(parent)?;
                }
            }
            let group = file.group(&format!("chemistry/{}", system.name))?;
            set_number(&group, "order", order)?;
            let columns = (0_i64..).zip(&system.quantities).map(|(order, (name, unit))| {
                let path = system.path(name);
                let description = format!("{name} of the system {}.", system.name);
                let plan = Plan { path: &path, number: Number::Float, unit, description: &description };
                let column = match system.scope {
                    SystemScope::Scene => SystemColumn::Small(Column::create(file, &plan, &[])?),
                    SystemScope::Cells(_) if system.members() >= MANY_CELLS => {
                        SystemColumn::Large(PackedColumn::create(file, &plan, 1, &[system.members()])?)
                    }
                    SystemScope::Cells(_) => SystemColumn::Small(Column::create(file, &plan, &[system.members()])?),
                };
                let dataset = file.dataset(&path)?;
                set_number(&dataset, "order", order)?;
                Ok(column)
            });
            made.columns.push(columns.collect::<hdf5::Result<_>>()?);
        }
        Ok(made)
    }

    /// Opens the datasets and cuts them to their first frames.
    pub fn reopen(file: &File, layout: &Layout, frames: usize) -> hdf5::Result<Self> {
        let mut found = Self::default();
        for system in &layout.systems {
            let row = [system.members()];
            let columns = system.quantities.iter().map(|(name, _)| {
                let path = system.path(name);
                Ok(match system.scope {
                    SystemScope::Scene => SystemColumn::Small(Column::reopen(file, &path, Number::Float, &[], frames)?),
                    SystemScope::Cells(_) if system.members() >= MANY_CELLS => {
                        SystemColumn::Large(PackedColumn::reopen(file, &path, 1, &row, frames)?)
                    }
                    SystemScope::Cells(_) => {
                        SystemColumn::Small(Column::reopen(file, &path, Number::Float, &row, frames)?)
                    }
                })
            });
            found.columns.push(columns.collect::<hdf5::Result<_>>()?);
        }
        Ok(found)
    }

    /// Appends the values of a frame.
    ///
    /// # Panics
    /// If they do not fit the layout.
    pub fn append(&mut self, layout_members: &[usize], values: &[Vec<Vec<f64>>]) -> hdf5::Result<()> {
        assert_eq!(values.len(), self.columns.len(), "the systems of a frame must fit the layout");
        let mut large = Vec::new();
        for ((columns, quantities), members) in self.columns.iter_mut().zip(values).zip(layout_members) {
            assert_eq!(quantities.len(), columns.len(), "the quantities of a frame's system must fit the layout");
            for (column, values) in columns.iter_mut().zip(quantities) {
                assert_eq!(values.len(), *members, "the values of a frame's quantity must fit the layout");
                match column {
                    SystemColumn::Small(column) => column.push(values.iter().map(|value| value.to_bits()))?,
                    SystemColumn::Large(column) => large.push((column, Cow::from(values.as_slice()))),
                }
            }
        }
        push_frames(&mut large)
    }

    /// Hands all rows that are still in memory to the file.
    pub fn write(&mut self) -> hdf5::Result<()> {
        self.columns.iter_mut().flatten().try_for_each(|column| match column {
            SystemColumn::Small(column) => column.write(),
            SystemColumn::Large(_) => Ok(()),
        })
    }

    /// See [`PackedColumn::renewed`].
    pub fn renew(&mut self, file: &File) -> hdf5::Result<()> {
        for columns in &mut self.columns {
            for column in std::mem::take(columns) {
                columns.push(match column {
                    SystemColumn::Small(column) => SystemColumn::Small(column),
                    SystemColumn::Large(column) => SystemColumn::Large(column.renewed(file)?),
                });
            }
        }
        Ok(())
    }
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
        let mut system = SystemLayout { name, scope: SystemScope::Scene, quantities };
        if file.link_exists("chemistry_cells")
            && let Ok(cells) = file.dataset(&system.cells_path())
        {
            let cells = cells.read_raw::<i64>()?.into_iter().map(|cell| u32::try_from(cell).unwrap_or(u32::MAX));
            system.scope = SystemScope::Cells(cells.collect());
        }
        found.push((group.attr("order")?.read_scalar()?, system));
    }
    found.sort_by_key(|system| system.0);
    Ok(found.into_iter().map(|(_, layout)| layout).collect())
}
