//! Series of what types of cells have by names: loads, and atoms that are moved on courses.

/// The names of what types have, in their order: NAME, or TYPE.NAME where several types have one of this name. Of each type its name and the
/// names of what it has.
pub fn names_by_type(types: &[(&str, Vec<String>)]) -> Vec<String> {
    let owners = |name: &str| types.iter().filter(|(_, own)| own.iter().any(|other| other == name)).count();
    let all = types.iter().flat_map(|(kind, own)| own.iter().map(move |name| (kind, name)));
    all.map(|(kind, name)| if owners(name) > 1 { format!("{kind}.{name}") } else { name.clone() }).collect()
}

/// Names and units of the series of what is moved, `displacement.NAME` and `force.NAME`; of each type its name and the names of what is moved
/// of it.
pub fn series_of_moved(types: &[(&str, Vec<String>)]) -> Vec<(String, &'static str)> {
    let series =
        |name: String| [("displacement", "um"), ("force", "pN")].map(|(word, unit)| (format!("{word}.{name}"), unit));
    names_by_type(types).into_iter().flat_map(series).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_types_share_have_that_of_the_type_before_them() {
        let own = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let types = [("plate", own(&["down", "hold"])), ("cell", own(&["hold"]))];
        assert_eq!(names_by_type(&types), ["down", "plate.hold", "cell.hold"]);
        let series = series_of_moved(&types);
        assert_eq!(series[..2], [("displacement.down".to_owned(), "um"), ("force.down".to_owned(), "pN")]);
        assert_eq!(series[5], ("force.cell.hold".to_owned(), "pN"));
    }
}
