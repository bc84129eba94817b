//! exp, ln, cos and sin for several lanes at once, from plain arithmetic that the compiler turns into wide registers.
//!
//! No fused multiply-add and no table: the same bits on every processor and for every number of lanes. exp and ln stay
//! within 2 units in the last place (tested against the standard library).

/// Where [`fnv1a`] begins.
pub const FNV_START: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV-1a in 64 bits (Fowler, Noll and Vo): goes on from a hash with some bytes. The same on every machine and in every version; no secret.
pub fn fnv1a(hash: u64, bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Moves numbers back on the lines to what they were before: all the way where the share is 0, and not at all where it is 1.
pub fn go_back(now: &mut [f64], before: &[f64], share: f64) {
    now.iter_mut().zip(before).for_each(|(now, before)| *now = before + share * (*now - before));
}

/// Whether a number is nothing, so that documents need not say it.
pub(crate) fn is_zero(number: &f64) -> bool {
    *number == 0.0
}

const LN2_HIGH: f64 = 0.693_147_180_369_123_8; // the first 33 bits of ln 2, so that k·LN2_HIGH is exact
const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5·2^52: adding it leaves a whole number in the low bits

/// 1/k! from k = 13 down to 2.
const EXP: [f64; 12] = [
    1.0 / 6_227_020_800.0,
    1.0 / 479_001_600.0,
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    1.0 / 2.0,
];

/// 2/(2k+1) from k = 11 down to 1: the series of 2·artanh.
const LN: [f64; 11] = [
    2.0 / 23.0,
    2.0 / 21.0,
    2.0 / 19.0,
    2.0 / 17.0,
    2.0 / 15.0,
    2.0 / 13.0,
    2.0 / 11.0,
    2.0 / 9.0,
    2.0 / 7.0,
    2.0 / 5.0,
    2.0 / 3.0,
];

/// ±1/(2k+1)! from k = 8 down to 1.
const SIN: [f64; 8] = [
    1.0 / 355_687_428_096_000.0,
    -1.0 / 1_307_674_368_000.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 39_916_800.0,
    1.0 / 362_880.0,
    -1.0 / 5_040.0,
    1.0 / 120.0,
    -1.0 / 6.0,
];

/// ±1/(2k)! from k = 8 down to 1.
const COS: [f64; 8] = [
    1.0 / 20_922_789_888_000.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 479_001_600.0,
    -1.0 / 3_628_800.0,
    1.0 / 40_320.0,
    -1.0 / 720.0,
    1.0 / 24.0,
    -1.0 / 2.0,
];

/// e to the power of a number.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    let bounded = if x > 710.0 { 710.0 } else { x };
    let bounded = if bounded < -746.0 { -746.0 } else { bounded };
    let shifted = bounded * std::f64::consts::LOG2_E + ROUND;
    let k = shifted - ROUND;
    let high = bounded - k * LN2_HIGH;
    let low = k * LN2_LOW;
    let r = high - low;
    let rest = (high - r) - low;
    let mut series = EXP[0];
    for &coefficient in &EXP[1..] {
        series = series * r + coefficient;
    }
    let value = 1.0 + (r + (rest + r * r * series));
    // 2^k in two factors, so that the ends of the range are reached. The low bits of `shifted` hold k.
    let whole = shifted.to_bits().wrapping_sub(ROUND.to_bits()) as i64;
    let half = whole >> 1;
    value * power_of_two(half) * power_of_two(whole - half)
}

#[inline(always)]
fn power_of_two(k: i64) -> f64 {
    f64::from_bits((k.wrapping_add(1023) as u64) << 52)
}

/// The natural logarithm.
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    let tiny = x < f64::MIN_POSITIVE;
    let scaled = if tiny { x * 18_014_398_509_481_984.0 } else { x }; // 2^54
    // Mantissa in [√½, √2): subtract the bits of √½ and keep the exponent.
    let bits = scaled.to_bits();
    let offset = bits.wrapping_sub(std::f64::consts::FRAC_1_SQRT_2.to_bits());
    let exponent = (offset as i64) >> 52;
    let mantissa = f64::from_bits(bits.wrapping_sub((exponent << 52) as u64));
    let k = f64::from_bits((exponent.wrapping_add(ROUND.to_bits() as i64)) as u64) - ROUND;
    let k = if tiny { k - 54.0 } else { k };
    let f = mantissa - 1.0;
    let s = f / (2.0 + f);
    let z = s * s;
    let mut series = LN[0];
    for &coefficient in &LN[1..] {
        series = series * z + coefficient;
    }
    let half_square = 0.5 * f * f;
    let value = k * LN2_HIGH - ((half_square - (s * (half_square + z * series) + k * LN2_LOW)) - f);
    let value = if x == 0.0 { f64::NEG_INFINITY } else { value };
    let value = if x < 0.0 { f64::NAN } else { value };
    if x < f64::INFINITY { value } else { x }
}

/// Cosine and sine of a share, from 0 to 1, of a whole turn.
#[inline(always)]
pub fn turn(share: f64) -> [f64; 2] {
    let shifted = 4.0 * share + ROUND;
    let quarter = shifted.to_bits();
    let r = (4.0 * share - (shifted - ROUND)) * std::f64::consts::FRAC_PI_2;
    let square = r * r;
    let (mut sin, mut cos) = (SIN[0], COS[0]);
    for k in 1..SIN.len() {
        (sin, cos) = (sin * square + SIN[k], cos * square + COS[k]);
    }
    let (sin, cos) = (r + r * square * sin, 1.0 + square * cos);
    let (along, across) = if quarter & 1 == 0 { (cos, sin) } else { (sin, cos) };
    let signed = |value: f64, sign: u64| f64::from_bits(value.to_bits() ^ (sign & 2) << 62);
    [signed(along, quarter.wrapping_add(1)), signed(across, quarter)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance in units in the last place.
    fn ulps(a: f64, b: f64) -> u64 {
        if a == b || (a.is_nan() && b.is_nan()) {
            return 0;
        }
        if a.is_sign_positive() != b.is_sign_positive() || !a.is_finite() || !b.is_finite() {
            return u64::MAX;
        }
        a.to_bits().abs_diff(b.to_bits())
    }

    #[test]
    fn exp_is_within_two_units_in_the_last_place() {
        let mut worst = 0;
        for step in 0..2_000_000 {
            let x = -708.0 + 1417.7 * f64::from(step) / 2e6;
            let small = x * 1e-3;
            worst = worst.max(ulps(exp(x), x.exp())).max(ulps(exp(small), small.exp()));
        }
        assert!(worst <= 2, "exp differs by {worst} units in the last place");
        for special in [0.0, -0.0, 1e-300, 709.782, 709.79, 1e9, -745.0, -746.5, -1e9, f64::NAN, f64::INFINITY] {
            assert!(ulps(exp(special), special.exp()) <= 2, "exp({special}) = {}", exp(special));
        }
        assert_eq!(exp(f64::NEG_INFINITY), 0.0);
    }

    #[test]
    fn ln_is_within_two_units_in_the_last_place() {
        let mut worst = 0;
        for step in 0..2_000_000 {
            let wide = (-744.0 + 1453.0 * f64::from(step) / 2e6).exp();
            let near = 0.5 + f64::from(step) / 1e6;
            worst = worst.max(ulps(ln(wide), wide.ln())).max(ulps(ln(near), near.ln()));
        }
        assert!(worst <= 2, "ln differs by {worst} units in the last place");
        for special in [0.0, -0.0, 1.0, 5e-324, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
            assert!(ulps(ln(special), special.ln()) <= 2, "ln({special}) = {}", ln(special));
        }
    }

    #[test]
    fn turns_are_those_of_the_standard_library() {
        for k in 1..100_000 {
            let share = f64::from(k) / 100_000.0;
            let ([cos, sin], angle) = (turn(share), std::f64::consts::TAU * share);
            // The angle that the library is asked for is rounded.
            let close = 4.0 * f64::EPSILON * (1.0 + angle);
            assert!((cos - angle.cos()).abs() <= close && (sin - angle.sin()).abs() <= close, "a turn by {share}");
        }
        assert_eq!(turn(0.0), [1.0, 0.0]);
    }
}
