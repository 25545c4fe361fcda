//! From stencils over whole rings to the hubs of a garment's layout.

use super::bending::Stencil;
use super::order::ParticleOrder;
use toile_base::garment::layout::{HubGroup, Hubs, OWNERS};

/// Stencils of up to so many particles are laid out on their own.
const SHORT: usize = 4;

/// The stencils of one vertex.
struct Hub<'a> {
    stencils: &'a [Stencil],
    owner: usize,
    crosses: bool,
    /// Its particles: the vertex, then its ring in the order of memory, and where each stands in the stencils.
    points: Vec<(u32, usize)>,
}

impl<'a> Hub<'a> {
    fn new(order: &ParticleOrder, stencils: &'a [Stencil]) -> Self {
        let particle = |v: &u32| order.particle[*v as usize];
        let mut points: Vec<(u32, usize)> = stencils[0].v.iter().map(particle).zip(0..).collect();
        points[1..].sort_unstable();
        let owner = |p: u32| usize::from(order.owner[p as usize]);
        let own = owner(points[0].0);
        Self { stencils, owner: own, crosses: points.iter().any(|(p, _)| owner(*p) != own), points }
    }

    fn kind(&self) -> (usize, usize) {
        (self.points.len(), self.stencils.len())
    }
}

/// All hubs: those of a kind side by side, within it in the order of memory.
pub fn hubs(order: &ParticleOrder, stencils: &[Stencil]) -> Hubs {
    let around = stencils.chunk_by(|a, b| a.v == b.v).filter(|s| s[0].v.len() > SHORT);
    let mut all: Vec<Hub<'_>> = around.map(|s| Hub::new(order, s)).collect();
    all.sort_by_key(|hub| (hub.kind(), hub.points[0].0));
    let (mut particles, mut coefficients, mut groups, mut count) = (Vec::new(), Vec::new(), Vec::new(), 0);
    let sets = [false, true].map(|crosses| {
        std::array::from_fn::<_, OWNERS, _>(|owner| {
            let first = groups.len() as u32;
            let mine: Vec<&Hub<'_>> = all.iter().filter(|h| h.crosses == crosses && h.owner == owner).collect();
            for group in mine.chunk_by(|a, b| a.kind() == b.kind()) {
                groups.push(HubGroup {
                    points: group[0].points.len() as u32,
                    sums: group[0].stencils.len() as u32,
                    count: group.len() as u32,
                    number: count as u32,
                    particles: particles.len() as u32,
                    coefficients: coefficients.len() as u32,
                });
                count += group.len();
                for hub in group {
                    particles.extend(hub.points.iter().map(|(p, _)| *p));
                    let each = hub.points.iter().flat_map(|(_, at)| hub.stencils.iter().map(|s| s.c[*at] * s.k.sqrt()));
                    coefficients.extend(each);
                }
            }
            first..groups.len() as u32
        })
    });
    Hubs { particles: particles.into(), coefficients: coefficients.into(), groups: groups.into(), sets, count }
}
