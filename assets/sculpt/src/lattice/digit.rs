//! The grid over a finger or a toe.

use std::f32::consts::PI;

use glam::Vec3;

use super::cage::Lattice;
use super::chart::Chart;
use toile_base::body::Region;

/// A finger or toe to be laid.
pub(super) struct Digit<'a> {
    /// Its form: centres and radii.
    pub balls: &'a [(Vec3, f32)],
    /// Positions of its rings, as shares of its length.
    pub ways: &'a [f32],
    /// Direction of its nail, and of the side that its rim reaches after the nail's.
    pub nail: Vec3,
    pub side: Vec3,
    pub region: Region,
    /// Of the nail's half and of the other.
    pub charts: [Chart; 2],
}

impl Lattice {
    /// A finger or toe: rings along its balls, closed by quads across its tip. The rim has six vertices, of which the
    /// first two lie on the nail's side, or eight, of which the first three do.
    pub(super) fn lay_digit(&mut self, rim: &[u32], digit: &Digit<'_>) {
        let n = rim.len();
        let chart = |k: usize| digit.charts[usize::from(k >= n / 3 + n / 8 && k < n - 1)];
        let mut ring = rim.to_vec();
        // The last ring stands round the tip's ball, beyond its middle, so that the quads across it close a dome.
        let last = on_chain(digit.balls, 1.0);
        let dome = (last.0 + last.2 * (0.6 * last.1), 0.75 * last.1, last.2);
        for (centre, radius, along) in digit.ways.iter().map(|&w| on_chain(digit.balls, w)).chain([dome]) {
            let nail = digit.nail.reject_from_normalized(along).normalize();
            let side = nail.cross(along).normalize();
            let side = if side.dot(digit.side) < 0.0 { -side } else { side };
            // The middle of the nail's side stands at angle 0.
            let middle = if n == 6 { 0.5 } else { 1.0 };
            let angle = |k: usize| (k as f32 - middle) / n as f32 * 2.0 * PI;
            let to: Vec<u32> = (0..n)
                .map(|k| centre + (nail * angle(k).cos() + side * angle(k).sin()) * radius)
                .map(|p| self.push(p, digit.region, 0.06))
                .collect();
            self.band(&ring, &to, chart);
            ring = to;
        }
        if n == 6 {
            self.quad([ring[0], ring[1], ring[2], ring[5]], digit.charts[0]);
            self.quad([ring[5], ring[2], ring[3], ring[4]], digit.charts[1]);
            return;
        }
        let [.., (before, _), (tip, radius)] = digit.balls else { return };
        let middle = self.push(*tip + (*tip - *before).normalize() * *radius, digit.region, 0.06);
        for k in [0, 2, 4, 6] {
            self.quad([ring[k], ring[k + 1], middle, ring[(k + 7) % 8]], digit.charts[k / 4]);
        }
    }
}

/// Centre, radius and direction a share of the way along a chain of balls.
fn on_chain(balls: &[(Vec3, f32)], share: f32) -> (Vec3, f32, Vec3) {
    let lengths: Vec<f32> = balls.windows(2).map(|w| w[0].0.distance(w[1].0)).collect();
    let mut left = share * lengths.iter().sum::<f32>();
    let mut k = 0;
    while k + 1 < lengths.len() && left > lengths[k] {
        left -= lengths[k];
        k += 1;
    }
    let ([(a, ra), (b, rb)], t) = ([balls[k], balls[k + 1]], left / lengths[k]);
    (a.lerp(b, t), ra + (rb - ra) * t.min(1.0), (b - a) / lengths[k])
}
