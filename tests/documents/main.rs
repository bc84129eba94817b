//! The experiment document: what is understood, and where it makes a run start.

mod contact;
mod meaning;
mod population;
mod start;
