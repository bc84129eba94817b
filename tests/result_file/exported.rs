//! What is written for VTK and for programs of microscopy says what the result says, number by number.

use std::io::Read;
use std::path::Path;

use pseudopod::output::{
    Frame, Overwrite, ResultFile, ResultWriter, series_file, write_field_image, write_field_series, write_field_tiff,
    write_mesh, write_mesh_series,
};
use roxmltree::{Document, Node};
use tiff::decoder::{Decoder, DecodingResult};
use tiff::tags::Tag;

use crate::example::{cells, header, lineage};
use crate::fields::{frame, layout};

/// A result in which cells come and go, and its frames.
fn result(folder: &Path) -> (ResultFile, Vec<Frame>) {
    let path = folder.join("run.vtkhdf");
    let frames: Vec<Frame> = lineage().iter().enumerate().map(|(number, cells)| frame(cells, number)).collect();
    let mut writer = ResultWriter::create(&path, &header(), &layout(), Overwrite::Refuse).unwrap();
    frames.iter().for_each(|frame| writer.append(frame).unwrap());
    writer.finish(1.0).unwrap();
    (ResultFile::open(&path).unwrap(), frames)
}

fn base64(text: &str) -> Vec<u8> {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let four = |four: &[u8]| -> Vec<u8> {
        let known = four.iter().filter_map(|sign| SIGNS.iter().position(|known| known == sign));
        let bits = known.fold(0_u32, |bits, sign| bits << 6 | sign as u32);
        let filling = four.iter().filter(|sign| **sign == b'=').count();
        (bits << (6 * filling)).to_be_bytes()[1..4 - filling].to_vec()
    };
    text.as_bytes().chunks(4).flat_map(four).collect()
}

/// The bytes of an array, by the rules of VTK: lengths of blocks, then the blocks.
fn bytes(array: Node) -> Vec<u8> {
    let text = array.text().unwrap().trim();
    let words = |text: &str| -> Vec<u64> {
        base64(text).as_chunks::<8>().0.iter().map(|word| u64::from_le_bytes(*word)).collect()
    };
    let blocks = words(&text[..32])[0] as usize;
    let length = (8 * (3 + blocks)).div_ceil(3) * 4;
    let lengths = words(&text[..length]);
    let packed = base64(&text[length..]);
    let (mut start, mut all) = (0, Vec::new());
    for (number, packed_length) in lengths[3..].iter().enumerate() {
        let end = start + *packed_length as usize;
        let before = all.len();
        flate2::read::ZlibDecoder::new(&packed[start..end]).read_to_end(&mut all).unwrap();
        let is_partial = number + 1 == blocks && lengths[2] > 0;
        assert_eq!((all.len() - before) as u64, if is_partial { lengths[2] } else { lengths[1] });
        start = end;
    }
    assert_eq!((lengths.len(), start), (3 + blocks, packed.len()));
    all
}

/// The array of this name in an element.
fn array<'a>(document: &'a Document, element: &str, name: &str) -> Node<'a, 'a> {
    let parent = document.descendants().find(|node| node.has_tag_name(element)).unwrap();
    let found = parent.children().find(|node| node.attribute("Name") == Some(name));
    found.unwrap_or_else(|| panic!("{name} is missing from {element}"))
}

fn floats(document: &Document, element: &str, name: &str) -> Vec<f64> {
    let array = array(document, element, name);
    assert_eq!(array.attribute("type"), Some("Float64"));
    bytes(array).as_chunks::<8>().0.iter().map(|word| f64::from_le_bytes(*word)).collect()
}

fn integers(document: &Document, element: &str, name: &str) -> Vec<i64> {
    let array = array(document, element, name);
    assert_eq!(array.attribute("type"), Some("Int64"));
    bytes(array).as_chunks::<8>().0.iter().map(|word| i64::from_le_bytes(*word)).collect()
}

/// Whether two lists hold the same bits: NaN is NaN.
fn same(one: &[f64], other: &[f64]) -> bool {
    one.iter().map(|value| value.to_bits()).eq(other.iter().map(|value| value.to_bits()))
}

#[test]
fn a_mesh_has_every_number_of_its_atoms_and_cells() {
    let folder = tempfile::tempdir().unwrap();
    let (result, frames) = result(folder.path());
    for (number, frame) in frames.iter().enumerate() {
        let path = folder.path().join("mesh.vtu");
        write_mesh(&result, number, None, &path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let document = Document::parse(&text).unwrap();
        let time = array(&document, "FieldData", "TimeValue").text().unwrap();
        assert_eq!(time.parse(), Ok(frame.time));
        assert_eq!(floats(&document, "Points", "Points"), frame.positions.as_flattened());
        let corners: Vec<i64> = layout().facets_of(&frame.cells).flatten().map(i64::from).collect();
        assert_eq!(integers(&document, "Cells", "connectivity"), corners);
        let ends: Vec<i64> = (1..=corners.len() as i64 / 3).map(|facet| 3 * facet).collect();
        assert_eq!(integers(&document, "Cells", "offsets"), ends);
        assert!(bytes(array(&document, "Cells", "types")).iter().all(|kind| *kind == 5));
        // Of atoms: whose they are, forces, tractions, what is on membranes.
        let ids: Vec<i64> = frame.cells.iter().flat_map(|cell| [cell.id as i64; 6]).collect();
        assert_eq!(integers(&document, "PointData", "cell"), ids);
        assert_eq!(floats(&document, "PointData", "force"), frame.forces.as_flattened());
        assert_eq!(floats(&document, "PointData", "traction"), frame.tractions.traction.as_flattened());
        assert_eq!(floats(&document, "PointData", "inertia"), frame.tractions.inertia.as_flattened());
        assert_eq!(floats(&document, "PointData", "holding_force"), frame.tractions.held.as_flattened());
        assert!(same(&floats(&document, "PointData", "brain.a"), &frame.membranes[1]));
        // Of cells, for each of the eight facets.
        let of_facets = |of: &dyn Fn(usize) -> Vec<f64>| -> Vec<f64> {
            (0..frame.cells.len()).flat_map(|cell| of(cell).repeat(8)).collect()
        };
        let records = &frame.records;
        let cell_data = |name: &str| floats(&document, "CellData", name);
        assert_eq!(cell_data("area"), of_facets(&|cell| vec![records[cell].area]));
        assert_eq!(cell_data("aggregate"), of_facets(&|cell| vec![records[cell].aggregate]));
        assert_eq!(cell_data("velocity"), of_facets(&|cell| records[cell].velocity.to_vec()));
        assert_eq!(cell_data("traction_moment"), of_facets(&|cell| records[cell].traction.moment.to_vec()));
        assert_eq!(cell_data("speed"), of_facets(&|_| vec![(9.0 + 16.0 * frame.time * frame.time).sqrt()]));
        assert!(same(&cell_data("brain.U"), &of_facets(&|cell| vec![frame.systems[0][0][cell]])));
        let parents = frame.cells.iter().flat_map(|cell| [cell.parent.map_or(-1, |id| id as i64); 8]);
        assert!(integers(&document, "CellData", "parent").into_iter().eq(parents));
        let unit = array(&document, "CellData", "area").children().find(|node| node.is_element()).unwrap();
        assert_eq!((unit.attribute("name"), unit.text()), (Some("UNITS_LABEL"), Some("um^2")));
    }
}

#[test]
fn large_arrays_are_packed_in_several_blocks() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.vtkhdf");
    let mut writer = crate::example::write(&path, 4000, 1);
    let wanted = crate::example::frame(&cells(4000), 1);
    writer.append(&wanted).unwrap();
    writer.finish(1.0).unwrap();
    let (result, mesh) = (ResultFile::open(&path).unwrap(), folder.path().join("mesh.vtu"));
    write_mesh(&result, 1, None, &mesh).unwrap();
    let text = std::fs::read_to_string(&mesh).unwrap();
    let document = Document::parse(&text).unwrap();
    assert_eq!(floats(&document, "Points", "Points"), wanted.positions.as_flattened());
    assert_eq!(floats(&document, "PointData", "force"), wanted.forces.as_flattened());
    assert_eq!(integers(&document, "CellData", "cell").len(), 8 * 4000);
}

#[test]
fn a_series_leads_to_the_frames_that_have_a_cell_and_to_no_others() {
    let folder = tempfile::tempdir().unwrap();
    let (result, frames) = result(folder.path());
    let path = folder.path().join("cells & more.pvd");
    let listed = || -> Vec<(f64, String)> {
        let text = std::fs::read_to_string(&path).unwrap();
        let document = Document::parse(&text).unwrap();
        let sets = document.descendants().filter(|node| node.has_tag_name("DataSet"));
        let set =
            |node: Node| (node.attribute("timestep").unwrap().parse().unwrap(), node.attribute("file").unwrap().into());
        sets.map(set).collect()
    };
    let name = |frame: usize| format!("cells & more/cells & more_{frame:06}.vtu");
    write_mesh_series(&result, &[0, 1, 2, 3, 4, 5], None, &path).unwrap();
    let wanted: Vec<_> = (0..6).map(|number| (frames[number].time, name(number))).collect();
    assert_eq!(listed(), wanted);
    std::fs::write(folder.path().join("cells & more/notes.txt"), "own").unwrap();
    // A cell that is there from frame 1 to 3: what was there before is taken away, what belongs to others stays.
    write_mesh_series(&result, &[1, 3], Some(2), &path).unwrap();
    assert_eq!(listed(), [(frames[1].time, name(1)), (frames[3].time, name(3))]);
    let there = |name: String| folder.path().join(name).exists();
    assert!(there(name(1)) && there(name(3)) && !there(name(2)) && there("cells & more/notes.txt".into()));
    let text = std::fs::read_to_string(series_file(&path, 1, "vtu")).unwrap();
    let document = Document::parse(&text).unwrap();
    assert_eq!(floats(&document, "Points", "Points"), frames[1].positions[6..12].as_flattened());
    assert_eq!(integers(&document, "CellData", "cell"), [2; 8]);
    assert_eq!(floats(&document, "PointData", "brain.b"), frames[1].membranes[0][6..12]);
    let corners: Vec<i64> = layout().facets_of(&frames[1].cells[..1]).flatten().map(i64::from).collect();
    assert_eq!(integers(&document, "Cells", "connectivity"), corners);
}

#[test]
fn an_image_of_a_field_and_its_series_have_the_stored_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let (result, frames) = result(folder.path());
    let (layout, path) = (layout(), folder.path().join("field.pvd"));
    write_field_series(&result, &layout.fields[0], &[1], &[0, 5], &path).unwrap();
    let single = folder.path().join("field.vti");
    write_field_image(&result, &layout.fields[0], &[0, 1], 5, &single).unwrap();
    for path in [series_file(&path, 5, "vti"), single] {
        let text = std::fs::read_to_string(path).unwrap();
        let document = Document::parse(&text).unwrap();
        let image = document.descendants().find(|node| node.has_tag_name("ImageData")).unwrap();
        assert_eq!(image.attribute("WholeExtent"), Some("0 6 0 5 0 1"));
        assert_eq!((image.attribute("Origin"), image.attribute("Spacing")), (Some("-3 -4 -1.5"), Some("2 2 1")));
        let found = bytes(array(&document, "CellData", "inhibitor"));
        let found = found.as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word));
        assert!(found.eq(frames[5].fields[0][1].iter().map(|value| *value as f32)));
    }
}

#[test]
fn a_stack_of_pictures_has_axes_sizes_times_and_every_number() {
    let folder = tempfile::tempdir().unwrap();
    let (result, frames) = result(folder.path());
    let chosen = [0, 2, 4];
    for (field, number) in layout().fields.iter().zip(0..) {
        let path = folder.path().join("field.ome.tiff");
        let species: Vec<usize> = (0..field.species.len()).collect();
        write_field_tiff(&result, field, &species, &chosen, &path).unwrap();
        let mut decoder = Decoder::new(std::fs::File::open(&path).unwrap()).unwrap();
        let text = decoder.get_tag_ascii_string(Tag::ImageDescription).unwrap();
        assert!(text.is_ascii());
        let document = Document::parse(&text).unwrap();
        let all = |tag: &'static str| document.descendants().filter(move |node| node.tag_name().name() == tag);
        let pixels = all("Pixels").next().unwrap();
        let [nx, ny, nz] = field.cells.map(|boxes| boxes.to_string());
        let attributes = ["DimensionOrder", "Type", "SizeX", "SizeY", "SizeZ", "SizeT", "PhysicalSizeX"];
        let spacing = field.spacing[0].to_string();
        let wanted = ["XYZCT", "float", &nx, &ny, &nz, "3", &spacing].map(Some);
        assert_eq!(attributes.map(|name| pixels.attribute(name)), wanted);
        assert_eq!(pixels.attribute("PhysicalSizeXUnit"), Some("\u{b5}m"));
        assert_eq!(pixels.attribute("PhysicalSizeZ").is_some(), !field.is_flat());
        assert_eq!(pixels.attribute("TimeIncrement"), Some("0.5"));
        let names: Vec<_> = all("Channel").map(|channel| channel.attribute("Name").unwrap()).collect();
        assert!(names.iter().eq(field.species.iter().map(|(name, _)| name)));
        assert!(all("M").map(|unit| unit.text().unwrap()).eq(field.species.iter().map(|(_, unit)| unit)));
        let mut planes = all("Plane");
        for (t, frame) in chosen.iter().enumerate() {
            for (c, values) in frames[*frame].fields[number].iter().enumerate() {
                for (z, layer) in values.chunks(field.cells[0] * field.cells[1]).enumerate() {
                    let plane = planes.next().unwrap();
                    let indices = ["TheT", "TheC", "TheZ"].map(|name| plane.attribute(name).unwrap().parse().ok());
                    assert_eq!(indices, [Some(t), Some(c), Some(z)]);
                    assert_eq!(plane.attribute("DeltaT").unwrap().parse(), Ok(frames[*frame].time));
                    assert_eq!(decoder.dimensions().unwrap(), (field.cells[0] as u32, field.cells[1] as u32));
                    let DecodingResult::F32(found) = decoder.read_image().unwrap() else { panic!("not of four bytes") };
                    assert!(found.into_iter().eq(layer.iter().map(|value| *value as f32)));
                    assert_eq!(decoder.more_images(), planes.clone().next().is_some());
                    if decoder.more_images() {
                        decoder.next_image().unwrap();
                    }
                }
            }
        }
        assert!(planes.next().is_none());
    }
}
