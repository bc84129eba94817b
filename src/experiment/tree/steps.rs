//! Paths of keys, step by step.

use std::ops::Range;

/// One step of a path: the name of a key or the number of an entry, with its bytes in the path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    pub(super) name: Name,
    pub(super) at: Range<usize>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Name {
    Key(String),
    Entry(usize),
}

/// The steps of a path such as `cells.red.loads[0].force`; the bytes at fault if it is not one.
pub(super) fn steps(path: &str) -> Result<Vec<Step>, Range<usize>> {
    let mut steps = Vec::new();
    let mut start = 0;
    for part in path.split('.') {
        let whole = start..start + part.len();
        let (name, mut brackets) = part.split_at(part.find('[').unwrap_or(part.len()));
        let left = start + name.len() - name.trim_start().len();
        let name_span = left..left + name.trim().len();
        if name_span.is_empty() || name.contains([']', '"', '\'']) {
            return Err(whole);
        }
        steps.push(Step { name: Name::Key(name.trim().to_owned()), at: name_span });
        let mut bracket_start = start + name.len();
        while let Some((index, rest)) = brackets.strip_prefix('[').and_then(|inside| inside.split_once(']')) {
            let end = bracket_start + index.len() + 2;
            let index = index.trim().parse().map_err(|_| bracket_start..end)?;
            steps.push(Step { name: Name::Entry(index), at: bracket_start..end });
            (brackets, bracket_start) = (rest, end);
        }
        if !brackets.trim().is_empty() {
            return Err(whole);
        }
        start = whole.end + 1;
    }
    Ok(steps)
}
