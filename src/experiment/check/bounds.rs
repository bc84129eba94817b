//! Ranges of numbers and quantities.

use super::{Walk, with_purpose};
use crate::error::Fault;
use crate::experiment::tree::Node;
use crate::units::{self, Dimension};
use serde_json::{Map, Value as Json};

/// The longest that a length is in any direction where the schema says nothing else, µm: a kilometre. Squares and cubes of what is longer, and
/// the boxes of four bytes a number in which contacts are looked for, would be no numbers any more.
const LONGEST: f64 = 1e9;

impl Walk<'_> {
    /// A plain number against `minimum`, `exclusiveMinimum`, `maximum`.
    pub(super) fn number_bounds(&mut self, node: &Node, value: f64, schema: &Map<String, Json>, path: &str) {
        let [above, least, most] = numbers(schema, ["exclusiveMinimum", "minimum", "maximum"]);
        let is_narrow = schema.get("format").is_some_and(|format| format == "uint32");
        let most = most.or(is_narrow.then_some(u32::MAX.into()));
        self.bounds(node, value, [above, least, most], |bound| format!("{bound}"), schema, path);
    }

    /// A quantity (in base units) against `x-minimum`, `x-exclusive-minimum`, `x-maximum`.
    pub(super) fn quantity_bounds(
        &mut self,
        node: &Node,
        value: f64,
        dimension: Dimension,
        schema: &Map<String, Json>,
        path: &str,
    ) {
        let [above, least, most] = numbers(schema, ["x-exclusive-minimum", "x-minimum", "x-maximum"]);
        let longest = (dimension == Dimension::LENGTH).then_some(LONGEST);
        let bounds = [above, least.or(longest.map(|longest| -longest)), most.or(longest)];
        let shown = |bound: f64| if bound == 0.0 { "0".to_owned() } else { units::pretty(bound, dimension) };
        self.bounds(node, value, bounds, shown, schema, path);
    }

    fn bounds(
        &mut self,
        node: &Node,
        value: f64,
        [above, least, most]: [Option<f64>; 3],
        shown: impl Fn(f64) -> String,
        schema: &Map<String, Json>,
        path: &str,
    ) {
        let demand = if !value.is_finite() {
            Some("must be finite".to_owned())
        } else if let Some(bound) = above.filter(|bound| value <= *bound) {
            Some(format!("must be more than {}", shown(bound)))
        } else if let Some(bound) = least.filter(|bound| value < *bound) {
            Some(format!("must be at least {}", shown(bound)))
        } else {
            most.filter(|bound| value > *bound).map(|bound| format!("must be at most {}", shown(bound)))
        };
        if let Some(demand) = demand {
            let found = node.written().trim_matches(['"', '\'']);
            let fault = Fault::new(format!("`{path}` is {found} and {demand}")).at(node.location(demand));
            self.faults.push(with_purpose(fault, schema));
        }
    }
}

/// Numbers of a schema.
fn numbers(schema: &Map<String, Json>, keys: [&str; 3]) -> [Option<f64>; 3] {
    keys.map(|key| schema.get(key).and_then(Json::as_f64))
}
