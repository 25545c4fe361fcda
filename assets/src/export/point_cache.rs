//! Point caches: the positions of all vertices in each frame, one file a mesh, read by Blender, Maya and Houdini beside a still
//! mesh of the same vertex order.
//!
//! MDD (NewTek's Motion Designer) is big endian: frames and points as 32-bit integers, the times of the frames (s), then the
//! positions of each frame in f32. PC2 (3ds Max' Point Cache 2) is little endian: a header of 32 bytes, then the same.

use std::io::{self, Write};

use glam::Vec3;

use super::frame_rate::FrameRate;

/// A format of point caches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CacheFormat {
    /// MDD, big endian.
    Mdd,
    /// PC2, little endian.
    Pc2,
}

/// A point cache being written, frame by frame.
#[derive(Debug)]
pub struct PointCache<W> {
    out: W,
    format: CacheFormat,
    points: usize,
    left: usize,
    bytes: Vec<u8>,
}

impl<W: Write> PointCache<W> {
    /// Writes the header of a cache of so many points in each of `rate.frames` frames.
    ///
    /// # Errors
    /// An error of the output.
    pub fn begin(mut out: W, format: CacheFormat, points: usize, rate: FrameRate) -> io::Result<Self> {
        let count = |n: usize| u32::try_from(n).map_err(|_| io::Error::other("it has more than 2^32 points or frames"));
        let (frames, number) = (count(rate.frames)?, count(points)?);
        let mut head = Vec::new();
        match format {
            CacheFormat::Mdd => {
                [frames, number].into_iter().for_each(|n| head.extend(n.to_be_bytes()));
                (0..rate.frames).for_each(|f| head.extend(rate.time(f).to_be_bytes()));
            }
            CacheFormat::Pc2 => {
                head.extend(b"POINTCACHE2\0");
                head.extend(1u32.to_le_bytes());
                head.extend(number.to_le_bytes());
                // The first frame, and how many frames lie between two samples.
                [0.0f32, 1.0].into_iter().for_each(|x| head.extend(x.to_le_bytes()));
                head.extend(frames.to_le_bytes());
            }
        }
        out.write_all(&head)?;
        Ok(Self { out, format, points, left: rate.frames, bytes: Vec::with_capacity(12 * points) })
    }

    /// Writes the next frame: positions (m) `[points]`.
    ///
    /// # Errors
    /// What the output says, and a frame that the header does not announce.
    pub fn add(&mut self, positions: &[Vec3]) -> io::Result<()> {
        if positions.len() != self.points || self.left == 0 {
            return Err(io::Error::other("it gets other frames than its header says"));
        }
        self.left -= 1;
        self.bytes.clear();
        let numbers = positions.iter().flat_map(|p| p.to_array());
        match self.format {
            CacheFormat::Mdd => self.bytes.extend(numbers.flat_map(f32::to_be_bytes)),
            CacheFormat::Pc2 => self.bytes.extend(numbers.flat_map(f32::to_le_bytes)),
        }
        self.out.write_all(&self.bytes)
    }

    /// Ends the cache.
    ///
    /// # Errors
    /// An error of the output, or missing frames.
    pub fn finish(mut self) -> io::Result<()> {
        if self.left > 0 {
            return Err(io::Error::other(format!("{} frames are missing", self.left)));
        }
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: FrameRate = FrameRate { frames: 3, hz: 30.0 };

    fn frame(k: usize) -> [Vec3; 2] {
        [Vec3::new(k as f32, 1.0 / 3.0, -0.0), Vec3::new(-2.5e-7, 123.456_79, k as f32 * 0.1)]
    }

    fn written(format: CacheFormat) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut cache = PointCache::begin(&mut bytes, format, 2, RATE).unwrap();
        (0..3).for_each(|k| cache.add(&frame(k)).unwrap());
        assert!(cache.add(&frame(3)).is_err(), "a frame too many");
        cache.finish().unwrap();
        bytes
    }

    /// A reader by the formats' descriptions: header, then the bits of all numbers.
    fn bits(bytes: &[u8], big: bool) -> Vec<u32> {
        let word = |b: &[u8]| {
            if big { u32::from_be_bytes(b.try_into().unwrap()) } else { u32::from_le_bytes(b.try_into().unwrap()) }
        };
        bytes.chunks_exact(4).map(word).collect()
    }

    #[test]
    fn mdd_has_counts_times_and_the_bits_of_all_positions() {
        let bytes = written(CacheFormat::Mdd);
        let words = bits(&bytes, true);
        assert_eq!(words[..2], [3, 2]);
        assert_eq!(words[2..5], [0.0f32, 1.0 / 30.0, 2.0 / 30.0].map(f32::to_bits));
        let all: Vec<u32> = (0..3).flat_map(frame).flat_map(|p| p.to_array()).map(f32::to_bits).collect();
        assert_eq!(words[5..], all);
    }

    #[test]
    fn pc2_has_its_header_and_the_bits_of_all_positions() {
        let bytes = written(CacheFormat::Pc2);
        assert_eq!(&bytes[..12], b"POINTCACHE2\0");
        let words = bits(&bytes[12..], false);
        assert_eq!(words[..5], [1, 2, 0, 1.0f32.to_bits(), 3]);
        let all: Vec<u32> = (0..3).flat_map(frame).flat_map(|p| p.to_array()).map(f32::to_bits).collect();
        assert_eq!(words[5..], all);
    }

    #[test]
    fn a_cache_that_is_cut_short_is_an_error() {
        let mut cache = PointCache::begin(Vec::new(), CacheFormat::Pc2, 2, RATE).unwrap();
        assert!(cache.add(&frame(0)[..1]).is_err(), "a point is missing");
        cache.add(&frame(0)).unwrap();
        assert!(cache.finish().unwrap_err().to_string().contains("2 frames"));
    }
}
