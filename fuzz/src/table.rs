//! Changes of tables: rows, columns, cells.

use crate::chance::Chance;
use crate::damage::{NUMBERS, one_of};
use crate::mutate::times;
use crate::shipped::Shipped;

/// One change of a table.
pub fn change(text: &str, shipped: &Shipped, chance: &mut Chance) -> String {
    let mut rows: Vec<Vec<String>> = text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect();
    if rows.is_empty() {
        return shipped.text(chance).to_owned();
    }
    let (row, other) = (chance.below(rows.len()), chance.below(rows.len()));
    let (column, to) = (chance.below(rows[row].len()), chance.below(rows[row].len()));
    match chance.below(10) {
        0 => drop(rows.remove(row)),
        1 => {
            let copy = rows[row].clone();
            drop(rows.splice(other..other, std::iter::repeat_n(copy, times(chance))));
        }
        2 => rows.swap(row, other),
        3 => rows.iter_mut().filter(|row| column < row.len()).for_each(|row| drop(row.remove(column))),
        4 => rows.iter_mut().filter(|row| column < row.len()).for_each(|row| row.push(row[column].clone())),
        5 => rows.iter_mut().filter(|row| column.max(to) < row.len()).for_each(|row| row.swap(column, to)),
        6 => rows[row][column] = one_of(&NUMBERS, chance).to_owned(),
        7 => {
            let cells = &rows[other];
            rows[row][column] = cells[chance.below(cells.len())].clone();
        }
        8 => rows.extend(shipped.text(chance).lines().map(|line| line.split(',').map(str::to_owned).collect())),
        _ => {
            let sign = [";", "\t", ", ", "\",\""][chance.below(4)];
            return rows.iter().map(|row| row.join(sign)).collect::<Vec<_>>().join("\n");
        }
    }
    rows.iter().map(|row| row.join(",")).collect::<Vec<_>>().join("\n")
}
