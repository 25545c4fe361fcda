//! A seam: a run of edges of one panel sewn to a run of edges of another, or of its own.

use super::panel::Panel;

/// A run of edges along an outline, in the direction of sewing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SeamSide {
    /// Index of the panel.
    pub panel: usize,
    /// The first edge of the run in the direction of the outline.
    pub first: usize,
    /// Number of edges; the run may pass the end of the list and go on at its beginning.
    pub count: usize,
    /// True where sewing begins at the end of the run and goes against the outline.
    pub reversed: bool,
}

impl SeamSide {
    /// The edges in the order of sewing, in a panel of `edges` edges.
    pub fn run(&self, edges: usize) -> impl Iterator<Item = usize> {
        let Self { first, count, reversed, .. } = *self;
        (0..count).map(move |i| (first + if reversed { count - 1 - i } else { i }) % edges)
    }

    /// Length of the run (m).
    pub fn length(&self, panels: &[Panel]) -> f64 {
        let lengths = panels[self.panel].lengths();
        self.run(lengths.len()).map(|e| lengths[e]).sum()
    }
}

/// Two runs of edges that are sewn together from their beginnings to their ends. They may differ in length: the longer
/// one is gathered evenly.
#[derive(Debug, Clone, PartialEq)]
pub struct Seam {
    /// How messages name it.
    pub name: String,
    /// The two runs of edges, sewn from beginning to beginning.
    pub sides: [SeamSide; 2],
}
