//! The face of a gel that cells pull at: where it was, how far it has gone, and what pulls at it.

use crate::Vec3;
use crate::error::words::all_of;
use crate::error::{Error, Fault, Result};
use crate::geometry::bounding_box;
use crate::output::ResultFile;

/// Facets whose normals are off that of the face by more than this are none of it (a cosine).
const FLAT: f64 = 0.9;

/// How much higher one of its corners may be than another, over the size of the body.
const PLANE: f64 = 1e-6;

/// A face of the one body of a type.
pub struct Gel {
    /// Where its atoms were in the first frame, µm.
    pub rest: Vec<Vec3>,
    /// How far they have gone since, µm.
    pub moved: Vec<Vec3>,
    /// The facets of the face, by atoms.
    pub facets: Vec<[usize; 3]>,
    /// The forces of cells on its atoms, pN, where the run recorded tractions.
    pub forces: Option<Vec<Vec3>>,
}

impl Gel {
    /// The face of a body that looked along `normal` (a unit vector) in the first frame, as it is in a frame.
    ///
    /// # Errors
    /// [`Error::Input`] when there is no such type, not one body of it, or no such face; [`Error::File`] for a damaged file.
    pub fn of(file: &ResultFile, name: &str, frame: usize, normal: Vec3) -> Result<Self> {
        let (layout, cells) = (file.layout(), file.cells(frame));
        let names = layout.type_names();
        let Some(kind) = names.iter().position(|other| other == name) else {
            let fault = Fault::new(format!("there is no type \"{name}\""));
            return Err(Error::input(fault.help(format!("types are {}", all_of(names.iter().map(String::as_str))))));
        };
        let bodies: Vec<usize> = (0..cells.len()).filter(|number| cells[*number].kind as usize == kind).collect();
        let [number] = bodies[..] else {
            let fault = Fault::new(format!("there are {} bodies of the type \"{name}\" in that frame", bodies.len()));
            return Err(Error::input(fault.help("name a type of which there is one, the gel")));
        };
        let first = file.cells(0);
        let before = first.iter().position(|cell| cell.id == cells[number].id);
        let before = before.and_then(|number| layout.atoms_of(&first).nth(number));
        let (Some(before), Some(atoms)) = (before, layout.atoms_of(&cells).nth(number)) else {
            let fault = Fault::new(format!("the body of the type \"{name}\" was not there in the first frame"));
            return Err(Error::input(fault.help("name a type that is there from the start")));
        };
        let vectors = |list: &[[f64; 3]]| list.iter().map(|x| Vec3::from(*x)).collect::<Vec<_>>();
        let rest = vectors(&file.positions(0)?[before]);
        let now = vectors(&file.positions(frame)?[atoms.clone()]);
        // What the gel does to cells they do to it, the other way round.
        let forces =
            file.tractions(frame)?.map(|forces| vectors(&forces.of_cells[atoms]).iter().map(|pull| -pull).collect());
        let facets = layout.facets_of(&cells[number..=number]).map(|facet| facet.map(|corner| corner as usize));
        let is_of_face = |[a, b, c]: &[usize; 3]| {
            let across = (rest[*b] - rest[*a]).cross(&(rest[*c] - rest[*a]));
            across.dot(&normal) > FLAT * across.norm()
        };
        let facets: Vec<_> = facets.filter(is_of_face).collect();
        let heights = facets.iter().flatten().map(|corner| rest[*corner].dot(&normal));
        let (low, high) =
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        let size = bounding_box(&rest).map_or(0.0, |(low, high)| (high - low).norm());
        if facets.is_empty() || high - low > PLANE * size {
            let [x, y, z] = <[f64; 3]>::from(normal);
            let fault =
                Fault::new(format!("\"{name}\" had no flat face that looked along [{x}, {y}, {z}] in the first frame"));
            return Err(Error::input(fault.help("name a type with a flat face there, such as a block")));
        }
        let moved = now.iter().zip(&rest).map(|(now, rest)| now - rest).collect();
        Ok(Self { rest, moved, facets, forces })
    }
}
