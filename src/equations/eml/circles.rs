//! Finds what depends on itself.

/// The circles among `count` things, each told once, from its member with the smallest number; `uses` says on which
/// things one depends.
pub(super) fn circles(count: usize, uses: &impl Fn(usize) -> Vec<usize>) -> Vec<Vec<usize>> {
    let mut found: Vec<Vec<usize>> = Vec::new();
    let mut done = vec![false; count];
    for first in 0..count {
        // A walk with its own stack: documents may chain tens of thousands of definitions.
        let mut path: Vec<(usize, Vec<usize>)> = Vec::new();
        let mut open = vec![];
        if !done[first] {
            path.push((first, uses(first)));
            open.push(first);
        }
        let mut is_open = std::collections::HashSet::from([first]);
        while let Some((number, rest)) = path.last_mut() {
            let number = *number;
            match rest.pop() {
                Some(next) if is_open.contains(&next) => {
                    let begin = open.iter().position(|&other| other == next).unwrap_or(0);
                    let mut circle = open[begin..].to_vec();
                    let least = circle.iter().enumerate().min_by_key(|(_, id)| **id).map_or(0, |(at, _)| at);
                    circle.rotate_left(least);
                    if !found.contains(&circle) {
                        found.push(circle);
                    }
                }
                Some(next) if !done[next] => {
                    path.push((next, uses(next)));
                    open.push(next);
                    is_open.insert(next);
                }
                Some(_) => {}
                None => {
                    done[number] = true;
                    is_open.remove(&number);
                    open.pop();
                    path.pop();
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_circle_is_found_once_and_chains_are_none() {
        let uses = |number: usize| [vec![1], vec![2], vec![0, 3], vec![], vec![4], vec![3, 0]][number].clone();
        assert_eq!(circles(6, &uses), [vec![0, 1, 2], vec![4]]);
        let chain = |number: usize| if number + 1 < 100_000 { vec![number + 1] } else { vec![] };
        assert!(circles(100_000, &chain).is_empty());
    }
}
