//! Colours for cells, curves and numbers, chosen so that readers with any colour vision can tell them apart.

use super::ticks::Scale;

/// A colour in sRGB, as screens and image files mean it: red, green, blue, 0 to 255.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Colour(pub [u8; 3]);

impl Colour {
    /// The form `#rrggbb` that SVG reads.
    pub fn hex(self) -> String {
        let [r, g, b] = self.0;
        format!("#{r:02x}{g:02x}{b:02x}")
    }

    /// Reads `#rrggbb` (the `#` may be missing); `None` when the text is not that.
    pub fn from_hex(text: &str) -> Option<Self> {
        let digits = text.strip_prefix('#').unwrap_or(text);
        if digits.len() != 6 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return None;
        }
        let number = u32::from_str_radix(digits, 16).ok()?;
        Some(Self([(number >> 16) as u8, (number >> 8) as u8, number as u8]))
    }

    /// A mixture in sRGB: this colour at `share` 0, `other` at 1.
    pub fn mixed(self, other: Self, share: f64) -> Self {
        let share = share.clamp(0.0, 1.0);
        Self(std::array::from_fn(|k| {
            (f64::from(self.0[k]) + share * (f64::from(other.0[k]) - f64::from(self.0[k]))).round() as u8
        }))
    }

    /// The amounts of light, 0 to 1 and linear, that shading calculates with.
    pub(crate) fn linear(self) -> [f32; 3] {
        self.0.map(|byte| {
            let value = f32::from(byte) / 255.0;
            if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        })
    }
}

/// Numbers that differ by less than this share of their size are one: what is below is round-off.
const ROUND_OFF: f64 = 1e-6;

/// The ends of a scale for numbers between two: one number twice where they differ by round-off alone, or by less than `least`, and
/// from 0 to 1 where there are none.
pub(crate) fn scale_of([low, high]: [f64; 2], least: f64) -> [f64; 2] {
    if !(low.is_finite() && high.is_finite()) {
        return [0.0, 1.0];
    }
    let size = low.abs().max(high.abs());
    match high - low <= (ROUND_OFF * size).max(least) {
        true if size <= least => [0.0; 2],
        true => [0.5 * (low + high); 2],
        false => [low, high],
    }
}

/// Decades that a logarithmic scale has at most, unless it is told its ends: what is smaller is as good as nothing.
const DECADES: f64 = 1e6;

/// The ends of a logarithmic scale for numbers above 0, the least and the largest of them.
pub(crate) fn decades_of([least, largest]: [f64; 2]) -> [f64; 2] {
    if !(largest > 0.0 && largest.is_finite()) {
        return [0.1, 1.0];
    }
    let low = least.max(largest / DECADES);
    if largest - low <= ROUND_OFF * largest { [largest; 2] } else { [low, largest] }
}

/// How a number becomes a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// Dark violet to yellow, equally bright steps; the default for quantities that start at zero.
    #[default]
    Viridis,
    /// Black to pale yellow.
    Magma,
    /// Pale yellow to dark purple: magma turned round and without its black, so that a field leaves its background light where
    /// it is absent, and cells and their shadows stand out on it.
    Ink,
    /// Blue to red through grey, for quantities with a meaningful middle such as a signed error.
    Coolwarm,
}

impl ColourMap {
    /// The colour at `position` between 0 (lowest) and 1 (highest); outside values take the end's colour and a value
    /// that is not a number a neutral grey.
    pub fn at(self, position: f64) -> Colour {
        if position.is_nan() {
            return Colour([0xb0, 0xb4, 0xba]);
        }
        if self == Self::Ink {
            return Self::Magma.at(1.0 - 0.8 * position.clamp(0.0, 1.0));
        }
        let stops = self.stops();
        let stop = position.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
        let below = (stop as usize).min(stops.len() - 2);
        let rgb = |hex: u32| Colour([(hex >> 16) as u8, (hex >> 8) as u8, hex as u8]);
        rgb(stops[below]).mixed(rgb(stops[below + 1]), stop - below as f64)
    }

    /// The colour of a number on a scale between two ends. Where these are the same, so that there is one number, it is that of the
    /// middle of the map, or the first where the number is nothing.
    pub fn of_value(self, value: f64, ends: [f64; 2]) -> Colour {
        self.at(Scale::Linear.share(value, ends))
    }

    /// Eleven equally spaced samples of the map (viridis and magma as published with matplotlib, coolwarm after
    /// Moreland 2009); between them the map is linear to within what an eye can tell.
    fn stops(self) -> [u32; 11] {
        match self {
            Self::Viridis => [
                0x440154, 0x482576, 0x414487, 0x35608d, 0x2a788e, 0x21908c, 0x22a884, 0x43bf71, 0x7ad151, 0xbbdf27,
                0xfde725,
            ],
            Self::Magma | Self::Ink => [
                0x000004, 0x140e36, 0x3b0f70, 0x641a80, 0x8c2981, 0xb73779, 0xde4968, 0xf7705c, 0xfe9f6d, 0xfecf92,
                0xfcfdbf,
            ],
            Self::Coolwarm => [
                0x3b4cc0, 0x5977e3, 0x7b9ff9, 0x9ebeff, 0xc0d4f5, 0xdddcdc, 0xf2cbb7, 0xf7ac8e, 0xee8468, 0xd65244,
                0xb40426,
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_maps_start_and_end_at_their_published_colours() {
        assert_eq!(ColourMap::Viridis.at(-3.0).hex(), "#440154");
        assert_eq!(ColourMap::Viridis.at(1.0).hex(), "#fde725");
        assert_eq!(ColourMap::Magma.at(0.0).hex(), "#000004");
        assert_eq!(ColourMap::Ink.at(0.0), ColourMap::Magma.at(1.0));
        assert_eq!(ColourMap::Ink.at(2.0).hex(), "#3b0f70");
        assert_eq!(ColourMap::Coolwarm.at(0.5).hex(), "#dddcdc");
        assert_eq!(ColourMap::Coolwarm.at(9.0).hex(), "#b40426");
    }

    #[test]
    fn a_value_that_is_not_a_number_is_grey() {
        assert_eq!(ColourMap::Viridis.at(f64::NAN), ColourMap::Magma.at(f64::NAN));
    }

    #[test]
    fn round_off_is_one_colour_and_the_least_difference_two() {
        let ends = scale_of([523.598_775_598, 523.598_775_599], 0.0);
        assert_eq!(ends[0], ends[1]);
        for value in [523.598_775_598, 523.598_775_599] {
            assert_eq!(ColourMap::Viridis.of_value(value, ends), ColourMap::Viridis.at(0.5));
        }
        assert_eq!(scale_of([523.0, 523.01], 0.0), [523.0, 523.01]);
        assert_eq!(scale_of([-1e-17, 3e-17], 1e-9), [0.0; 2], "nothing");
        assert_eq!(ColourMap::Viridis.of_value(2e-17, [0.0; 2]), ColourMap::Viridis.at(0.0));
        assert_eq!(scale_of([f64::INFINITY, f64::NEG_INFINITY], 0.0), [0.0, 1.0]);
        assert_eq!(ColourMap::Viridis.of_value(f64::NAN, ends), ColourMap::Viridis.at(f64::NAN));
    }

    #[test]
    fn decades_take_equal_parts_of_a_logarithmic_scale() {
        let ends = decades_of([1e-3, 10.0]);
        for (value, share) in [(1e-3, 0.0), (1e-2, 0.25), (0.1, 0.5), (10.0, 1.0), (0.0, 0.0), (-5.0, 0.0)] {
            assert!((Scale::Log.share(value, ends) - share).abs() < 1e-12, "{value}");
        }
        assert!(Scale::Log.share(f64::NAN, ends).is_nan());
        // What a diffusing substance leaves far away is no reason for three hundred decades.
        assert_eq!(decades_of([1e-300, 1.0]), [1e-6, 1.0]);
        assert_eq!(decades_of([2.0, 2.0]), [2.0; 2]);
        assert_eq!(decades_of([f64::INFINITY, f64::NEG_INFINITY]), [0.1, 1.0]);
    }

    #[test]
    fn hex_is_read_as_it_is_written() {
        for colour in [[0x00, 0x72, 0xb2], [0xf0, 0xe4, 0x42], [0, 0, 0]].map(Colour) {
            assert_eq!(Colour::from_hex(&colour.hex()), Some(colour));
        }
        assert_eq!(Colour::from_hex("#12"), None);
        assert_eq!(Colour::from_hex("#+12345"), None);
    }
}
