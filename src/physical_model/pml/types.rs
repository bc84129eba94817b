//! The words of the language for what cells are and how components are shown.

/// What the atoms of a cell make.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CellType {
    /// Nothing known.
    Invalid,
    /// One atom.
    Atom,
    /// Two atoms.
    Line,
    /// A triangle.
    Triangle,
    /// A quadrilateral.
    Quad,
    /// Four atoms in space.
    Tetrahedron,
    /// Six atoms: two triangles.
    Wedge,
    /// Five atoms: a quadrilateral and a tip.
    Pyramid,
    /// Eight atoms: the bottom quadrilateral, then the top one.
    Hexahedron,
    /// A line through its atoms.
    PolyLine,
    /// A group of atoms.
    PolyVertex,
    /// A word that the language has not.
    Other(Box<str>),
}

/// The words, and how many atoms a cell has, if that is fixed.
const CELL_TYPES: [(&str, CellType, Option<usize>); 11] = [
    ("INVALID", CellType::Invalid, None),
    ("ATOM", CellType::Atom, Some(1)),
    ("LINE", CellType::Line, Some(2)),
    ("TRIANGLE", CellType::Triangle, Some(3)),
    ("QUAD", CellType::Quad, Some(4)),
    ("TETRAHEDRON", CellType::Tetrahedron, Some(4)),
    ("WEDGE", CellType::Wedge, Some(6)),
    ("PYRAMID", CellType::Pyramid, Some(5)),
    ("HEXAHEDRON", CellType::Hexahedron, Some(8)),
    ("POLY_LINE", CellType::PolyLine, None),
    ("POLY_VERTEX", CellType::PolyVertex, None),
];

impl CellType {
    /// The words of the language.
    pub fn words() -> impl Iterator<Item = &'static str> {
        CELL_TYPES.iter().map(|(word, ..)| *word)
    }

    /// What a word means.
    pub fn of(word: &str) -> Self {
        let known = CELL_TYPES.iter().find(|(own, ..)| *own == word);
        known.map_or_else(|| Self::Other(word.into()), |(_, kind, _)| kind.clone())
    }

    /// Its word.
    pub fn word(&self) -> &str {
        match self {
            Self::Other(word) => word,
            known => CELL_TYPES.iter().find(|(_, kind, _)| kind == known).map_or("INVALID", |(word, ..)| word),
        }
    }

    /// How many atoms such a cell has, if that is fixed.
    pub fn atoms(&self) -> Option<usize> {
        CELL_TYPES.iter().find(|(_, kind, _)| kind == self).and_then(|(.., atoms)| *atoms)
    }
}

/// How a component is shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Mode {
    /// Not at all.
    None,
    /// Its atoms.
    Points,
    /// Its atoms and surface.
    PointsAndSurface,
    /// Its surface.
    Surface,
    /// Its edges and surface.
    WireframeAndSurface,
    /// Its edges and atoms.
    WireframeAndPoints,
    /// Its edges.
    Wireframe,
    /// Its edges, surface and atoms.
    WireframeAndSurfaceAndPoints,
    /// A word that the language has not.
    Other(Box<str>),
}

const MODES: [(&str, Mode); 8] = [
    ("NONE", Mode::None),
    ("POINTS", Mode::Points),
    ("POINTS_AND_SURFACE", Mode::PointsAndSurface),
    ("SURFACE", Mode::Surface),
    ("WIREFRAME_AND_SURFACE", Mode::WireframeAndSurface),
    ("WIREFRAME_AND_POINTS", Mode::WireframeAndPoints),
    ("WIREFRAME", Mode::Wireframe),
    ("WIREFRAME_AND_SURFACE_AND_POINTS", Mode::WireframeAndSurfaceAndPoints),
];

impl Mode {
    /// What a word means.
    pub fn of(word: &str) -> Self {
        let known = MODES.iter().find(|(own, _)| *own == word);
        known.map_or_else(|| Self::Other(word.into()), |(_, mode)| mode.clone())
    }

    /// Its word.
    pub fn word(&self) -> &str {
        match self {
            Self::Other(word) => word,
            known => MODES.iter().find(|(_, mode)| mode == known).map_or("NONE", |(word, _)| word),
        }
    }
}
