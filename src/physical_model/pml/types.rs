//! The words of the language for what cells are and how components are shown.

use super::super::words::{meaning, word_for};

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

const CELL_TYPES: [(&str, CellType); 11] = [
    ("INVALID", CellType::Invalid),
    ("ATOM", CellType::Atom),
    ("LINE", CellType::Line),
    ("TRIANGLE", CellType::Triangle),
    ("QUAD", CellType::Quad),
    ("TETRAHEDRON", CellType::Tetrahedron),
    ("WEDGE", CellType::Wedge),
    ("PYRAMID", CellType::Pyramid),
    ("HEXAHEDRON", CellType::Hexahedron),
    ("POLY_LINE", CellType::PolyLine),
    ("POLY_VERTEX", CellType::PolyVertex),
];

impl CellType {
    /// The words of the language.
    pub fn words() -> impl Iterator<Item = &'static str> {
        CELL_TYPES.iter().map(|(word, _)| *word)
    }

    /// What a word means.
    pub fn of(word: &str) -> Self {
        meaning(&CELL_TYPES, word).unwrap_or_else(|| Self::Other(word.into()))
    }

    /// Its word.
    pub fn word(&self) -> &str {
        match self {
            Self::Other(word) => word,
            known => word_for(&CELL_TYPES, known),
        }
    }

    /// How many atoms such a cell has, if that is fixed.
    pub fn atoms(&self) -> Option<usize> {
        match self {
            Self::Atom => Some(1),
            Self::Line => Some(2),
            Self::Triangle => Some(3),
            Self::Quad | Self::Tetrahedron => Some(4),
            Self::Pyramid => Some(5),
            Self::Wedge => Some(6),
            Self::Hexahedron => Some(8),
            Self::Invalid | Self::PolyLine | Self::PolyVertex | Self::Other(_) => None,
        }
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
        meaning(&MODES, word).unwrap_or_else(|| Self::Other(word.into()))
    }

    /// Its word.
    pub fn word(&self) -> &str {
        match self {
            Self::Other(word) => word,
            known => word_for(&MODES, known),
        }
    }
}
