//! Values of fields that others may hold on to while a simulation goes on.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The numbers of a document of fields, `[species][box]`.
///
/// Whoever [shares](Self::share) them has them for good as they are: they are changed where nobody shares them, and else numbers of
/// their own take their place. A clone is a copy.
#[derive(Debug, PartialEq, Default)]
pub struct FieldValues(Arc<Vec<f64>>);

impl FieldValues {
    /// The numbers as they are now, without a copy.
    pub fn share(&self) -> Arc<Vec<f64>> {
        self.0.clone()
    }

    /// Becomes a copy of others; nothing is allocated where nobody shares these and there are as many.
    pub fn copy_from(&mut self, other: &Self) {
        match Arc::get_mut(&mut self.0) {
            Some(own) => own.clone_from(&other.0),
            None => *self = other.clone(),
        }
    }
}

impl From<Vec<f64>> for FieldValues {
    fn from(values: Vec<f64>) -> Self {
        Self(Arc::new(values))
    }
}

impl Clone for FieldValues {
    fn clone(&self) -> Self {
        Self(Arc::new(self.0.to_vec()))
    }
}

impl Deref for FieldValues {
    type Target = Vec<f64>;

    fn deref(&self) -> &Vec<f64> {
        &self.0
    }
}

impl DerefMut for FieldValues {
    fn deref_mut(&mut self) -> &mut Vec<f64> {
        Arc::make_mut(&mut self.0)
    }
}

impl Serialize for FieldValues {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.as_slice().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for FieldValues {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_shares_values_has_them_as_they_were_and_who_does_not_changes_them_in_place() {
        let mut values = FieldValues::from(vec![1.0, 2.0]);
        let before = values.as_ptr();
        values[0] = 3.0;
        assert_eq!((values.as_ptr(), values[0]), (before, 3.0));
        let shared = values.share();
        assert_eq!(shared.as_ptr(), before, "no copy");
        values.fill(7.0);
        assert_eq!((shared.as_slice(), values.as_slice()), ([3.0, 2.0].as_slice(), [7.0, 7.0].as_slice()));

        let (mut next, held) = (values.clone(), values.share());
        assert_ne!(next.as_ptr(), held.as_ptr(), "a clone is a copy");
        let own = next.as_ptr();
        next.copy_from(&FieldValues::from(vec![0.5, 0.25]));
        assert_eq!((next.as_ptr(), next.as_slice()), (own, [0.5, 0.25].as_slice()));
        values.copy_from(&next);
        assert_eq!((held.as_slice(), values.as_slice()), ([7.0, 7.0].as_slice(), [0.5, 0.25].as_slice()));
    }
}
