//! Round numbers: where an axis, a colour bar or a scale bar puts its marks and how it writes them.

/// The marks of an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Ticks {
    /// Where the axis begins, in the axis' own unit.
    pub low: f64,
    /// Where it ends.
    pub high: f64,
    /// Labelled marks: value and text.
    pub major: Vec<(f64, String)>,
    /// Marks without a label.
    pub minor: Vec<f64>,
    /// The power of ten that the texts leave out; the axis label has to name it ("×10³").
    pub exponent: i32,
}

/// How values are spaced along an axis, or along a scale of colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal differences take equal lengths.
    #[default]
    Linear,
    /// Equal ratios take equal lengths.
    Log,
}

impl Scale {
    /// Where a value stands between two ends, from 0 to 1: beyond them what is beyond. Where the ends are the same, so that there is one
    /// value, it is in the middle, or 0 where it is nothing. On a logarithmic scale what is not above 0 is at its lower end.
    pub fn share(self, value: f64, [low, high]: [f64; 2]) -> f64 {
        match (self, high != low) {
            _ if value.is_nan() => f64::NAN,
            (Self::Linear, true) => (value - low) / (high - low),
            (Self::Log, true) if value <= 0.0 => 0.0,
            (Self::Log, true) => (value / low).ln() / (high / low).ln(),
            (_, false) if low == 0.0 => 0.0,
            (_, false) => 0.5,
        }
    }

    /// Marks of a scale that ends where it ends, for about `most` labels.
    pub(crate) fn marks(self, low: f64, high: f64, most: usize) -> Ticks {
        match self {
            Self::Linear => linear(low, high, most, Ends::Exact),
            Self::Log => logarithmic(low, high, most, Ends::Exact),
        }
    }
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `value`, which must be positive.
pub fn nice_above(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    // Rounding in log10 and powf may put an exact power of ten a hair off, hence the 1e-9.
    [1.0, 2.0, 5.0, 10.0].iter().map(|digit| digit * decade).find(|nice| *nice >= value * (1.0 - 1e-9)).unwrap_or(value)
}

/// The largest of 1, 2, 5 times a power of ten that is not above `value`, which must be positive.
pub fn nice_below(value: f64) -> f64 {
    let above = nice_above(value);
    if above <= value * (1.0 + 1e-9) {
        return above;
    }
    let lead = above / 10f64.powf((above * (1.0 + 1e-9)).log10().floor());
    if (lead - 5.0).abs() < 0.1 { above * 0.4 } else { above * 0.5 }
}

/// Marks for values from `low` to `high` on a linear axis for about `most` labels.
pub(crate) fn linear(low: f64, high: f64, most: usize, ends: Ends) -> Ticks {
    let (low, high) = opened(low, high);
    let step = nice_above((high - low) / most.max(1) as f64);
    // A thousandth of a step is invisible; without this slack an end like 0.30000000000000004 would add a whole step.
    let first = (low / step + 1e-3).floor();
    let last = (high / step - 1e-3).ceil();
    let (low, high) = if ends == Ends::Rounded { (first * step, last * step) } else { (low, high) };
    let inside = |value: f64| value >= low - 1e-6 * step && value <= high + 1e-6 * step;
    let whole: Vec<f64> =
        (0..=(last - first) as usize).map(|k| (first + k as f64) * step).filter(|v| inside(*v)).collect();
    let exponent = shared_exponent(low.abs().max(high.abs()), step);
    let scale = 10f64.powi(-exponent);
    let lead = step / 10f64.powf((step * (1.0 + 1e-9)).log10().floor());
    let parts = if (lead - 2.0).abs() < 0.1 { 4 } else { 5 };
    let minor = (0..(last - first) as usize * parts)
        .filter(|k| k % parts != 0)
        .map(|k| (first + k as f64 / parts as f64) * step)
        .filter(|v| inside(*v))
        .collect();
    let major = whole.iter().map(|v| (*v, plain(*v * scale, step * scale))).collect();
    Ticks { low, high, major, minor, exponent }
}

/// What happens to the ends of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ends {
    /// Moved outwards to a mark.
    Rounded,
    /// Left where they are.
    Exact,
}

/// Marks for positive values from `low` to `high` on an axis that counts in powers of ten.
pub(crate) fn logarithmic(low: f64, high: f64, most: usize, ends: Ends) -> Ticks {
    let (low, high) = if high > low * (1.0 + 1e-9) { (low, high) } else { (low / 2.0, high * 2.0) };
    let (low, high) = if ends == Ends::Rounded { (nice_below(low), nice_above(high)) } else { (low, high) };
    let inside = |value: f64| value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9);
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    let every = ((last - first) as usize).div_ceil(most.max(1)).max(1) as i32;
    let decades = high.log10() - low.log10();
    let (mut major, mut minor) = (Vec::new(), Vec::new());
    for power in first..=last {
        for digit in 1..10 {
            let value = f64::from(digit) * 10f64.powi(power);
            if !inside(value) {
                continue;
            }
            let between = decades < 1.6 && (digit == 2 || digit == 5);
            if (digit == 1 && power.rem_euclid(every) == 0) || between {
                major.push((value, log_label(digit, power, first >= -3 && last <= 4)));
            } else {
                minor.push(value);
            }
        }
    }
    Ticks { low, high, major, minor, exponent: 0 }
}

/// A range that has some width.
fn opened(low: f64, high: f64) -> (f64, f64) {
    if high - low > 1e-12 * low.abs().max(high.abs()) {
        return (low, high);
    }
    let half = if low == 0.0 { 1.0 } else { 0.1 * low.abs() };
    (low - half, high + half)
}

/// The power of ten, a multiple of three, that keeps labels short; 0 for everyday numbers.
fn shared_exponent(largest: f64, step: f64) -> i32 {
    if largest < 1e5 && step >= 0.99e-3 {
        return 0;
    }
    let power = largest.log10().floor() as i32;
    3 * power.div_euclid(3)
}

/// Writes a value with as many digits as its step needs, with a true minus sign.
pub(crate) fn plain(value: f64, step: f64) -> String {
    let digits = (-(step * (1.0 + 1e-9)).log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.digits$}");
    let zero = text.bytes().all(|byte| !byte.is_ascii_digit() || byte == b'0');
    if zero { text.trim_start_matches('-').into() } else { text.replace('-', "−") }
}

/// "0.02", "500" or, where decades reach far, "2×10⁻⁵".
fn log_label(digit: u32, power: i32, everyday: bool) -> String {
    if everyday {
        return plain(f64::from(digit) * 10f64.powi(power), 10f64.powi(power.min(0)));
    }
    if digit == 1 { power_of_ten(power) } else { format!("{digit}×{}", power_of_ten(power)) }
}

/// "10⁻³".
pub(crate) fn power_of_ten(power: i32) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = power.to_string();
    let raised = digits.chars().map(|c| c.to_digit(10).map_or('⁻', |d| RAISED[d as usize])).collect::<String>();
    format!("10{raised}")
}

/// A short text for one number, three significant digits.
pub(crate) fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { "–".into() };
    }
    let power = value.abs().log10().floor() as i32;
    if (-3..5).contains(&power) {
        let text = plain(value, 10f64.powi((power - 2).min(0)));
        let trimmed = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        return trimmed.into();
    }
    format!("{}×{}", plain(value / 10f64.powi(power), 0.01), power_of_ten(power))
}

/// What a bar says of one number: "1.00 fL, constant", with the unit that its label has in brackets at its end.
pub(crate) fn constant(value: f64, label: &str) -> String {
    let unit = label.strip_suffix(')').and_then(|label| label.rsplit_once(" (")).map(|(_, unit)| format!(" {unit}"));
    let number = if (1.0..10.0).contains(&value.abs()) { plain(value, 0.01) } else { short(value) };
    format!("{number}{}, constant", unit.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_or_five_and_cover_the_range() {
        for (low, high) in [(0.0, 1.0), (-3.7, 12.2), (1e-7, 4e-7), (0.0, 193.0), (-5e6, -1e6), (3.0, 3.0), (0.0, 0.0)]
        {
            let ticks = linear(low, high, 6, Ends::Rounded);
            assert!(ticks.low <= low + 1e-9 * low.abs() && ticks.high >= high - 1e-9 * high.abs(), "{low} {high}");
            let step = ticks.major[1].0 - ticks.major[0].0;
            let lead = step / 10f64.powf(step.log10().floor());
            assert!([1.0, 2.0, 5.0, 10.0].iter().any(|nice| (lead - nice).abs() < 1e-6), "{step}");
            assert!((2..=9).contains(&ticks.major.len()), "{} marks", ticks.major.len());
        }
    }

    #[test]
    fn labels_carry_the_digits_of_their_step() {
        let texts = |low, high| linear(low, high, 5, Ends::Rounded).major.into_iter().map(|m| m.1).collect::<Vec<_>>();
        assert_eq!(texts(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(-200.0, 200.0), ["−200", "−100", "0", "100", "200"]);
    }

    #[test]
    fn large_and_small_numbers_share_an_exponent() {
        assert_eq!(linear(0.0, 4e6, 5, Ends::Rounded).exponent, 6);
        assert_eq!(linear(0.0, 4e-5, 5, Ends::Rounded).exponent, -6);
        assert_eq!(linear(0.0, 400.0, 5, Ends::Rounded).exponent, 0);
    }

    #[test]
    fn decades_are_marked_at_powers_of_ten() {
        let ticks = logarithmic(0.3, 2e4, 8, Ends::Rounded);
        assert!(ticks.low <= 0.3 && ticks.high >= 2e4);
        for (value, _) in &ticks.major {
            assert!((value.log10() - value.log10().round()).abs() < 1e-9, "{value}");
        }
        assert_eq!(power_of_ten(-12), "10⁻¹²");
    }

    #[test]
    fn nice_numbers_enclose() {
        for value in [0.9, 1.0, 1.1, 2.0, 3.0, 5.0, 7.0, 10.0, 1234.0, 4.2e-5] {
            assert!(nice_below(value) <= value * 1.001 && nice_above(value) >= value * 0.999, "{value}");
            assert!(nice_above(value) / nice_below(value) < 2.6, "{value}");
        }
    }

    #[test]
    fn short_texts_keep_three_digits() {
        assert_eq!(short(12.0), "12");
        assert_eq!(short(0.5), "0.5");
        assert_eq!(short(-2.6666), "−2.67");
        assert_eq!(short(2.5e-6), "2.50×10⁻⁶");
    }
    #[test]
    fn one_number_is_told_with_its_unit() {
        assert_eq!(constant(1.0, "volume (fL)"), "1.00 fL, constant");
        assert_eq!(constant(523.6, "clock.U"), "524, constant");
        assert_eq!(constant(0.0, "height (µm)"), "0 µm, constant");
    }
}
