//! A tree of boxes over triangles, for what is nearest.

use glam::DVec3;

/// Triangles of a leaf, at most.
const LEAF: usize = 4;

/// A box along the axes (m) and what is in it.
#[derive(Debug, Clone, Copy)]
struct TreeNode {
    low: DVec3,
    high: DVec3,
    /// Of a leaf its first triangle in the tree's order; of others the second child, the first being the next node.
    first: u32,
    /// Triangles of a leaf; 0 for others.
    count: u32,
}

impl TreeNode {
    /// Square of the distance to a point (m2).
    fn distance2(&self, p: DVec3) -> f64 {
        p.clamp(self.low, self.high).distance_squared(p)
    }
}

/// The tree: every node before its children.
#[derive(Debug)]
pub(super) struct TriangleTree {
    nodes: Vec<TreeNode>,
    order: Vec<u32>,
}

impl TriangleTree {
    /// Over some triangles by their corners.
    pub fn new(corners: &[[DVec3; 3]]) -> Self {
        let mut this = Self { nodes: Vec::new(), order: (0..corners.len() as u32).collect() };
        if !corners.is_empty() {
            this.split(corners, 0, corners.len());
        }
        this
    }

    /// Adds the node of a range of triangles and all below it: halves at the median along the longest side.
    fn split(&mut self, corners: &[[DVec3; 3]], from: usize, to: usize) {
        let points = || self.order[from..to].iter().flat_map(|&t| corners[t as usize]);
        let low = points().fold(DVec3::INFINITY, DVec3::min);
        let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
        let node = self.nodes.len();
        self.nodes.push(TreeNode { low, high, first: from as u32, count: (to - from) as u32 });
        if to - from <= LEAF {
            return;
        }
        let size = high - low;
        let axis = (0..3).fold(0, |most, axis| if size[axis] > size[most] { axis } else { most });
        let centre = |t: &u32| corners[*t as usize].iter().map(|p| p[axis]).sum::<f64>();
        let middle = (from + to) / 2;
        self.order[from..to].select_nth_unstable_by(middle - from, |a, b| centre(a).total_cmp(&centre(b)));
        self.split(corners, from, middle);
        let second = self.nodes.len() as u32;
        self.split(corners, middle, to);
        (self.nodes[node].first, self.nodes[node].count) = (second, 0);
    }

    /// Calls for each triangle that may be nearer to a point than `nearest2` (m2), which the call makes smaller.
    pub fn each_nearer(&self, p: DVec3, nearest2: &mut f64, mut call: impl FnMut(u32, &mut f64)) {
        let mut waiting = vec![0u32];
        while let Some(at) = waiting.pop() {
            let Some(node) = self.nodes.get(at as usize).filter(|node| node.distance2(p) < *nearest2) else { continue };
            if node.count > 0 {
                let triangles = &self.order[node.first as usize..(node.first + node.count) as usize];
                triangles.iter().for_each(|&t| call(t, nearest2));
                continue;
            }
            let children = [at + 1, node.first];
            let far = |child: u32| self.nodes[child as usize].distance2(p);
            // The nearer child is looked at first.
            waiting.extend(if far(children[0]) < far(children[1]) { [children[1], children[0]] } else { children });
        }
    }
}
