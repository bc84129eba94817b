//! Quantities as the types of a document hold them: a value in base units and, in its type, what it is.

use super::dimension::Dimension;
use super::parse::{UnitError, parse_as};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::borrow::Cow;
use std::fmt;
use std::str::FromStr;

/// A quantity whose powers of length, time, force and angle are in its type. It holds the value in base units (µm, s,
/// pN, rad) and is written in documents as text, "5 um".
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub struct Quantity<const LENGTH: i8, const TIME: i8, const FORCE: i8, const ANGLE: i8>(f64);

/// A length, µm.
pub type Length = Quantity<1, 0, 0, 0>;
/// A time, s.
pub type Time = Quantity<0, 1, 0, 0>;
/// A force, pN.
pub type Force = Quantity<0, 0, 1, 0>;
/// An angle, rad.
pub type Angle = Quantity<0, 0, 0, 1>;
/// A speed, µm/s.
pub type Speed = Quantity<1, -1, 0, 0>;
/// An acceleration, µm/s².
pub type Acceleration = Quantity<1, -2, 0, 0>;
/// A stiffness of a line or a surface, or a surface tension: pN/µm = µN/m.
pub type LineStiffness = Quantity<-1, 0, 1, 0>;
/// An energy or a bending rigidity, pN·µm.
pub type Energy = Quantity<1, 0, 1, 0>;
/// A drag, pN·s/µm.
pub type Drag = Quantity<-1, 1, 1, 0>;
/// A friction of surfaces, drag over area, pN·s/µm³.
pub type SurfaceDrag = Quantity<-3, 1, 1, 0>;
/// A mass, pN·s²/µm = mg.
pub type Mass = Quantity<-1, 2, 1, 0>;
/// A volume, µm³.
pub type Volume = Quantity<3, 0, 0, 0>;
/// A stress or a modulus, pN/µm² = Pa.
pub type Stress = Quantity<-2, 0, 1, 0>;
/// A viscosity, Pa·s = pN·s/µm².
pub type Viscosity = Quantity<-2, 1, 1, 0>;
/// How many there are on an area, 1/µm².
pub type SurfaceDensity = Quantity<-2, 0, 0, 0>;
/// A rate, 1/s.
pub type Frequency = Quantity<0, -1, 0, 0>;

impl<const L: i8, const T: i8, const F: i8, const A: i8> Quantity<L, T, F, A> {
    /// What the quantity is.
    pub const DIMENSION: Dimension = Dimension { angle: A, ..Dimension::of(L, T, F) };
    /// None of it.
    pub const ZERO: Self = Self(0.0);

    /// The quantity with this value in base units: µm, s, pN, rad and their products.
    pub const fn new(value: f64) -> Self {
        Self(value)
    }

    /// The value in base units.
    pub const fn value(self) -> f64 {
        self.0
    }
}

impl<const L: i8, const T: i8, const F: i8, const A: i8> fmt::Display for Quantity<L, T, F, A> {
    /// Text that is read back as exactly the same value.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        // Display of a tiny or huge double would be hundreds of digits long.
        let plain = self.0 == 0.0 || (1e-6..1e15).contains(&self.0.abs());
        let unit = Self::DIMENSION.base_unit();
        if plain { write!(f, "{} {unit}", self.0) } else { write!(f, "{:e} {unit}", self.0) }
    }
}

impl<const L: i8, const T: i8, const F: i8, const A: i8> FromStr for Quantity<L, T, F, A> {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        parse_as(text, Self::DIMENSION).map(Self)
    }
}

impl<const L: i8, const T: i8, const F: i8, const A: i8> Serialize for Quantity<L, T, F, A> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de, const L: i8, const T: i8, const F: i8, const A: i8> Deserialize<'de> for Quantity<L, T, F, A> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Written::deserialize(deserializer)?.0.parse().map_err(de::Error::custom)
    }
}

/// The text of a quantity as a document has it: quoted, or a bare 0, which needs no unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Written(pub(crate) String);

impl<'de> Deserialize<'de> for Written {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ReadsWritten)
    }
}

struct ReadsWritten;

impl de::Visitor<'_> for ReadsWritten {
    type Value = Written;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a quantity with its unit in quotes, or 0")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Written, E> {
        Ok(Written(text.to_owned()))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<Written, E> {
        self.visit_f64(number as f64)
    }

    fn visit_u64<E: de::Error>(self, number: u64) -> Result<Written, E> {
        self.visit_f64(number as f64)
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<Written, E> {
        match number == 0.0 {
            true => Ok(Written("0".to_owned())),
            false => Err(E::invalid_value(de::Unexpected::Float(number), &self)),
        }
    }
}

impl<const L: i8, const T: i8, const F: i8, const A: i8> JsonSchema for Quantity<L, T, F, A> {
    fn schema_name() -> Cow<'static, str> {
        Self::DIMENSION.name().into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let dimension = Self::DIMENSION;
        // A text with its unit, or 0.
        json_schema!({
            "type": ["string", "integer"],
            "minimum": 0,
            "maximum": 0,
            "x-dimension": dimension.name(),
            "examples": [dimension.example()],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_quantity_refuses_another_dimension() {
        let error = "5 um/min".parse::<Length>().expect_err("a speed is no length");
        assert_eq!(error.message, "\"5 um/min\" is a speed; a length was expected");
    }

    #[test]
    fn zero_needs_no_unit_and_everything_else_does() {
        assert_eq!("0".parse(), Ok(Length::ZERO));
        assert_eq!(serde_json::from_str::<Time>("0").ok(), Some(Time::ZERO));
        assert_eq!(serde_json::from_str::<Angle>("0.0").ok(), Some(Angle::ZERO));
        assert!("5".parse::<Length>().is_err() && serde_json::from_str::<Length>("5").is_err());
    }

    proptest! {
        #[test]
        fn a_quantity_survives_its_own_text(bits in any::<f64>().prop_filter("finite", |x| x.abs() < 1e290)) {
            prop_assert_eq!(Mass::new(bits).to_string().parse(), Ok(Mass::new(bits)));
            prop_assert_eq!(Angle::new(bits).to_string().parse(), Ok(Angle::new(bits)));
            prop_assert_eq!(Drag::new(bits).to_string().parse(), Ok(Drag::new(bits)));
        }
    }
}
