//! Bars with their intervals, a row for each parameter.

use crate::analysis::bootstrap::Estimate;
use crate::picture::colour::Colour;
use crate::picture::{Axis, Chart, Series};

/// Longest name beside a row, letters.
const LONGEST_NAME: usize = 30;
/// How much of a row its bars take.
const THICK: f64 = 0.64;

/// Bars from zero, with a whisker each: for each name a row, the first on top, with a bar for each label, the first on top. Numbers that are not
/// finite have none; no chart without any.
///
/// * `labels` – what the bars of a row are, for the legend; a single empty one for no legend
/// * `rows` – the numbers of each row, one for each label
pub fn bars(names: &[&str], labels: &[&str], rows: &[Vec<Estimate>], x: Axis) -> Option<Chart> {
    let thick = THICK / labels.len().max(1) as f64;
    let (mut series, mut whiskers) = (Vec::new(), Vec::new());
    for (kind, label) in labels.iter().enumerate() {
        let mut outlines = Vec::new();
        for (row, found) in rows.iter().map(|row| row[kind]).enumerate() {
            if !found.value.is_finite() {
                continue;
            }
            let high = (rows.len() - 1 - row) as f64 + 0.5 * THICK - kind as f64 * thick;
            let (low, middle) = (high - thick, high - 0.5 * thick);
            outlines.push(vec![[0.0, low], [found.value, low], [found.value, high], [0.0, high]]);
            if found.low.is_finite() {
                let cap = 0.16 * thick;
                whiskers.push(vec![[found.low, middle], [found.high, middle]]);
                whiskers.extend([found.low, found.high].map(|end| vec![[end, middle - cap], [end, middle + cap]]));
            }
        }
        if !outlines.is_empty() {
            let label = (*label).to_owned();
            series.push(Series::Areas { label, outlines, colour: Some(Colour::of_palette(kind)) });
        }
    }
    if series.is_empty() {
        return None;
    }
    let dark = Colour([0x33; 3]);
    series.extend(whiskers.into_iter().map(|points| Series::line("", points).coloured(dark)));
    series.push(Series::line("", vec![[0.0, -0.5], [0.0, names.len() as f64 - 0.5]]).coloured(dark));
    let names = names.iter().rev().map(|name| shortened(name));
    Some(Chart { x, y: Axis::named("", names), series, ..Chart::default() })
}

/// A name that is not too long: of a long key its last words, which say most.
fn shortened(name: &str) -> String {
    if name.chars().count() <= LONGEST_NAME {
        return name.to_owned();
    }
    let ends = name.match_indices('.').map(|(at, _)| &name[at + 1..]);
    let fitting = ends.filter(|end| !end.is_empty() && end.chars().count() < LONGEST_NAME).max_by_key(|end| end.len());
    let skipped = name.chars().count() - LONGEST_NAME + 1;
    fitting.map_or_else(|| format!("…{}", name.chars().skip(skipped).collect::<String>()), |end| format!("…{end}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_keep_their_ends() {
        assert_eq!(shortened("adhesion"), "adhesion");
        assert_eq!(shortened("cells.cell.motility.attraction.stiffness"), "…motility.attraction.stiffness");
        let odd = shortened(&"a long name without any key in it".repeat(2));
        assert!(odd.starts_with('…') && odd.chars().count() == LONGEST_NAME, "{odd}");
    }

    #[test]
    fn bars_of_a_row_stand_below_each_other_and_what_is_no_number_has_none() {
        let of = |value: f64| Estimate { value, low: value - 0.1, high: value + 0.1 };
        let rows = [vec![of(0.2), of(0.4)], vec![of(f64::NAN), of(0.6)]];
        let chart = bars(&["a", "b"], &["first", "total"], &rows, Axis::linear("share")).expect("bars");
        let of_label = |wanted: &str| {
            chart.series.iter().find_map(|series| match series {
                Series::Areas { label, outlines, .. } if label == wanted => Some(outlines.clone()),
                _ => None,
            })
        };
        let (first, total) = (of_label("first").expect("bars"), of_label("total").expect("bars"));
        assert_eq!((first.len(), total.len()), (1, 2));
        // The first row is the upper one, and the first bar the upper one of it.
        assert!(first[0][0][1] == 1.0 && first[0][2] == [0.2, 1.32] && total[0][2] == [0.4, 1.0]);
        assert_eq!(total[1][2], [0.6, 0.0]);
        assert_eq!(bars(&["a"], &[""], &[vec![of(f64::NAN)]], Axis::linear("share")), None);
    }
}
