//! How a tetrahedron deforms in its principal directions, and the positive part of the stiffness of an energy there.
//!
//! In the frame of its principal stretches the second derivatives of an isotropic energy by the deformation gradient fall apart into a 3 × 3
//! block of the stretches and, for each pair of directions, a twist and a flip; each of which may be kept where it is positive alone, eq. (solids.7). After Smith,
//! de Goes & Kim 2019; for surfaces see `tangent/facet.rs`.

use super::super::lanes::{Real, V3};
use super::super::tangent::matrix::Block;

/// Rounds of Jacobi's method for a matrix of 3 × 3, each of three turns: the last makes nothing but round-off.
const ROUNDS: usize = 5;

/// A symmetric matrix of 3 × 3: the diagonal, and the entries (1, 2), (2, 0), (0, 1) across from it.
pub type Symmetric<T> = [[T; 3]; 2];

/// Eigenvalues, and the components of the eigenvectors: `vectors[k]` is that of the value k. Both in falling order if `sorted`. (Closures
/// are not compiled for wide registers: none here.)
#[inline(always)]
pub fn eigen<T: Real>(token: T::Token, [mut diagonal, mut across]: Symmetric<T>, sorted: bool) -> ([T; 3], [V3<T>; 3]) {
    let (zero, one) = (T::constant(token, 0.0), T::constant(token, 1.0));
    let mut vectors =
        [V3 { x: one, y: zero, z: zero }, V3 { x: zero, y: one, z: zero }, V3 { x: zero, y: zero, z: one }];
    for _ in 0..ROUNDS {
        for k in 0..3 {
            let (p, q) = ((k + 1) % 3, (k + 2) % 3);
            // The turn that takes the entry (p, q) to nothing, by at most an eighth of a whole one.
            let h = across[k];
            let d = (diagonal[q] - diagonal[p]) * 0.5;
            let side = sign(d);
            let t = h / (d + side * ((d * d + h * h).sqrt() + 1e-300));
            let cosine = one / (t * t + 1.0).sqrt();
            let sine = t * cosine;
            diagonal[p] -= t * h;
            diagonal[q] += t * h;
            across[k] = zero;
            let (of_p, of_q) = (across[q], across[p]);
            across[q] = cosine * of_p - sine * of_q;
            across[p] = sine * of_p + cosine * of_q;
            let (v, w) = (vectors[p], vectors[q]);
            vectors[p] = v.times(cosine) - w.times(sine);
            vectors[q] = v.times(sine) + w.times(cosine);
        }
    }
    if sorted {
        for [p, q] in [[0, 1], [1, 2], [0, 1]] {
            // One where they stand right, nothing where they are to be swapped.
            let stay = (sign(diagonal[p] - diagonal[q]) + 1.0) * 0.5;
            let swap = one - stay;
            let (a, b, v, w) = (diagonal[p], diagonal[q], vectors[p], vectors[q]);
            diagonal[p] = a * stay + b * swap;
            diagonal[q] = b * stay + a * swap;
            vectors[p] = v.times(stay) + w.times(swap);
            vectors[q] = w.times(stay) + v.times(swap);
        }
    }
    (diagonal, vectors)
}

/// 1 or −1, of nothing 1.
#[inline(always)]
fn sign<T: Real>(value: T) -> T {
    let side = value + 1e-300;
    side / side.max(-side)
}

/// A deformation gradient in its principal directions, F = Σ s_k n_k ⊗ N_k.
pub struct Principal<T> {
    /// The stretches s, falling; the last is negative where the body is turned inside out.
    pub stretches: [T; 3],
    /// Their directions n in space.
    pub directions: [V3<T>; 3],
    /// Their directions N at rest.
    pub at_rest: [V3<T>; 3],
}

impl<T: Real> Principal<T> {
    /// Of a deformation gradient by its columns.
    #[inline(always)]
    pub fn of(token: T::Token, [f, g, h]: [V3<T>; 3]) -> Self {
        let tiny = T::constant(token, 1e-150);
        let squares = [[f.squared(), g.squared(), h.squared()], [g.dot(h), h.dot(f), f.dot(g)]];
        let (_, at_rest) = eigen(token, squares, true);
        let (a, b) = (at_rest[0], at_rest[1]);
        let c = a.cross(b);
        let long = f.times(a.x) + g.times(a.y) + h.times(a.z);
        let middle = f.times(b.x) + g.times(b.y) + h.times(b.z);
        let short = f.times(c.x) + g.times(c.y) + h.times(c.z);
        let s = long.squared().sqrt().max(tiny);
        let n = long.times(T::constant(token, 1.0) / s);
        // What is left of the first direction in the second by round-off would be in the third, too.
        let middle = middle - n.times(n.dot(middle));
        let t = middle.squared().sqrt().max(tiny);
        let m = middle.times(T::constant(token, 1.0) / t);
        let o = n.cross(m);
        Self { stretches: [s, t, o.dot(short)], directions: [n, m, o], at_rest: [a, b, c] }
    }

    /// The rotation R of F = R U, by its columns.
    #[inline(always)]
    pub fn rotation(&self) -> [V3<T>; 3] {
        let ([n, m, o], [a, b, c]) = (self.directions, self.at_rest);
        [
            n.times(a.x) + m.times(b.x) + o.times(c.x),
            n.times(a.y) + m.times(b.y) + o.times(c.y),
            n.times(a.z) + m.times(b.z) + o.times(c.z),
        ]
    }

    /// How an atom with this gradient of its weight takes part in each direction.
    #[inline(always)]
    pub fn part(&self, token: T::Token, gradient: [f64; 3]) -> [T; 3] {
        let g = V3::constant(token, gradient);
        [self.at_rest[0].dot(g), self.at_rest[1].dot(g), self.at_rest[2].dot(g)]
    }

    /// The block of two atoms that take part by `a` and `b`, for an energy with these second derivatives, times `volume`.
    #[inline(always)]
    pub fn block(&self, a: [T; 3], b: [T; 3], of: &Curvatures<T>, volume: f64) -> Block<T> {
        let [one, two, three] = self.directions;
        let [p, q, r] = [of.row(0, a, b), of.row(1, a, b), of.row(2, a, b)];
        let rows = [
            one.times(p[0]) + two.times(p[1]) + three.times(p[2]),
            one.times(q[0]) + two.times(q[1]) + three.times(q[2]),
            one.times(r[0]) + two.times(r[1]) + three.times(r[2]),
        ];
        let [u, v, w] = [rows[0].scaled(volume), rows[1].scaled(volume), rows[2].scaled(volume)];
        [
            u.times(one.x) + v.times(two.x) + w.times(three.x),
            u.times(one.y) + v.times(two.y) + w.times(three.y),
            u.times(one.z) + v.times(two.z) + w.times(three.z),
        ]
    }
}

/// The second derivatives of an energy by the principal stretches and by turns of their directions, Pa. Pairs of directions are numbered by
/// the one that is left out.
#[derive(Clone, Copy)]
pub struct Curvatures<T> {
    /// By the stretches.
    pub stretch: Symmetric<T>,
    /// Of turns of the deformation against the body at rest: (ψ_k + ψ_l)/(s_k + s_l).
    pub twist: [T; 3],
    /// Of shear at 45° to both directions: (ψ_k − ψ_l)/(s_k − s_l).
    pub flip: [T; 3],
}

impl<T: Real> Curvatures<T> {
    /// With those of `slope` times the volume over that at rest, at these stretches.
    #[inline(always)]
    pub fn with_volume(mut self, slope: T, stretches: [T; 3]) -> Self {
        for k in 0..3 {
            let across = slope * stretches[k];
            self.stretch[1][k] += across;
            self.twist[k] += across;
            self.flip[k] -= across;
        }
        self
    }

    /// Without what is negative.
    #[inline(always)]
    pub fn positive(self, token: T::Token) -> Self {
        let zero = T::constant(token, 0.0);
        let (values, vectors) = eigen(token, self.stretch, false);
        let ([p, q, r], [u, v, w]) = ([values[0].max(zero), values[1].max(zero), values[2].max(zero)], vectors);
        let stretch = [
            [
                p * u.x * u.x + q * v.x * v.x + r * w.x * w.x,
                p * u.y * u.y + q * v.y * v.y + r * w.y * w.y,
                p * u.z * u.z + q * v.z * v.z + r * w.z * w.z,
            ],
            [
                p * u.y * u.z + q * v.y * v.z + r * w.y * w.z,
                p * u.z * u.x + q * v.z * v.x + r * w.z * w.x,
                p * u.x * u.y + q * v.x * v.y + r * w.x * w.y,
            ],
        ];
        let [twist, flip] = [self.twist, self.flip];
        Self {
            stretch,
            twist: [twist[0].max(zero), twist[1].max(zero), twist[2].max(zero)],
            flip: [flip[0].max(zero), flip[1].max(zero), flip[2].max(zero)],
        }
    }

    /// A row of the block of two atoms that take part by `a` and `b`, in the frame of the principal directions.
    #[inline(always)]
    fn row(&self, k: usize, a: [T; 3], b: [T; 3]) -> [T; 3] {
        let (l, m) = ((k + 1) % 3, (k + 2) % 3);
        let [of_l, of_m] = [m, l];
        let mut row = a;
        row[k] = self.stretch[0][k] * a[k] * b[k]
            + (self.flip[of_l] + self.twist[of_l]) * 0.5 * a[l] * b[l]
            + (self.flip[of_m] + self.twist[of_m]) * 0.5 * a[m] * b[m];
        row[l] = self.stretch[1][of_l] * a[k] * b[l] + (self.flip[of_l] - self.twist[of_l]) * 0.5 * a[l] * b[k];
        row[m] = self.stretch[1][of_m] * a[k] * b[m] + (self.flip[of_m] - self.twist[of_m]) * 0.5 * a[m] * b[k];
        row
    }
}
