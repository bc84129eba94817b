//! The numbers of the methods.

/// The explicit pair of order 5(4) of Dormand and Prince (J. Comput. Appl. Math. 6, 1980), with the continuous
/// extension of order 4 by Shampine as in Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, II.6.
pub mod dormand_prince {
    /// Stages; the last is the first of the next step.
    pub const STAGES: usize = 7;
    /// Times of the stages.
    pub const C: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];
    /// Weights of earlier stages; the last row gives the new state.
    pub const A: [[f64; 6]; 7] = [
        [0.0; 6],
        [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
        [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
        [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
        [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
        [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    ];
    /// Weights of the error: order 5 less order 4.
    pub const E: [f64; 7] =
        [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];
    /// Weights of the continuous extension.
    pub const D: [f64; 7] = [
        -12715105075.0 / 11282082432.0,
        0.0,
        87487479700.0 / 32700410799.0,
        -10690763975.0 / 1880347072.0,
        701980252875.0 / 199316789632.0,
        -1453857185.0 / 822651844.0,
        69997945.0 / 29380423.0,
    ];
}

/// RODAS, the L-stable, stiffly accurate Rosenbrock method of order 4(3) with 6 stages of Hairer and Wanner, *Solving
/// Ordinary Differential Equations II*, IV.7 and IV.10 (set 1 of coefficients), with its continuous extension of order 3.
pub mod rodas {
    /// Stages.
    pub const STAGES: usize = 6;
    /// The diagonal.
    pub const GAMMA: f64 = 0.25;
    /// Times of the stages.
    pub const C: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
    /// Weights of the derivative by time.
    pub const G: [f64; 6] = [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23, 0.0, 0.0];
    /// Weights of earlier stages in the argument; the sixth is the fifth with 1 for the fifth stage.
    pub const A: [[f64; 5]; 6] = [
        [0.0; 5],
        [1.544, 0.0, 0.0, 0.0, 0.0],
        [0.946_678_528_081_582_6, 0.255_701_169_898_328_4, 0.0, 0.0, 0.0],
        [3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7, 0.0, 0.0],
        [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 0.0],
        [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 1.0],
    ];
    /// Weights of earlier stages, over the step, on the right side.
    pub const K: [[f64; 5]; 6] = [
        [0.0; 5],
        [-5.668_8, 0.0, 0.0, 0.0, 0.0],
        [-2.430_093_356_833_875, -0.206_359_915_709_191_5, 0.0, 0.0, 0.0],
        [-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16, 0.0, 0.0],
        [7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6, 0.0],
        [
            8.083_246_795_921_522,
            -7.981_132_988_064_893,
            -31.521_594_328_743_71,
            16.319_305_431_231_36,
            -6.058_818_238_834_054,
        ],
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
}
