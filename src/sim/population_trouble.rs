//! Why cells cannot come or go: what, where, what was expected.

/// Why cells cannot come or go.
#[derive(Debug, Clone, PartialEq)]
pub enum PopulationTrouble {
    /// There is no such kind.
    NoSuchKind {
        /// The kind that was named.
        kind: usize,
        /// How many there are.
        kinds: usize,
    },
    /// There is, or for a parent was, no such cell.
    NoSuchCell {
        /// Its id.
        id: u64,
    },
    /// A cell has another number of atoms than its kind.
    Atoms {
        /// Name of the kind.
        kind: String,
        /// Number of the cell among those that come.
        cell: usize,
        /// Atoms that it has.
        found: usize,
        /// Atoms that it must have.
        expected: usize,
    },
    /// A position of a cell is not a finite number.
    NotFinite {
        /// Name of the kind.
        kind: String,
        /// Number of the cell among those that come.
        cell: usize,
    },
    /// A cell that comes is inside another, deeper than contacts allow.
    Overlap {
        /// Kind and id of the two cells; ids of cells that come are those that they would have got.
        cells: [(String, u64); 2],
        /// How deep, µm.
        depth: f64,
    },
    /// A cell that comes is behind an obstacle, deeper than contacts can mend.
    BehindObstacle {
        /// Kind of the cell and the id that it would have got.
        cell: (String, u64),
        /// Name of the obstacle.
        obstacle: String,
        /// How deep, µm.
        depth: f64,
    },
    /// A box has no space for all cells that were to come at random points of it.
    NoSpace {
        /// Name of the kind.
        kind: String,
        /// How many fitted.
        found: usize,
        /// How many were to come.
        wanted: usize,
    },
}

impl std::fmt::Display for PopulationTrouble {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::NoSuchKind { kind, kinds } => {
                write!(f, "there is no type of cells with the number {kind}: there are {kinds}, numbered from 0")
            }
            Self::NoSuchCell { id } => write!(f, "there is no cell with the id {id}"),
            Self::Atoms { kind, cell, found, expected } => {
                write!(f, "cell {cell} of those to be added has {found} atoms; cells of type `{kind}` have {expected}")
            }
            Self::NotFinite { kind, cell } => {
                write!(
                    f,
                    "cell {cell} of those to be added to type `{kind}` has a position that is not a finite number"
                )
            }
            Self::Overlap { cells: [(kind, id), (other, its)], depth } => {
                write!(f, "a cell to be added overlaps another: cell {id} of type `{kind}` and cell {its} of type ")?;
                write!(f, "`{other}` would be {depth:.1e} um deep in each other; place it where nothing is")
            }
            Self::NoSpace { kind, found, wanted } => {
                write!(
                    f,
                    "there is no space for all cells that come to type `{kind}`: {found} of {wanted} found a point "
                )?;
                write!(f, "where they touch no other cell and no plane; make their box larger, or them fewer")
            }
            Self::BehindObstacle { cell: (kind, id), obstacle, depth } => {
                write!(f, "a cell to be added is behind a plane or in a tool: cell {id} of type `{kind}` would be ")?;
                write!(f, "{depth:.1e} um deep in `{obstacle}`; place it clear of that")
            }
        }
    }
}

impl std::error::Error for PopulationTrouble {}
