//! Quantities in the text of a document ("5 um/min") and their values in µm, s and pN.
//!
//! Everything inside the program is a bare number in base units: µm, s, pN and radian, so a stress is in
//! pN/µm² = Pa, a line stiffness in pN/µm = µN/m, an energy in pN·µm and a mass in pN·s²/µm = 1 mg. This module is
//! the only file that knows prefixes and other units.
//!
//! ```
//! use pseudopod::units::{self, Dimension, Speed};
//! assert_eq!(units::parse_as("5 um/min", Dimension::SPEED).unwrap(), 5.0 / 60.0);
//! assert_eq!("90 nm/s".parse::<Speed>().unwrap().value(), 0.09);
//! assert_eq!(units::pretty(5.0e-3, Dimension::LENGTH), "5 nm");
//! assert_eq!(units::label(Dimension::SPEED), "µm/s");
//! ```

mod dimension;
mod parse;
mod quantity;
mod symbols;

pub use dimension::{Dimension, label, pretty};
pub use parse::{Measured, UnitError, parse, parse_as, parse_unit};
pub(crate) use quantity::Written;
pub use quantity::{
    Acceleration, Angle, Drag, Energy, Force, Frequency, Length, LineStiffness, Mass, Quantity, Speed, Stress,
    SurfaceDensity, SurfaceDrag, Time, Viscosity, Volume,
};
