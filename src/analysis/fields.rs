//! The fields of a finished run, frame by frame: their values at points, means, extremes and amounts.

use crate::error::{Error, Fault, Result};
use crate::output::{Along, FieldLayout, ResultFile};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The axes of a field.
const AXES: [Along; 3] = [Along::X, Along::Y, Along::Z];

/// The fields of a run; the default is those of a run without any.
#[derive(Clone, Copy, Default)]
pub struct Fields<'a> {
    file: Option<&'a ResultFile>,
}

/// One species of a field.
#[derive(Clone, Copy)]
pub struct Field<'a> {
    file: &'a ResultFile,
    /// Its grid.
    pub layout: &'a FieldLayout,
    /// The name of the species.
    pub species: &'a str,
}

impl<'a> Fields<'a> {
    /// The fields of a result file; none without a file.
    pub fn of(file: Option<&'a ResultFile>) -> Self {
        Self { file }
    }

    /// The field of a name: `FIELD.SPECIES`, or a field's name for its first species.
    ///
    /// # Errors
    /// When there is none; the fault lists what there is.
    pub fn field(&self, name: &str) -> Result<Field<'a>> {
        let Some(file) = self.file else {
            let fault = Fault::new(format!("there is no field \"{name}\" in this run"));
            return Err(Error::input(fault.help("give the experiment a field")));
        };
        let (layout, species) = file.field_species(name)?;
        Ok(Field { file, layout, species: &layout.species[species].0 })
    }
}

impl Field<'_> {
    /// The values of a frame, one for each box, x fastest.
    ///
    /// # Errors
    /// A damaged file.
    pub fn frame(&self, frame: usize) -> Result<Vec<f64>> {
        self.file.field_frame(&self.layout.name, self.species, frame)
    }
}

/// How the values of all boxes of a field become one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum OverBoxes {
    /// Their mean.
    #[default]
    Mean,
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The amount: the sum of value times volume (µm³) of a box, or times its area (µm²) in a flat field.
    Amount,
}

/// Makes one of the values of all boxes.
pub fn reduce(layout: &FieldLayout, values: &[f64], over: OverBoxes) -> f64 {
    match over {
        OverBoxes::Mean => super::statistics::mean(values),
        OverBoxes::Min => values.iter().copied().fold(f64::INFINITY, f64::min),
        OverBoxes::Max => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        OverBoxes::Amount => {
            let axes = if layout.is_flat() { 2 } else { 3 };
            values.iter().sum::<f64>() * layout.spacing[..axes].iter().product::<f64>()
        }
    }
}

/// That a point lies outside of a field; z does not count in a flat one.
///
/// # Errors
/// When it does.
pub fn check_inside(layout: &FieldLayout, position: [f64; 3]) -> Result<()> {
    for axis in AXES.iter().copied().filter(|axis| *axis != Along::Z || !layout.is_flat()) {
        let number = axis.number();
        let (low, size) = (layout.origin[number], layout.cells[number] as f64 * layout.spacing[number]);
        // The round-off of a corner that is meant to be the corner.
        let slack = 1e-9 * size;
        if !(low - slack..=low + size + slack).contains(&position[number]) {
            let letter = axis.letter();
            let found = format!("the field {} does not reach {letter} = {} µm", layout.name, position[number]);
            let help = format!("give a point with {letter} from {low} µm to {} µm", low + size);
            return Err(Error::input(Fault::new(found).help(help)));
        }
    }
    Ok(())
}

/// The value at a point, µm: straight between the centres of boxes along each axis, eq. (analysis.10), and that of the
/// box at the wall within half a box from it.
pub fn value_at(layout: &FieldLayout, values: &[f64], position: [f64; 3]) -> f64 {
    let sides = AXES.map(|along| {
        let axis = along.number();
        let last = layout.cells[axis].saturating_sub(1);
        let steps = ((position[axis] - layout.origin[axis]) / layout.spacing[axis] - 0.5).clamp(0.0, last as f64);
        let lower = (steps as usize).min(last.saturating_sub(1));
        let share = steps - lower as f64;
        [(lower, 1.0 - share), ((lower + 1).min(last), share)]
    });
    let [nx, ny, _] = layout.cells;
    let mut sum = 0.0;
    for (z, along_z) in sides[2] {
        for (y, along_y) in sides[1] {
            for (x, along_x) in sides[0] {
                let weight = along_x * along_y * along_z;
                if weight > 0.0 {
                    sum += weight * values[(z * ny + y) * nx + x];
                }
            }
        }
    }
    sum
}

/// The distance of each box from a point, µm; in the plane x, y if the third component is not to count.
pub fn distances(layout: &FieldLayout, point: [f64; 3], axes: usize) -> Vec<f64> {
    let [nx, ny, nz] = layout.cells;
    let step = |axis: Along, index: usize| (layout.centre(axis, index) - point[axis.number()]).powi(2);
    let mut found = Vec::with_capacity(layout.len());
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let up = if axes == 3 { step(Along::Z, z) } else { 0.0 };
                found.push((step(Along::X, x) + step(Along::Y, y) + up).sqrt());
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(cells: [usize; 3]) -> FieldLayout {
        let species = vec![("a".to_owned(), "uM".to_owned())];
        FieldLayout { name: "a".into(), species, cells, spacing: [2.0, 1.0, 0.5], origin: [-4.0, 0.0, 1.0] }
    }

    /// The values of a function at the centres of all boxes.
    fn sampled(layout: &FieldLayout, of: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
        let [nx, ny, _] = layout.cells;
        let position = |at: usize| {
            let index = [at % nx, at / nx % ny, at / (nx * ny)];
            AXES.map(|axis| layout.centre(axis, index[axis.number()]))
        };
        (0..layout.len()).map(|at| of(position(at))).collect()
    }

    #[test]
    fn a_plane_is_met_between_centres_and_kept_level_at_the_walls() {
        let layout = grid([4, 5, 6]);
        let plane = |[x, y, z]: [f64; 3]| 1.0 + 2.0 * x - y + 4.0 * z;
        let values = sampled(&layout, plane);
        for position in [[-3.0, 0.5, 1.25], [0.3, 2.2, 2.9], [3.0, 4.5, 3.75]] {
            assert!((value_at(&layout, &values, position) - plane(position)).abs() < 1e-12, "{position:?}");
        }
        assert_eq!(value_at(&layout, &values, [-4.0, 0.0, 1.0]), values[0]);
        assert_eq!(value_at(&layout, &values, [4.0, 5.0, 4.0]), values[119]);
    }

    #[test]
    fn the_height_does_not_count_in_a_flat_field() {
        let layout = grid([4, 5, 1]);
        let values = sampled(&layout, |[x, y, _]| x + 10.0 * y);
        assert!((value_at(&layout, &values, [0.5, 2.25, 77.0]) - 23.0).abs() < 1e-12);
        assert!(check_inside(&layout, [0.5, 2.25, 77.0]).is_ok());
        let message = check_inside(&layout, [0.5, 5.1, 0.0]).unwrap_err().to_string();
        assert_eq!(message, "the field a does not reach y = 5.1 µm");
        assert!(check_inside(&grid([4, 5, 6]), [0.5, 2.25, 77.0]).is_err());
    }

    #[test]
    fn an_amount_counts_the_volume_of_boxes_and_the_area_of_flat_ones() {
        let values = |number: usize| (0..number).map(|at| at as f64).collect::<Vec<_>>();
        assert_eq!(reduce(&grid([4, 5, 6]), &values(120), OverBoxes::Amount), 119.0 * 60.0);
        assert_eq!(reduce(&grid([4, 5, 1]), &values(20), OverBoxes::Amount), 19.0 * 10.0 * 2.0);
        let [mean, min, max] = [OverBoxes::Mean, OverBoxes::Min, OverBoxes::Max];
        assert_eq!([mean, min, max].map(|over| reduce(&grid([4, 5, 1]), &values(20), over)), [9.5, 0.0, 19.0]);
    }

    #[test]
    fn distances_are_those_of_centres() {
        let found = distances(&grid([2, 1, 2]), [-3.0, 0.5, 1.25], 3);
        assert_eq!(found, [0.0, 2.0, 0.5, 4.25_f64.sqrt()]);
        assert_eq!(distances(&grid([2, 1, 1]), [-3.0, 0.5, 77.0], 2), [0.0, 2.0]);
    }

    #[test]
    fn a_field_that_was_not_recorded_is_not_measured() {
        let fault = Fields::default().field("front").err().unwrap();
        assert_eq!(fault.to_string(), "there is no field \"front\" in this run");
    }
}
