//! A field at a point, or its mean, extremes or amount.

use super::declared::Declared;
use super::finished::Finished;
use super::reduction::Reduction;
use crate::analysis::fields::{self, OverBoxes};
use crate::error::Result;
use crate::units::Length;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A field at a point, or its mean, extremes or amount.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(inline)]
pub struct FieldValue {
    /// The field: its name, or FIELD.SPECIES for another than its first species.
    #[schemars(extend("x-text" = "field"))]
    pub field: String,
    /// The point, between the centres of boxes on straight lines; its z does not count in a flat field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[Length; 3]>,
    /// How the values of all boxes become one, where no point is given; their mean when absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<OverBoxes>,
    /// The instant, or how the values at several instants become one.
    #[serde(default)]
    pub time: Reduction,
}

impl FieldValue {
    pub(super) fn check(&self, at: &mut dyn Declared) {
        if self.at.is_some() && self.over.is_some() {
            at.two_keys("over", "at", "leave `over` out for the value at a point");
        }
        self.time.check(at);
    }

    /// The value of the field.
    ///
    /// # Errors
    /// When there is no such field, point or time.
    pub(super) fn evaluate(&self, run: &Finished) -> Result<f64> {
        let times = &run.recording.times;
        let field = run.fields().field(&self.field)?;
        let position = self.at.map(|at| at.map(Length::value));
        if let Some(position) = position {
            fields::check_inside(field.layout, position)?;
        }
        let frames = self.time.frames(times)?;
        let value = |frame: usize| -> Result<f64> {
            let values = field.frame(frame)?;
            Ok(match position {
                Some(position) => fields::value_at(field.layout, &values, position),
                None => fields::reduce(field.layout, &values, self.over.unwrap_or_default()),
            })
        };
        let values: Vec<f64> = frames.clone().map(value).collect::<Result<_>>()?;
        self.time.reduce(&times[frames], &values)
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::measures::test_results::all_are;

    #[test]
    fn fields_are_read_at_points_and_over_all_boxes() {
        // Boxes of the medium are numbered x fastest; a step along x, y, z adds 1, 4, 12; a second adds 1.
        let medium = |rest: &str| format!("kind = 'field_value'; field = 'medium'; {rest}");
        all_are(&[
            (&medium("at = ['1 um', '0.5 um', '1.5 um']; time = 'first'"), 0.0, 0.0),
            (&medium("at = ['2 um', '1.25 um', '3 um']; time = '10 s'"), 0.5 + 3.0 + 6.0 + 10.0, 1e-6),
            (&medium("at = ['2 um', '1.25 um', '3 um']; time = '10.5 s'"), 0.5 + 3.0 + 6.0 + 10.5, 1e-6),
            (&medium("time = 'mean'"), 11.5 + 50.0, 1e-5),
            (&medium("over = 'min'"), 100.0, 0.0),
            (&medium("over = 'max'; time = 'range'"), 100.0, 0.0),
            (&medium("over = 'amount'; time = 'first'"), 11.5 * 24.0 * 6.0, 1e-9),
            ("kind = 'field_value'; field = 'medium.attractant'; over = 'max'; time = '100 s'", 123.0, 0.0),
            ("kind = 'field_value'; field = 'front'; at = ['5.5 um', '4.25 um', '9 um']", 2.0, 1e-5),
        ]);
    }
}
