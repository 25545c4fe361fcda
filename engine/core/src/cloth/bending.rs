//! Bending along warp and weft.
//!
//! For three particles in a row, spaced h apart, the curvature is |x0 - 2 x1 + x2| / h^2. A strip of width w and rigidity
//! B stores (B w h / 2) curvature^2 = (k / 2) |x0 - 2 x1 + x2|^2 with k = B w / h^3, so C = |x0 - 2 x1 + x2| is a
//! position-based constraint with compliance 1 / k and gradient (n, -2n, n). Cloth is flat when nothing bends it.

use toile_assets::garment::Garment;

use super::Cloth;

/// Below this the three particles are straight already (m).
const LEAST_BEND_M: f32 = 1e-7;

/// Solves every bend once.
pub fn solve(cloth: &mut Cloth, garment: &Garment, dt: f32) {
    let per_dt2 = (dt * dt).recip();
    let (x, w) = (&mut cloth.positions, &garment.inverse_mass);
    for bend in &garment.bends {
        let [a, b, c] = bend.v.map(|i| i as usize);
        let d = x[a] - x[b] * 2.0 + x[c];
        let size = d.length();
        if size < LEAST_BEND_M {
            continue;
        }
        let weight = w[a] + 4.0 * w[b] + w[c] + bend.compliance * per_dt2;
        // C / (sum w |grad|^2 + alpha / dt^2), along n = d / |d|: the length cancels.
        let push = d / weight;
        x[a] -= push * w[a];
        x[b] += push * (2.0 * w[b]);
        x[c] -= push * w[c];
    }
}
