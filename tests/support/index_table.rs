//! The table of measured indices of chemotaxis.

use std::path::PathBuf;

use pseudopod::analysis::table::Table;

use crate::shared::shared;

/// A row: a concentration (nM) in a gradient (nM/mm), and the index that was measured there.
#[derive(Clone, Copy)]
pub struct Measured {
    pub concentration: f64,
    pub gradient: f64,
    pub index: f64,
}

/// All rows; `PSEUDOPOD_INDEX_TABLE` names another table of the same columns.
pub fn index_table() -> Option<Vec<Measured>> {
    let other = std::env::var_os("PSEUDOPOD_INDEX_TABLE").map(PathBuf::from);
    let path = other.or_else(|| shared("migration/chemotactic_index_open.csv"))?;
    let table = Table::read(&path).expect("a table");
    let [concentration, gradient, index] = ["concentration_nM", "gradient_nM_per_mm", "chemotactic_index"]
        .map(|name| table.column(name).expect("a column"));
    let row = |row: usize| Measured { concentration: concentration[row], gradient: gradient[row], index: index[row] };
    Some((0..table.rows()).map(row).collect())
}
