//! The numbers of the methods.

/// The explicit pair of order 5(4) of Tsitouras (Computers & Mathematics with Applications 62, 2011, 770–775) with its
/// continuous extension of order 4. The last stage is the first of the next step.
pub mod tsitouras {
    use crate::chemistry::ode::block::NEAR;
    use crate::chemistry::program::Tableau;

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
    pub const TABLEAU: Tableau = Tableau { times: C, weights: row, error: E, near: NEAR };
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
    /// Weights of earlier stages in the argument of the second stage.
    pub const A1: [f64; 1] = [1.544];
    /// Of the third.
    pub const A2: [f64; 2] = [0.946_678_528_081_582_6, 0.255_701_169_898_328_4];
    /// Of the fourth.
    pub const A3: [f64; 3] = [3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7];
    /// Of the fifth.
    pub const A4: [f64; 4] =
        [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895];
    /// Of the sixth: the fifth with 1 for the fifth stage.
    pub const A5: [f64; 5] = [A4[0], A4[1], A4[2], A4[3], 1.0];
    /// Weights of earlier stages, over the step, on the right side of the second stage.
    pub const K1: [f64; 1] = [-5.668_8];
    /// Of the third.
    pub const K2: [f64; 2] = [-2.430_093_356_833_875, -0.206_359_915_709_191_5];
    /// Of the fourth.
    pub const K3: [f64; 3] = [-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16];
    /// Of the fifth.
    pub const K4: [f64; 4] =
        [7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6];
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
}

#[cfg(test)]
mod tests {
    use super::tsitouras::{B, C, D, E, row};

    type Weights = [f64; 7];

    fn dot(a: Weights, b: Weights) -> f64 {
        a.iter().zip(&b).map(|(a, b)| a * b).sum()
    }

    fn times(a: Weights, b: Weights) -> Weights {
        std::array::from_fn(|i| a[i] * b[i])
    }

    /// The matrix of the stages times a vector.
    fn staged(vector: Weights) -> Weights {
        std::array::from_fn(|stage| row(stage).iter().zip(&vector).map(|(a, b)| a * b).sum())
    }

    /// How far weights are from the conditions up to an order at a share of the step: one for each rooted tree.
    fn distance(b: Weights, order: i32, share: f64) -> f64 {
        let (c, c2) = (C, times(C, C));
        let (c3, ac) = (times(c2, c), staged(c));
        let ac2 = staged(c2);
        let conditions = [
            (1, dot(b, [1.0; 7]), 1.0),
            (2, dot(b, c), 2.0),
            (3, dot(b, c2), 3.0),
            (3, dot(b, ac), 6.0),
            (4, dot(b, c3), 4.0),
            (4, dot(b, times(c, ac)), 8.0),
            (4, dot(b, ac2), 12.0),
            (4, dot(b, staged(ac)), 24.0),
            (5, dot(b, times(c2, c2)), 5.0),
            (5, dot(b, times(c2, ac)), 10.0),
            (5, dot(b, times(ac, ac)), 20.0),
            (5, dot(b, times(c, ac2)), 15.0),
            (5, dot(b, staged(c3)), 20.0),
            (5, dot(b, times(c, staged(ac))), 30.0),
            (5, dot(b, staged(times(c, ac))), 40.0),
            (5, dot(b, staged(ac2)), 60.0),
            (5, dot(b, staged(staged(ac))), 120.0),
        ];
        let of_order = conditions.iter().filter(|(of, ..)| *of <= order);
        of_order.map(|(of, value, density)| (value - share.powi(*of) / density).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn the_explicit_pair_meets_the_conditions_of_its_orders() {
        let fifth: Weights = std::array::from_fn(|stage| if stage < 6 { B[stage] } else { 0.0 });
        let fourth: Weights = std::array::from_fn(|stage| fifth[stage] + E[stage]);
        // The coefficients have 16 digits and are as large as 13.
        assert!(distance(fifth, 5, 1.0) < 1e-13 && distance(fourth, 4, 1.0) < 1e-13);
        assert!(distance(fourth, 5, 1.0) > 1e-5, "the error estimate must see the fifth order");
        for stage in 0..7 {
            let sum: f64 = row(stage).iter().sum();
            assert!((sum - C[stage]).abs() < 1e-13);
        }
    }

    #[test]
    fn values_between_are_of_order_4_and_end_at_the_new_state() {
        let weights =
            |share: f64| -> Weights { D.map(|row| row.iter().rev().fold(0.0, |sum, weight| (sum + weight) * share)) };
        for share in [0.2, 0.5, 0.9, 1.0] {
            // Coefficients as large as 88 with 16 digits.
            assert!(distance(weights(share), 4, share) < 1e-12, "{share}");
        }
        (0..7).for_each(|stage| assert!((weights(1.0)[stage] - row(6).get(stage).unwrap_or(&0.0)).abs() < 1e-12));
    }
}
