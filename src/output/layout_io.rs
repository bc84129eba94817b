//! The parts of the result file that are written once: who made it, the cells, their facets and links.

use hdf5::types::{FixedAscii, VarLenUnicode};
use hdf5::{File, Group};

use super::catalogue::{CATALOGUE, Entry, Filled, TRACTION, entry};
use super::column::{Number, Plan, write_integers, write_vectors};
use super::container::{FORMAT, FORMAT_ATTRIBUTE, set_number};
use super::header::Header;
use super::texts::{self, read_text, read_texts, set_text, text, write_texts};
use super::{CellType, Layout, Obstacle};
use crate::recorded::VISCOUS;

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
    experiment.write_scalar(&texts::stored(&header.experiment))?;
    described(&experiment, "/provenance/experiment")
}

/// Reads the header.
pub(super) fn read_header(file: &File) -> hdf5::Result<Header> {
    let group = file.group("provenance")?;
    Ok(Header {
        document: text(&group, "document")?,
        title: text(&group, "title")?,
        experiment: read_text(file, "/provenance/experiment")?,
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
    for entry in CATALOGUE.iter().filter(|entry| matches!(entry.filled, Filled::OnceIntegers)) {
        let numbers = of_types(entry.path, layout);
        write_integers(file, &entry.plan(Number::Integer), numbers.len(), |i| numbers[i])?;
    }
    let types: Vec<&str> = layout.types.iter().map(|kind| kind.name.as_str()).collect();
    described(&write_texts(file, "/cells/type_names", &types)?, "/cells/type_names")?;
    write_obstacles(file, &layout.obstacles)
}

/// Writes what cells cannot pass.
fn write_obstacles(file: &File, obstacles: &[Obstacle]) -> hdf5::Result<()> {
    let names: Vec<&str> = obstacles.iter().map(|obstacle| obstacle.name.as_str()).collect();
    described(&write_texts(file, "/planes/names", &names)?, "/planes/names")?;
    let vectors = |path: &str, of: &dyn Fn(&Obstacle) -> Vec<[f64; 3]>| {
        let all: Vec<[f64; 3]> = obstacles.iter().flat_map(of).collect();
        write_vectors(file, &entry(path).plan(Number::Float), &all)
    };
    vectors("/planes/point", &|obstacle| vec![obstacle.point])?;
    vectors("/planes/normal", &|obstacle| vec![obstacle.normal])?;
    vectors("/planes/direction", &|obstacle| vec![obstacle.direction])?;
    // The third of each is the number of the tool, by which rows are told apart.
    let number = |obstacle: &Obstacle| obstacles.iter().position(|other| other.name == obstacle.name).unwrap_or(0);
    vectors("/planes/profile", &|obstacle| {
        obstacle.profile.iter().map(|[radius, height]| [*radius, *height, number(obstacle) as f64]).collect()
    })?;
    Ok(())
}

/// Reads them.
fn read_obstacles(file: &File) -> hdf5::Result<Vec<Obstacle>> {
    let names = read_texts(file, "/planes/names")?;
    let (points, normals) = (vectors(file, "/planes/point")?, vectors(file, "/planes/normal")?);
    // Files of earlier versions have none.
    let later = |path: &str| if file.link_exists(path) { vectors(file, path) } else { Ok(Vec::new()) };
    let (profiles, directions) = (later("/planes/profile")?, later("/planes/direction")?);
    let count = points.len().min(normals.len());
    let mut own: Vec<Vec<[f64; 2]>> = vec![Vec::new(); count];
    for [radius, height, number] in profiles {
        // What names no tool is of none.
        own.get_mut(number as usize).into_iter().for_each(|own| own.push([radius, height]));
    }
    let obstacle = |(number, name): (usize, String)| Obstacle {
        name,
        point: points[number],
        normal: normals[number],
        direction: directions.get(number).copied().unwrap_or_default(),
        profile: std::mem::take(&mut own[number]),
    };
    Ok(names.into_iter().take(count).enumerate().map(obstacle).collect())
}

/// The numbers of a dataset of the types of cells; none for what VTK wants and nobody fills.
fn of_types(path: &str, layout: &Layout) -> Vec<i64> {
    let types = || layout.types.iter();
    let numbers = |value: fn(&CellType) -> usize| types().map(|kind| value(kind) as i64).collect();
    let atoms = |value: fn(&CellType) -> &[u32]| types().flat_map(value).map(|atom| i64::from(*atom)).collect();
    match path {
        "/types/atoms" => numbers(|kind| kind.atoms as usize),
        "/types/facets" => numbers(|kind| kind.facets.len()),
        "/types/links" => numbers(|kind| kind.links.len()),
        "/types/facet_atoms" => atoms(|kind| kind.facets.as_flattened()),
        "/types/link_atoms" => atoms(|kind| kind.links.as_flattened()),
        _ => Vec::new(),
    }
}

/// Reads the layout.
pub(super) fn read_layout(file: &File) -> hdf5::Result<Layout> {
    Ok(Layout {
        types: read_types(file)?,
        scene_series: read_scene_names(file)?,
        obstacles: read_obstacles(file)?,
        fields: super::fields::read_layouts(file)?,
        systems: super::systems::read_layouts(file)?,
        membranes: super::membranes::read_layouts(file)?,
        contacts: file.link_exists("contacts"),
        tractions: file.dataset(TRACTION[0].path).is_ok(),
        fibres: file.link_exists("fibres"),
        linked: file.link_exists("links"),
        viscosity: file.dataset(VISCOUS[0].dataset).is_ok(),
    })
}

/// Reads the types of cells; the atoms of facets and links are checked, since arrays are looked up by them.
fn read_types(file: &File) -> hdf5::Result<Vec<CellType>> {
    let integers = |path: &str| -> hdf5::Result<Vec<u32>> {
        let numbers = file.dataset(path)?.read_raw::<i64>()?;
        numbers.into_iter().map(|n| u32::try_from(n).map_err(|_| format!("{path} holds {n}").as_str().into())).collect()
    };
    let names = read_texts(file, "/cells/type_names")?;
    let (atoms, facets, links) = (integers("/types/atoms")?, integers("/types/facets")?, integers("/types/links")?);
    let (facet_atoms, link_atoms) = (integers("/types/facet_atoms")?, integers("/types/link_atoms")?);
    let sum = |counts: &[u32]| counts.iter().map(|count| *count as usize).sum::<usize>();
    if [atoms.len(), facets.len(), links.len()].iter().any(|n| *n != names.len())
        || (3 * sum(&facets), 2 * sum(&links)) != (facet_atoms.len(), link_atoms.len())
    {
        return Err("the datasets of /types differ in length".into());
    }
    let (mut facet_atoms, mut link_atoms) = (facet_atoms.as_slice(), link_atoms.as_slice());
    let mut types = Vec::new();
    for (number, name) in names.into_iter().enumerate() {
        let (of_facets, later_facets) = facet_atoms.split_at(3 * facets[number] as usize);
        let (of_links, later_links) = link_atoms.split_at(2 * links[number] as usize);
        if of_facets.iter().chain(of_links).any(|atom| *atom >= atoms[number]) {
            return Err(format!("the mesh of the type {name} names an atom that is not there").as_str().into());
        }
        types.push(CellType {
            name,
            atoms: atoms[number],
            facets: of_facets.as_chunks::<3>().0.to_vec(),
            links: of_links.as_chunks::<2>().0.to_vec(),
        });
        (facet_atoms, link_atoms) = (later_facets, later_links);
    }
    Ok(types)
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
