//! Areas of contact as they are recorded: of facets that face each other, whatever law acts.

use pseudopod::contact::closest_on_facet;
use pseudopod::random::{Purpose, Stream};
use pseudopod::{Simulation, Vec3};

fn series(simulation: &Simulation, name: &str) -> Vec<f64> {
    simulation.series(name).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_box_on_a_floor_has_the_area_of_its_floor_under_strengths_and_penalties() {
    for rules in ["strength = \"1 pN/um^2\"", "model = \"penalty\"\npenalty = \"50 pN/um\""] {
        for parts in [4, 8] {
            let text = format!(
                "title = \"A box on a floor\"\n[run]\nuntil = \"1 s\"\n[[planes]]\nname = \"floor\"\n\
                 point = [\"0 um\", \"0 um\", \"0 um\"]\nnormal = [0, 0, 1]\n[cells.box]\n\
                 mesh = {{ shape = \"box\", size = [\"10 um\", \"10 um\", \"5 um\"], divisions = [{parts}, {parts}, 4] }}\n\
                 placement = {{ at = [[\"0 um\", \"0 um\", \"2.5 um\"]] }}\n[cells.box.mechanics]\ndrag = \"20 pN s/um\"\n\
                 shape_memory = {{ shape_modulus = \"200 pN/um\" }}\n[contact]\n{rules}\n"
            );
            let mut simulation = Simulation::from_text("box.toml", &text).unwrap_or_else(|error| panic!("{error}"));
            simulation.run_until(1.0).unwrap_or_else(|error| panic!("{error}"));
            let area = series(&simulation, "contact.area.box.floor")[0];
            assert!((area - 100.0).abs() < 5.0, "{rules}, {parts}: {area} um^2");
        }
    }
}

#[test]
fn what_is_nearer_than_the_length_of_the_document_is_in_contact_and_nothing_that_cells_do_depends_on_it() {
    let sheets = |within: &str| {
        let text = format!(
            "title = \"Two sheets\"\n[run]\nuntil = \"1 s\"\n[cells.sheet]\n\
             mesh = {{ shape = \"sheet\", size = [\"10 um\", \"8 um\"], divisions = [5, 4] }}\n\
             placement = {{ at = [[\"0 um\", \"0 um\", \"0 um\"], [\"0 um\", \"0 um\", \"0.4 um\"]] }}\n\
             mechanics = {{ drag = \"20 pN s/um\", springs = {{ stiffness = \"10 pN/um\" }} }}\n[contact]\nproximity = \"0.2 um\"\n{within}\n"
        );
        let simulation = Simulation::from_text("sheets.toml", &text).unwrap_or_else(|error| panic!("{error}"));
        let of_pair = ["contact.area.sheet.sheet", "contact.pairs.sheet.sheet", "aggregates"];
        let checkpoint = simulation.checkpoint();
        (of_pair.map(|name| series(&simulation, name)[0]), checkpoint)
    };
    let (near, with_default) = sheets("");
    assert_eq!(near, [0.0, 0.0, 2.0]);
    let (far, checkpoint) = sheets("area_within = \"0.5 um\"");
    assert!((far[0] - 80.0).abs() < 1e-9 && far[1..] == [1.0, 1.0], "{far:?}");
    assert!(checkpoint == with_default, "a run may go on with another length");
}

/// Sixty-four cells that have grown in a box until 92 % of it is full.
fn crowded() -> Simulation {
    let plane = |axis: usize, side: i32| {
        let (mut point, mut normal) = (["0 um".to_owned(), "0 um".to_owned(), "0 um".to_owned()], [0; 3]);
        (point[axis], normal[axis]) = (format!("{} um", 20 * side), -side);
        format!("[[planes]]\nname = \"wall_{axis}_{side}\"\npoint = {point:?}\nnormal = {normal:?}\n")
    };
    let walls: String = (0..3).flat_map(|axis| [-1, 1].map(|side| plane(axis, side))).collect();
    let text = format!(
        "title = \"A full box\"\n[run]\nuntil = \"10 s\"\nintegrator = {{ tolerance = 0.01 }}\n{walls}[cells.cell]\n\
         mesh = {{ shape = \"icosphere\", radius = \"4.6 um\", level = 2 }}\nnumber = 64\n\
         placement = {{ grid = [4, 4, 4], spacing = \"10 um\" }}\n[cells.cell.mechanics]\ndrag = \"20 pN s/um\"\n\
         shape_memory = {{ stiffness = \"1 pN/um\" }}\nvolume = {{ target = [[\"0 s\", \"390 um^3\"], [\"9 s\", \"920 um^3\"]] }}\n\
         [contact]\n"
    );
    let mut simulation = Simulation::from_text("box.toml", &text).unwrap_or_else(|error| panic!("{error}"));
    simulation.run_until(10.0).unwrap_or_else(|error| panic!("{error}"));
    simulation
}

/// The part of the surface of cells of one mesh that is nearer than `within` (µm) to another cell, by points at random places.
fn share_by_points(facets: &[[u32; 3]], cells: &[Vec<Vec3>], within: f64, points: u32) -> f64 {
    let centres: Vec<Vec3> = cells.iter().map(|cell| cell.iter().sum::<Vec3>() / cell.len() as f64).collect();
    let corners = |cell: &[Vec3], facet: &[u32; 3]| facet.map(|atom| cell[atom as usize]);
    let area = |[a, b, c]: [Vec3; 3]| 0.5 * (b - a).cross(&(c - a)).norm();
    let (mut near, mut all) = (0.0, 0.0);
    for (number, cell) in cells.iter().enumerate() {
        let others: Vec<[Vec3; 3]> = (0..cells.len())
            .filter(|other| *other != number && (centres[*other] - centres[number]).norm() < 18.0)
            .flat_map(|other| facets.iter().map(move |facet| (other, facet)))
            .map(|(other, facet)| corners(&cells[other], facet))
            .collect();
        let areas: Vec<f64> = facets.iter().map(|facet| area(corners(cell, facet))).collect();
        let whole: f64 = areas.iter().sum();
        let mut stream = Stream::new(5, Purpose::Placement, number as u32, 0);
        for _ in 0..points {
            let ([at, _], [s, t]) = (stream.uniform_pair(), stream.uniform_pair());
            let mut left = at * whole;
            let facet = areas.iter().position(|area| {
                left -= area;
                left < 0.0
            });
            let [a, b, c] = corners(cell, &facets[facet.unwrap_or(facets.len() - 1)]);
            let x = a + s.sqrt() * ((1.0 - t) * (b - a) + t * (c - a));
            let is_near = others.iter().any(|other| closest_on_facet(x, *other).offset.norm() < within);
            all += whole;
            near += if is_near { whole } else { 0.0 };
        }
    }
    near / all
}

#[test]
fn crowded_cells_touch_by_what_points_at_random_places_say() {
    let simulation = crowded();
    let mut positions = vec![[0.0; 3]; simulation.atom_count()];
    simulation.positions_into(&mut positions).unwrap_or_else(|error| panic!("{error}"));
    let kind = simulation.types().next().expect("one type");
    let cells: Vec<Vec<Vec3>> =
        positions.chunks(kind.atom_count()).map(|cell| cell.iter().map(|x| Vec3::from(*x)).collect()).collect();
    let volume: f64 = series(&simulation, "volume").iter().sum();
    assert!((volume / 40_f64.powi(3) - 0.92).abs() < 1e-9, "{volume} um^3");
    let (found, wanted) =
        (series(&simulation, "contact.area_share")[0], share_by_points(kind.facets(), &cells, 0.3, 200));
    println!("{found}, by points {wanted}");
    assert!((found / wanted - 1.0).abs() < 0.05 && wanted > 0.5, "{found}, by points {wanted}");
}
