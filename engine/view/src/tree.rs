//! The accelerating tree: a bounding volume hierarchy over triangles, built anew for each picture.
//!
//! Built top-down with the surface area heuristic in bins (Wald 2007, "On fast construction of SAH-based bounding
//! volume hierarchies"); walked with a small stack, the nearer child first. Triangles are met with the test of Moeller
//! and Trumbore (1997). The same triangles give the same tree, bit for bit.

use glam::Vec3;

use crate::scene::Bounds;

/// Bins an axis is cut into when a split is sought: beyond a dozen the trees hardly improve.
const BINS: usize = 12;

/// Most triangles in a leaf that the heuristic may keep together.
const LEAF: usize = 4;

/// Depth from which nodes are cut at the median, so that no input can outgrow the stack.
const STEEP: u32 = 30;

/// Nodes waiting while the tree is walked: [`STEEP`] levels, then at most 32 halvings of `u32::MAX` triangles.
const STACK: usize = 64;

/// Cost of passing a node, in triangle tests.
const NODE_COST: f32 = 1.2;

/// Least component of a ray's direction: keeps its reciprocal finite, so that no slab test meets 0 x infinity.
const LEAST_SLOPE: f32 = 1e-12;

/// How far outside an edge (barycentric) a triangle still counts as met: closes the cracks that rounding opens
/// between neighbours.
const EDGE_SLACK: f32 = 1e-6;

/// A half line.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    /// Where it starts (m).
    pub origin: Vec3,
    /// Its unit direction.
    pub direction: Vec3,
    inverse: Vec3,
}

impl Ray {
    /// A ray from a point along a unit direction.
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        let slope = |d: f32| if d.abs() < LEAST_SLOPE { LEAST_SLOPE.copysign(d) } else { d };
        let inverse = Vec3::new(1.0 / slope(direction.x), 1.0 / slope(direction.y), 1.0 / slope(direction.z));
        Self { origin, direction, inverse }
    }
}

/// Where a ray met a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance along the ray (m).
    pub distance: f32,
    /// Barycentric weight of the second corner.
    pub u: f32,
    /// Barycentric weight of the third corner.
    pub v: f32,
    /// The triangle: its place in the order given to [`Tree::build`].
    pub triangle: u32,
}

/// A node: its box, and its children or triangles. Children lie side by side.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(32))]
struct Node {
    min: [f32; 3],
    /// First child, or first triangle of a leaf.
    first: u32,
    max: [f32; 3],
    /// Triangles of a leaf; 0 for a node with children.
    count: u32,
}

const _: () = assert!(size_of::<Node>() == 32);

/// A triangle as the ray test wants it: a corner and the two edges that leave it.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    corner: Vec3,
    edges: [Vec3; 2],
    id: u32,
}

/// The tree.
#[derive(Debug, Clone)]
pub struct Tree {
    nodes: Vec<Node>,
    triangles: Vec<Triangle>,
}

impl Tree {
    /// Builds the tree over triangles given by their corners (m). Those that are not finite or have no area keep
    /// their number but are never met.
    pub fn build(faces: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let mut triangles = Vec::with_capacity(faces.size_hint().0);
        let mut parts = Vec::with_capacity(faces.size_hint().0);
        for (id, [a, b, c]) in (0..).zip(faces) {
            let edges = [b - a, c - a];
            let area = edges[0].cross(edges[1]).length_squared();
            if area.is_finite() && area > f32::MIN_POSITIVE && a.is_finite() {
                parts.push(Part { min: a.min(b).min(c), max: a.max(b).max(c), slot: triangles.len() as u32 });
                triangles.push(Triangle { corner: a, edges, id });
            }
        }
        let nodes = grow(&mut parts);
        let triangles = parts.iter().map(|p| triangles[p.slot as usize]).collect();
        Self { nodes, triangles }
    }

    /// Triangles that can be met.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// True if no triangle can be met.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The box around all triangles.
    pub fn bounds(&self) -> Bounds {
        let root = self.nodes.first();
        root.map_or(Bounds::EMPTY, |n| Bounds { min: Vec3::from_array(n.min), max: Vec3::from_array(n.max) })
    }

    /// The nearest triangle closer than `limit` (m).
    pub fn closest(&self, ray: &Ray, limit: f32) -> Option<Hit> {
        let mut best = Hit { distance: limit, u: 0.0, v: 0.0, triangle: u32::MAX };
        self.walk(ray, limit, |triangle| {
            if let Some(hit) = triangle.meet(ray, best.distance) {
                best = hit;
            }
            best.distance
        });
        (best.triangle != u32::MAX).then_some(best)
    }

    /// True if any triangle lies closer than `limit` (m).
    pub fn blocked(&self, ray: &Ray, limit: f32) -> bool {
        let mut blocked = false;
        self.walk(ray, limit, |triangle| {
            if !blocked && triangle.meet(ray, limit).is_some() {
                blocked = true;
            }
            if blocked { f32::NEG_INFINITY } else { limit }
        });
        blocked
    }

    /// Visits the triangles of every leaf nearer than the limit, nearer children first; the visitor returns the
    /// limit from then on, and a negative one ends the walk.
    #[inline(always)]
    fn walk(&self, ray: &Ray, mut limit: f32, mut visit: impl FnMut(&Triangle) -> f32) {
        let Some(mut node) = self.nodes.first().filter(|root| root.entry(ray, limit) < f32::INFINITY) else { return };
        let mut stack = [(0.0_f32, 0_u32); STACK];
        let mut depth = 0;
        loop {
            if node.count > 0 {
                for triangle in &self.triangles[node.first as usize..(node.first + node.count) as usize] {
                    limit = visit(triangle);
                }
            } else {
                let first = node.first as usize;
                let pair = &self.nodes[first..first + 2];
                let entries = [pair[0].entry(ray, limit), pair[1].entry(ray, limit)];
                let near = usize::from(entries[1] < entries[0]);
                if entries[1 - near] < f32::INFINITY {
                    stack[depth] = (entries[1 - near], (first + 1 - near) as u32);
                    depth += 1;
                }
                if entries[near] < f32::INFINITY {
                    node = &pair[near];
                    continue;
                }
            }
            loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                let (entry, next) = stack[depth];
                if entry <= limit {
                    node = &self.nodes[next as usize];
                    break;
                }
            }
        }
    }
}

impl Node {
    /// Where the ray enters the box, or infinity if it misses it or enters beyond the limit.
    #[inline(always)]
    fn entry(&self, ray: &Ray, limit: f32) -> f32 {
        let slab = |axis: usize| {
            let (o, i) = (ray.origin[axis], ray.inverse[axis]);
            let (a, b) = ((self.min[axis] - o) * i, (self.max[axis] - o) * i);
            (least(a, b), greatest(a, b))
        };
        let (x, y, z) = (slab(0), slab(1), slab(2));
        let enter = greatest(greatest(x.0, y.0), greatest(z.0, 0.0));
        // Two units in the last place more, so that rounding never loses a box (Ize 2013, "Robust BVH ray traversal").
        let leave = least(least(x.1, y.1), least(z.1, limit)) * 1.000_000_2;
        if enter <= leave { enter } else { f32::INFINITY }
    }
}

/// Minimum and maximum as one instruction each: unlike `f32::min`, they do not mind NaN, which cannot come here.
#[inline(always)]
fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greatest(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

impl Triangle {
    /// The hit between the ray's origin and the limit, if there is one; both sides of the triangle count.
    #[inline(always)]
    fn meet(&self, ray: &Ray, limit: f32) -> Option<Hit> {
        let [e1, e2] = self.edges;
        let p = ray.direction.cross(e2);
        let inverse = 1.0 / e1.dot(p);
        let from = ray.origin - self.corner;
        let u = from.dot(p) * inverse;
        let q = from.cross(e1);
        let v = ray.direction.dot(q) * inverse;
        let distance = e2.dot(q) * inverse;
        // A ray within the triangle's plane divides by zero; the NaN then fails these comparisons.
        let inside = u >= -EDGE_SLACK && v >= -EDGE_SLACK && u + v <= 1.0 + EDGE_SLACK;
        (inside && distance > 0.0 && distance < limit).then_some(Hit { distance, u, v, triangle: self.id })
    }
}

/// A triangle while the tree grows: its box and where it is kept.
#[derive(Debug, Clone, Copy)]
struct Part {
    min: Vec3,
    max: Vec3,
    slot: u32,
}

impl Part {
    /// Twice the middle of the box, which sorts like the middle.
    fn key(&self) -> Vec3 {
        self.min + self.max
    }
}

/// A stretch of parts that shall become the node at `node`.
struct Job {
    node: usize,
    from: usize,
    to: usize,
    depth: u32,
}

/// Grows the nodes over the parts, which it sorts so that each leaf's lie side by side.
fn grow(parts: &mut [Part]) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(parts.len());
    if parts.is_empty() {
        return nodes;
    }
    let empty = Node { min: [0.0; 3], first: 0, max: [0.0; 3], count: 0 };
    nodes.push(empty);
    let mut jobs = vec![Job { node: 0, from: 0, to: parts.len(), depth: 0 }];
    while let Some(Job { node, from, to, depth }) = jobs.pop() {
        let mine = &mut parts[from..to];
        let around = mine.iter().fold(Bounds::EMPTY, |b, p| b.union(Bounds { min: p.min, max: p.max }));
        nodes[node] = Node { min: around.min.to_array(), max: around.max.to_array(), ..empty };
        let Some(middle) = split(mine, half_area(around), depth) else {
            nodes[node].first = from as u32;
            nodes[node].count = (to - from) as u32;
            continue;
        };
        let first = nodes.len();
        nodes[node].first = first as u32;
        nodes.extend([empty, empty]);
        jobs.push(Job { node: first + 1, from: from + middle, to, depth: depth + 1 });
        jobs.push(Job { node: first, from, to: from + middle, depth: depth + 1 });
    }
    nodes
}

/// Half the surface of a box (m^2); 0 for the empty one.
fn half_area(b: Bounds) -> f32 {
    let d = (b.max - b.min).max(Vec3::ZERO);
    d.x * d.y + d.y * d.z + d.z * d.x
}

/// Sorts the parts into two groups and returns the length of the first, or `None` where a leaf is cheaper.
fn split(parts: &mut [Part], area: f32, depth: u32) -> Option<usize> {
    if parts.len() == 1 {
        return None;
    }
    let keys = parts.iter().fold(Bounds::EMPTY, |b, p| b.grown(p.key()));
    let cut = if depth < STEEP { best_cut(parts, keys) } else { None };
    match cut {
        Some(cut) if parts.len() > LEAF || NODE_COST * area + cut.cost < area * parts.len() as f32 => {
            Some(partition(parts, |p| cut.bin(p.key()) < cut.at))
        }
        None if parts.len() > LEAF => {
            // All keys in one place, or too deep: halve by count along the longest axis.
            let size = keys.max - keys.min;
            let axis = if size.x >= size.y.max(size.z) { 0 } else { 1 + usize::from(size.z > size.y) };
            let middle = parts.len() / 2;
            let order = |a: &Part, b: &Part| a.key()[axis].total_cmp(&b.key()[axis]).then(a.slot.cmp(&b.slot));
            parts.select_nth_unstable_by(middle, order);
            Some(middle)
        }
        _ => None,
    }
}

/// A plane between bins: parts in bins below `at` go left.
struct Cut {
    axis: usize,
    at: usize,
    /// Areas times counts of both sides (m^2).
    cost: f32,
    origin: f32,
    scale: f32,
}

impl Cut {
    fn bin(&self, key: Vec3) -> usize {
        bin(key[self.axis], self.origin, self.scale)
    }
}

#[inline(always)]
fn bin(key: f32, origin: f32, scale: f32) -> usize {
    (((key - origin) * scale) as usize).min(BINS - 1)
}

/// The cheapest plane over all axes, or `None` if all keys agree.
fn best_cut(parts: &[Part], keys: Bounds) -> Option<Cut> {
    let scale = (keys.max - keys.min).map(|d| if d > 0.0 { BINS as f32 / d } else { 0.0 });
    let scale = scale.map(|s| if s.is_finite() { s } else { 0.0 });
    let mut bins = [[(Bounds::EMPTY, 0_u32); BINS]; 3];
    for part in parts {
        let key = part.key();
        for (axis, bins) in bins.iter_mut().enumerate() {
            let (bounds, count) = &mut bins[bin(key[axis], keys.min[axis], scale[axis])];
            *bounds = bounds.union(Bounds { min: part.min, max: part.max });
            *count += 1;
        }
    }
    let mut best: Option<Cut> = None;
    for axis in (0..3).filter(|&axis| scale[axis] > 0.0) {
        let (at, cost) = cheapest(&bins[axis]);
        if best.as_ref().is_none_or(|b| cost < b.cost) {
            best = Some(Cut { axis, at, cost, origin: keys.min[axis], scale: scale[axis] });
        }
    }
    best
}

/// The cheapest place to cut one axis' bins. The outer bins are never empty, so neither side is.
fn cheapest(bins: &[(Bounds, u32); BINS]) -> (usize, f32) {
    let mut right = [0.0; BINS];
    let mut side = (Bounds::EMPTY, 0);
    for i in (1..BINS).rev() {
        side = (side.0.union(bins[i].0), side.1 + bins[i].1);
        right[i] = half_area(side.0) * side.1 as f32;
    }
    let mut best = (1, f32::INFINITY);
    let mut side = (Bounds::EMPTY, 0);
    for i in 1..BINS {
        side = (side.0.union(bins[i - 1].0), side.1 + bins[i - 1].1);
        let cost = half_area(side.0) * side.1 as f32 + right[i];
        if cost < best.1 {
            best = (i, cost);
        }
    }
    best
}

/// Moves the parts that satisfy `left` to the front and returns how many there are.
fn partition(parts: &mut [Part], left: impl Fn(&Part) -> bool) -> usize {
    let mut count = 0;
    for i in 0..parts.len() {
        if left(&parts[i]) {
            parts.swap(i, count);
            count += 1;
        }
    }
    count
}
