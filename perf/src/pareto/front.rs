//! The Pareto front: settings than which no other is both faster and nearer.

use super::report::Point;

/// Marks the front of each scene, mesh and number of threads. What was rolled back is on none.
pub fn mark(points: &mut [Point]) {
    let kept: Vec<bool> = points.iter().map(|p| sound(p) && !points.iter().any(|q| beats(q, p))).collect();
    points.iter_mut().zip(kept).for_each(|(p, kept)| p.on_front = kept);
}

fn sound(p: &Point) -> bool {
    p.rolled_back == 0 && p.error_mm.is_finite()
}

/// Whether one is as fast and as near as another, and better in one of both.
fn beats(one: &Point, other: &Point) -> bool {
    let alike = one.scene == other.scene && one.mesh == other.mesh && one.threads == other.threads;
    let as_good = one.step_us <= other.step_us && one.error_mm <= other.error_mm;
    let better = one.step_us < other.step_us || one.error_mm < other.error_mm;
    alike && sound(one) && as_good && better
}

/// The front of one scene and mesh on so many threads, fastest first.
pub fn of<'a>(points: &'a [Point], scene: &str, mesh: &str, threads: usize) -> Vec<&'a Point> {
    let on = |p: &&Point| p.on_front && p.scene == scene && p.mesh == mesh && p.threads == threads;
    let mut front: Vec<&Point> = points.iter().filter(on).collect();
    front.sort_by(|a, b| a.step_us.total_cmp(&b.step_us));
    front
}
