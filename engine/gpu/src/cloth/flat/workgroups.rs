//! Workgroups of a dispatch, and where a garment lies in a scene.

/// Invocations of a workgroup: the least that fills the vectors of every GPU of today, which are 32 or 64 wide.
pub const WIDTH: u32 = 64;

/// Where a garment lies in the scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GarmentSpan {
    /// Its number among the garments as they lie.
    pub garment: u32,
    /// Index of its first particle.
    pub first: u32,
    /// Number of its particles.
    pub len: u32,
}

/// The workgroups of a dispatch, garment after garment: the first garments' alone are a prefix.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Workgroups {
    /// Garment, first item, number of items, and what else the kernel wants to know.
    pub groups: Vec<[u32; 4]>,
    /// Workgroups of the first so many garments and one `[garments]`.
    ends: Vec<u32>,
}

impl Workgroups {
    /// From here on they are this garment's.
    pub fn begin(&mut self, garment: u32) {
        self.ends.resize(garment as usize + 1, self.groups.len() as u32);
    }

    /// Appends one of the garment that has begun.
    pub fn push(&mut self, group: [u32; 4]) {
        self.groups.push(group);
        if let Some(end) = self.ends.last_mut() {
            *end = self.groups.len() as u32;
        }
    }

    /// Appends what so many items of a garment need.
    pub fn add(&mut self, garment: u32, first: u32, count: u32, what: u32) {
        self.begin(garment);
        for at in (0..count).step_by(WIDTH as usize) {
            self.push([garment, first + at, (count - at).min(WIDTH), what]);
        }
    }

    /// The same without those of some garments `[garments]`.
    pub fn without(&self, some: &[bool]) -> Self {
        let (mut kept, mut from) = (Self::default(), 0);
        for (garment, end) in self.ends.iter().enumerate() {
            kept.begin(garment as u32);
            let groups = &self.groups[from..*end as usize];
            groups.iter().filter(|_| !some[garment]).for_each(|group| kept.push(*group));
            from = *end as usize;
        }
        kept
    }

    /// Workgroups of the first so many garments.
    pub fn of(&self, garments: usize) -> u32 {
        let last = garments.min(self.ends.len());
        if last == 0 { 0 } else { self.ends[last - 1] }
    }
}
