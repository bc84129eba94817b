//! Yes or no for every lane, in words as wide as the numbers beside them: so loops over both become wide registers.

/// All bits of a lane set for yes, none for no.
pub type Mask<const L: usize> = [u64; L];

/// Yes for all lanes.
pub const YES: u64 = u64::MAX;

/// The word for one lane.
#[inline(always)]
pub fn when(holds: bool) -> u64 {
    if holds { YES } else { 0 }
}

/// One of two numbers.
#[inline(always)]
pub fn pick(mask: u64, yes: f64, no: f64) -> f64 {
    if mask != 0 { yes } else { no }
}

/// How many lanes say yes.
#[inline(always)]
pub fn count<const L: usize>(mask: &Mask<L>) -> usize {
    let mut sum = 0_u64;
    for word in mask {
        sum += word & 1;
    }
    sum as usize
}

/// Lanes that say yes to both.
#[inline(always)]
pub fn both<const L: usize>(a: &Mask<L>, b: &Mask<L>) -> Mask<L> {
    let mut result = [0; L];
    for l in 0..L {
        result[l] = a[l] & b[l];
    }
    result
}

/// Takes over some lanes of another.
#[inline(always)]
pub fn choose<const L: usize>(to: &mut [f64; L], from: &[f64; L], lanes: &Mask<L>) {
    for l in 0..L {
        to[l] = pick(lanes[l], from[l], to[l]);
    }
}
