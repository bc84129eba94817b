//! Series of the scene about contacts: those that a run records, and those that follow from who touches whom.

/// A series about contacts that a run records.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactSeries {
    /// Sweeps of the last step over contacts.
    Sweeps,
    /// The deepest penetration over the smallest mean edge; 0 when nothing is inside anything.
    Deepest,
    /// Contacts: atoms on facets, edges on edges and atoms on planes together.
    Count,
    /// Aggregates; a cell alone is one.
    Aggregates,
    /// Cells of the largest aggregate.
    LargestAggregate,
    /// Energy of what contacts that hold have yielded.
    Energy,
    /// Bonds of surfaces that are closed.
    Bonds,
    /// Links between facets.
    Links,
    /// Virtual adhesives.
    Adhesives,
    /// Atoms of the largest virtual adhesive.
    LargestAdhesive,
}

/// In which runs with contacts a series is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Recorded {
    /// In all.
    Always,
    /// With bonds that close and open.
    WithBonds,
    /// With links.
    WithLinks,
    /// With virtual adhesives.
    WithAdhesives,
}

/// A row of [`CONTACTS`].
#[derive(Debug, Clone, Copy)]
pub struct ContactQuantity {
    /// The series.
    pub series: ContactSeries,
    /// Its name; the dataset is `/scene/NAME`.
    pub name: &'static str,
    /// Unit; `1` for pure numbers.
    pub unit: &'static str,
    /// What a chart calls it.
    pub label: &'static str,
    /// When it is recorded.
    pub recorded: Recorded,
}

const fn row(
    series: ContactSeries,
    name: &'static str,
    unit: &'static str,
    label: &'static str,
    recorded: Recorded,
) -> ContactQuantity {
    ContactQuantity { series, name, unit, label, recorded }
}

use Recorded::{Always, WithAdhesives, WithBonds, WithLinks};

/// All recorded series about contacts, in the order of the result file.
#[rustfmt::skip]
pub const CONTACTS: &[ContactQuantity] = &[
    row(ContactSeries::Sweeps, "contact.sweeps", "1", "sweeps over contacts", Always),
    row(ContactSeries::Deepest, "contact.deepest", "1", "deepest penetration over edge", Always),
    row(ContactSeries::Count, "contact.count", "1", "contacts", Always),
    row(ContactSeries::Aggregates, "aggregates", "1", "aggregates", Always),
    row(ContactSeries::LargestAggregate, "largest_aggregate", "1", "cells of the largest aggregate", Always),
    row(ContactSeries::Energy, "contact.energy", "pN um", "energy in contacts", Always),
    row(ContactSeries::Bonds, "contact.bonds", "1", "closed bonds", WithBonds),
    row(ContactSeries::Links, "contact.links", "1", "contact.links", WithLinks),
    row(ContactSeries::Adhesives, "contact.adhesives", "1", "contact.adhesives", WithAdhesives),
    row(ContactSeries::LargestAdhesive, "contact.largest_adhesive", "1", "contact.largest_adhesive", WithAdhesives),
];

/// The rows of [`CONTACTS`] for a run whose contacts record `own` besides what all do.
pub fn contact_quantities(own: Recorded) -> impl Iterator<Item = &'static ContactQuantity> {
    CONTACTS.iter().filter(move |row| row.recorded == Always || row.recorded == own)
}

/// A series that follows from who touches whom; types and planes by their numbers, of two types the smaller first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// Area between cells of two types.
    Area([usize; 2]),
    /// Area between cells of a type and a plane.
    AreaOnPlane(usize, usize),
    /// Pairs of cells of two types that touch.
    Pairs([usize; 2]),
    /// Part of the surface of all cells that touches another cell.
    AreaShare,
    /// Part of that area between types.
    HeterotypicShare,
    /// The segregation index.
    Segregation,
    /// Clusters of cells of a type.
    Clusters(usize),
    /// Cells of the largest cluster of a type.
    LargestCluster(usize),
    /// Aggregates that were born since the frame before.
    Births,
    /// Aggregates that merged.
    Merges,
    /// Aggregates that split.
    Splits,
    /// Aggregates that died.
    Deaths,
}

impl Touch {
    /// All series for so many types of cells and planes.
    pub fn all(types: usize, planes: usize) -> Vec<Self> {
        let pairs = || (0..types).flat_map(move |one| (one..types).map(move |other| [one, other]));
        let on_planes = (0..types).flat_map(|kind| (0..planes).map(move |plane| Self::AreaOnPlane(kind, plane)));
        let mut all: Vec<Self> = pairs().map(Self::Area).chain(on_planes).collect();
        all.extend(pairs().map(Self::Pairs));
        all.extend([Self::AreaShare, Self::HeterotypicShare, Self::Segregation]);
        all.extend((0..types).map(Self::Clusters).chain((0..types).map(Self::LargestCluster)));
        all.extend([Self::Births, Self::Merges, Self::Splits, Self::Deaths]);
        all
    }

    /// What the name begins with, the unit, and what a chart calls it; the names of types and planes follow.
    fn words(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Area(_) | Self::AreaOnPlane(..) => ("contact.area", "um^2", "area of contact"),
            Self::Pairs(_) => ("contact.pairs", "1", "pairs in contact"),
            Self::AreaShare => ("contact.area_share", "1", "share of surface in contact"),
            Self::HeterotypicShare => ("contact.heterotypic_share", "1", "heterotypic share of contact area"),
            Self::Segregation => ("contact.segregation", "1", "segregation index"),
            Self::Clusters(_) => ("contact.clusters", "1", "clusters of"),
            Self::LargestCluster(_) => ("contact.largest_cluster", "1", "cells of the largest cluster of"),
            Self::Births => ("contact.births", "1", "births of aggregates"),
            Self::Merges => ("contact.merges", "1", "merges of aggregates"),
            Self::Splits => ("contact.splits", "1", "splits of aggregates"),
            Self::Deaths => ("contact.deaths", "1", "deaths of aggregates"),
        }
    }

    /// The names of types and planes that it is about.
    fn about<'a>(self, types: &[&'a str], planes: &[&'a str]) -> Vec<&'a str> {
        match self {
            Self::Area([one, other]) | Self::Pairs([one, other]) => vec![types[one], types[other]],
            Self::AreaOnPlane(kind, plane) => vec![types[kind], planes[plane]],
            Self::Clusters(kind) | Self::LargestCluster(kind) => vec![types[kind]],
            _ => Vec::new(),
        }
    }

    /// Its name: `contact.area.red.white`.
    ///
    /// # Panics
    /// If there is no such type or plane.
    pub fn name(self, types: &[&str], planes: &[&str]) -> String {
        [&[self.words().0], self.about(types, planes).as_slice()].concat().join(".")
    }

    /// Its unit; `1` for pure numbers.
    pub fn unit(self) -> &'static str {
        self.words().1
    }

    /// What a chart calls it.
    ///
    /// # Panics
    /// As [`Touch::name`].
    pub fn label(self, types: &[&str], planes: &[&str]) -> String {
        match self.about(types, planes).as_slice() {
            [] => self.words().2.to_owned(),
            about => format!("{} {}", self.words().2, about.join("–")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_by_types_are_named_in_the_order_of_the_document() {
        let (types, planes) = (["red", "white"], ["floor"]);
        let all = Touch::all(2, 1);
        let names: Vec<String> = all.iter().map(|series| series.name(&types, &planes)).collect();
        let first = ["contact.area.red.red", "contact.area.red.white", "contact.area.white.white"];
        assert_eq!(names[..3], first);
        assert_eq!(names[3..5], ["contact.area.red.floor", "contact.area.white.floor"]);
        assert_eq!(names.last().map(String::as_str), Some("contact.deaths"));
        assert_eq!(names.len(), 19);
        assert_eq!(all[1].label(&types, &planes), "area of contact red–white");
        assert_eq!(Touch::Clusters(1).label(&types, &planes), "clusters of white");
    }

    #[test]
    fn a_model_of_contacts_records_its_own_series_after_those_of_all() {
        let names = |own| contact_quantities(own).map(|row| row.name).collect::<Vec<_>>();
        assert_eq!(names(Recorded::Always).len(), 6);
        assert_eq!(names(Recorded::WithBonds)[6..], ["contact.bonds"]);
        assert_eq!(names(Recorded::WithLinks)[6..], ["contact.links"]);
        assert_eq!(names(Recorded::WithAdhesives)[6..], ["contact.adhesives", "contact.largest_adhesive"]);
    }
}
