//! What pictures, charts and exports show of fields and chemistry, from a made-up result.

mod example;
mod pictures;
mod plots;
