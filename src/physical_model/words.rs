//! Words of the languages with what they mean.

/// What a word means by a table.
pub(super) fn meaning<T: Clone>(table: &[(&'static str, T)], word: &str) -> Option<T> {
    table.iter().find(|(own, _)| *own == word).map(|(_, meant)| meant.clone())
}

/// The word for what is meant.
///
/// # Panics
/// When the table has no word for it.
pub(super) fn word_for<T: PartialEq>(table: &[(&'static str, T)], meant: &T) -> &'static str {
    table.iter().find(|(_, own)| own == meant).map(|(word, _)| *word).expect("a table has all that its language knows")
}

#[cfg(test)]
mod tests {
    use crate::physical_model::lml::LoadKind;
    use crate::physical_model::mml::{CriterionKind, Scope};
    use crate::physical_model::pml::{CellType, Mode};

    #[test]
    fn words_that_a_language_has_and_others_are_written_as_they_were_read() {
        for word in ["Translation", "Rotation", "Force", "Pressure", "Acceleration", "Torque"] {
            assert_eq!(LoadKind::of(word).word(), word);
        }
        for word in ["KineticEnergy", "Speed", "Position", "Time", "Force", "Heat"] {
            assert_eq!(CriterionKind::of(word).word(), word);
        }
        for word in CellType::words().chain(["SPHERE"]) {
            assert_eq!(CellType::of(word).word(), word);
        }
        for word in ["NONE", "POINTS", "WIREFRAME_AND_SURFACE_AND_POINTS", "GLOWING"] {
            assert_eq!(Mode::of(word).word(), word);
        }
        assert_eq!([Scope::Any, Scope::Average, Scope::Sum].map(Scope::word), ["Any", "Average", "Sum"]);
        let counts = ["TRIANGLE", "HEXAHEDRON", "POLY_VERTEX"].map(|word| CellType::of(word).atoms());
        assert_eq!(counts, [Some(3), Some(8), None]);
    }
}
