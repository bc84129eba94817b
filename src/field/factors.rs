//! The factors of the solves along one axis: computed once for a step size and kept.
//!
//! Along one axis a step multiplies by R(z) = 1 / (1 − z + z²/2), eq. (field.3), with z the step times the discrete
//! second derivative. R = 1 + z Y(z), where Y comes from one tridiagonal system with the complex shift p = 1 + i:
//! Y = Re X − Im X with (p − z) X = 1, eq. (field.4). The limiter needs the same with p = 1, which is backward Euler.

use super::grid::Wall;

/// A complex number, real part first.
type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// r / b.
fn over(r: f64, b: Complex) -> Complex {
    let squared = b[0] * b[0] + b[1] * b[1];
    [r * b[0] / squared, -r * b[1] / squared]
}

/// What closes a line of boxes into a ring, by the formula of Sherman and Morrison.
#[derive(Debug, Clone, Default)]
pub struct Ring {
    /// What is added to Y in each box for the real and the imaginary part of the closing number.
    pub share: Vec<[f64; 2]>,
    /// The closing number for each unit of X in the first and last box.
    pub close: Complex,
    /// The same two of backward Euler.
    pub real_share: Vec<f64>,
    /// See `real_share`.
    pub real_close: f64,
}

/// The solves along one axis, for one species and one step size.
#[derive(Debug, Clone)]
pub struct Line {
    /// Step × diffusion coefficient / spacing²; 0 leaves the line as it is.
    pub ratio: f64,
    /// Elimination factors of the complex system, one a box.
    pub complex: Vec<Complex>,
    /// Elimination factors of backward Euler, one a box.
    pub real: Vec<f64>,
    /// The flow through the low and the high wall, for each unit of Y in the box at the wall: 0 or 2.
    pub walls: [f64; 2],
    /// Present where the axis is periodic.
    pub ring: Option<Ring>,
}

impl Line {
    /// Empty factors of an axis of `n` boxes between these walls.
    pub fn new(n: usize, walls: [Wall; 2]) -> Self {
        let ring = (walls[0] == Wall::Periodic).then(|| Ring {
            share: vec![[0.0; 2]; n],
            real_share: vec![0.0; n],
            ..Default::default()
        });
        // A wall that is held lies half a box from the centre: the difference to it counts twice.
        let walls = walls.map(|wall| if matches!(wall, Wall::Fixed(_)) { 2.0 } else { 0.0 });
        Self { ratio: 0.0, complex: vec![[0.0; 2]; n], real: vec![0.0; n], walls, ring }
    }

    /// Fills in the factors for a ratio, without allocating.
    pub fn fill(&mut self, ratio: f64) {
        self.ratio = ratio;
        let n = self.complex.len();
        if ratio == 0.0 || n == 1 {
            self.ratio = 0.0;
            return;
        }
        let (mut before, mut before_real) = ([0.0; 2], 0.0);
        for i in 0..n {
            let at_wall = |end: usize| if self.ring.is_some() { 2.0 } else { self.walls[end] };
            let low = if i == 0 { at_wall(0) } else { 1.0 };
            let high = if i + 1 == n { at_wall(1) } else { 1.0 };
            let here = ratio * (low + high);
            before = over(ratio, [1.0 + here - ratio * before[0], 1.0 - ratio * before[1]]);
            before_real = ratio / (1.0 + here - ratio * before_real);
            self.complex[i] = before;
            self.real[i] = before_real;
        }
        if let Some(ring) = &mut self.ring {
            close(ring, &self.complex, &self.real);
        }
    }
}

/// A ring is a line whose ends are held at zero, but for the product −r s sᵀ with s one in the first and last box.
fn close(ring: &mut Ring, complex: &[Complex], real: &[f64]) {
    let n = complex.len();
    let end = |i: usize| if i == 0 || i + 1 == n { 1.0 } else { 0.0 };
    let (mut g, mut g_real) = ([0.0; 2], 0.0);
    for i in 0..n {
        g = times([g[0] + end(i), g[1]], complex[i]);
        g_real = (g_real + end(i)) * real[i];
        ring.share[i] = g;
        ring.real_share[i] = g_real;
    }
    for i in (0..n - 1).rev() {
        let next = times(complex[i], ring.share[i + 1]);
        ring.share[i] = [ring.share[i][0] + next[0], ring.share[i][1] + next[1]];
        ring.real_share[i] += real[i] * ring.real_share[i + 1];
    }
    let both = [ring.share[0][0] + ring.share[n - 1][0], ring.share[0][1] + ring.share[n - 1][1]];
    ring.close = over(1.0, [1.0 - both[0], -both[1]]);
    ring.real_close = 1.0 / (1.0 - (ring.real_share[0] + ring.real_share[n - 1]));
    for share in &mut ring.share {
        // Re(q d) − Im(q d) for the closing number d, as factors of Re d and Im d.
        *share = [share[0] - share[1], -(share[0] + share[1])];
    }
}
