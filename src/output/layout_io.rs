//! The parts of the result file that are written once: who made it, the cells, their facets and links.

use hdf5::types::{FixedAscii, VarLenUnicode};
use hdf5::{File, Group};

use super::catalogue::{CATALOGUE, Entry, Filled, entry};
use super::column::{Number, Plan, write_integers, write_vectors};
use super::container::{self, FORMAT, FORMAT_ATTRIBUTE, read_texts, set_number, set_text, text, write_texts};
use super::header::Header;
use super::mark::FlushMark;
use super::{CellLayout, Layout};

/// Kinds of cells that VTK keeps apart in a surface.
const VTK_KINDS: [&str; 4] = ["Vertices", "Lines", "Polygons", "Strips"];

impl Entry {
    /// What the dataset of this row is when it is made.
    pub(super) fn plan(&self, number: Number) -> Plan<'_> {
        Plan { path: self.path, number, unit: self.unit, description: self.description }
    }
}

/// Writes the header, with the marks that the run has not finished.
pub(super) fn write_header(file: &File, header: &Header) -> hdf5::Result<()> {
    set_number(file, FORMAT_ATTRIBUTE, FORMAT)?;
    let group = file.create_group("provenance")?;
    for (name, value) in [
        ("document", &header.document),
        ("title", &header.title),
        ("version", &header.version),
        ("commit", &header.commit),
        ("started", &header.started),
    ] {
        set_text(&group, name, value)?;
    }
    set_number(&group, "seed", header.seed)?;
    set_number(&group, "finished", 0_i64)?;
    set_number(&group, "resumed", 0_i64)?;
    set_number(&group, "wall_time", f64::NAN)?;
    set_text(&group, "wall_time_unit", "s")?;
    let sets: Vec<&str> = header.sets.iter().map(String::as_str).collect();
    described(&write_texts(file, "/provenance/sets", &sets)?, "/provenance/sets")?;
    let (paths, texts): (Vec<&str>, Vec<&str>) =
        header.equations.iter().map(|(path, text)| (path.as_str(), text.as_str())).unzip();
    for (name, texts) in [("/provenance/equation_files", paths), ("/provenance/equations", texts)] {
        described(&write_texts(file, name, &texts)?, name)?;
    }
    // A dataset, because an attribute may not be longer than 64 kB.
    let experiment = file.new_dataset::<VarLenUnicode>().obj_track_times(false).create("/provenance/experiment")?;
    experiment.write_scalar(&container::stored(&header.experiment))?;
    described(&experiment, "/provenance/experiment")?;
    FlushMark::create(file)
}

/// Reads the header.
pub(super) fn read_header(file: &File) -> hdf5::Result<Header> {
    let group = file.group("provenance")?;
    let experiment = file.dataset("/provenance/experiment")?.read_scalar::<VarLenUnicode>()?;
    Ok(Header {
        document: text(&group, "document")?,
        title: text(&group, "title")?,
        experiment: experiment.as_str().to_string(),
        sets: read_texts(file, "/provenance/sets")?,
        equations: match file.link_exists("/provenance/equations") {
            true => read_texts(file, "/provenance/equation_files")?
                .into_iter()
                .zip(read_texts(file, "/provenance/equations")?)
                .collect(),
            false => Vec::new(),
        },
        seed: group.attr("seed")?.read_scalar()?,
        version: text(&group, "version")?,
        commit: text(&group, "commit")?,
        started: text(&group, "started")?,
    })
}

fn described(dataset: &hdf5::Dataset, path: &str) -> hdf5::Result<()> {
    set_text(dataset, "unit", entry(path).unit)?;
    set_text(dataset, "description", entry(path).description)
}

/// Writes all that the layout says.
pub(super) fn write_layout(file: &File, layout: &Layout) -> hdf5::Result<()> {
    let vtk = file.create_group("VTKHDF")?;
    vtk.new_attr_builder().with_data(&[2_i64, 0]).create("Version")?;
    // VTK wants this text at a fixed length.
    let kind = FixedAscii::<8>::from_ascii("PolyData").unwrap_or_default();
    vtk.new_attr::<FixedAscii<8>>().create("Type")?.write_scalar(&kind)?;
    let steps = vtk.create_group("Steps")?;
    set_number(&steps, "NSteps", 0_i64)?;
    let owners = Owners::of(layout);
    for entry in CATALOGUE.iter().filter(|entry| matches!(entry.filled, Filled::OnceIntegers)) {
        write_once(file, entry, layout, &owners)?;
    }
    let types: Vec<&str> = layout.types.iter().map(String::as_str).collect();
    described(&write_texts(file, "/cells/type_names", &types)?, "/cells/type_names")?;
    let names: Vec<&str> = layout.planes.iter().map(|plane| plane.0.as_str()).collect();
    described(&write_texts(file, "/planes/names", &names)?, "/planes/names")?;
    let points: Vec<[f64; 3]> = layout.planes.iter().map(|plane| plane.1).collect();
    write_vectors(file, &entry("/planes/point").plan(Number::Float), &points)?;
    let normals: Vec<[f64; 3]> = layout.planes.iter().map(|plane| plane.2).collect();
    write_vectors(file, &entry("/planes/normal").plan(Number::Float), &normals)?;
    Ok(())
}

/// Which cell every atom and every drawn thing (links, then facets) belongs to.
struct Owners {
    atoms: Vec<u32>,
    drawn: Vec<u32>,
}

impl Owners {
    fn of(layout: &Layout) -> Self {
        let mut atoms = vec![0; layout.atoms()];
        let mut facets = vec![0; layout.facets.len()];
        for (number, cell) in (0..).zip(&layout.cells) {
            atoms[cell.first_atom as usize..][..cell.atoms as usize].fill(number);
            facets[cell.first_facet as usize..][..cell.facets as usize].fill(number);
        }
        let drawn = layout.links.iter().map(|link| atoms[link[0] as usize]).chain(facets).collect();
        Self { atoms, drawn }
    }
}

fn write_once(file: &File, entry: &Entry, layout: &Layout, owners: &Owners) -> hdf5::Result<()> {
    let plan = entry.plan(Number::Integer);
    let integers =
        |count: usize, value: &(dyn Fn(usize) -> i64 + Sync)| write_integers(file, &plan, count, value).map(|_| ());
    let of_cells =
        |value: fn(&CellLayout) -> u32| integers(layout.cells.len(), &|i| i64::from(value(&layout.cells[i])));
    let kind = |cell: u32| i64::from(layout.cells[cell as usize].kind);
    match entry.path {
        "/VTKHDF/NumberOfPoints" => integers(1, &|_| owners.atoms.len() as i64),
        "/VTKHDF/PointData/cell" => integers(owners.atoms.len(), &|i| i64::from(owners.atoms[i])),
        "/VTKHDF/PointData/type" => integers(owners.atoms.len(), &|i| kind(owners.atoms[i])),
        "/VTKHDF/CellData/cell" => integers(owners.drawn.len(), &|i| i64::from(owners.drawn[i])),
        "/VTKHDF/CellData/type" => integers(owners.drawn.len(), &|i| kind(owners.drawn[i])),
        "/cells/type" => of_cells(|cell| cell.kind),
        "/cells/first_atom" => of_cells(|cell| cell.first_atom),
        "/cells/atoms" => of_cells(|cell| cell.atoms),
        "/cells/first_facet" => of_cells(|cell| cell.first_facet),
        "/cells/facets" => of_cells(|cell| cell.facets),
        path => {
            let name = path.rsplit('/').next().unwrap_or_default();
            let kind = VTK_KINDS.iter().find(|kind| path.contains(*kind)).expect("all other rows are topology");
            let (corners, atoms): (usize, &[u32]) = match *kind {
                "Lines" => (2, layout.links.as_flattened()),
                "Polygons" => (3, layout.facets.as_flattened()),
                _ => (1, &[]),
            };
            match name {
                "NumberOfConnectivityIds" => integers(1, &|_| atoms.len() as i64),
                "NumberOfCells" => integers(1, &|_| (atoms.len() / corners) as i64),
                "Offsets" => integers(atoms.len() / corners + 1, &|i| (corners * i) as i64),
                _ => integers(atoms.len(), &|i| i64::from(atoms[i])),
            }
        }
    }
}

/// Reads the layout.
pub(super) fn read_layout(file: &File) -> hdf5::Result<Layout> {
    let integers = |path: &str| -> hdf5::Result<Vec<u32>> {
        let numbers = file.dataset(path)?.read_raw::<i64>()?;
        numbers.into_iter().map(|n| u32::try_from(n).map_err(|_| format!("{path} holds {n}").as_str().into())).collect()
    };
    let (kind, first_atom, atoms) =
        (integers("/cells/type")?, integers("/cells/first_atom")?, integers("/cells/atoms")?);
    let (first_facet, facets) = (integers("/cells/first_facet")?, integers("/cells/facets")?);
    if [first_atom.len(), atoms.len(), first_facet.len(), facets.len()].iter().any(|n| *n != kind.len()) {
        return Err("the datasets of /cells differ in length".into());
    }
    let cells = (0..kind.len())
        .map(|i| CellLayout {
            kind: kind[i],
            first_atom: first_atom[i],
            atoms: atoms[i],
            first_facet: first_facet[i],
            facets: facets[i],
        })
        .collect();
    let names = read_texts(file, "/planes/names")?;
    let (points, normals) = (vectors(file, "/planes/point")?, vectors(file, "/planes/normal")?);
    Ok(Layout {
        types: read_texts(file, "/cells/type_names")?,
        cells,
        facets: integers("/VTKHDF/Polygons/Connectivity")?.as_chunks::<3>().0.to_vec(),
        links: integers("/VTKHDF/Lines/Connectivity")?.as_chunks::<2>().0.to_vec(),
        scene_series: read_scene_names(file)?,
        planes: names.into_iter().zip(points.into_iter().zip(normals)).map(|(name, (p, n))| (name, p, n)).collect(),
        fields: super::fields::read_layouts(file)?,
        systems: super::systems::read_layouts(file)?,
        contacts: file.link_exists("contacts"),
    })
}

/// Names and units of the scene series, in the order of the layout that was written.
fn read_scene_names(file: &File) -> hdf5::Result<Vec<(String, String)>> {
    let Ok(group) = file.group("scene") else { return Ok(Vec::new()) };
    let mut found: Vec<(i64, String, String)> = Vec::new();
    for name in group.member_names()? {
        let dataset = group.dataset(&name)?;
        found.push((dataset.attr("order")?.read_scalar()?, name, text(&dataset, "unit")?));
    }
    found.sort_by_key(|series| series.0);
    Ok(found.into_iter().map(|(_, name, unit)| (name, unit)).collect())
}

fn vectors(file: &Group, path: &str) -> hdf5::Result<Vec<[f64; 3]>> {
    Ok(file.dataset(path)?.read_raw::<f64>()?.as_chunks::<3>().0.to_vec())
}
