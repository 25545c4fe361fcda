//! An edge that carries a constraint, and a fiber: a chain of them.

use toile_base::garment::Direction;

/// An edge that carries a constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Smaller vertex index.
    pub a: u32,
    /// Larger vertex index.
    pub b: u32,
    /// Length as cut (m).
    pub rest: f32,
    /// Width of the strip of cloth that the edge stands for (m): its share of the faces beside it over its length. The
    /// warp edges of a grid together stand for the whole cloth, and so do the weft edges; a diagonal has the width
    /// that [`Edge::angle`] and the formula of [`stiffness`](crate::stiffness) ask for.
    pub width: f32,
    /// Its direction by angle: within 30 degrees of the warp, within 30 of the weft, or between. What strain is
    /// measured by; a fiber that the edge belongs to has its own.
    pub direction: Direction,
    /// Direction from `a` to `b` within the cloth (rad): 0 down the warp, a quarter turn along the weft.
    pub angle: f32,
    /// False for a quad's diagonals, which are no side of any face and join neither warp nor weft fibers.
    pub side: bool,
}

/// A chain of edges. A closed hoop repeats its first vertex at its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Fiber {
    /// Which way it runs; single edges of it may lean as far as 60 degrees, one that it hangs by 75.
    pub direction: Direction,
    /// Vertices in order: one more than edges.
    pub vertices: Vec<u32>,
    /// Indices of the edges in order.
    pub edges: Vec<u32>,
}

impl Fiber {
    /// True where the fiber closes on itself.
    pub fn is_hoop(&self) -> bool {
        self.edges.len() > 2 && self.vertices.first() == self.vertices.last()
    }

    /// True for a single edge, which continues none and is continued by none.
    pub fn is_loose(&self) -> bool {
        self.edges.len() == 1
    }

    /// The pieces of the fiber that can move: links between two fixed vertices are left out. Each piece starts at a
    /// fixed end if it has one, so that a sweep runs from the support outwards; a hoop with a fixed vertex starts there.
    pub fn split_at_pins(&self, fixed: &[bool]) -> Vec<Self> {
        let whole = self.turned_to_pin(fixed);
        let pinned = |v: u32| fixed[v as usize];
        let mut pieces = Vec::new();
        let mut start = 0;
        for link in 0..=whole.edges.len() {
            let breaks =
                link == whole.edges.len() || (pinned(whole.vertices[link]) && pinned(whole.vertices[link + 1]));
            if breaks {
                if link > start {
                    let mut piece = Self {
                        direction: whole.direction,
                        vertices: whole.vertices[start..=link].to_vec(),
                        edges: whole.edges[start..link].to_vec(),
                    };
                    if !pinned(piece.vertices[0]) && pinned(piece.vertices[link - start]) {
                        piece.vertices.reverse();
                        piece.edges.reverse();
                    }
                    pieces.push(piece);
                }
                start = link + 1;
            }
        }
        pieces
    }

    /// A hoop may begin anywhere: with a fixed vertex in front no piece of it is cut in two by where it began.
    fn turned_to_pin(&self, fixed: &[bool]) -> Self {
        let mut turned = self.clone();
        if !self.is_hoop() {
            return turned;
        }
        if let Some(at) = self.vertices.iter().position(|&v| fixed[v as usize]) {
            turned.vertices.pop();
            turned.vertices.rotate_left(at);
            turned.vertices.push(turned.vertices[0]);
            turned.edges.rotate_left(at);
        }
        turned
    }
}
