//! Repeatable numbers for the tests of this folder: the generator SplitMix64 (Steele, Lea & Flood 2014).

/// Numbers uniform in [0, 1), the same for the same seed.
pub fn uniform(seed: u64) -> impl FnMut() -> f64 {
    // Seeds one apart would give streams that are shifted copies of each other, so they are spread first.
    let mut state = seed.wrapping_mul(0xD134_2543_DE82_EF95);
    move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
