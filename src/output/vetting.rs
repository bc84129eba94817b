//! Looks a file over before anything in it is used: files come from other machines, broken disks and bad people.
//!
//! What leads out of the file is refused (links, external storage, virtual datasets), as are filters that are not built in,
//! groups that hold themselves, and datasets of the catalogue of another type or shape than it says, or that claim more
//! numbers than the bytes in the file can hold.

use std::collections::HashSet;

use hdf5::filters::Filter;
use hdf5::plist::dataset_create::Layout as Storage;
use hdf5::types::TypeDescriptor;
use hdf5::{Dataset, File, Group, LinkType, LocationType};

use super::catalogue::{CATALOGUE, CONTACT, Entry, FIBRE, FORCE, Filled, LINK, TRACTION};
use crate::recorded::{OnDemand, Values, cell_quantities};

/// Groups within groups: three are needed.
const DEEPEST: usize = 8;
/// Groups and datasets: a hundred and some are usual, and one for each name of a series, species or quantity.
const MOST_OBJECTS: usize = 100_000;
/// What deflate can make of a byte at most is 1032.
const MOST_UNPACKED: usize = 1100;

/// The numbers or texts of a dataset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Integers,
    Floats,
    HalfFloats,
    Bytes,
    Texts,
}

/// What is expected of a dataset: its kind, its number of dimensions, and what a row has.
type Expected = (Kind, &'static [Option<usize>]);

const SCALAR: &[Option<usize>] = &[];
const ROWS: &[Option<usize>] = &[None];
const VECTORS: &[Option<usize>] = &[None, Some(3)];
const FOURS: &[Option<usize>] = &[None, Some(4)];
const BOXES: &[Option<usize>] = &[None, None, None, None];

/// Looks over all that is in a file.
///
/// # Errors
/// The first thing that no file of ours has, in words.
pub(super) fn vet(file: &File) -> hdf5::Result<()> {
    let mut walk = Walk { file, seen: HashSet::new(), objects: 0 };
    walk.group(file, "", 0)
}

struct Walk<'a> {
    file: &'a File,
    seen: HashSet<String>,
    objects: usize,
}

impl Walk<'_> {
    fn group(&mut self, group: &Group, path: &str, depth: usize) -> hdf5::Result<()> {
        if depth > DEEPEST {
            return Err(fault(path, "lies in too many groups"));
        }
        let mut links = Vec::new();
        group.iter_visit_default(|name, link| {
            links.push((name.to_owned(), link.link_type));
            Ok(())
        })?;
        for (name, link) in links {
            self.objects += 1;
            if self.objects > MOST_OBJECTS {
                return Err(fault(path, "holds too many objects"));
            }
            let inner = format!("{path}/{name}");
            match link {
                LinkType::Hard => self.object(group, &name, &inner, depth)?,
                LinkType::Soft if is_time_link(&inner) => {}
                LinkType::Soft => return Err(fault(&inner, "is a link by name, which no result has there")),
                LinkType::External => return Err(fault(&inner, "leads to another file")),
            }
        }
        Ok(())
    }

    fn object(&mut self, group: &Group, name: &str, path: &str, depth: usize) -> hdf5::Result<()> {
        let known = group.loc_info_by_name(name)?;
        match known.loc_type {
            LocationType::Group if !self.seen.insert(format!("{:?}", known.token)) => {
                Err(fault(path, "is a group that is there twice, or holds itself"))
            }
            LocationType::Group => self.group(&group.group(name)?, path, depth + 1),
            LocationType::Dataset => vet_dataset(&group.dataset(name)?, path, self.file.size()),
            _ => Err(fault(path, "is neither a group nor a dataset")),
        }
    }
}

/// Whether this is where a field says when its frames are, by the name of the list of times.
fn is_time_link(path: &str) -> bool {
    path.starts_with("/fields/") && path.ends_with("/Steps/Values")
}

fn fault(path: &str, words: &str) -> hdf5::Error {
    format!("{} {words}", if path.is_empty() { "/" } else { path }).as_str().into()
}

fn vet_dataset(dataset: &Dataset, path: &str, file_size: u64) -> hdf5::Result<()> {
    let plan = dataset.dcpl()?;
    if plan.layout() == Storage::Virtual {
        return Err(fault(path, "is put together from other files"));
    }
    if !plan.external().is_empty() {
        return Err(fault(path, "has its numbers in another file"));
    }
    if dataset
        .filters()
        .iter()
        .any(|filter| !matches!(filter, Filter::Deflate(_) | Filter::Shuffle | Filter::Fletcher32))
    {
        return Err(fault(path, "is packed in a way that no result is"));
    }
    let kind = kind_of(&dataset.dtype()?.to_descriptor()?);
    let shape = dataset.space()?.shape();
    if let Some((expected, rows)) = expected(path) {
        let fits =
            shape.len() == rows.len() && shape.iter().zip(rows).all(|(found, row)| row.is_none_or(|n| *found == n));
        // Dimensions of nothing belong to scenes without cells.
        let fits = fits || (shape.len() == rows.len() && shape.iter().product::<usize>() == 0);
        if kind != Some(expected) || !fits || dataset.space()?.is_null() {
            return Err(fault(path, "has another type or shape than a result has there"));
        }
    }
    vet_size(dataset, path, &shape, file_size)
}

/// A dataset holds what its bytes can hold: what is never written costs nothing in the file, and all memory when it is read.
fn vet_size(dataset: &Dataset, path: &str, shape: &[usize], file_size: u64) -> hdf5::Result<()> {
    let numbers = shape.iter().try_fold(1_usize, |product, n| product.checked_mul(*n));
    let claimed = numbers.and_then(|numbers| numbers.checked_mul(dataset.dtype().ok()?.size()));
    let stored = dataset.storage_size().min(file_size) as usize;
    let packed = !dataset.filters().is_empty();
    let piece = dataset.chunk().map_or(0, |piece| piece.iter().product::<usize>().saturating_mul(8));
    if dataset.is_chunked() && piece > 64 << 20 {
        return Err(fault(path, "is cut into pieces that are too large"));
    }
    let most = if packed { stored.saturating_mul(MOST_UNPACKED) } else { stored }.saturating_add(piece);
    match claimed {
        Some(claimed) if claimed <= most => Ok(()),
        _ => Err(fault(path, "claims more numbers than are in the file")),
    }
}

fn kind_of(found: &TypeDescriptor) -> Option<Kind> {
    use hdf5::types::{FloatSize, IntSize};
    match found {
        TypeDescriptor::Integer(IntSize::U8) => Some(Kind::Integers),
        TypeDescriptor::Float(FloatSize::U8) => Some(Kind::Floats),
        TypeDescriptor::Float(FloatSize::U4) => Some(Kind::HalfFloats),
        TypeDescriptor::Unsigned(IntSize::U1) => Some(Kind::Bytes),
        TypeDescriptor::VarLenUnicode => Some(Kind::Texts),
        _ => None,
    }
}

/// What a result has at a path; nothing is said of what it does not have.
fn expected(path: &str) -> Option<Expected> {
    let of_cells = cell_quantities(OnDemand::ALL);
    if let Some(quantity) = of_cells.into_iter().find(|quantity| quantity.dataset == path) {
        return Some(match quantity.values {
            Values::Number(..) => (Kind::Floats, ROWS),
            Values::Vector(..) => (Kind::Floats, VECTORS),
        });
    }
    let mut entries = CATALOGUE.iter().chain(CONTACT).chain(FIBRE).chain(LINK).chain(FORCE).chain(TRACTION);
    if let Some(entry) = entries.find(|entry| entry.path == path) {
        return of_entry(entry);
    }
    match path.split('/').collect::<Vec<_>>()[..] {
        ["", "scene", _] => Some((Kind::Floats, ROWS)),
        ["", "summary", _] => Some((Kind::Floats, SCALAR)),
        ["", "chemistry", _, _] => Some((Kind::Floats, ROWS)),
        ["", "fields", _, "CellData", _] => Some((Kind::HalfFloats, BOXES)),
        ["", "VTKHDF", "PointData", name] if name.contains('.') => Some((Kind::Floats, ROWS)),
        _ => None,
    }
}

fn of_entry(entry: &Entry) -> Option<Expected> {
    Some(match &entry.filled {
        Filled::OnceTexts if entry.shape == "1" || entry.path == "/provenance/experiment" => (Kind::Texts, SCALAR),
        Filled::OnceTexts => (Kind::Texts, ROWS),
        Filled::OnceFloats | Filled::Atoms(_) => (Kind::Floats, VECTORS),
        Filled::Frame(_) | Filled::RowFloat(..) => (Kind::Floats, ROWS),
        Filled::Counters(_) => (Kind::Integers, FOURS),
        Filled::Link(target) => return expected(target),
        Filled::OnceIntegers | Filled::Counter(_) | Filled::Population(_) | Filled::Shared(_) => (Kind::Integers, ROWS),
        Filled::CellInteger(_) | Filled::RowInteger(..) => (Kind::Integers, ROWS),
        Filled::Bytes => (Kind::Bytes, ROWS),
        Filled::Cell(_) | Filled::Scene | Filled::Measure => return None,
    })
}
