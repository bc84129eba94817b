//! What a living cell does with mechanics and chemistry: it wanders, is attracted, senses, secretes, and changes what
//! it is made of as its chemistry tells.
pub mod ends;
pub mod motility;
