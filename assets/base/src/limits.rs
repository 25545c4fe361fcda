//! Every capacity and every rate of the engine: a named constant, its unit and its reason.

/// Physics steps a second: fast enough that a hand at 6 m/s moves 5 cm a step, the radius of a wrist.
pub const STEP_HZ: u32 = 120;

/// Length of one step (s). Derived from [`STEP_HZ`]; time itself is counted in `u64` ticks.
pub const STEP_SECONDS: f32 = 1.0 / STEP_HZ as f32;

/// Collision spheres a body carries: each end of every capsule may have its own. They are moved once a step; contact pays
/// for capsules alone.
pub const MAX_SPHERES: usize = 2 * MAX_CAPSULES;

/// Tapered capsules between those spheres: what a body with head, hands and feet needs. A bit of 32 names one, and rows
/// of 32 are whole lanes of every width: the last four cost nothing where nothing is near them.
pub const MAX_CAPSULES: usize = 32;

/// Garments that one body wears at once: the eight layers of Ugur 2008, from underwear to an overcoat.
pub const MAX_GARMENTS: usize = 10;

/// Garments of one scene file: as many skirts side by side as the largest benchmark has.
pub const MAX_SCENE_GARMENTS: usize = 64;

/// Vertices of all garments of one scene file. Each takes some 700 bytes baked and in motion, so that a scene stays below a
/// gigabyte; at the engine's rate a step of so many takes a second.
pub const MAX_SCENE_VERTICES: usize = 1 << 20;

/// Planes beside the floor: the four walls of a changing room.
pub const MAX_PLANES: usize = 4;

/// Bone influences a vertex: four weights fill one 128-bit lane group.
pub const INFLUENCES: usize = 4;

/// Bone influences a vertex of an import: the two sets of four that glTF files carry.
pub const MAX_INFLUENCES: usize = 8;

/// Confidence below which a joint is not believed (0..1); Gultepe 2013, section 4.2.
pub const CONFIDENCE_GATE: f32 = 0.5;

/// Most vertices of an imported body: seventeen times the mannequin's, and more than any avatar made for real time;
/// beyond it skinning alone would take a tenth of the frame.
pub const MAX_BODY_VERTICES: usize = 250_000;

/// Most joints and other nodes of an imported body: ten times those of the largest face rigs.
pub const MAX_BODY_NODES: usize = 8_192;

/// Largest file of an imported body that is read (bytes): avatars carry their pictures with them.
pub const MAX_BODY_BYTES: u64 = 256 << 20;

/// Bone influences of a vertex that imports read before they keep [`INFLUENCES`]: two glTF attribute sets.
pub const IMPORT_INFLUENCES: usize = 8;

/// Most pixels of a depth image: four times the largest sensor in sale (1 megapixel).
pub const MAX_PIXELS: u64 = 4_194_304;

/// Longest side of a depth image (px): no sensor is wider, and it keeps width * height within `u32`.
pub const MAX_SIDE: u32 = 8_192;

/// Farthest coordinate that a recording may hold (m): a room, with room to spare.
pub const MAX_COORDINATE: f32 = 100.0;
