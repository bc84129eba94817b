//! Random numbers that belong to (seed, purpose, cell, draw) and to nothing else.
