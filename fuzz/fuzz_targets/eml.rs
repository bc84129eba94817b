//! EML: read, and begun as the chemistry of an experiment.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
use pseudopod_fuzz::equations::read_and_begin;
use pseudopod_fuzz::mutate::mutate;
use pseudopod_fuzz::shipped::Shipped;
use pseudopod_fuzz::xml::change;

static SHIPPED: LazyLock<Shipped> = LazyLock::new(|| Shipped::read("eml", &["eml", "experiments", "tests/messages"]));

fuzz_target!(init: pseudopod_fuzz::one_thread(), |data: &[u8]| -> Corpus {
    let Ok(text) = std::str::from_utf8(data) else { return Corpus::Reject };
    read_and_begin(text);
    Corpus::Keep
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, &SHIPPED, change)
});
