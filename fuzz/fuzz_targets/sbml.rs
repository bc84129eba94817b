//! SBML: read, begun as the chemistry of an experiment, and written as EML, which is read again.
#![no_main]

use std::sync::{Arc, LazyLock};

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
use pseudopod::equations::eml;
use pseudopod::error::Source;
use pseudopod_fuzz::commands::told;
use pseudopod_fuzz::equations::read_and_begin;
use pseudopod_fuzz::mutate::mutate;
use pseudopod_fuzz::shipped::Shipped;
use pseudopod_fuzz::xml::change;

static SHIPPED: LazyLock<Shipped> = LazyLock::new(|| Shipped::read("xml", &["tests/messages", "tests/chemistry"]));

fuzz_target!(init: pseudopod_fuzz::one_thread(), |data: &[u8]| -> Corpus {
    let Ok(text) = std::str::from_utf8(data) else { return Corpus::Reject };
    if let Some(read) = read_and_begin(text).filter(|read| read.sbml.is_some()) {
        let written = eml::write(&read.document, "Origin: a fuzzer.").text;
        if let Err(error) = eml::read(Arc::new(Source { name: "as EML".into(), text: written })) {
            told(&error);
        }
    }
    Corpus::Keep
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, &SHIPPED, change)
});
