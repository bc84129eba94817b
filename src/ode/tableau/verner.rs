//! The explicit pair of order 6(5) of Verner with nine stages, of which the last is the first of the next step (Numerical Algorithms
//! 53, 2010, 383–396, the "most efficient" one), and its tenth stage: a state of order 5 in the middle of the step.
//!
//! Some coefficients are so large that sums of them, rounded, are off by 10⁻¹⁴, which would add up from step to step. So the last of `A6`,
//! `A7` and `A8`, three of `B` and the first of `E` differ from the published ones by up to 2·10⁻¹¹ of their size: the sums of the rows
//! are the times of the stages and those of `B` meet the conditions of quadrature to order 3 within 10⁻¹⁵.

/// Times of the stages.
pub const C: [f64; 9] = [0.0, 0.06, 0.095_933_333_333_333_33, 0.143_9, 0.497_3, 0.972_5, 0.999_5, 1.0, 1.0];
/// Weights of earlier stages.
pub const A2: [f64; 1] = [0.06];
/// As above.
pub const A3: [f64; 2] = [0.019_239_962_962_962_962, 0.076_693_370_370_370_37];
/// As above.
pub const A4: [f64; 3] = [0.035_975, 0.0, 0.107_925];
/// As above.
pub const A5: [f64; 4] = [1.318_683_415_233_148_4, 0.0, -5.042_058_063_628_562, 4.220_674_648_395_414];
/// As above.
pub const A6: [f64; 5] =
    [-41.872_591_664_327_516, 0.0, 159.432_562_163_137_5, -122.119_213_565_010_03, 5.531_743_066_200_04];
/// As above.
pub const A7: [f64; 6] = [
    -54.430_156_935_316_504,
    0.0,
    207.067_251_365_018_48,
    -158.610_813_784_59,
    6.991_816_585_950_242,
    -0.018_597_231_062_223_55,
];
/// As above.
pub const A8: [f64; 7] = [
    -54.663_741_787_281_98,
    0.0,
    207.952_806_255_389_36,
    -159.288_957_474_499_5,
    7.018_743_740_796_944,
    -0.018_338_785_905_045_722,
    -0.000_511_948_499_770_827_1,
];
/// Weights of the new state.
pub const B: [f64; 8] = [
    0.034_389_578_683_660_44,
    0.0,
    0.0,
    0.258_262_455_563_217_5,
    0.420_937_118_967_382_73,
    4.405_396_469_669_31,
    -176.483_119_024_298_65,
    172.364_133_401_415_07,
];
/// Weights of the error: order 5 less order 6.
pub const E: [f64; 9] = [
    0.014_710_097_800_262_993,
    0.0,
    0.0,
    -0.033_151_232_611_697_924,
    0.048_531_106_335_602_49,
    -3.598_817_244_670_423_4,
    176.483_119_024_298_65,
    -172.971_252_890_592_87,
    0.056_861_139_440_475_696,
];
/// Weights of the state in the middle of the step.
pub const MIDDLE: [f64; 9] = [
    0.016_524_159_013_572_806,
    0.0,
    0.0,
    0.305_312_818_751_417_9,
    0.207_120_093_820_197_9,
    -1.293_879_140_655_123,
    57.119_884_115_881_49,
    -55.879_792_075_109_32,
    0.024_830_028_297_766_014,
];

/// The weights of a stage's argument, or of the new state for the last.
pub fn row(stage: usize) -> &'static [f64] {
    match stage {
        0 => &[],
        1 => &A2,
        2 => &A3,
        3 => &A4,
        4 => &A5,
        5 => &A6,
        6 => &A7,
        7 => &A8,
        _ => &B,
    }
}
