//! The conditions that make a method one of its order: one for each rooted tree (Hairer, Nørsett, Wanner, *Solving Ordinary
//! Differential Equations I*, II.2).

use super::{tsitouras, verner};

/// A rooted tree: what grows from its root.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Tree(Vec<Tree>);

impl Tree {
    /// All trees with so many vertices.
    fn all(order: usize) -> Vec<Tree> {
        if order == 1 {
            return vec![Tree(Vec::new())];
        }
        // Each of `order` is a smaller one with one more branch at its root.
        let grown = (1..order).flat_map(|rest| {
            let branches = Tree::all(order - rest);
            Tree::all(rest).into_iter().flat_map(move |tree| {
                branches.clone().into_iter().map(move |branch| {
                    let mut from_root = tree.0.clone();
                    from_root.push(branch);
                    from_root.sort();
                    Tree(from_root)
                })
            })
        });
        let mut trees: Vec<Tree> = grown.collect();
        trees.sort();
        trees.dedup();
        trees
    }

    fn order(&self) -> i32 {
        1 + self.0.iter().map(Tree::order).sum::<i32>()
    }

    fn density(&self) -> f64 {
        f64::from(self.order()) * self.0.iter().map(Tree::density).product::<f64>()
    }

    /// What stands for it in each stage.
    fn stages(&self, method: &Method) -> Vec<f64> {
        let mut values = vec![1.0; method.rows.len()];
        for branch in &self.0 {
            let inner = branch.stages(method);
            for (value, row) in values.iter_mut().zip(&method.rows) {
                *value *= dot(row, &inner);
            }
        }
        values
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Weights of earlier stages in each.
struct Method {
    rows: Vec<Vec<f64>>,
}

impl Method {
    fn new<'a>(rows: impl Iterator<Item = &'a [f64]>) -> Self {
        Self { rows: rows.map(<[f64]>::to_vec).collect() }
    }

    /// How far weights are from the conditions up to an order at a share of the step.
    fn distance(&self, weights: &[f64], order: usize, share: f64) -> f64 {
        let far = |tree: &Tree| {
            let wanted = share.powi(tree.order()) / tree.density();
            (dot(weights, &tree.stages(self)) - wanted).abs()
        };
        (1..=order).flat_map(Tree::all).map(|tree| far(&tree)).fold(0.0, f64::max)
    }
}

fn tsitouras() -> Method {
    Method::new((0..7).map(tsitouras::row))
}

fn verner() -> Method {
    Method::new((0..9).map(verner::row))
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    (0..a.len().max(b.len())).map(|at| a.get(at).unwrap_or(&0.0) + b.get(at).unwrap_or(&0.0)).collect()
}

#[test]
fn there_are_as_many_trees_as_is_known() {
    assert_eq!([1, 2, 3, 4, 5, 6].map(|order| Tree::all(order).len()), [1, 1, 2, 4, 9, 20]);
}

#[test]
fn the_explicit_pairs_meet_the_conditions_of_their_orders() {
    let fourth = sum(&tsitouras::B, &tsitouras::E);
    // The coefficients have 16 digits and are as large as 13.
    assert!(tsitouras().distance(&tsitouras::B, 5, 1.0) < 1e-13 && tsitouras().distance(&fourth, 4, 1.0) < 1e-13);
    assert!(tsitouras().distance(&fourth, 5, 1.0) > 1e-5, "the error estimate must see the fifth order");
    let fifth = sum(&verner::B, &verner::E);
    // Here they are as large as 208 under weights as large as 176, and each sum rounds nine times.
    let exact = 9.0 * 176.0 * 208.0 * f64::EPSILON;
    assert!(verner().distance(&verner::B, 6, 1.0) < exact && verner().distance(&fifth, 5, 1.0) < exact);
    assert!(verner().distance(&fifth, 6, 1.0) > 1e-5, "the error estimate must see the sixth order");
}

/// A sum to the last digit: what each addition loses is added up, too (Neumaier 1974).
fn exact_sum(values: &[f64]) -> f64 {
    let (mut sum, mut lost) = (0.0_f64, 0.0);
    for &value in values {
        let next = sum + value;
        lost += if sum.abs() >= value.abs() { (sum - next) + value } else { (value - next) + sum };
        sum = next;
    }
    sum + lost
}

#[test]
fn the_times_of_stages_are_the_sums_of_their_weights() {
    let far = |rows: &Method, times: &[f64]| {
        let sums = rows.rows.iter().zip(times).map(|(row, time)| (exact_sum(row) - time).abs());
        sums.fold(0.0, f64::max)
    };
    // A defect here is the same in every step and adds up.
    assert!(far(&tsitouras(), &tsitouras::C) < 1e-14 && far(&verner(), &verner::C) < 1e-15);
    assert!(exact_sum(&verner::E).abs() < 1e-15 && exact_sum(&tsitouras::E).abs() < 1e-15);
}

#[test]
fn values_between_are_of_order_4_and_end_at_the_new_state() {
    let weights = |share: f64| tsitouras::D.map(|row| row.iter().rev().fold(0.0, |sum, weight| (sum + weight) * share));
    for share in [0.2, 0.5, 0.9, 1.0] {
        // Coefficients as large as 88 with 16 digits.
        assert!(tsitouras().distance(&weights(share), 4, share) < 1e-12, "{share}");
    }
    (0..7).for_each(|stage| {
        let last = tsitouras::B.get(stage).unwrap_or(&0.0);
        assert!((weights(1.0)[stage] - last).abs() < 1e-12);
    });
}

#[test]
fn the_middle_of_a_step_of_the_second_pair_is_of_order_5() {
    // Round-off as above, under weights as large as 57.
    assert!(verner().distance(&verner::MIDDLE, 5, 0.5) < 9.0 * 57.0 * 208.0 * f64::EPSILON);
    assert!(verner().distance(&verner::MIDDLE, 6, 0.5) > 1e-5, "and of no higher");
}
