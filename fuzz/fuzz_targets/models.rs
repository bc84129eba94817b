//! PML, LML and MML by their roots: read, written, read back equal, and a surface made of what has one.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
use pseudopod::error::Result;
use pseudopod::geometry::{SurfaceRules, check_surface};
use pseudopod::physical_model::Read;
use pseudopod::physical_model::lml::Loads;
use pseudopod::physical_model::mml::Monitoring;
use pseudopod::physical_model::pml::{PhysicalModel, Wanted};
use pseudopod_fuzz::commands::told;
use pseudopod_fuzz::mutate::mutate;
use pseudopod_fuzz::shipped::Shipped;
use pseudopod_fuzz::xml::change;

static SHIPPED: LazyLock<Shipped> =
    LazyLock::new(|| Shipped::read("pml", &["tests/messages/models", "fuzz/corpus/models"]));

/// Reads, writes and reads again.
fn there_and_back<T: PartialEq>(
    data: &[u8],
    read: fn(&str, Vec<u8>) -> Result<Read<T>>,
    write: fn(&T, &mut Vec<u8>) -> std::io::Result<()>,
) -> Option<T> {
    let first = read("fuzzed", data.to_vec()).map_err(|error| told(&error)).ok()?.document;
    let mut written = Vec::new();
    write(&first, &mut written).expect("memory takes all");
    match read("written", written.clone()) {
        Ok(second) => assert!(first == second.document, "{}", String::from_utf8_lossy(&written)),
        Err(error) => panic!("{error} in what was written: {}", String::from_utf8_lossy(&written)),
    }
    Some(first)
}

fuzz_target!(init: pseudopod_fuzz::one_thread(), |data: &[u8]| -> Corpus {
    if let Some(model) = there_and_back(data, PhysicalModel::read, |model, out| model.write(out))
        && let Ok(chosen) = model.surface("fuzzed", Wanted::TheOnly)
    {
        let _ = check_surface(&chosen.surface, &SurfaceRules::CELL);
    }
    let loads = there_and_back(data, Loads::read, |loads, out| loads.write(out));
    if let Some(load) = loads.iter().flat_map(|loads| &loads.loads).next() {
        assert!(!load.value_at(1.0).is_nan());
    }
    there_and_back(data, Monitoring::read, |monitoring, out| monitoring.write(out));
    Corpus::Keep
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, &SHIPPED, change)
});
