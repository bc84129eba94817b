//! The wavelength of a pattern in a flat field.

use super::declared::Declared;
use super::finished::Finished;
use crate::analysis::pattern;
use crate::error::Result;
use crate::values::When;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The wavelength of a pattern in a flat field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct Wavelength {
    /// The field: its name, or FIELD.SPECIES for another than its first species.
    #[schemars(extend("x-text" = "field"))]
    pub field: String,
    /// The instant.
    #[serde(default)]
    pub time: When,
}

impl Wavelength {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        at.when("time", self.time);
    }

    /// The wavelength of the pattern in the frame that the time means.
    ///
    /// # Errors
    /// When there is no such field, or no pattern in it.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let field = run.fields().field(&self.field)?;
        pattern::wavelength(field.layout, &field.frame(run.recording.frame_at(self.time))?)
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::measures::test_results::measured;

    #[test]
    fn the_wavelength_is_that_of_the_species_asked_for() {
        let found = measured("kind = 'wavelength'; field = 'front.back'; time = '50 s'").unwrap();
        // The shorter side holds no more than two of them.
        assert!((found / 5.0 - 1.0).abs() < 3e-3, "{found}");
    }
}
