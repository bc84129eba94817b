//! Finds the word that was meant, and lists words in a sentence.

/// The candidate that a misspelt word was most likely meant for.
pub fn meant<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let plain = |text: &str| text.to_lowercase().replace(['-', ' ', '.'], "_");
    let word = plain(word);
    // One slip in three letters: more would make "radius" a misspelling of "ratio".
    let allowed = (word.chars().count() / 3).max(1);
    let near = candidates.into_iter().filter_map(|candidate| {
        let known = plain(candidate);
        let begins = word.len() >= 3 && (known.starts_with(&word) || word.starts_with(&known) && known.len() >= 3);
        let slips = strsim::damerau_levenshtein(&word, &known);
        let distance = if begins { 1 } else { slips };
        (distance <= allowed && distance < known.chars().count()).then_some((distance, slips, candidate))
    });
    near.min_by_key(|(distance, slips, _)| (*distance, *slips)).map(|(.., candidate)| candidate)
}

/// "`a`, `b` or `c`"; a long list is cut.
pub fn any_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "or")
}

/// "`a`, `b` and `c`"; a long list is cut.
pub fn all_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    joined(words, "and")
}

fn joined<'a>(words: impl IntoIterator<Item = &'a str>, last: &str) -> String {
    // As many as a table of a document has keys.
    const MOST: usize = 20;
    let words: Vec<String> = words.into_iter().map(|word| format!("`{word}`")).collect();
    if words.len() > MOST {
        return format!("{} …", words[..MOST].join(", "));
    }
    match words.as_slice() {
        [] => "nothing".to_owned(),
        [only] => only.clone(),
        [init @ .., end] => format!("{} {last} {end}", init.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_is_recognised_and_another_word_is_not() {
        let known = ["radius", "level", "semi_implicit_euler", "colour"];
        assert_eq!(meant("radus", known), Some("radius"));
        assert_eq!(meant("lvel", known), Some("level"));
        assert_eq!(meant("color", known), Some("colour"));
        assert_eq!(meant("Semi-Implicit-Euler", known), Some("semi_implicit_euler"));
        assert_eq!(meant("ratio", known), None);
        assert_eq!(meant("x", ["y", "z"]), None);
    }

    #[test]
    fn lists_read_as_sentences() {
        assert_eq!(any_of(["a"]), "`a`");
        assert_eq!(any_of(["a", "b", "c"]), "`a`, `b` or `c`");
    }
}
