//! Meshes in STL: read, and checked as the surface of a cell.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use pseudopod_fuzz::mesh;

fuzz_target!(|data: &[u8]| mesh::read("fuzzed.stl", data));

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mesh::mutate("stl", data, size, max_size, seed)
});
