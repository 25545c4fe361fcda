//! Quality of a rasterised picture.

/// Most directions that light is followed along in one picture: what a uniform block of 16 KiB has room for.
pub const MOST_BEAMS: u32 = 112;

/// What a picture is drawn with. Lamps and sky are taken apart into beams, parallel lights with a depth map each: one
/// beam of a lamp gives a shadow whose edge is as soft everywhere, many the shadow of its disc.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RenderQuality {
    /// Samples a pixel along edges: 1 or 4, which every driver has.
    pub samples: u32,
    /// Beams of the key lamp, at least 1.
    pub key: u32,
    /// Beams of the rim lamp; without any it throws no shadow.
    pub rim: u32,
    /// Beams of the sky, from all around; without any nothing is darker in hollows or under the feet.
    pub sky: u32,
    /// Width and height of a beam's depth map (texels).
    pub tile: u32,
    /// Whether ambient occlusion is found a vertex and not a pixel: a body has fewer vertices than pixels.
    pub by_vertex: bool,
    /// Whether threads are drawn. They are finer than a pixel unless the picture has more than about 1,500 rows.
    pub weave: bool,
}

impl RenderQuality {
    /// A live picture drawn by the processor, beside physics.
    pub const LOW: Self = Self { samples: 1, key: 1, rim: 0, sky: 5, tile: 192, by_vertex: true, weave: false };

    /// A live picture drawn by graphics hardware.
    pub const HIGH: Self = Self { samples: 4, key: 12, rim: 6, sky: 40, tile: 384, by_vertex: false, weave: true };

    /// A still, with everything switched on.
    pub const STILL: Self = Self { samples: 4, key: 24, rim: 12, sky: 76, tile: 384, by_vertex: false, weave: true };

    /// The live picture that suits an adapter.
    pub const fn live(software: bool) -> Self {
        if software { Self::LOW } else { Self::HIGH }
    }

    /// The same within what can be drawn: counts beyond [`MOST_BEAMS`] are taken from the sky first.
    #[must_use]
    pub fn within_limits(self, most_texture: u32) -> Self {
        let key = self.key.clamp(1, MOST_BEAMS);
        let rim = self.rim.min(MOST_BEAMS - key);
        let sky = self.sky.min(MOST_BEAMS - key - rim);
        let columns = columns(key + rim + sky);
        let tile = self.tile.clamp(16, (most_texture / columns).max(16));
        Self { samples: if self.samples > 1 { 4 } else { 1 }, key, rim, sky, tile, ..self }
    }

    /// Beams of all lights.
    pub const fn beams(&self) -> u32 {
        self.key + self.rim + self.sky
    }

    /// Depth maps lie side by side in one texture, as many a row as there are rows at least.
    pub(super) fn grid(&self) -> (u32, u32) {
        let columns = columns(self.beams());
        (columns, self.beams().div_ceil(columns))
    }
}

/// The least square that has room for so many.
fn columns(count: u32) -> u32 {
    (1..).find(|n| n * n >= count).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_within_the_limits_of_every_driver() {
        for quality in [RenderQuality::LOW, RenderQuality::HIGH] {
            assert_eq!(quality.within_limits(4096), quality);
        }
        assert_eq!(RenderQuality::STILL.within_limits(8192), RenderQuality::STILL);
        let small = RenderQuality::STILL.within_limits(2048);
        let (columns, rows) = small.grid();
        assert!(columns * small.tile <= 2048 && rows <= columns && small.tile >= 128, "{small:?}");
    }

    #[test]
    fn too_much_is_cut_down_and_nothing_is_made_enough() {
        let greedy =
            RenderQuality { samples: 16, key: 1000, rim: 5, sky: 5, tile: 9000, by_vertex: false, weave: true }
                .within_limits(8192);
        assert_eq!((greedy.samples, greedy.key, greedy.rim, greedy.sky), (4, MOST_BEAMS, 0, 0));
        assert!(greedy.tile * greedy.grid().0 <= 8192);
        let none = RenderQuality { samples: 0, key: 0, rim: 0, sky: 0, tile: 0, by_vertex: false, weave: false }
            .within_limits(2048);
        assert_eq!((none.samples, none.key, none.tile), (1, 1, 16));
    }
}
