//! Chunks of a session that another tool has packed with zstd, unpacked within bounds.

use std::io::Read;

use mcap::sans_io::decompressor::{DecompressResult, Decompressor};
use mcap::{McapError, McapResult};
use ruzstd::decoding::StreamingDecoder;

use crate::limits::{MAX_CHUNK_BYTES, MAX_FILE_BYTES};

/// A chunk packed with zstd: all of it is asked for and unpacked at once, and handed out from there.
#[derive(Default)]
pub(super) struct Zstd {
    unpacked: Vec<u8>,
    /// Bytes of it that were handed out.
    given: usize,
    /// Bytes of all chunks so far.
    total: u64,
}

impl Zstd {
    fn unpack(&mut self, packed: &[u8]) -> Result<(), String> {
        let broken = || "corrupt: a chunk cannot be unpacked".to_owned();
        let window = MAX_CHUNK_BYTES as u64;
        let decoder = StreamingDecoder::new_with_max_window_size(packed, window).map_err(|_| broken())?;
        decoder.take(window + 1).read_to_end(&mut self.unpacked).map_err(|_| broken())?;
        if self.unpacked.len() > MAX_CHUNK_BYTES {
            return Err(format!("a chunk unpacks to more than {MAX_CHUNK_BYTES} bytes"));
        }
        self.total += self.unpacked.len() as u64;
        if self.total > MAX_FILE_BYTES {
            return Err(format!("its chunks unpack to more than {MAX_FILE_BYTES} bytes"));
        }
        Ok(())
    }
}

impl Decompressor for Zstd {
    /// All that is left of the chunk.
    fn next_read_size(&self) -> usize {
        usize::MAX
    }

    fn decompress(&mut self, src: &[u8], dst: &mut [u8]) -> McapResult<DecompressResult> {
        if !src.is_empty() {
            self.unpack(src).map_err(McapError::DecompressionError)?;
        }
        let wrote = dst.len().min(self.unpacked.len() - self.given);
        dst[..wrote].copy_from_slice(&self.unpacked[self.given..][..wrote]);
        self.given += wrote;
        Ok(DecompressResult { consumed: src.len(), wrote })
    }

    fn reset(&mut self) -> McapResult<()> {
        (self.unpacked, self.given) = (Vec::new(), 0);
        Ok(())
    }

    fn name(&self) -> &'static str {
        "zstd"
    }
}
