//! Exact volume: after every free step a cell is brought back to its target volume along the gradient of its volume.
//!
//! `V = (1/6) Σ det(a, b, c)` over facets, eq. (volume.1), and `∇_i V = (1/6) Σ_j χ_j × χ_{j+1}` over the ring of atom
//! i, eq. (volume.2). V(X + λ g), g the gradient without the components that are held, is a cubic in λ whose
//! coefficients are, with h = ∇V(g), eq. (volume.3): `c₀ = ⅓ X·∇V, c₁ = ∇V·g, c₂ = X·h, c₃ = ⅓ g·h`. The real root of
//! least magnitude is taken. Positions are taken relative to the cell's first atom, so that a cell far from the origin
//! keeps its volume as exactly as one at it.

use super::lanes::{BlockWork, Real, V3, Vectors, VectorsMut, dispatch};

/// Adds nothing, sets `gradient` to ∇V of each atom, eq. (volume.2), and returns V of each lane.
#[inline(always)]
pub fn measure<T: Real>(facets: &[[u32; 3]], x: &Vectors<T>, gradient: &mut VectorsMut<T>, atoms: usize) -> T {
    let token = x.token;
    for atom in 0..atoms {
        gradient.set(atom, V3::zero(token));
    }
    let origin = x.get(0);
    for facet in facets {
        let [i, j, k] = facet.map(|atom| atom as usize);
        let (a, b, c) = (x.get(i) - origin, x.get(j) - origin, x.get(k) - origin);
        gradient.add(i, b.cross(c));
        gradient.add(j, c.cross(a));
        gradient.add(k, a.cross(b));
    }
    let mut volume = T::constant(token, 0.0);
    for atom in 0..atoms {
        let g = gradient.get(atom).scaled(1.0 / 6.0);
        gradient.set(atom, g);
        volume += (x.get(atom) - origin).dot(g);
    }
    volume * (1.0 / 3.0)
}

/// Measures volume and gradient of a block; `held` is one factor per atom and axis (0 held, 1 free) applied to the
/// gradient, or empty when nothing is held. Writes V of each lane to `volume`, µm³.
pub fn measure_block(facets: &[[u32; 3]], x: &[f64], held: &[f64], gradient: &mut [f64], volume: &mut [f64]) {
    let lanes = volume.len();
    struct Work<'a> {
        facets: &'a [[u32; 3]],
        x: &'a [f64],
        gradient: &'a mut [f64],
        volume: &'a mut [f64],
    }
    impl BlockWork for Work<'_> {
        type Output = ();
        #[inline(always)]
        fn run<T: Real>(self, token: T::Token, stride: usize) {
            let atoms = self.x.len() / (3 * self.volume.len());
            let x = T::view(token, self.x);
            let gradient = T::view_mut(token, self.gradient);
            let volume = T::view_mut(token, self.volume);
            for part in 0..stride {
                let x = Vectors::<T>::new(token, x, stride, part);
                let mut g = VectorsMut::<T>::new(token, gradient, stride, part);
                volume[part] = measure(self.facets, &x, &mut g, atoms).raw();
            }
        }
    }
    dispatch(lanes, Work { facets, x, gradient, volume });
    hold(lanes, held, gradient);
}

/// Multiplies every vector component of a block by its factor (0 held, 1 free); an empty list holds nothing.
pub fn hold(lanes: usize, held: &[f64], values: &mut [f64]) {
    for (component, row) in held.iter().zip(values.chunks_exact_mut(lanes)) {
        row.iter_mut().for_each(|value| *value *= component);
    }
}

/// Brings every cell of a block to its target volume; see [`enforce_block`] for the arguments.
struct Enforce<'a> {
    facets: &'a [[u32; 3]],
    x: &'a mut [f64],
    held: &'a [f64],
    gradient: &'a mut [f64],
    second: &'a mut [f64],
    target: &'a [f64],
    worst: &'a mut [f64],
}

impl BlockWork for Enforce<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let atoms = self.x.len() / (3 * self.target.len());
        let target = T::view(token, self.target);
        let worst = T::view_mut(token, self.worst);
        for part in 0..stride {
            let target = T::load(token, target[part]);
            let x = Vectors::<T>::new(token, T::view(token, self.x), stride, part);
            let mut g = VectorsMut::<T>::new(token, T::view_mut(token, self.gradient), stride, part);
            let c0 = measure(self.facets, &x, &mut g, atoms) - target;
            for (atom, axes) in self.held.chunks_exact(3).enumerate() {
                let free = g.get(atom);
                g.set(atom, V3 { x: free.x * axes[0], y: free.y * axes[1], z: free.z * axes[2] });
            }
            let direction = Vectors::<T>::new(token, T::view(token, self.gradient), stride, part);
            let mut h = VectorsMut::<T>::new(token, T::view_mut(token, self.second), stride, part);
            let c3 = measure(self.facets, &direction, &mut h, atoms);
            let origin = x.get(0);
            let (mut c1, mut c2) = (T::constant(token, 0.0), T::constant(token, 0.0));
            for atom in 0..atoms {
                let g = direction.get(atom);
                c1 += g.squared();
                c2 += (x.get(atom) - origin).dot(h.get(atom));
            }
            let root = least_root(token, c0, c1, c2, c3);
            let mut x = VectorsMut::<T>::new(token, T::view_mut(token, self.x), stride, part);
            for atom in 0..atoms {
                x.add(atom, direction.get(atom).times(root));
            }
            let left = ((c3 * root + c2) * root + c1) * root + c0;
            // A root far from the linear one is another branch, on which the cell would be thrown about and its volume
            // lose digits: it counts as an error, so that the caller looks closer.
            let (linear, moved) = (c1 * root, c0 * 3.0);
            let astray = (linear.max(-linear) - moved.max(-moved)).max(T::constant(token, 0.0));
            worst[part] = (left.max(-left) + astray).raw();
        }
    }
}

/// The root of c₀ + c₁λ + c₂λ² + c₃λ³ nearest to zero by Newton's method from zero. The volumes of two successive
/// steps differ little, so that the iteration converges quadratically to the near root; six rounds reach round-off
/// from errors of a third of the volume. What is left is returned to the caller by [`enforce_block`].
#[inline(always)]
fn least_root<T: Real>(token: T::Token, c0: T, c1: T, c2: T, c3: T) -> T {
    let mut root = T::constant(token, 0.0);
    for _ in 0..6 {
        let value = ((c3 * root + c2) * root + c1) * root + c0;
        let slope = (c3 * root * 3.0 + c2 * 2.0) * root + c1;
        root -= value / slope;
    }
    root
}

/// Brings every cell of a block to its target volume (µm³) along its volume gradient, eq. (volume.3). `held` as in
/// [`measure_block`]; `gradient` and `second` are scratch of the size of `x`. Writes |V − target| left by the cubic
/// to `worst`, µm³; more where the root found is not the near one.
pub fn enforce_block(
    facets: &[[u32; 3]],
    x: &mut [f64],
    held: &[f64],
    target: &[f64],
    gradient: &mut [f64],
    second: &mut [f64],
    worst: &mut [f64],
) {
    dispatch(target.len(), Enforce { facets, x, held, gradient, second, target, worst });
}

/// The real root of least magnitude of c₀ + c₁λ + c₂λ² + c₃λ³, in closed form: the oracle of the Newton iteration, and
/// its rescue when a cell is far from its target. The closed form loses its digits where c₃ is small, so that each of its
/// roots is polished by Newton's method, as is the root of the linear part; `None` if there is no real root.
pub fn least_root_exact(c0: f64, c1: f64, c2: f64, c3: f64) -> Option<f64> {
    let mut roots = [f64::NAN; 4];
    let size = c1.abs().max(c2.abs()).max(c3.abs());
    if c3.abs() > 1e-14 * size {
        let (a, b, c) = (c2 / c3, c1 / c3, c0 / c3);
        let q = (a * a - 3.0 * b) / 9.0;
        let r = (2.0 * a * a * a - 9.0 * a * b + 27.0 * c) / 54.0;
        if r * r < q * q * q {
            let angle = (r / (q * q * q).sqrt()).clamp(-1.0, 1.0).acos();
            for (root, turn) in roots.iter_mut().zip([0.0, 1.0, -1.0]) {
                *root = -2.0 * q.sqrt() * ((angle + turn * std::f64::consts::TAU) / 3.0).cos() - a / 3.0;
            }
        } else {
            let big = -r.signum() * (r.abs() + (r * r - q * q * q).sqrt()).cbrt();
            let small = if big == 0.0 { 0.0 } else { q / big };
            roots[0] = big + small - a / 3.0;
        }
    } else if c2.abs() > 1e-14 * size {
        let discriminant = c1 * c1 - 4.0 * c2 * c0;
        if discriminant >= 0.0 {
            let half = -0.5 * (c1 + c1.signum() * discriminant.sqrt());
            roots[0] = half / c2;
            if half != 0.0 {
                roots[1] = c0 / half;
            }
        }
    } else if c1 != 0.0 {
        roots[0] = -c0 / c1;
    }
    roots[3] = -c0 / c1;
    let polished = roots.into_iter().filter_map(|root| polish(root, c0, c1, c2, c3));
    polished.min_by(|a, b| a.abs().total_cmp(&b.abs()))
}

/// A root near a guess by Newton's method; `None` where it finds none.
fn polish(guess: f64, c0: f64, c1: f64, c2: f64, c3: f64) -> Option<f64> {
    let mut root = guess;
    // Quadratic convergence: from the digits that the closed form keeps to all of them, and from the linear root of
    // every cell that is not far from its target.
    for _ in 0..12 {
        let value = ((c3 * root + c2) * root + c1) * root + c0;
        let slope = (3.0 * c3 * root + 2.0 * c2) * root + c1;
        if value == 0.0 || slope == 0.0 {
            break;
        }
        root -= value / slope;
    }
    let value = ((c3 * root + c2) * root + c1) * root + c0;
    // What round-off leaves of a sum of these terms.
    let size = c0.abs() + (c1 * root).abs() + (c2 * root * root).abs() + (c3 * root * root * root).abs();
    (root.is_finite() && value.abs() <= 1e-14 * size).then_some(root)
}

#[cfg(test)]
mod tests {
    use super::least_root_exact;

    #[test]
    fn the_least_root_keeps_its_digits_where_the_cubic_term_is_small() {
        // (λ - 1e-3)(1 + λ)(1 + s λ) for steep and vanishing s: the least root is 1e-3.
        for s in [1.0, 0.1, 1e-4, 1e-8, 1e-13, 0.0, -1e-8] {
            let (a, b, c, d) = (-1e-3, 1.0 - 1e-3 * (1.0 + s), 1.0 + s - 1e-3 * s, s);
            let root = least_root_exact(a, b, c, d).unwrap();
            // A few units in the last place of the coefficients, which are of size 1.
            assert!((root - 1e-3).abs() < 1e-15, "{s}: {root}");
        }
        assert_eq!(least_root_exact(1.0, 0.0, 1.0, 0.0), None, "1 + λ² has no real root");
    }
}
