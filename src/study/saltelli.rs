//! Saltelli's points, at which runs tell how much of the variance of a measure comes from which parameter, eq. (analysis.39).

use super::sobol;

/// Points that a base point makes.
pub fn each(parameters: usize) -> usize {
    parameters + 2
}

/// The points of so many base points, each with a coordinate for each parameter inside (0, 1), in the order of [`about`].
///
/// # Panics
/// For more than half of [`sobol::MOST_DIMENSIONS`] parameters.
pub fn points(number: u32, parameters: usize, seed: u64) -> Vec<Vec<f64>> {
    about(&sobol::points(number, 2 * parameters, seed))
}

/// The points about base points. The first half of the coordinates of a base point is a row of the matrix A, the second one of B; it
/// makes the point A, then A with one coordinate after the other from B, then B. So more base points leave those that there are as they were.
fn about(base: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let of_one = |both: &Vec<f64>| {
        let (a, b) = both.split_at(both.len() / 2);
        let mut rows = vec![a.to_vec(); each(a.len())];
        b.iter().enumerate().for_each(|(parameter, value)| rows[1 + parameter][parameter] = *value);
        rows[1 + a.len()] = b.to_vec();
        rows
    };
    base.iter().flat_map(of_one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_in_the_order_of_others() {
        // Rows 4 and 5 of stats.qmc.Sobol(6, scramble=False).random(8) of scipy 1.17.1, times 8, and rows 20 to 29 of sample.sobol.sample(…, 8,
        // calc_second_order=False, scramble=False) of SALib 1.6.0 with three parameters in [0, 1], times 8.
        let base = [[3.0, 3.0, 5.0, 7.0, 3.0, 1.0], [7.0, 7.0, 1.0, 3.0, 7.0, 5.0]];
        let known = [
            [[3.0, 3.0, 5.0], [7.0, 3.0, 5.0], [3.0, 3.0, 5.0], [3.0, 3.0, 1.0], [7.0, 3.0, 1.0]],
            [[7.0, 7.0, 1.0], [3.0, 7.0, 1.0], [7.0, 7.0, 1.0], [7.0, 7.0, 5.0], [3.0, 7.0, 5.0]],
        ];
        assert_eq!(about(&base.map(Vec::from)), known.concat());
    }

    #[test]
    fn more_points_begin_with_the_same_and_seeds_differ() {
        let some = points(8, 3, 5);
        assert_eq!((some.len(), some[0].len()), (40, 3));
        assert_eq!(points(16, 3, 5)[..40], some);
        assert_ne!(points(8, 3, 6), some);
    }

    #[test]
    fn each_point_between_differs_from_the_first_in_one_coordinate() {
        for rows in points(64, 4, 1).chunks(6) {
            for parameter in 0..4 {
                for other in 0..4 {
                    let from = if other == parameter { &rows[5] } else { &rows[0] };
                    assert_eq!(rows[1 + parameter][other], from[other]);
                }
            }
        }
    }
}
