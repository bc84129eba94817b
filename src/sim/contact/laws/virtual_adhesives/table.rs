//! What a model says of virtual adhesives.

/// Which surfaces are glued, and how well.
#[derive(Debug, Clone, PartialEq)]
pub struct AdhesiveTable {
    /// What an atom's own displacement in a step may differ from that of its adhesive, µm: `between[kind * kinds + other]`,
    /// symmetric; 0 glues nothing.
    pub between: Vec<f64>,
    /// The same for kinds and obstacles: `on_obstacles[kind * obstacles + obstacle]`.
    pub on_obstacles: Vec<f64>,
    /// Which adhesives merge.
    pub zones: Zones,
}

/// Which adhesives grow together where their atoms are neighbours on the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Zones {
    /// All, as printed.
    #[default]
    Merged,
    /// Those of the same two objects; an atom that touches several belongs to the nearest.
    Pairs,
}
