//! What a living cell does with mechanics: it wanders and is attracted.

pub mod motility;
