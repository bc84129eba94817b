//! Turns four rows of four numbers into columns. Written out for the registers of x86, because compilers do it number by
//! number.

/// A row.
pub type Four = [f64; 4];

/// Knows whether the processor has registers for it.
#[derive(Clone, Copy)]
pub struct Turner {
    #[cfg(target_arch = "x86_64")]
    wide: Option<pulp::x86::V3>,
}

impl Turner {
    /// Asks the processor.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            #[cfg(target_arch = "x86_64")]
            wide: pulp::x86::V3::try_new(),
        }
    }

    /// Writes column i of `from` to row i of `to`. They are given by reference, so that a row is read and written whole.
    #[inline(always)]
    pub fn turn(self, from: [&Four; 4], to: [&mut Four; 4]) {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = self.wide {
            let (a, b) = (pulp::cast(*from[0]), pulp::cast(*from[1]));
            let (c, d) = (pulp::cast(*from[2]), pulp::cast(*from[3]));
            let (even, odd) = (simd.avx._mm256_unpacklo_pd(a, b), simd.avx._mm256_unpackhi_pd(a, b));
            let (even_last, odd_last) = (simd.avx._mm256_unpacklo_pd(c, d), simd.avx._mm256_unpackhi_pd(c, d));
            *to[0] = pulp::cast(simd.avx._mm256_permute2f128_pd::<0x20>(even, even_last));
            *to[1] = pulp::cast(simd.avx._mm256_permute2f128_pd::<0x20>(odd, odd_last));
            *to[2] = pulp::cast(simd.avx._mm256_permute2f128_pd::<0x31>(even, even_last));
            *to[3] = pulp::cast(simd.avx._mm256_permute2f128_pd::<0x31>(odd, odd_last));
            return;
        }
        turn_plainly(from, to);
    }
}

/// The same on every processor.
#[inline(always)]
fn turn_plainly(from: [&Four; 4], to: [&mut Four; 4]) {
    for (i, to) in to.into_iter().enumerate() {
        *to = [from[0][i], from[1][i], from[2][i], from[3][i]];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_become_columns() {
        let rows: [Four; 4] = std::array::from_fn(|i| std::array::from_fn(|j| (10 * i + j) as f64));
        let (mut turned, mut plain) = ([[0.0; 4]; 4], [[0.0; 4]; 4]);
        Turner::new().turn(rows.each_ref(), turned.each_mut());
        turn_plainly(rows.each_ref(), plain.each_mut());
        assert_eq!(turned, plain);
        assert_eq!(turned[1], [1.0, 11.0, 21.0, 31.0]);
    }
}
