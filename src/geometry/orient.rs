//! Turns facets so that all of a surface face outwards.

use super::Surface;
use super::topology::half_edges;

/// Turns facets so that neighbours face to the same side and each closed piece outwards, for surfaces whose source says
/// nothing of the order of corners. Returns how many were turned. Edges that more than two facets share join nothing, and
/// a surface that has but one side stays as torn as it is: [`check_surface`](super::check_surface) tells.
///
/// # Panics
/// When a facet names an atom that the surface does not have.
pub fn orient_outwards(surface: &mut Surface) -> usize {
    let sides = half_edges(&surface.facets);
    // Of each facet its neighbours, and whether they run along the shared edge in the same direction, which they must not.
    let mut neighbours: Vec<Vec<(u32, bool)>> = vec![Vec::new(); surface.facets.len()];
    for of_edge in sides.chunk_by(|left, right| left.edge() == right.edge()) {
        if let [left, right] = of_edge {
            let opposed = left.from == right.from;
            neighbours[left.facet as usize].push((right.facet, opposed));
            neighbours[right.facet as usize].push((left.facet, opposed));
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; surface.facets.len()];
    let mut count = 0;
    for first in 0..surface.facets.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut piece = vec![first as u32];
        let mut next = 0;
        while next < piece.len() {
            let facet = piece[next] as usize;
            let own = turned[facet] == Some(true);
            for &(neighbour, opposed) in &neighbours[facet] {
                let state = &mut turned[neighbour as usize];
                if state.is_none() {
                    *state = Some(own != opposed);
                    piece.push(neighbour);
                }
            }
            next += 1;
        }
        let is_turned = |facet: &&u32| turned[**facet as usize] == Some(true);
        count += piece.iter().filter(is_turned).count();
        for facet in piece.iter().filter(is_turned) {
            surface.facets[*facet as usize].swap(1, 2);
        }
        let closed = piece.iter().all(|facet| neighbours[*facet as usize].len() == 3);
        // From one of its atoms, so that far from the origin no digits are lost.
        let origin = surface.positions[surface.facets[first][0] as usize];
        let parts = piece.iter().map(|facet| {
            let [a, b, c] = surface.corners(surface.facets[*facet as usize]).map(|corner| corner - origin);
            a.cross(&b).dot(&c)
        });
        if closed && parts.sum::<f64>() < 0.0 {
            count += piece.len();
            piece.iter().for_each(|facet| surface.facets[*facet as usize].swap(1, 2));
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{SurfaceRules, check_surface, icosphere, sheet};

    #[test]
    fn a_closed_surface_whose_facets_face_anywhere_is_turned_outwards() {
        let sphere = icosphere(1.0, 1);
        let mut mixed = sphere.clone();
        mixed.facets.iter_mut().enumerate().filter(|(i, _)| i % 3 == 0 || *i > 40).for_each(|(_, f)| f.swap(1, 2));
        assert!(check_surface(&mixed, &SurfaceRules::CELL).is_err());
        assert!(orient_outwards(&mut mixed) > 0);
        assert_eq!(check_surface(&mixed, &SurfaceRules::CELL), Ok(()));
        let mut good = sphere.clone();
        assert_eq!(orient_outwards(&mut good), 0);
        assert_eq!(good, sphere);
    }

    #[test]
    fn facets_of_an_open_surface_face_to_the_side_of_the_first() {
        let plain = sheet(1.0, 1.0, 3, 3);
        let mut mixed = plain.clone();
        mixed.facets.iter_mut().skip(1).step_by(2).for_each(|facet| facet.swap(1, 2));
        orient_outwards(&mut mixed);
        assert_eq!(check_surface(&mixed, &SurfaceRules::SHEET), Ok(()));
    }
}
