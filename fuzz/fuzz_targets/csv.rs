//! Tables: measured curves, and measured tracks with their measures.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
use pseudopod::analysis::furth::Localisation;
use pseudopod::analysis::table::Table;
use pseudopod::analysis::tracks::motion::Cue;
use pseudopod::analysis::tracks::read::{Options, parse};
use pseudopod::analysis::tracks::summary::{Wishes, summary};
use pseudopod_fuzz::commands::told;
use pseudopod_fuzz::mutate::mutate;
use pseudopod_fuzz::shipped::Shipped;
use pseudopod_fuzz::table::change;

static SHIPPED: LazyLock<Shipped> = LazyLock::new(|| Shipped::read("csv", &["experiments", "tests"]));

/// More tracks and frames take their time, a thousand draws for each measure.
const MOST_SPOTS: usize = 400;

fuzz_target!(init: pseudopod_fuzz::one_thread(), |data: &[u8]| -> Corpus {
    let Ok(text) = std::str::from_utf8(data) else { return Corpus::Reject };
    if let Err(error) = Table::parse("fuzzed.csv", text) {
        told(&error);
    }
    match parse("fuzzed.csv", text, &Options::default()) {
        Err(error) => told(&error),
        Ok(read) if read.tracks.number() * read.tracks.times.len() <= MOST_SPOTS => {
            let tracks = read.tracks;
            let lags = tracks.usual_lags();
            let cue = Some(Cue::Direction([1.0, 0.0, 0.0]));
            summary(&tracks, &Wishes { cue, localisation: Localisation::Noisy, lags, seed: 0 });
        }
        Ok(_) => {}
    }
    Corpus::Keep
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, &SHIPPED, change)
});
