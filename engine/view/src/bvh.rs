//! A bounding volume hierarchy over triangles, built for each picture.
//!
//! Built top-down with the surface area heuristic in bins (Wald 2007, "On fast construction of SAH-based bounding
//! volume hierarchies"). A node has four children of 28 bytes each, and a leaf up to four triangles, so that one ray is
//! tested against four boxes or triangles at once (Wald, Benthin and Boulos 2008, "Getting rid of packets"). Triangles are
//! met with the test of Moeller and Trumbore (1997). The same triangles give the same tree, bit for bit.

use glam::{BVec4A, Vec3, Vec3A, Vec4};

use crate::scene::Bounds;

/// Children of a node, triangles of a leaf: the lanes of a 128-bit register.
const WIDE: usize = 4;

/// Bins an axis is cut into when a split is sought: beyond a dozen the trees hardly improve.
const BINS: usize = 12;

/// Level from which ranges are cut at the median, so that no input can outgrow the stack.
const STEEP: usize = 20;

/// Most triangles of a tree: 4 GB of them. Further ones are left out.
const MOST_TRIANGLES: usize = 1 << 24;

/// Boxes waiting while the tree is walked: each level leaves three behind, and under [`STEEP`] levels the remaining
/// triangles are quartered until four are left.
const STACK: usize = 96;

const _: () = assert!((STEEP + 11) * (WIDE - 1) < STACK && MOST_TRIANGLES == WIDE.pow(11) * WIDE);

/// Least component of a ray's direction: keeps its reciprocal finite, so that no slab test meets 0 x infinity.
const LEAST_SLOPE: f32 = 1e-12;

/// Distance that stands for infinity (m), so that the far corner of a spare box still lies beyond it.
const FAR: f32 = 1e30;

/// How far outside an edge (barycentric) a triangle still counts as met: closes the cracks that rounding opens
/// between neighbours.
const EDGE_SLACK: f32 = 1e-6;

/// A ray: half of a line.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Its start (m).
    pub origin: Vec3,
    /// Its unit direction.
    pub direction: Vec3,
}

impl Ray {
    /// A ray from a point along a unit direction.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Self { origin, direction }
    }
}

/// Hit of a ray on a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance along the ray (m).
    pub distance: f32,
    /// Barycentric weight of the second corner.
    pub u: f32,
    /// Barycentric weight of the third corner.
    pub v: f32,
    /// The triangle: its place in the order given to [`Bvh::build`].
    pub triangle: u32,
}

/// Three coordinates of four things.
type Vec3x4 = [Vec4; 3];

/// Four children: their boxes and what is in them.
#[derive(Debug, Clone, Copy)]
struct BvhNode {
    min: Vec3x4,
    max: Vec3x4,
    child: [NodeChild; WIDE],
}

/// What a box holds: a node, a leaf (its [`NodeChild::LEAF`] bit set), or nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct NodeChild(u32);

impl NodeChild {
    const LEAF: u32 = 1 << 31;
    const NONE: Self = Self(u32::MAX);
}

const _: () = assert!(size_of::<BvhNode>() == WIDE * 28);

/// Four triangles as the ray test wants them: a corner and the two edges that leave it. Spare lanes have no area.
#[derive(Debug, Clone, Copy)]
struct BvhLeaf {
    corner: Vec3x4,
    edges: [Vec3x4; 2],
    ids: [u32; WIDE],
}

/// A bounding volume hierarchy of triangles.
#[derive(Debug, Clone)]
pub struct Bvh {
    nodes: Vec<BvhNode>,
    leaves: Vec<BvhLeaf>,
    bounds: Bounds,
    count: usize,
}

impl Bvh {
    /// Builds the tree over triangles given by their corners (m). Those that are not finite or have no area keep
    /// their number but are never met.
    pub fn build(faces: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let mut triangles = Vec::with_capacity(faces.size_hint().0);
        let mut parts = Vec::with_capacity(faces.size_hint().0);
        for (id, [a, b, c]) in (0..).zip(faces) {
            let edges = [b - a, c - a];
            let area = edges[0].cross(edges[1]).length_squared();
            if area.is_finite() && area > f32::MIN_POSITIVE && a.is_finite() && parts.len() < MOST_TRIANGLES {
                let slot = parts.len() as u32;
                parts.push(TriangleBounds { min: a.min(b).min(c).into(), max: a.max(b).max(c).into(), slot });
                triangles.push(Triangle { corner: a, edges, id });
            }
        }
        let bounds = around(&parts);
        let bounds = Bounds { min: bounds.0.into(), max: bounds.1.into() };
        let mut growth = BvhBuilder { triangles: &triangles, nodes: Vec::new(), leaves: Vec::new() };
        if !parts.is_empty() {
            growth.node(&mut parts, 0);
        }
        Self { nodes: growth.nodes, leaves: growth.leaves, bounds, count: triangles.len() }
    }

    /// Triangles that can be met.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True if no triangle can be met.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The box around all triangles.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The nearest triangle closer than `limit` (m).
    pub fn closest(&self, ray: &Ray, limit: f32) -> Option<Hit> {
        let probe = RayLanes::new(ray);
        let mut best = Hit { distance: limit.min(FAR), u: 0.0, v: 0.0, triangle: u32::MAX };
        let mut stack = [(0.0_f32, NodeChild::NONE); STACK];
        let mut waiting = 0;
        let mut child = if self.nodes.is_empty() { NodeChild::NONE } else { NodeChild(0) };
        while child != NodeChild::NONE {
            if child.0 & NodeChild::LEAF == 0 {
                let node = &self.nodes[child.0 as usize];
                let (entries, met) = node.meet(&probe, best.distance);
                let entries = entries.to_array();
                let bottom = waiting;
                for lane in lanes(met) {
                    // The nearest stays on top: those farther than the newcomer move one down.
                    let mut at = waiting;
                    while at > bottom && stack[at - 1].0 < entries[lane] {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = (entries[lane], node.child[lane]);
                    waiting += 1;
                }
            } else if let Some(hit) = self.leaves[(child.0 ^ NodeChild::LEAF) as usize].nearest(&probe, best.distance) {
                best = hit;
            }
            child = NodeChild::NONE;
            while waiting > 0 && child == NodeChild::NONE {
                waiting -= 1;
                if stack[waiting].0 <= best.distance {
                    child = stack[waiting].1;
                }
            }
        }
        (best.triangle != u32::MAX).then_some(best)
    }

    /// True if any triangle lies closer than `limit` (m).
    pub fn blocked(&self, ray: &Ray, limit: f32) -> bool {
        let (probe, limit) = (RayLanes::new(ray), limit.min(FAR));
        let mut stack = [NodeChild::NONE; STACK];
        let mut waiting = usize::from(!self.nodes.is_empty());
        stack[0] = NodeChild(0);
        while waiting > 0 {
            waiting -= 1;
            let child = stack[waiting];
            if child.0 & NodeChild::LEAF == 0 {
                let node = &self.nodes[child.0 as usize];
                for lane in lanes(node.meet(&probe, limit).1) {
                    stack[waiting] = node.child[lane];
                    waiting += 1;
                }
            } else if self.leaves[(child.0 ^ NodeChild::LEAF) as usize].meet(&probe, limit).mask != 0 {
                return true;
            }
        }
        false
    }
}

/// A ray in every lane.
struct RayLanes {
    origin: Vec3x4,
    direction: Vec3x4,
    inverse: Vec3x4,
}

impl RayLanes {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        let slope = |d: f32| if d.abs() < LEAST_SLOPE { LEAST_SLOPE.copysign(d) } else { d };
        Self {
            origin: ray.origin.to_array().map(Vec4::splat),
            direction: ray.direction.to_array().map(Vec4::splat),
            inverse: ray.direction.to_array().map(|d| Vec4::splat(1.0 / slope(d))),
        }
    }
}

/// The lanes of a mask, lowest first.
#[inline(always)]
fn lanes(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (lane < WIDE).then_some(lane)
    })
}

impl BvhNode {
    /// Where the ray enters each box, and the mask of those it does enter before the limit.
    #[inline(always)]
    fn meet(&self, probe: &RayLanes, limit: f32) -> (Vec4, u32) {
        let mut enter = Vec4::ZERO;
        let mut leave = Vec4::splat(limit);
        for axis in 0..3 {
            let a = (self.min[axis] - probe.origin[axis]) * probe.inverse[axis];
            let b = (self.max[axis] - probe.origin[axis]) * probe.inverse[axis];
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        // Two units in the last place more, so that rounding never loses a box (Ize 2013, "Robust BVH ray traversal").
        (enter, enter.cmple(leave * 1.000_000_2).bitmask())
    }
}

/// Hits on the triangles of a leaf.
struct LeafHits {
    mask: u32,
    distance: Vec4,
    u: Vec4,
    v: Vec4,
}

#[inline(always)]
fn cross(a: Vec3x4, b: Vec3x4) -> Vec3x4 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn dot(a: Vec3x4, b: Vec3x4) -> Vec4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl BvhLeaf {
    /// All four triangles against the ray, both sides of each, nearer than the limit.
    #[inline(always)]
    fn meet(&self, probe: &RayLanes, limit: f32) -> LeafHits {
        let [e1, e2] = self.edges;
        let p = cross(probe.direction, e2);
        let inverse = dot(e1, p).recip();
        let from = [0, 1, 2].map(|i| probe.origin[i] - self.corner[i]);
        let u = dot(from, p) * inverse;
        let q = cross(from, e1);
        let v = dot(probe.direction, q) * inverse;
        let distance = dot(e2, q) * inverse;
        // A ray within a triangle's plane divides by zero, as do spare lanes; NaN then fails these comparisons.
        let slack = Vec4::splat(-EDGE_SLACK);
        let inside: BVec4A = u.cmpge(slack) & v.cmpge(slack) & (u + v).cmple(Vec4::splat(1.0 + EDGE_SLACK));
        let within = distance.cmpgt(Vec4::ZERO) & distance.cmplt(Vec4::splat(limit));
        LeafHits { mask: (inside & within).bitmask(), distance, u, v }
    }

    /// The nearest of the triangles met.
    #[inline(always)]
    fn nearest(&self, probe: &RayLanes, limit: f32) -> Option<Hit> {
        let hits = self.meet(probe, limit);
        let lane = lanes(hits.mask).reduce(|a, b| if hits.distance[b] < hits.distance[a] { b } else { a })?;
        let LeafHits { distance, u, v, .. } = hits;
        Some(Hit { distance: distance[lane], u: u[lane], v: v[lane], triangle: self.ids[lane] })
    }
}

/// A triangle by a corner and its edges.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corner: Vec3,
    edges: [Vec3; 2],
    id: u32,
}

/// A triangle while the tree grows: its box and where it is kept.
#[derive(Debug, Clone, Copy)]
struct TriangleBounds {
    min: Vec3A,
    max: Vec3A,
    slot: u32,
}

impl TriangleBounds {
    /// Twice the middle of the box, which sorts like the middle.
    #[inline(always)]
    fn key(&self) -> Vec3A {
        self.min + self.max
    }
}

/// Least and greatest corner of a box.
type Corners = (Vec3A, Vec3A);

const NOTHING: Corners = (Vec3A::INFINITY, Vec3A::NEG_INFINITY);

#[inline(always)]
fn join(a: Corners, b: Corners) -> Corners {
    (a.0.min(b.0), a.1.max(b.1))
}

fn around(parts: &[TriangleBounds]) -> Corners {
    parts.iter().fold(NOTHING, |b, p| join(b, (p.min, p.max)))
}

/// Half the surface of a box (m^2); 0 for the empty one.
fn half_area(b: Corners) -> f32 {
    let d = (b.1 - b.0).max(Vec3A::ZERO);
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// Cost of intersecting this many triangles: leaves hold four.
fn leaf_cost(count: u32) -> f32 {
    count.div_ceil(WIDE as u32) as f32
}

/// The tree while it grows.
struct BvhBuilder<'a> {
    triangles: &'a [Triangle],
    nodes: Vec<BvhNode>,
    leaves: Vec<BvhLeaf>,
}

impl BvhBuilder<'_> {
    /// Makes the node over these parts, and all below it.
    fn node(&mut self, parts: &mut [TriangleBounds], level: usize) -> NodeChild {
        let me = self.nodes.len();
        // Spare lanes hold a point at infinity, which no ray reaches.
        self.nodes.push(BvhNode { min: [Vec4::INFINITY; 3], max: [Vec4::INFINITY; 3], child: [NodeChild::NONE; WIDE] });
        // The range that promises most is split until there are four.
        let mut ranges: [&mut [TriangleBounds]; WIDE] = [parts, &mut [], &mut [], &mut []];
        for filled in 1..WIDE {
            let promise = |r: &&mut [TriangleBounds]| match r.len() {
                0..=WIDE => -1.0,
                n if level >= STEEP => n as f32,
                _ => half_area(around(r)),
            };
            let promises: [f32; WIDE] = std::array::from_fn(|i| promise(&&mut *ranges[i]));
            let widest = (0..filled).fold(0, |a, b| if promises[b] > promises[a] { b } else { a });
            if promises[widest] < 0.0 {
                break;
            }
            let whole = std::mem::take(&mut ranges[widest]);
            let middle = split(whole, level);
            (ranges[widest], ranges[filled]) = whole.split_at_mut(middle);
        }
        for (lane, range) in ranges.into_iter().enumerate().filter(|(_, r)| !r.is_empty()) {
            let (min, max) = around(range);
            let child = if range.len() <= WIDE { self.leaf(range) } else { self.node(range, level + 1) };
            let node = &mut self.nodes[me];
            for axis in 0..3 {
                node.min[axis][lane] = min[axis];
                node.max[axis][lane] = max[axis];
            }
            node.child[lane] = child;
        }
        NodeChild(me as u32)
    }

    fn leaf(&mut self, parts: &[TriangleBounds]) -> NodeChild {
        let zero = [Vec4::ZERO; 3];
        let mut leaf = BvhLeaf { corner: zero, edges: [zero; 2], ids: [u32::MAX; WIDE] };
        for (lane, part) in parts.iter().enumerate() {
            let triangle = &self.triangles[part.slot as usize];
            for axis in 0..3 {
                leaf.corner[axis][lane] = triangle.corner[axis];
                leaf.edges[0][axis][lane] = triangle.edges[0][axis];
                leaf.edges[1][axis][lane] = triangle.edges[1][axis];
            }
            leaf.ids[lane] = triangle.id;
        }
        self.leaves.push(leaf);
        NodeChild(NodeChild::LEAF | (self.leaves.len() - 1) as u32)
    }
}

/// Sorts the parts into two groups, neither empty, and returns the length of the first.
fn split(parts: &mut [TriangleBounds], level: usize) -> usize {
    let keys = parts.iter().fold(NOTHING, |b, p| join(b, (p.key(), p.key())));
    let size = keys.1 - keys.0;
    let cut = if level < STEEP { best_cut(parts, keys) } else { None };
    if let Some(cut) = cut {
        return partition(parts, |p| bin(p.key(), cut.origin, cut.scale)[cut.axis] < cut.at as i32);
    }
    // All keys in one place, or too deep: halve by count along the longest axis.
    let axis = if size.x >= size.y.max(size.z) { 0 } else { 1 + usize::from(size.z > size.y) };
    let middle = parts.len() / 2;
    let order =
        |a: &TriangleBounds, b: &TriangleBounds| a.key()[axis].total_cmp(&b.key()[axis]).then(a.slot.cmp(&b.slot));
    parts.select_nth_unstable_by(middle, order);
    middle
}

/// A plane between bins: parts in bins below `at` go left.
struct SplitPlane {
    axis: usize,
    at: usize,
    /// Areas times costs of both sides (m^2).
    cost: f32,
    origin: Vec3A,
    scale: Vec3A,
}

/// The bin of a key along each axis.
#[inline(always)]
fn bin(key: Vec3A, origin: Vec3A, scale: Vec3A) -> [i32; 3] {
    let bins = ((key - origin) * scale).min(Vec3A::splat((BINS - 1) as f32));
    bins.to_array().map(|b| b as i32)
}

/// The cheapest plane over all axes, or `None` if all keys agree.
fn best_cut(parts: &[TriangleBounds], keys: Corners) -> Option<SplitPlane> {
    let scale = (keys.1 - keys.0).map(|d| if d > 0.0 { BINS as f32 / d } else { 0.0 });
    let scale = scale.map(|s| if s.is_finite() { s } else { 0.0 });
    let mut bins = [[(NOTHING, 0_u32); BINS]; 3];
    for part in parts {
        let places = bin(part.key(), keys.0, scale);
        for (bins, place) in bins.iter_mut().zip(places) {
            let (extent, count) = &mut bins[place as usize];
            *extent = join(*extent, (part.min, part.max));
            *count += 1;
        }
    }
    let mut best: Option<SplitPlane> = None;
    for axis in (0..3).filter(|&axis| scale[axis] > 0.0) {
        let (at, cost) = cheapest(&bins[axis]);
        if best.as_ref().is_none_or(|b| cost < b.cost) {
            best = Some(SplitPlane { axis, at, cost, origin: keys.0, scale });
        }
    }
    best
}

/// The cheapest place to cut one axis' bins. The outer bins are never empty, so neither side is.
fn cheapest(bins: &[(Corners, u32); BINS]) -> (usize, f32) {
    let mut right = [0.0; BINS];
    let mut side = (NOTHING, 0);
    for i in (1..BINS).rev() {
        side = (join(side.0, bins[i].0), side.1 + bins[i].1);
        right[i] = half_area(side.0) * leaf_cost(side.1);
    }
    let mut best = (1, f32::INFINITY);
    let mut side = (NOTHING, 0);
    for i in 1..BINS {
        side = (join(side.0, bins[i - 1].0), side.1 + bins[i - 1].1);
        let cost = half_area(side.0) * leaf_cost(side.1) + right[i];
        if cost < best.1 {
            best = (i, cost);
        }
    }
    best
}

/// Moves the parts that satisfy `left` to the front and returns how many there are.
fn partition(parts: &mut [TriangleBounds], left: impl Fn(&TriangleBounds) -> bool) -> usize {
    let mut count = 0;
    for i in 0..parts.len() {
        if left(&parts[i]) {
            parts.swap(i, count);
            count += 1;
        }
    }
    count
}
