//! Series of what types of cells have by names: loads, pressures, torques, traps, flexible plates, and atoms that are moved on courses.

/// The series of the scene that tells how far from equilibrium its cells are, where a run ends there, pN.
pub const OUT_OF_BALANCE: &str = "out_of_balance";

/// What the series of things with names begin with, and what a chart calls them: `load.NAME` and its like.
pub const NAMED: [(&str, &str); 18] = [
    ("load", "load"),
    ("pressure", "pressure"),
    ("displacement", "displacement"),
    ("force", "force"),
    ("angle", "angle"),
    ("torque", "torque"),
    ("twist", "applied torque"),
    ("twist_angle", "angle under torque"),
    ("trap_x", "force along x of trap"),
    ("trap_y", "force along y of trap"),
    ("trap_z", "force along z of trap"),
    ("plate_force", "force of plate"),
    ("plate_displacement", "displacement of plate"),
    ("tool_x", "force along x on tool"),
    ("tool_y", "force along y on tool"),
    ("tool_z", "force along z on tool"),
    ("tool_reach", "reach of cells past tool"),
    ("tool_displacement", "displacement of tool"),
];

/// The names of what types have, in their order: NAME, or TYPE.NAME where several types have one of this name. Of each type its name and the
/// names of what it has.
pub fn names_by_type(types: &[(&str, Vec<String>)]) -> Vec<String> {
    let owners = |name: &str| types.iter().filter(|(_, own)| own.iter().any(|other| other == name)).count();
    let all = types.iter().flat_map(|(kind, own)| own.iter().map(move |name| (kind, name)));
    all.map(|(kind, name)| if owners(name) > 1 { format!("{kind}.{name}") } else { name.clone() }).collect()
}

/// Atoms that are moved on courses, as the names of their series follow from them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Motion {
    /// Their name.
    pub name: String,
    /// Whether they go along a direction.
    pub goes: bool,
    /// Whether they turn about an axis.
    pub turns: bool,
}

/// Names and units of the series of what is moved: `displacement.NAME` and `force.NAME` of what goes, `angle.NAME` and `torque.NAME` of what
/// turns. Of each type its name and what is moved of it.
pub fn series_of_moved(types: &[(&str, Vec<Motion>)]) -> Vec<(String, &'static str)> {
    let own = |motions: &[Motion]| motions.iter().map(|motion| motion.name.clone()).collect();
    let names: Vec<(&str, Vec<String>)> = types.iter().map(|(kind, motions)| (*kind, own(motions))).collect();
    let motions = types.iter().flat_map(|(_, motions)| motions);
    let series = |(name, motion): (String, &Motion)| {
        let going = [("displacement", "um"), ("force", "pN")].into_iter().filter(|_| motion.goes);
        let turning = [("angle", "rad"), ("torque", "pN um")].into_iter().filter(|_| motion.turns);
        going.chain(turning).map(|(word, unit)| (format!("{word}.{name}"), unit)).collect::<Vec<_>>()
    };
    names_by_type(&names).into_iter().zip(motions).flat_map(series).collect()
}

/// Names of the series of traps, in pN: `trap_x.NAME`, `trap_y.NAME` and `trap_z.NAME`. Of each type its name and the names of its traps.
pub fn series_of_traps(types: &[(&str, Vec<String>)]) -> Vec<String> {
    let series = |name: String| ["x", "y", "z"].map(|axis| format!("trap_{axis}.{name}"));
    names_by_type(types).into_iter().flat_map(series).collect()
}

/// Names and units of the series of a tool: the force of the cells on it, `tool_x.NAME`, `tool_y.NAME` and `tool_z.NAME`, how far they reach along
/// its axis past its point, `tool_reach.NAME`, and how far it has gone where it goes, `tool_displacement.NAME`.
pub fn series_of_tool(name: &str, goes: bool) -> Vec<(String, &'static str)> {
    let forces = [("tool_x", "pN"), ("tool_y", "pN"), ("tool_z", "pN"), ("tool_reach", "um")];
    let going = [("tool_displacement", "um")].into_iter().filter(|_| goes);
    forces.into_iter().chain(going).map(|(word, unit)| (format!("{word}.{name}"), unit)).collect()
}

/// Names and units of the series of flexible plates: `plate_force.NAME` and `plate_displacement.NAME`. Of each type its name and the names of its
/// plates.
pub fn series_of_plates(types: &[(&str, Vec<String>)]) -> Vec<(String, &'static str)> {
    let series = |name: String| {
        [("plate_force", "pN"), ("plate_displacement", "um")].map(|(word, unit)| (format!("{word}.{name}"), unit))
    };
    names_by_type(types).into_iter().flat_map(series).collect()
}

/// Names of the series of pressures, in pN/µm²: `pressure.NAME`. Of each type its name and the names of its pressures.
pub fn series_of_pressures(types: &[(&str, Vec<String>)]) -> Vec<String> {
    names_by_type(types).into_iter().map(|name| format!("pressure.{name}")).collect()
}

/// Names and units of the series of torques: `twist.NAME` and `twist_angle.NAME`. Of each type its name and the names of its torques.
pub fn series_of_torques(types: &[(&str, Vec<String>)]) -> Vec<(String, &'static str)> {
    let series = |name: String| {
        [("twist", "pN um"), ("twist_angle", "rad")].map(|(word, unit)| (format!("{word}.{name}"), unit))
    };
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
        let motion = |name: &str, turns: bool| Motion { name: name.to_owned(), goes: !turns, turns };
        let types =
            [("plate", vec![motion("down", false), motion("hold", false)]), ("cell", vec![motion("hold", true)])];
        let series = series_of_moved(&types);
        assert_eq!(series[..2], [("displacement.down".to_owned(), "um"), ("force.down".to_owned(), "pN")]);
        assert_eq!(series[4..], [("angle.cell.hold".to_owned(), "rad"), ("torque.cell.hold".to_owned(), "pN um")]);
    }
}
