//! The explicit pair of order 5(4) of Tsitouras (Computers & Mathematics with Applications 62, 2011, 770–775) with its
//! continuous extension of order 4. The last stage is the first of the next step.

use crate::equations::program::Tableau;
use crate::ode::control::NEAR;

/// Times of the stages.
pub const C: [f64; 7] = [0.0, 0.161, 0.327, 0.9, 0.980_025_540_904_509_7, 1.0, 1.0];
/// Weights of earlier stages.
pub const A2: [f64; 1] = [0.161];
/// As above.
pub const A3: [f64; 2] = [-0.008_480_655_492_356_989, 0.335_480_655_492_357];
/// As above.
pub const A4: [f64; 3] = [2.897_153_057_105_493_5, -6.359_448_489_975_075, 4.362_295_432_869_581_5];
/// As above.
pub const A5: [f64; 4] =
    [5.325_864_828_439_257, -11.748_883_564_062_828, 7.495_539_342_889_836_5, -0.092_495_066_361_755_25];
/// As above.
pub const A6: [f64; 5] = [
    5.861_455_442_946_42,
    -12.920_969_317_847_11,
    8.159_367_898_576_159,
    -0.071_584_973_281_401,
    -0.028_269_050_394_068_383,
];
/// Weights of the new state.
pub const B: [f64; 6] = [
    0.096_460_766_818_065_23,
    0.01,
    0.479_889_650_414_499_6,
    1.379_008_574_103_742,
    -3.290_069_515_436_081,
    2.324_710_524_099_774,
];
/// Weights of the error: order 4 less order 5.
pub const E: [f64; 7] = [
    -0.001_780_011_052_225_777,
    -0.000_816_434_459_656_746_9,
    0.007_880_878_010_261_995,
    -0.144_711_007_173_262_9,
    0.582_357_165_452_555_2,
    -0.458_082_105_929_186_97,
    1.0 / 66.0,
];
/// The continuous extension: the weight of a stage at a share of the step, by powers of the share from the first on.
pub const D: [[f64; 4]; 7] = [
    [1.0, -2.763_706_197_274_826, 2.913_255_461_821_912_6, -1.053_088_497_729_021_6],
    [0.0, 0.1317, -0.2234, 0.1017],
    [0.0, 3.930_296_236_894_751_6, -5.941_033_872_131_505, 2.490_627_285_651_253],
    [0.0, -12.411_077_166_933_676, 30.338_188_630_282_32, -16.548_102_889_244_902],
    [0.0, 37.509_313_416_511_04, -88.178_904_894_766_4, 47.379_521_962_819_28],
    [0.0, -27.896_526_289_197_286, 65.091_894_674_793_66, -34.870_657_861_496_61],
    [0.0, 1.5, -4.0, 2.5],
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
        _ => &B,
    }
}

/// All of it, for machine code.
pub const TABLEAU: Tableau = Tableau { number: 0, times: &C, weights: row, error: &E, near: NEAR };
