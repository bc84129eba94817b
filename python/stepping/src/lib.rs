//! The front door of pseudopod for Python. What users see is `pseudopod_stepping.Simulation`, a class in Python over the `Core` of
//! this module, which does as it is told and holds what it must: a simulation behind a lock, and numbers that arrays show.

mod block;
mod core;
mod errors;
mod held;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use super::block::Block;
    #[pymodule_export]
    use super::core::Core;
}
