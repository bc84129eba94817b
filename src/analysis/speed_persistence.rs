//! Whether faster cells keep their direction longer: the persistence of groups of cells against their speed.
//!
//! Cells of many kinds do, and the logarithm of their persistence is a line in their speed (Maiuri et al., Cell 161, 374, 2015).

use super::bootstrap::Estimate;
use super::furth::{self, Localisation};
use super::msd;
use super::statistics::{Line, fit_line, mean};
use super::tracks::Tracks;
use super::tracks::motion::Quantity;
use crate::error::{Error, Fault, Result};

/// Groups from which on a line through them says something.
pub const FEWEST: usize = 3;

/// Speed and persistence of one group of cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Mean speed, eq. (analysis.20), µm/s.
    pub speed: f64,
    /// Persistence, eq. (analysis.6), s.
    pub persistence: Estimate,
}

impl Point {
    /// That of some tracks, at the lags that are usual.
    ///
    /// # Errors
    /// When no track has a speed, or Fürth's law cannot be fitted to them.
    pub fn of(tracks: &Tracks, localisation: Localisation, seed: u64) -> Result<Self> {
        let speeds: Vec<f64> = Quantity::MeanSpeed.of(tracks).into_iter().filter(|speed| !speed.is_nan()).collect();
        let of = msd::of_cells(tracks.positions.view(), &tracks.times, &tracks.usual_lags());
        let walk = furth::estimate(&of, tracks.axes(), localisation, seed)?;
        Ok(Self { speed: mean(&speeds), persistence: walk.persistence })
    }
}

/// The line ln p = a + b v through groups of cells, eq. (analysis.36).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relation {
    /// The line, with v in µm/s and p in s.
    pub line: Line,
    /// The coefficient of correlation of ln p and v.
    pub correlation: f64,
    /// The decades between the smallest persistence and the largest.
    pub decades: f64,
}

/// How the persistence of groups goes with their speed.
///
/// # Errors
/// When there are fewer than three groups, or all are as fast.
pub fn relation(points: &[Point]) -> Result<Relation> {
    if points.len() < FEWEST {
        let fault = Fault::new(format!("{} groups of cells say nothing of a line", points.len()));
        return Err(Error::input(fault.help("give three types of cells or more")));
    }
    let speeds: Vec<f64> = points.iter().map(|point| point.speed).collect();
    let logarithms: Vec<f64> = points.iter().map(|point| point.persistence.value.ln()).collect();
    let line = fit_line(&speeds, &logarithms)?;
    let ends = logarithms.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
    Ok(Relation {
        line,
        correlation: line.r_squared.max(0.0).sqrt() * line.slope.signum(),
        decades: (ends[1] - ends[0]) / std::f64::consts::LN_10,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(speed: f64, persistence: f64) -> Point {
        Point { speed, persistence: Estimate { value: persistence, low: f64::NAN, high: f64::NAN } }
    }

    #[test]
    fn exponentials_are_lines_and_others_less_so() {
        let growing: Vec<Point> = [0.1, 0.2, 0.4].map(|v: f64| point(v, 10.0 * (5.0 * v).exp())).to_vec();
        let found = relation(&growing).unwrap();
        assert!((found.line.slope - 5.0).abs() < 1e-12 && (found.correlation - 1.0).abs() < 1e-12, "{found:?}");
        assert!((found.decades - 1.5 / std::f64::consts::LN_10).abs() < 1e-12);
        // (1, 0), (2, 0), (3, −ln 10): S_xy = −ln 10, S_xx = 2, S_yy = 2/3 ln² 10, r = −√(3/4).
        let falling = relation(&[point(1.0, 1.0), point(2.0, 1.0), point(3.0, 0.1)]).unwrap();
        assert!((falling.correlation + 0.75_f64.sqrt()).abs() < 1e-12, "{falling:?}");
        assert!(relation(&growing[..2]).unwrap_err().to_string().contains("2 groups of cells"));
        assert!(relation(&[point(0.5, 1.0); 3]).is_err());
    }
}
