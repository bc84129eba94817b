//! At which points of a facet it is looked what attracts it, eq. (adhesion.18).

/// Barycentric weights of the middles of the parts of a facet whose sides are cut into so many.
pub fn points_of_facet(parts: u32) -> &'static [[f64; 3]] {
    const fn middles<const N: usize>(parts: usize) -> [[f64; 3]; N] {
        let (mut all, mut next) = ([[0.0; 3]; N], 0);
        let mut i = 0;
        while i < parts {
            let mut j = 0;
            while i + j < parts {
                let mut half = 0;
                while half < 2 && i + j + half < parts {
                    let third = (1 + half) as f64 / 3.0;
                    let (v, w) = ((i as f64 + third) / parts as f64, (j as f64 + third) / parts as f64);
                    all[next] = [1.0 - v - w, v, w];
                    next += 1;
                    half += 1;
                }
                j += 1;
            }
            i += 1;
        }
        all
    }
    const ONE: [[f64; 3]; 1] = middles(1);
    const TWO: [[f64; 3]; 4] = middles(2);
    const THREE: [[f64; 3]; 9] = middles(3);
    const FOUR: [[f64; 3]; 16] = middles(4);
    match parts {
        0 | 1 => &ONE,
        2 => &TWO,
        3 => &THREE,
        _ => &FOUR,
    }
}
