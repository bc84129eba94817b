//! Numbers as the documents write them.

/// A finite number; C++ and XML write a few that Rust does not read, and none of those is finite.
pub(super) fn finite(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|value| value.is_finite())
}

/// The shortest text that reads back as the same number.
pub(super) fn shortest(value: f64) -> String {
    // Longer than this, zeros fill it up.
    const LONGEST: usize = 21;
    let plain = value.to_string();
    if plain.len() > LONGEST { format!("{value:e}") } else { plain }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_so_that_they_read_back_the_same() {
        for value in [0.0, -0.0, 1.0, 0.1, 1.0 / 3.0, 1e300, 5e-324, -2.5e-9, f64::MAX, 77.8211, 1e20] {
            let text = shortest(value);
            assert_eq!(finite(&text).map(f64::to_bits), Some(value.to_bits()), "{text}");
            assert!(text.len() <= 24, "{text}");
        }
        assert_eq!(["7", "0.1"], [7.0, 0.1].map(shortest).each_ref().map(String::as_str));
    }

    #[test]
    fn what_is_no_finite_number_is_none() {
        for text in ["", "1,5", "NULL", "nan", "inf", "INF", "1e999", "0x10", "1 2"] {
            assert_eq!(finite(text), None, "{text}");
        }
        assert_eq!(finite(" +1.5e1 "), Some(15.0));
    }
}
