//! What is said about bad input: each text is kept beside the input that causes it.
//!
//! `PSEUDOPOD_BLESS=1 cargo test --release --test messages` writes the texts anew; read the difference before committing it.

mod documents;
mod eml;
mod experiments;
mod fields;
mod fits;
mod kept;
mod meshes;
mod physical_models;
mod runs;
mod sbml;
mod studies;

#[path = "../support/turns.rs"]
mod turns;
