//! How forces of contacts move cells over a step: as the implicit step itself would, eq. (adhesion.16).
//!
//! A force on a few atoms of a stiff cell moves the whole cell and hardly dents it. The sweeps know that by the softest modes of the
//! mesh, by the rotation of the cell, and by what is left, for which each atom stands alone.

use nalgebra::Matrix3;

use super::change::Change;
use super::columns::Columns;
use super::rows::{Pairing, Row};
use super::turns::Turns;
use super::vectors::{V4, map};
use crate::Vec3;
use crate::mechanics::integrator::Order;
use crate::mechanics::modes::{MODES, Modes, OfModes};

/// How a kind gives way over a step.
#[derive(Debug, Clone)]
pub struct Response {
    /// Displacement over force of each mode less that of what is left, µm/pN.
    pub modes: OfModes,
    /// The same of what is left, µm/pN.
    pub rest: f64,
    /// The same of free atoms: dt/ζ, µm/pN.
    pub free: f64,
}

impl Response {
    /// That of atoms that move alone.
    pub fn alone(mobility: f64) -> Self {
        Self { modes: OfModes::default(), rest: mobility, free: mobility }
    }

    /// That of the implicit step, eq. (adhesion.16), where K is raised by a factor and taken γ times.
    pub fn new(modes: &Modes, raised: f64, (order, gamma): (Order, f64), dt: f64, drag: f64) -> Self {
        let free = dt / drag;
        let of = |stiffness: f64| {
            let step = 1.0 / (1.0 / free + gamma * raised * stiffness);
            match order {
                Order::First => step,
                Order::Second => step * (2.0 - (0.5 * raised * stiffness + 1.0 / free) * step),
            }
        };
        let rest = modes.rest.map_or(0.0, of);
        Self { modes: modes.stiffness.map(|stiffness| of(stiffness) - rest), rest, free }
    }
}

/// How a cell gives way.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    /// Its kind.
    kind: u32,
    first_atom: u32,
    /// Where its shapes begin.
    first_shape: u32,
    centre: Vec3,
    /// Rotation over torque, 1/(pN·µm).
    turning: Matrix3<f64>,
}

/// What the modes of a cell have moved.
#[derive(Debug, Clone, Copy, Default)]
pub struct Motion {
    /// The displacement of each mode, µm.
    pub along: [V4; MODES],
    /// Rotation.
    pub turn: V4,
}

/// What a contact needs beside its row.
#[derive(Debug, Clone, Copy)]
pub struct Lever {
    /// The cells of both sides.
    pub bodies: [u32; 2],
    /// Where the shapes of its atoms are.
    shapes: [u32; 4],
    /// Of both sides what their forces turn: the sum of weights times positions from the centre, µm.
    pub arms: [[f32; 3]; 2],
}

/// How all cells give way over a step, and what they have moved.
#[derive(Debug, Clone, Default)]
pub struct Mobility {
    /// Whether cells move by their modes; else atoms move alone.
    pub has_modes: bool,
    /// Of all kinds the shapes of their atoms.
    pub shapes: Vec<OfModes>,
    /// Of each kind where its shapes begin, and how it gives way.
    pub kinds: Vec<(u32, OfModes)>,
    pub bodies: Vec<Body>,
    pub levers: Vec<Lever>,
    /// Cells that move by columns of their own stiffness.
    pub columns: Columns,
    /// The order in which rows are swept.
    pub turns: Turns,
    /// Whether rows were put in that order for the sweeps alone.
    pub is_arranged: bool,
    /// What each job of a sweep changed.
    pub changes: Vec<Change>,
    /// One behind the last deep row of each job.
    pub deep_ends: Vec<usize>,
    pub moved: Vec<Motion>,
    pub before: Vec<Motion>,
    pub direction: Vec<Motion>,
}

impl Mobility {
    /// Begins a projection in which atoms move alone.
    pub fn clear(&mut self, has_modes: bool) {
        self.has_modes = has_modes;
        self.shapes.clear();
        self.kinds.clear();
        self.bodies.clear();
        self.levers.clear();
    }

    /// Adds a kind; its cells follow. Where K does not tell its shapes its atoms move alone.
    pub fn add_kind(&mut self, modes: Option<&Modes>, response: &Response, atoms: usize) {
        let first = self.shapes.len() as u32;
        match modes {
            Some(modes) => {
                self.shapes.extend_from_slice(&modes.shapes);
                self.kinds.push((first, response.modes));
            }
            None => {
                self.shapes.extend(std::iter::repeat_n(OfModes::default(), atoms));
                self.kinds.push((first, OfModes::default()));
            }
        }
    }

    /// Adds a cell of the kind added last; one that is held does not turn.
    pub fn add_cell(
        &mut self,
        first_atom: usize,
        response: &Response,
        is_held: bool,
        x: impl Iterator<Item = Vec3> + Clone,
    ) {
        let kind = self.kinds.len() - 1;
        let (first_shape, modes) = &self.kinds[kind];
        let mut body = Body {
            kind: kind as u32,
            first_atom: first_atom as u32,
            first_shape: *first_shape,
            centre: Vec3::zeros(),
            turning: Matrix3::zeros(),
        };
        if !is_held {
            let count = x.clone().count() as f64;
            body.centre = x.clone().sum::<Vec3>() / count;
            body.turning = turning(body.centre, x, &self.shapes[*first_shape as usize..], modes, response);
        }
        self.bodies.push(body);
    }

    /// Begins with nothing moved.
    pub fn begin(&mut self) {
        for list in [&mut self.moved, &mut self.before, &mut self.direction] {
            list.clear();
            list.resize(self.bodies.len(), Motion::default());
        }
    }

    /// The lever of a row, and its compliance along the normal and at most across it, µm/pN, beside that of atoms alone.
    pub fn lever(&self, row: &Row, bodies: [u32; 2], positions: &[Vec3]) -> (Lever, [f64; 2]) {
        let owner = |corner: usize| match row.pairing {
            Pairing::AtomOnFacet => bodies[usize::from(corner > 0)],
            Pairing::Edges => bodies[corner / 2],
            Pairing::AtomOnObstacle | Pairing::Rigid => bodies[0],
        };
        let shape = |corner: usize| {
            let body = &self.bodies[owner(corner) as usize];
            body.first_shape + row.atoms[corner] - body.first_atom
        };
        let weights = row.weights();
        let mut arms = [Vec3::zeros(); 2];
        for corner in 0..4 {
            let side = usize::from(match row.pairing {
                Pairing::AtomOnFacet => corner > 0,
                Pairing::Edges => corner > 1,
                Pairing::AtomOnObstacle | Pairing::Rigid => false,
            });
            let centre = self.bodies[owner(corner) as usize].centre;
            arms[side] += weights[corner] * (positions[row.atoms[corner] as usize] - centre);
        }
        let lever = Lever {
            bodies,
            shapes: [shape(0), shape(1), shape(2), shape(3)],
            arms: arms.map(|arm| [arm.x as f32, arm.y as f32, arm.z as f32]),
        };
        let [one, other] = sides(&self.shapes, &lever, row, weights);
        let normal = row.normal();
        let [a, b] = bodies.map(|body| &self.bodies[body as usize]);
        let (ra, rb) = (&self.kinds[a.kind as usize].1, &self.kinds[b.kind as usize].1);
        let alone: f64 = (0..MODES).map(|k| ra[k] * one[k] * one[k] + rb[k] * other[k] * other[k]).sum();
        let turned = |body: &Body, arm: Vec3, along: &Vec3| {
            let torque = arm.cross(along);
            torque.dot(&(body.turning * torque))
        };
        let (mut along, mut across) = (alone, alone);
        if bodies[0] == bodies[1] {
            along += (0..MODES).map(|k| 2.0 * ra[k] * one[k] * other[k]).sum::<f64>().max(-alone);
            along += turned(a, arms[0] + arms[1], &normal);
            across = along.max(alone) + a.turning.norm() * (arms[0] + arms[1]).norm_squared();
        } else {
            along += turned(a, arms[0], &normal) + turned(b, arms[1], &normal);
            across += a.turning.norm() * arms[0].norm_squared() + b.turning.norm() * arms[1].norm_squared();
        }
        (lever, [along, across])
    }

    /// What the modes and the rotation of a body move an atom of it, µm.
    pub fn of_atom(&self, body: usize, atom: usize, position: Vec3) -> Vec3 {
        let (b, motion) = (&self.bodies[body], &self.moved[body]);
        let shape = &self.shapes[b.first_shape as usize + atom];
        let [along_x, along_y, along_z, _] = moved(shape, &motion.along);
        let [x, y, z, _] = motion.turn;
        Vec3::new(along_x, along_y, along_z) + Vec3::new(x, y, z).cross(&(position - b.centre))
    }

    /// The response of the modes of a body.
    pub fn response(&self, body: usize) -> &OfModes {
        &self.kinds[self.bodies[body].kind as usize].1
    }

    /// What the modes make of vectors on all atoms of a body.
    pub fn project(&self, body: usize, vectors: &[[f64; 3]]) -> [V4; MODES] {
        let mut found = [[0.0; 4]; MODES];
        let first = self.bodies[body].first_shape as usize;
        for (shape, [x, y, z]) in self.shapes[first..].iter().zip(vectors) {
            let vector = [*x, *y, *z, 0.0];
            for k in 0..MODES {
                found[k] = map(|i| found[k][i] + shape[k] * vector[i]);
            }
        }
        found
    }
}

/// Rotation over torque so that the whole turns as free drag lets it, whatever the modes turn already.
fn turning(
    centre: Vec3,
    x: impl Iterator<Item = Vec3>,
    shapes: &[OfModes],
    modes: &OfModes,
    response: &Response,
) -> Matrix3<f64> {
    let mut inertia = Matrix3::zeros();
    let mut moments = [Vec3::zeros(); MODES];
    for (x, shape) in x.zip(shapes) {
        let r = x - centre;
        inertia += Matrix3::identity() * r.norm_squared() - r * r.transpose();
        for k in 0..MODES {
            moments[k] += shape[k] * r;
        }
    }
    let Some(inverse) = inertia.try_inverse() else { return Matrix3::zeros() };
    let mut turned = response.rest * inertia;
    for (moment, response) in moments.iter().zip(modes) {
        turned += *response * (Matrix3::identity() * moment.norm_squared() - moment * moment.transpose());
    }
    response.free * inverse - inverse * turned * inverse
}

/// The parts of both sides of a row in the modes of their cells.
#[inline(always)]
pub fn sides(shapes: &[OfModes], lever: &Lever, row: &Row, [p, q, r, s]: [f64; 4]) -> [OfModes; 2] {
    let [a, b, c, d] = lever.shapes.map(|at| &shapes[at as usize]);
    let (mut one, mut other) = (OfModes::default(), OfModes::default());
    match row.pairing {
        Pairing::AtomOnFacet => {
            for k in 0..MODES {
                one[k] = p * a[k];
                other[k] = (q * b[k] + r * c[k]) + s * d[k];
            }
        }
        Pairing::Edges => {
            for k in 0..MODES {
                one[k] = p * a[k] + q * b[k];
                other[k] = r * c[k] + s * d[k];
            }
        }
        Pairing::AtomOnObstacle => one = a.map(|a| p * a),
        Pairing::Rigid => {}
    }
    [one, other]
}

/// Displacement of something with these parts in the modes, µm, summed in a fixed order.
#[inline(always)]
fn moved(parts: &OfModes, along: &[V4; MODES]) -> V4 {
    let mut sums = [[0.0; 4]; 4];
    for k in 0..MODES {
        sums[k % 4] = map(|i| sums[k % 4][i] + parts[k] * along[k][i]);
    }
    map(|i| (sums[0][i] + sums[1][i]) + (sums[2][i] + sums[3][i]))
}

/// What a force on one side of a contact moves.
#[inline(always)]
pub fn push_body(mobility_of: (&Body, &OfModes), motion: &mut Motion, side: &OfModes, arm: &[f32; 3], force: &V4) {
    let (body, response) = mobility_of;
    for k in 0..MODES {
        let share = response[k] * side[k];
        motion.along[k] = map(|i| motion.along[k][i] + share * force[i]);
    }
    let arm = arm.map(f64::from);
    let torque = cross(&arm, &[force[0], force[1], force[2]]);
    let h = &body.turning;
    for axis in 0..3 {
        motion.turn[axis] += (h[(axis, 0)] * torque[0] + h[(axis, 1)] * torque[1]) + h[(axis, 2)] * torque[2];
    }
}

#[inline(always)]
fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// How far the motions of two bodies take the sides of a contact apart, µm.
#[inline(always)]
pub fn moved_apart(motions: [&Motion; 2], sides: &[OfModes; 2], arms: &[[f32; 3]; 2]) -> V4 {
    let one_side = |motion: &Motion, side: &OfModes, arm: &[f32; 3]| {
        let [x, y, z, _] = motion.turn;
        let (along, turned) = (moved(side, &motion.along), cross(&[x, y, z], &arm.map(f64::from)));
        [along[0] + turned[0], along[1] + turned[1], along[2] + turned[2], 0.0]
    };
    let one = one_side(motions[0], &sides[0], &arms[0]);
    let other = one_side(motions[1], &sides[1], &arms[1]);
    map(|i| one[i] + other[i])
}

impl Body {
    /// Its kind.
    #[inline(always)]
    pub fn kind(&self) -> usize {
        self.kind as usize
    }
}
