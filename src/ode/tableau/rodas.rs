//! RODAS, the L-stable, stiffly accurate Rosenbrock method of order 4(3) with 6 stages of Hairer and Wanner, *Solving
//! Ordinary Differential Equations II*, IV.7 and IV.10 (set 1 of coefficients), with its continuous extension of order 3.

/// Stages.
pub const STAGES: usize = 6;
/// The diagonal.
pub const GAMMA: f64 = 0.25;
/// Times of the stages.
pub const C: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
/// Weights of the derivative by time.
pub const G: [f64; 6] = [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23, 0.0, 0.0];
/// Weights of earlier stages in the argument of the second stage.
pub const A1: [f64; 1] = [1.544];
/// Of the third.
pub const A2: [f64; 2] = [0.946_678_528_081_582_6, 0.255_701_169_898_328_4];
/// Of the fourth.
pub const A3: [f64; 3] = [3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7];
/// Of the fifth.
pub const A4: [f64; 4] = [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895];
/// Of the sixth: the fifth with 1 for the fifth stage.
pub const A5: [f64; 5] = [A4[0], A4[1], A4[2], A4[3], 1.0];
/// Weights of earlier stages, over the step, on the right side of the second stage.
pub const K1: [f64; 1] = [-5.668_8];
/// Of the third.
pub const K2: [f64; 2] = [-2.430_093_356_833_875, -0.206_359_915_709_191_5];
/// Of the fourth.
pub const K3: [f64; 3] = [-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16];
/// Of the fifth.
pub const K4: [f64; 4] = [7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6];
/// Of the sixth.
pub const K5: [f64; 5] = [
    8.083_246_795_921_522,
    -7.981_132_988_064_893,
    -31.521_594_328_743_71,
    16.319_305_431_231_36,
    -6.058_818_238_834_054,
];
/// First weights of the continuous extension.
pub const D2: [f64; 5] = [
    10.126_235_083_445_86,
    -7.487_995_877_610_167,
    -34.800_918_615_557_47,
    -7.992_771_707_568_823,
    1.025_137_723_295_662,
];
/// Second weights of the continuous extension.
pub const D3: [f64; 5] = [
    -0.676_280_339_280_689_8,
    6.087_714_651_680_015,
    16.430_843_208_924_78,
    24.767_225_114_183_86,
    -6.594_389_125_716_872,
];
