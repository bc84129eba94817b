//! What surfaces do that touch: which law, and how strongly.

/// How strongly two surfaces stick, eq. (adhesion.2). It depends neither on the step nor on the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strength {
    /// The pull at which they part, pN/µm².
    pub tensile: f64,
    /// The shear at which they slide, pN/µm².
    pub shear: f64,
    /// What an area of contact releases, pN/µm, eq. (adhesion.9): contacts spread against the tension of the surfaces.
    pub energy: f64,
}

/// What surfaces do that touch.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Law {
    /// Contacts bear any push, and a pull and a shear, [`Strength`].
    #[default]
    Adhesives,
    /// Contacts bear any push; springs hold the atoms of facets that collided.
    Links(LinkTable),
    /// Contacts push by their depth, and pull within the proximity.
    Penalty(Penalty),
    /// Contacts bear any push; atoms that touch move in rigid zones.
    VirtualAdhesives(AdhesiveTable),
}

/// Which kinds are linked, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkTable {
    /// Stiffness of the spring between two atoms, pN/µm: `stiffness[kind * kinds + other]`, symmetric; 0 binds nothing.
    pub stiffness: Vec<f64>,
    /// Root mean square of the lengths of its three springs above which a link breaks, µm.
    pub range: f64,
}

impl LinkTable {
    /// A table that links nothing.
    pub fn new(kinds: usize, range: f64) -> Self {
        Self { stiffness: vec![0.0; kinds * kinds], range }
    }

    /// Whether the springs of a link hold, of this summed squared length (µm²).
    pub(super) fn holds(&self, squared: f64) -> bool {
        squared <= 3.0 * self.range * self.range
    }
}

/// What a contact pushes and pulls with, eq. (adhesion.12).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Penalty {
    /// Push over depth, pN/µm.
    pub stiffness: f64,
    /// Gap up to which contacts pull, µm.
    pub range: f64,
}

impl Penalty {
    /// Force of a contact that pulls `most` (pN) at most, positive where it pushes, and its energy (pN·µm), at a gap (µm).
    pub fn at(&self, gap: f64, most: f64) -> (f64, f64) {
        let deepest = -2.0 / 3.0 * most * self.range;
        let share = gap / self.range;
        if gap < 0.0 {
            (-self.stiffness * gap, 0.5 * self.stiffness * gap * gap + deepest)
        } else if share < 1.0 {
            let energy = 4.0 * most * self.range * share * share * (0.5 - share / 3.0);
            (-4.0 * most * share * (1.0 - share), energy + deepest)
        } else {
            (0.0, 0.0)
        }
    }
}

/// Which surfaces are glued, and how well.
#[derive(Debug, Clone, PartialEq)]
pub struct AdhesiveTable {
    /// What an atom's own displacement in a step may differ from that of its adhesive, µm: `between[kind * kinds + other]`,
    /// symmetric; 0 glues nothing.
    pub between: Vec<f64>,
    /// The same for kinds and planes: `on_planes[kind * planes + plane]`.
    pub on_planes: Vec<f64>,
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
