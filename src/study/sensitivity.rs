//! How much of the variance of each measure comes from which parameter, from the runs at Saltelli's points.

use super::collect::{Collected, Status};
use super::document::Design;
use super::saltelli;
use super::table::{Cells, TableColumn};
use crate::analysis::bootstrap::Estimate;
use crate::analysis::sobol_indices::{Shares, shares};
use crate::analysis::statistics::{mean, standard_error};

/// How the variance of a measure is shared out among the parameters of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// The measure, by its number in the plan.
    pub measure: usize,
    /// The variance of the measure, and the indices of each parameter.
    pub shares: Shares,
    /// Base points that they come from.
    pub base_points: usize,
    /// Base points that are left out, as some point of them has no run with a value.
    pub left_out: usize,
    /// The share of the variance that is noise between replicates, what their mean leaves of it; NaN where no point has two runs.
    pub noise: f64,
}

/// The sensitivities of all measures; none for designs that are not for that.
pub fn sensitivities(collected: &Collected) -> Vec<Sensitivity> {
    (0..collected.plan.facts.measures.len()).filter_map(|measure| sensitivity(collected, measure)).collect()
}

/// The sensitivity of a measure; none for a design that is not for that.
pub fn sensitivity(collected: &Collected, measure: usize) -> Option<Sensitivity> {
    let facts = &collected.plan.facts;
    let Design::Saltelli { .. } = facts.design else { return None };
    let mut points: Vec<Vec<f64>> = vec![Vec::new(); facts.points as usize];
    for (row, run) in collected.rows.iter().zip(&collected.plan.runs) {
        let value = row.values[measure].filter(|value| value.is_finite() && row.status == Status::Complete);
        points[run.point as usize - 1].extend(value);
    }
    let parameters = facts.parameters.len();
    let all = points.chunks(saltelli::each(parameters));
    let number = all.len();
    let whole: Vec<&[Vec<f64>]> = all.filter(|base| base.iter().all(|values| !values.is_empty())).collect();
    let means: Vec<Vec<f64>> = whole.iter().map(|base| base.iter().map(|values| mean(values)).collect()).collect();
    let repeated = whole.iter().copied().flatten().filter(|values| values.len() > 1);
    let errors: Vec<f64> = repeated.map(|values| standard_error(values).powi(2)).collect();
    let shares = shares(&means, parameters, facts.seed);
    let noise = if errors.is_empty() { f64::NAN } else { mean(&errors) / shares.variance };
    Some(Sensitivity { measure, base_points: whole.len(), left_out: number - whole.len(), noise, shares })
}

/// The table: a row for each measure and parameter, with the indices and the ends of their intervals.
pub fn sensitivity_columns(collected: &Collected, found: &[Sensitivity]) -> Vec<TableColumn> {
    let facts = &collected.plan.facts;
    let rows = || found.iter().flat_map(|one| one.shares.indices.iter().enumerate().map(move |row| (one, row)));
    let words = |title: &str, of: &dyn Fn(&Sensitivity, usize) -> String| TableColumn {
        title: title.to_owned(),
        cells: Cells::Words(rows().map(|(one, (parameter, _))| Some(of(one, parameter))).collect()),
    };
    let mut columns = vec![
        words("measure", &|one, _| facts.measures[one.measure].name.clone()),
        words("parameter", &|_, parameter| facts.parameters[parameter].name.clone()),
    ];
    for (name, is_first) in [("first", true), ("total", false)] {
        for (number, end) in ["", "_low", "_high"].into_iter().enumerate() {
            let of = |estimate: &Estimate| [estimate.value, estimate.low, estimate.high][number];
            let numbers =
                rows().map(|(_, (_, indices))| Some(of(if is_first { &indices.first } else { &indices.total })));
            columns.push(TableColumn { title: format!("{name}{end}"), cells: Cells::Numbers(numbers.collect()) });
        }
    }
    let counts = rows().map(|(one, _)| i64::try_from(one.base_points).ok()).collect();
    columns.push(TableColumn { title: "base_points".to_owned(), cells: Cells::Whole(counts) });
    columns
}

impl Sensitivity {
    /// What is to be known of it, in sentences; nothing where all is as it should be.
    pub fn notes(&self, collected: &Collected) -> Vec<String> {
        let name = &collected.plan.facts.measures[self.measure].name;
        let (used, all) = (self.base_points, self.base_points + self.left_out);
        let mut notes = Vec::new();
        if self.left_out > 0 {
            let out = self.left_out;
            notes.push(format!(
                "sensitivity of `{name}`: {out} of {all} base points left out, as {} a point without a complete run that has a value",
                if out == 1 { "it has" } else { "each has" }
            ));
        }
        match used {
            0 | 1 => notes.push(format!("sensitivity of `{name}`: NaN, as two base points are the least")),
            _ if self.shares.variance == 0.0 => notes.push(format!(
                "sensitivity of `{name}`: NaN, as it has the same value in all runs and there is no variance to share out"
            )),
            _ if self.noise.is_finite() => notes.push(format!(
                "sensitivity of `{name}`: {:.1} % of the variance is noise between replicates, which all total indices contain",
                100.0 * self.noise
            )),
            _ => {}
        }
        notes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::collect::Row;
    use crate::study::{Column, Facts, Kind, Measured, Plan, Run};
    use std::f64::consts::PI;

    /// The shares of a function at the points of 1 024 base points in the unit cube.
    fn shares_of(parameters: usize, of: impl Fn(&[f64]) -> f64) -> Shares {
        let points = saltelli::points(1024, parameters, 1);
        let values: Vec<f64> = points.iter().map(|point| of(point)).collect();
        let rows: Vec<Vec<f64>> = values.chunks(saltelli::each(parameters)).map(<[f64]>::to_vec).collect();
        shares(&rows, parameters, 1)
    }

    /// Holds indices against known ones: each in its interval, and within 0.03.
    fn holds(found: &Shares, known: &[[f64; 2]]) {
        for (one, [first, total]) in found.indices.iter().zip(known) {
            for (estimate, known) in [(one.first, *first), (one.total, *total)] {
                println!("{:.4} in {:.4} to {:.4}, known {known:.4}", estimate.value, estimate.low, estimate.high);
                assert!(estimate.low <= known && known <= estimate.high, "{known} not in {estimate:?}");
                assert!((estimate.value - known).abs() < 0.03, "{known} for {estimate:?}");
            }
        }
    }

    #[test]
    fn indices_of_ishigami_are_those_of_its_integrals() {
        let found = shares_of(3, |point| {
            let [x, y, z] = [0, 1, 2].map(|axis| PI * (2.0 * point[axis] - 1.0));
            x.sin() + 7.0 * y.sin().powi(2) + 0.1 * z.powi(4) * x.sin()
        });
        // Its variance is a²/8 + bπ⁴/5 + b²π⁸/18 + 1/2 for a = 7 and b = 0.1.
        let known: f64 = 49.0 / 8.0 + 0.1 * PI.powi(4) / 5.0 + 0.01 * PI.powi(8) / 18.0 + 0.5;
        assert!((found.variance / known - 1.0).abs() < 0.02, "{} for {known}", found.variance);
        // An index that is nothing by symmetry has an interval about it like the others.
        holds(&found, &[[0.3139, 0.5576], [0.4424, 0.4424], [0.0, 0.2437]]);
    }

    #[test]
    fn indices_of_the_g_function_are_those_of_its_integrals() {
        let factors = [0.0, 1.0, 4.5, 9.0, 99.0, 99.0];
        let found = shares_of(6, |point| {
            point.iter().zip(factors).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product()
        });
        // Each factor has the variance 1/3(1 + a)², and those of a product of independent factors of mean 1 multiply.
        let own = factors.map(|a| 1.0 / (3.0 * (1.0_f64 + a).powi(2)));
        let product: f64 = own.iter().map(|own| 1.0 + own).product();
        let known = own.map(|own| [own / (product - 1.0), own * product / (1.0 + own) / (product - 1.0)]);
        holds(&found, &known);
    }

    /// A study of two parameters at eight base points with two replicates, which measure something of the values and the replicate.
    fn collected(of: impl Fn(&[f64], u32) -> f64) -> Collected {
        let points = saltelli::points(8, 2, 0);
        let kind = Kind::Number;
        let column = |name: &str| Column { name: name.into(), key: name.into(), kind: kind.clone(), log: false };
        let measured = Measured { name: "size".into(), unit: "um".into(), description: String::new() };
        let facts = Facts {
            version: String::new(),
            title: String::new(),
            experiment: "cells.toml".into(),
            sets: Vec::new(),
            seed: 0,
            design: Design::Saltelli { number: 8 },
            points: 32,
            replicates: 2,
            parameters: vec![column("a"), column("b")],
            measures: vec![measured],
            files: std::collections::BTreeMap::default(),
            runs: String::new(),
            study: String::new(),
        };
        let run = |number: u32| Run {
            number: number + 1,
            point: number % 32 + 1,
            replicate: number / 32 + 1,
            seed: 0,
            cells: Vec::new(),
            output: "run.vtkhdf".into(),
        };
        let row = |run: &Run| Row {
            status: Status::Complete,
            values: vec![Some(of(&points[run.point as usize - 1], run.replicate))],
            version: None,
            wall_time: None,
            note: None,
        };
        let runs: Vec<Run> = (0..64).map(run).collect();
        let rows = runs.iter().map(row).collect();
        Collected { plan: Plan { folder: ".".into(), facts, runs }, rows }
    }

    #[test]
    fn base_points_whose_runs_are_missing_are_left_out_as_a_whole() {
        let mut some = collected(|point, _| point[0] + 2.0 * point[1]);
        let whole = sensitivities(&some);
        assert_eq!((whole[0].base_points, whole[0].left_out, whole[0].noise), (8, 0, 0.0));
        // One of two runs of a point is enough.
        some.rows[9].status = Status::Failed;
        assert_eq!(sensitivities(&some)[0].shares, whole[0].shares);
        // Points 9 to 12 belong to the third base point, the last one to the eighth.
        some.rows[9 + 32].values[0] = None;
        some.rows[31].status = Status::Missing;
        some.rows[63].values[0] = Some(f64::NAN);
        let found = sensitivities(&some);
        assert_eq!((found[0].base_points, found[0].left_out), (6, 2));
        assert!(found[0].notes(&some)[0].starts_with("sensitivity of `size`: 2 of 8 base points left out"));
        let table = super::super::table::csv_text(&sensitivity_columns(&some, &found));
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines[0], "measure,parameter,first,first_low,first_high,total,total_low,total_high,base_points");
        assert!(lines.len() == 3 && lines[2].starts_with("size,b,") && lines[2].ends_with(",6"), "{table}");
    }

    #[test]
    fn noise_between_replicates_is_told_and_what_does_not_vary_is_not_shared_out() {
        // The mean of two values at a distance of 0.2 has a squared error of 0.01.
        let noisy = collected(|point, replicate| point[0] + 0.2 * f64::from(replicate));
        let found = sensitivities(&noisy).remove(0);
        assert!((found.noise * found.shares.variance - 0.01).abs() < 1e-12, "{found:?}");
        assert!(found.notes(&noisy)[0].contains("% of the variance is noise between replicates"));
        let constant = collected(|_, _| 0.3);
        let found = sensitivities(&constant).remove(0);
        assert!(
            found.notes(&constant)[0].starts_with("sensitivity of `size`: NaN, as it has the same value in all runs")
        );
        let table = super::super::table::csv_text(&sensitivity_columns(&constant, &[found]));
        assert!(table.contains("size,a,NaN,NaN,NaN,NaN,NaN,NaN,8\n"), "{table}");
        let none = Collected {
            rows: constant.rows.iter().map(|row| Row { status: Status::Missing, ..row.clone() }).collect(),
            ..constant
        };
        let found = sensitivities(&none).remove(0);
        assert_eq!(found.notes(&none).len(), 2);
    }
}
