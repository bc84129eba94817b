//! What pictures, charts and exports show of a result.

mod cells;
mod example;
mod fields;
mod linked;
mod plots;
mod populations;
#[cfg(feature = "view")]
mod view;
