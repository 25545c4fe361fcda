//! A drafted garment: its panels, the seams between their edges, and its finished girths.

use super::panel::DraftPanel;

/// One side of a seam: a panel and the label of an edge.
pub type DraftSeamSide = (&'static str, String);

/// A garment as it is drafted for one body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DraftGarment {
    /// Its panels.
    pub panels: Vec<DraftPanel>,
    /// Its seams, edge to edge.
    pub seams: Vec<[DraftSeamSide; 2]>,
    /// Finished girths at chest, waist and hip (m), where it is judged there.
    pub girths: [Option<f64>; 3],
}

impl DraftGarment {
    /// A garment of panels that are not sewn yet.
    pub fn of(panels: impl IntoIterator<Item = DraftPanel>) -> Self {
        Self { panels: panels.into_iter().collect(), ..Self::default() }
    }

    /// Sews an edge to another.
    pub fn sew(&mut self, one: (&'static str, &str), other: (&'static str, &str)) {
        self.seams.push([one, other].map(|(panel, label)| (panel, label.to_owned())));
    }

    /// Sews edges of the same labels of two panels.
    pub fn sew_alike(&mut self, one: &'static str, other: &'static str, labels: &[&str]) {
        labels.iter().for_each(|label| self.sew((one, label), (other, label)));
    }

    /// A panel by its name.
    pub fn panel(&self, name: &str) -> Option<&DraftPanel> {
        self.panels.iter().find(|p| p.name == name)
    }

    /// Length of one side of a seam (m).
    pub fn length(&self, side: &DraftSeamSide) -> f64 {
        self.panel(side.0).map_or(0.0, |panel| panel.length(&side.1))
    }
}
