//! Documents of fields on their grids: they start and advance in their own units, the splitting agrees with the method
//! of lines to second order, and known fronts and patterns come out.

use std::sync::Arc;

use pseudopod::chemistry::eml;
use pseudopod::chemistry::field::{FieldSystem, Fields, Grid, Placing, Stepping};
use pseudopod::error::{Error, Fault, Result, Source};

const ADAPTIVE: Stepping = Stepping::Adaptive { relative: 1e-3, absolute: 1e-6 };

fn read(text: &str) -> eml::Document {
    eml::read(Arc::new(Source { name: "test.eml".into(), text: text.into() })).expect("a good document")
}

fn from_file(name: &str) -> eml::Document {
    let path = format!("{}/eml/{name}.eml", env!("CARGO_MANIFEST_DIR"));
    read(&std::fs::read_to_string(path).expect("a document of eml/"))
}

fn no_file(_: &eml::Profile, _: &Grid) -> Result<Vec<f64>> {
    Err(Error::input(Fault::new("no file was expected")))
}

fn placed(document: &eml::Document, placing: Option<&Placing>) -> (FieldSystem, Fields) {
    let system = FieldSystem::new(document, placing).expect("a good document");
    let fields = system.start(&no_file).expect("good profiles");
    (system, fields)
}

fn open(text: &str) -> (FieldSystem, Fields) {
    placed(&read(text), None)
}

/// Largest difference over all species and boxes.
fn apart(a: &Fields, b: &Fields) -> f64 {
    let species = 0..a.species().len();
    let pairs = species.flat_map(|s| a.values(s).iter().zip(b.values(s)));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn all_documents_of_fields_start_and_advance() {
    let placing = Placing { origin: [-50.0, -50.0, 2.0], size: [102.0, 100.0, 0.0] };
    for (name, boxes) in [("attractant", 21 * 20), ("brusselator", 128 * 128), ("gray_scott", 256 * 256)] {
        let (system, mut fields) = placed(&from_file(name), Some(&placing));
        assert_eq!((system.grid().len(), system.name()), (boxes, name));
        let report = system.advance(&mut fields, 1.0, &[], ADAPTIVE).expect("a window");
        assert!(report.error <= 1.0 && fields.time() == 1.0, "{name} {report:?}");
        println!("{name}: {report:?}");
    }
}
