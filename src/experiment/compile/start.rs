//! Where cells that touch each other start: apart.

use super::super::Document;
use super::Compiled;
use super::overlap::{Found, behind_obstacles, refusal, told, too_deep, within_tools};
use crate::Vec3;
use crate::contact::{Overlap, Yielding, find_overlaps_told, push_apart};
use crate::error::{Result, short};
use crate::geometry::{area, bounding_box};
use crate::sim::contact::ContactScene;
use crate::sim::{Kind, Model, State};

/// Rounds of pushing after which cells that still overlap are refused.
const ROUNDS: u32 = 200;

/// What a round moves a cell at most, over the smallest extent of a closed cell: far less than would bring a cell past
/// another, or past a sheet, unseen.
const STRIDE: f64 = 0.125;

/// What is left between cells that were pushed apart, over the proximity: they touch.
const GAP: f64 = 0.5;

/// What of the start of a run is under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Settling {
    /// Cells are looked at, whether they overlap, of which this share has been.
    Looking(f64),
    /// Cells that overlap are pushed apart.
    Pushing {
        /// The round of pushing, from 1 on.
        round: u32,
        /// Rounds after which cells that still overlap are refused.
        rounds: u32,
        /// Pairs of cells that overlap.
        pairs: usize,
    },
}

/// Cells that were pushed apart before the run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PushedApart {
    /// How many.
    pub cells: usize,
    /// How far one of them at most, µm.
    pub farthest: f64,
}

impl PushedApart {
    /// What there is to say about it, if anything.
    pub fn notice(&self) -> Option<String> {
        let whose = if self.cells == 1 { "1 cell was" } else { &format!("{} cells were", self.cells) };
        let farthest = short(self.farthest);
        (self.cells > 0).then(|| format!("{whose} pushed by up to {farthest} um so that no two overlap at the start"))
    }
}

/// Moves cells that overlap apart, as wholes, where the experiment has contacts: each by its radius at most, held ones not
/// at all, and none behind a plane. For the start of a run only: a run that goes on was good at its start.
///
/// # Errors
/// [`crate::error::Error::Input`] with the cells that cannot be parted so, and with those behind planes.
pub fn settle_start(document: &Document, compiled: &mut Compiled) -> Result<PushedApart> {
    settle_start_told(document, compiled, &|_| ())
}

/// The same, telling from time to time what is under way.
///
/// # Errors
/// As [`settle_start`].
pub fn settle_start_told(
    document: &Document,
    compiled: &mut Compiled,
    tell: &(dyn Fn(Settling) + Sync),
) -> Result<PushedApart> {
    let Compiled { model, state, .. } = compiled;
    let within = within_tools(model, state);
    refusal(document, model, "cells begin within tools, or tools within cells: ", &within, ", or move the tool")?;
    let Some(contact) = &model.contact.as_ref().map(|contact| contact.scene_of(&state.kinds)) else {
        return Ok(PushedApart::default());
    };
    let cells = model.kinds.iter().zip(&state.kinds);
    let mut positions: Vec<Vec3> =
        cells.flat_map(|(kind, now)| (0..now.cells()).flat_map(|cell| now.cell(kind, cell))).collect();
    let overlaps = find_overlaps_told(&contact.scene, &positions, &|share| tell(Settling::Looking(share)));
    refuse_what_cannot_move(document, model, state, contact, &positions, &overlaps)?;
    if overlaps.is_empty() {
        return Ok(PushedApart::default());
    }
    let resistance: Vec<f64> =
        of_cells(model, state, |kind| if kind.is_held() { f64::INFINITY } else { area(&kind.rest) });
    let gap = GAP * contact.reach.proximity;
    let yielding = Yielding { resistance: &resistance, gap, stride: stride(model), rounds: ROUNDS };
    let (moves, left) = push_apart(&contact.scene, &mut positions, &yielding, &|round, pairs| {
        tell(Settling::Pushing { round, rounds: ROUNDS, pairs });
    });
    let list =
        |overlaps: &[Overlap]| overlaps.iter().map(|overlap| told(model, state, overlap)).collect::<Vec<Found>>();
    let head = format!("cells overlap at the start, and {ROUNDS} rounds of pushing have not parted them all: ");
    let space = if model.obstacles.is_empty() { "" } else { ", or give them more space between the planes" };
    refusal(document, model, &head, &list(&left), space)?;
    let far = too_far(model, state, &moves);
    let head = "cells overlap at the start, and to part them some would have to move farther than their radius: ";
    refusal(document, model, head, &far, "")?;
    for (body, displacement) in moves.iter().enumerate() {
        let (kind, cell) = state.kind_of(body);
        state.kinds[kind].shift(&model.kinds[kind], cell, displacement);
    }
    // Pushes from both sides may leave round-off.
    let lengths = moves.iter().map(|displacement| displacement.norm()).filter(|length| *length > 1e-9 * gap);
    Ok(PushedApart { cells: lengths.clone().count(), farthest: lengths.fold(0.0, f64::max) })
}

/// Refuses cells behind planes, cells too deep in each other, and held cells that overlap.
fn refuse_what_cannot_move(
    document: &Document,
    model: &Model,
    state: &State,
    contact: &ContactScene,
    positions: &[Vec3],
    overlaps: &[Overlap],
) -> Result<()> {
    let found = |is: &dyn Fn(&Overlap) -> bool| -> Vec<Found> {
        overlaps.iter().filter(|overlap| is(overlap)).map(|overlap| told(model, state, overlap)).collect()
    };
    let behind = behind_obstacles(model, state, contact, positions);
    if !behind.is_empty() {
        let all: Vec<Found> = found(&|_| true).into_iter().chain(behind).collect();
        return refusal(
            document,
            model,
            "cells overlap or reach behind planes at the start: ",
            &all,
            ", or move the plane",
        );
    }
    let deep = found(&|overlap| too_deep(&contact.scene, positions, overlap));
    refusal(document, model, "cells overlap at the start, too deep in each other to be pushed apart: ", &deep, "")?;
    let is_held = |body: u32| model.kinds[state.kind_of(body as usize).0].is_held();
    let held = found(&|overlap| overlap.bodies.iter().all(|body| is_held(*body)));
    refusal(
        document,
        model,
        "cells overlap at the start that are held and cannot be pushed apart: ",
        &held,
        ", or hold one of them only",
    )
}

/// A number of each cell's kind for each cell.
fn of_cells(model: &Model, state: &State, number: impl Fn(&Kind) -> f64) -> Vec<f64> {
    let cells = model.kinds.iter().zip(&state.kinds);
    cells.flat_map(|(kind, now)| std::iter::repeat_n(number(kind), now.cells())).collect()
}

/// Extents of a kind at rest.
fn extents(kind: &Kind) -> Vec3 {
    bounding_box(&kind.rest.positions).map_or(Vec3::zeros(), |(low, high)| high - low)
}

/// The farthest that a cell is moved in a round.
fn stride(model: &Model) -> f64 {
    let thin = model.kinds.iter().filter(|kind| kind.closed).map(|kind| extents(kind).min());
    let edge = model.kinds.iter().map(|kind| kind.edge).fold(f64::INFINITY, f64::min);
    let thinnest = thin.fold(f64::INFINITY, f64::min);
    if thinnest.is_finite() { STRIDE * thinnest } else { edge }
}

/// Cells that would be moved farther than half of their largest extent.
fn too_far(model: &Model, state: &State, moves: &[Vec3]) -> Vec<Found> {
    let radii = of_cells(model, state, |kind| 0.5 * extents(kind).max());
    let far = moves.iter().zip(radii).enumerate().filter(|(_, (displacement, radius))| displacement.norm() > *radius);
    let words = |(body, (displacement, radius)): (usize, (&Vec3, f64))| {
        let (kind, cell) = state.kind_of(body);
        let (name, far) = (&model.kinds[kind].name, short(displacement.norm()));
        Found { kind, words: format!("cell {cell} of type `{name}` by {far} um of {} um", short(radius)) }
    };
    far.map(words).collect()
}
