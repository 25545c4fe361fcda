//! How much of a mesh its fibers cover: what `toile bake` reports.

use super::{Direction, Fiber};

/// How many edges each kind of fiber covers, and how well the cloth hangs.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Coverage {
    /// Number of edges of the mesh.
    pub edges: usize,
    /// Edges in warp fibers of two edges or more.
    pub warp: usize,
    /// Edges in open weft fibers of two edges or more.
    pub weft: usize,
    /// Edges in hoops, whichever way they run.
    pub hoops: usize,
    /// Edges in bias fibers of two edges or more.
    pub bias: usize,
    /// Edges that lie in no fiber of two edges or more.
    pub loose: usize,
    /// Fibers of two edges or more: along warp, weft (hoops with them) and bias.
    pub fibers: [usize; 3],
    /// Edges of the longest fiber.
    pub longest: usize,
    /// Vertices that can move.
    pub free: usize,
    /// Those that a warp fiber joins to a fixed vertex.
    pub hanging: usize,
    /// Those besides that hang from them by further warp fibers.
    pub hanging_on: usize,
}

impl Coverage {
    /// Counts what [`trace`](super::trace()) has found; `fixed` says which vertices do not move.
    pub fn of(fibers: &[Fiber], fixed: &[bool]) -> Self {
        let mut found = Self { free: fixed.iter().filter(|f| !**f).count(), ..Self::default() };
        for fiber in fibers {
            let count = fiber.edges.len();
            found.edges += count;
            found.longest = found.longest.max(count);
            let kind = match fiber.direction {
                _ if fiber.is_loose() => &mut found.loose,
                _ if fiber.is_hoop() => &mut found.hoops,
                Direction::Warp => &mut found.warp,
                Direction::Weft => &mut found.weft,
                Direction::Bias => &mut found.bias,
            };
            *kind += count;
            found.fibers[fiber.direction as usize] += usize::from(!fiber.is_loose());
        }
        (found.hanging, found.hanging_on) = hanging(fibers, fixed);
        found
    }

    /// Share of the free vertices that hang from a fixed one, by one fiber or by several (0..1); 1 if none is free.
    pub fn hanging_share(&self) -> f64 {
        if self.free == 0 { 1.0 } else { (self.hanging + self.hanging_on) as f64 / self.free as f64 }
    }
}

/// Free vertices on warp fibers with a fixed vertex, and those on fibers that hang from these.
fn hanging(fibers: &[Fiber], fixed: &[bool]) -> (usize, usize) {
    let mut held = fixed.to_vec();
    let mut open: Vec<&Fiber> = fibers.iter().filter(|f| f.direction == Direction::Warp).collect();
    let count = |held: &[bool]| held.iter().zip(fixed).filter(|(h, f)| **h && !**f).count();
    let mut rounds = Vec::new();
    loop {
        let before = held.clone();
        open.retain(|fiber| {
            let hangs = fiber.vertices.iter().any(|&v| before[v as usize]);
            if hangs {
                fiber.vertices.iter().for_each(|&v| held[v as usize] = true);
            }
            !hangs
        });
        if !rounds.is_empty() && before == held {
            return (rounds[0], count(&held) - rounds[0]);
        }
        rounds.push(count(&held));
    }
}
