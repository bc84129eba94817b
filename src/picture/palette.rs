//! Colours that are told apart, in the order in which curves and types of cells take them.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use super::colour::Colour;

/// The colours that were chosen by hand: those of Okabe and Ito (2008), which stay distinct under all common colour deficiencies, and
/// twelve that are far from them and from each other in a space in which equal distances look equal.
pub const PALETTE: [Colour; 20] = [
    Colour([0x00, 0x72, 0xb2]), // blue
    Colour([0xd5, 0x5e, 0x00]), // vermilion
    Colour([0x00, 0x9e, 0x73]), // bluish green
    Colour([0xe6, 0x9f, 0x00]), // orange
    Colour([0xcc, 0x79, 0xa7]), // reddish purple
    Colour([0x56, 0xb4, 0xe9]), // sky blue
    Colour([0x3c, 0x40, 0x48]), // near black
    Colour([0xf0, 0xe4, 0x42]), // yellow
    Colour([0x87, 0x78, 0xf0]), // violet
    Colour([0x87, 0x4b, 0x00]), // brown
    Colour([0x00, 0xf0, 0xc3]), // turquoise
    Colour([0x96, 0x1e, 0x78]), // plum
    Colour([0x78, 0xc3, 0x3c]), // leaf green
    Colour([0xff, 0xb4, 0xf0]), // pink
    Colour([0x3c, 0x2d, 0xa5]), // indigo
    Colour([0x00, 0x69, 0x00]), // dark green
    Colour([0x78, 0x00, 0x1e]), // wine
    Colour([0xa5, 0xb4, 0x96]), // sage
    Colour([0xff, 0xc3, 0x87]), // peach
    Colour([0x87, 0x69, 0x87]), // mauve
];

/// Colours before they repeat.
pub const COLOURS: usize = 128;

/// Colours that those beyond the palette are chosen among.
const CANDIDATES: usize = 900;

impl Colour {
    /// The colour for the curve or cell type number `index`: of the palette, then always the one of many that is farthest from all
    /// before it. Colours repeat after [`COLOURS`].
    pub fn of_palette(index: usize) -> Self {
        static BEYOND: OnceLock<Vec<Colour>> = OnceLock::new();
        let index = index % COLOURS;
        PALETTE.get(index).copied().unwrap_or_else(|| BEYOND.get_or_init(beyond)[index - PALETTE.len()])
    }

    /// Lightness, green to red and blue to yellow in OKLab (Ottosson 2020), in which equal distances look about equally large; white
    /// has lightness 1.
    pub fn oklab(self) -> [f64; 3] {
        let [r, g, b] = self.linear().map(f64::from);
        let cone =
            |from_red: f64, from_green: f64, from_blue: f64| (from_red * r + from_green * g + from_blue * b).cbrt();
        let long = cone(0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9);
        let medium = cone(0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6);
        let short = cone(0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5);
        [
            0.210_454_255_3 * long + 0.793_617_785_0 * medium - 0.004_072_046_8 * short,
            1.977_998_495_1 * long - 2.428_592_205_0 * medium + 0.450_593_709_9 * short,
            0.025_904_037_1 * long + 0.782_771_766_2 * medium - 0.808_675_766_0 * short,
        ]
    }

    /// The colour at a point of OKLab; `None` where screens have none.
    fn from_oklab([lightness, a, b]: [f64; 3]) -> Option<Self> {
        let long = (lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
        let medium = (lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
        let short = (lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b).powi(3);
        let linear = [
            4.076_741_662_1 * long - 3.307_711_591_3 * medium + 0.230_969_929_2 * short,
            -1.268_438_004_6 * long + 2.609_757_401_1 * medium - 0.341_319_396_5 * short,
            -0.004_196_086_3 * long - 0.703_418_614_7 * medium + 1.707_614_701_0 * short,
        ];
        let byte = |light: f64| {
            let value = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 };
            (value * 255.0).round() as u8
        };
        linear.iter().all(|light| (0.0..=1.0).contains(light)).then(|| Self(linear.map(byte)))
    }
}

/// How different two colours look.
fn apart(one: [f64; 3], other: [f64; 3]) -> f64 {
    (0..3).map(|k| (one[k] - other[k]).powi(2)).sum::<f64>().sqrt()
}

/// The colours beyond the palette: each is the candidate that is farthest from all before it.
fn beyond() -> Vec<Colour> {
    let candidates: Vec<([f64; 3], Colour)> = (1..).filter_map(candidate).take(CANDIDATES).collect();
    let to_palette =
        |at: [f64; 3]| PALETTE.iter().map(|colour| apart(at, colour.oklab())).fold(f64::INFINITY, f64::min);
    let mut nearest: Vec<f64> = candidates.iter().map(|(at, _)| to_palette(*at)).collect();
    let next = |_| {
        let best = (0..CANDIDATES).fold(0, |best, other| if nearest[other] > nearest[best] { other } else { best });
        for (known, (at, _)) in nearest.iter_mut().zip(&candidates) {
            *known = known.min(apart(*at, candidates[best].0));
        }
        candidates[best].1
    };
    (PALETTE.len()..COLOURS).map(next).collect()
}

/// Point number `index` of a sequence that fills the colours which are neither pale nor black nor grey nor glaring. Multiples of the
/// powers of one number, the root of x⁴ = x + 1, fill three dimensions evenly (Roberts 2018).
fn candidate(index: u32) -> Option<([f64; 3], Colour)> {
    const ROOT: f64 = 1.220_744_084_605_759_5;
    let share = |power: i32| (f64::from(index) * ROOT.powi(-power)).fract();
    let (lightness, chroma, hue) = (0.38 + 0.48 * share(1), 0.05 + 0.13 * share(2), TAU * share(3));
    let at = [lightness, chroma * hue.cos(), chroma * hue.sin()];
    Some((at, Colour::from_oklab(at)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nearest(count: usize) -> f64 {
        let points: Vec<[f64; 3]> = (0..count).map(|index| Colour::of_palette(index).oklab()).collect();
        let others = |i: usize| points[..i].iter().map(move |other| (i, other));
        (0..count).flat_map(others).map(|(i, other)| apart(points[i], *other)).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn twenty_colours_are_told_apart_and_more_as_well_as_may_be() {
        // The eight of Okabe and Ito are 0.156 from each other at the least; 0.02 is what an eye just sees side by side.
        assert!(nearest(8) > 0.15, "{}", nearest(8));
        assert!(nearest(20) > 0.12, "{}", nearest(20));
        assert!(nearest(40) > 0.07, "{}", nearest(40));
        assert!(nearest(COLOURS) > 0.03, "{}", nearest(COLOURS));
    }

    #[test]
    fn colours_stand_out_on_white() {
        let white = Colour([255; 3]).oklab();
        assert!((white[0] - 1.0).abs() < 1e-6 && white[1].abs() < 1e-6, "{white:?}");
        let least =
            (0..COLOURS).map(|index| apart(Colour::of_palette(index).oklab(), white)).fold(f64::INFINITY, f64::min);
        assert!(least > 0.13, "{least}");
    }

    #[test]
    fn one_number_has_one_colour() {
        assert_eq!(Colour::of_palette(0).hex(), "#0072b2");
        assert_eq!(Colour::of_palette(7).hex(), "#f0e442");
        assert_eq!(Colour::of_palette(33), Colour::of_palette(33 + COLOURS));
        for colour in PALETTE {
            let [l, a, b] = colour.oklab();
            let back = Colour::from_oklab([l - 1e-6, a, b]).map(|back| apart(back.oklab(), colour.oklab()));
            assert!(back.is_none_or(|off| off < 0.01), "{colour:?} {back:?}");
        }
    }
}
