//! Dense systems of linear equations, small ones and those of some hundred rows.

/// Gauss's elimination with row exchange in `rows × (rows + 1)` numbers, the right side last in each row, where the solution is left; false when the matrix
/// is singular.
pub fn eliminate(rows: usize, system: &mut [f64]) -> bool {
    let width = rows + 1;
    for column in 0..rows {
        let size = |row: &usize| system[row * width + column].abs();
        let Some(pivot) = (column..rows).max_by(|a, b| size(a).total_cmp(&size(b))) else { return false };
        let value = system[pivot * width + column];
        if value == 0.0 || !value.is_finite() {
            return false;
        }
        if pivot != column {
            let (above, below) = system.split_at_mut(pivot * width);
            above[column * width..][..width].swap_with_slice(&mut below[..width]);
        }
        let (above, rest) = system.split_at_mut(column * width);
        let (own, below) = rest.split_at_mut(width);
        let own = &own[column..];
        // Rows in one piece each, so that they are taken several numbers at once.
        for row in above.chunks_exact_mut(width).chain(below.chunks_exact_mut(width)) {
            let part = row[column] / value;
            row[column..].iter_mut().zip(own).for_each(|(to, from)| *to -= part * from);
        }
    }
    for row in 0..rows {
        system[row * width + rows] /= system[row * width + row];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_found_solves_the_system_with_rows_exchanged() {
        for rows in [1, 2, 7, 60] {
            // Nothing on the diagonal, so that rows must be exchanged.
            let entry = |i: usize, j: usize| {
                if i == j { 0.0 } else { ((i * i * 7 + i * j * 5 + j * 13 + 3) % 29) as f64 - 13.5 }
            };
            let entry = |i: usize, j: usize| if rows == 1 { 2.0 } else { entry(i, j) };
            let solution: Vec<f64> = (0..rows).map(|i| (i as f64 * 0.7).sin()).collect();
            let right = |i: usize| (0..rows).map(|j| entry(i, j) * solution[j]).sum::<f64>();
            let mut system: Vec<f64> = (0..rows)
                .flat_map(|i| (0..=rows).map(move |j| (i, j)))
                .map(|(i, j)| if j < rows { entry(i, j) } else { right(i) })
                .collect();
            assert!(eliminate(rows, &mut system), "{rows}");
            for (i, expected) in solution.iter().enumerate() {
                let found = system[i * (rows + 1) + rows];
                assert!((found - expected).abs() < 1e-9, "{rows}, {i}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn singular_systems_and_such_with_no_numbers_are_told() {
        assert!(!eliminate(2, &mut [1.0, 2.0, 1.0, 0.5, 1.0, 1.0]));
        assert!(!eliminate(2, &mut [f64::NAN, 2.0, 1.0, f64::NAN, 1.0, 1.0]));
        assert!(eliminate(0, &mut []));
    }
}
