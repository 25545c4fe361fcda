//! Stretch curves of links with more than one slope, as they lie in memory: knees, slopes and friction of each.

/// Stretch curves of the links of one kind, one number a place of their parameters; empty where one slope is all that they have. Strains are
/// of the link's own length, slopes are over its own.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CurveTable {
    /// Strain at the lower knee (1).
    pub lower: Box<[f32]>,
    /// Slope below it, over the link's (1).
    pub lower_slope: Box<[f32]>,
    /// Strain at the upper knee (1).
    pub upper: Box<[f32]>,
    /// Slope above it, over the link's (1).
    pub upper_slope: Box<[f32]>,
    /// Strain at which the link would carry what its friction can hold (1); 0 where nothing rubs.
    pub friction: Box<[f32]>,
}

/// Curve of one link, in the order of [`CurveTable`]'s columns.
pub type CurveParameters = [f32; 5];

/// A strain that no link has (1).
const FAR: f32 = 1e6;

/// A curve of one slope.
pub const ONE_SLOPE: CurveParameters = [-FAR, 1.0, FAR, 1.0, 0.0];

impl CurveTable {
    /// Of some links.
    pub fn new(link_curves: &(impl Iterator<Item = CurveParameters> + Clone)) -> Self {
        let column = |k: usize| link_curves.clone().map(|link_curve| link_curve[k]).collect();
        Self { lower: column(0), lower_slope: column(1), upper: column(2), upper_slope: column(3), friction: column(4) }
    }

    /// Places that it has.
    pub fn len(&self) -> usize {
        self.lower.len()
    }

    /// Whether one slope is all.
    pub fn is_empty(&self) -> bool {
        self.lower.is_empty()
    }
}

/// Stretch curves of all links of a garment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinkCurves {
    /// Of fibers along the bias.
    pub diagonals: CurveTable,
    /// Of shear links.
    pub shear: CurveTable,
    /// Of weft links.
    pub weft: CurveTable,
    /// Of warp fibers.
    pub fibers: CurveTable,
    /// Of fibers by index list.
    pub crossing: CurveTable,
}

impl LinkCurves {
    /// The tables, in the order of the fields.
    pub fn tables(&self) -> [&CurveTable; 5] {
        [&self.diagonals, &self.shear, &self.weft, &self.fibers, &self.crossing]
    }

    /// Whether any link has more than one slope.
    pub fn acts(&self) -> bool {
        self.tables().iter().any(|t| !t.is_empty())
    }

    /// Memory that they hold (bytes).
    pub fn bytes(&self) -> usize {
        self.tables().iter().map(|t| t.len() * size_of::<CurveParameters>()).sum()
    }
}
