//! The experiment document: read, checked as a whole, compiled.
