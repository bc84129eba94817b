//! Numbers that arrays of NumPy show without a copy.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Where numbers lie.
pub enum Numbers {
    /// Of a series or of fields.
    Plain(Arc<Vec<f64>>),
    /// Positions of atoms, µm.
    Positions(Arc<Vec<[f64; 3]>>),
}

/// Numbers that nobody changes any more, for arrays of NumPy to show.
///
/// An array that is made from it (by NumPy's array interface) is read-only and keeps it alive. A vector behind an `Arc` is changed only by
/// who holds it alone (`Arc::get_mut`, `Arc::make_mut`); while a block is there, nobody does, and so the memory stays where and as it is.
#[pyclass(frozen, module = "pseudopod_stepping._native")]
pub struct Block {
    numbers: Numbers,
    shape: Vec<usize>,
}

impl Block {
    /// Numbers in one row.
    pub fn row(numbers: Vec<f64>) -> Self {
        Self { shape: vec![numbers.len()], numbers: Numbers::Plain(Arc::new(numbers)) }
    }

    /// Positions, three numbers an atom.
    pub fn positions(positions: Arc<Vec<[f64; 3]>>) -> Self {
        Self { shape: vec![positions.len(), 3], numbers: Numbers::Positions(positions) }
    }

    /// Values of fields: species, then boxes along z, y and x.
    pub fn fields(values: Arc<Vec<f64>>, [x, y, z]: [usize; 3]) -> Self {
        let species = values.len() / (x * y * z);
        assert_eq!(species * x * y * z, values.len(), "one number for each species and box");
        Self { shape: vec![species, z, y, x], numbers: Numbers::Plain(values) }
    }
}

#[pymethods]
impl Block {
    #[getter(__array_interface__)]
    fn array_interface<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let first = match &self.numbers {
            Numbers::Plain(numbers) => numbers.as_ptr().addr(),
            Numbers::Positions(positions) => positions.as_ptr().addr(),
        };
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("typestr", if cfg!(target_endian = "little") { "<f8" } else { ">f8" })?;
        interface.set_item("shape", pyo3::types::PyTuple::new(py, &self.shape)?)?;
        interface.set_item("data", (first, true))?;
        Ok(interface)
    }
}
