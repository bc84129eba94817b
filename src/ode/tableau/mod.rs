//! The numbers of the methods.

#[cfg(test)]
mod conditions;
pub mod rodas;
pub mod tsitouras;
pub mod verner;
