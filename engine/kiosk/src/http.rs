//! The little of HTTP/1.1 (RFC 9112) that is spoken here: a request of bounded length is read for a bounded time.

use std::io::{self, Read};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Longest request (bytes).
pub const MOST_BYTES: usize = 2048;

/// Longest time that a request may take.
pub const LONGEST: Duration = Duration::from_secs(1);

/// Reads a request up to its empty line.
///
/// # Errors
/// One that is too long, takes too long or ends before its time.
pub fn read_request(stream: &mut TcpStream) -> io::Result<Vec<u8>> {
    let end = Instant::now() + LONGEST;
    let mut bytes = Vec::with_capacity(MOST_BYTES);
    while !bytes.windows(4).any(|w| w == b"\r\n\r\n") {
        let left = end.saturating_duration_since(Instant::now());
        if left.is_zero() || bytes.len() >= MOST_BYTES {
            return Err(io::ErrorKind::InvalidData.into());
        }
        stream.set_read_timeout(Some(left))?;
        let mut some = [0; 512];
        match stream.read(&mut some)? {
            0 => return Err(io::ErrorKind::UnexpectedEof.into()),
            n => bytes.extend_from_slice(&some[..n]),
        }
    }
    Ok(bytes)
}
