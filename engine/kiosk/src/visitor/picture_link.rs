//! Picture link: a picture at full size, served on the shop's own network for two minutes or until it is forgotten. Its name cannot be
//! guessed and is used once. No port is open before a picture is asked for, nor after it is gone.
//!
//! One connection at a time, on a thread of its own: two kilobytes and a second a request, sixteen answers a picture. There is no encryption: a listener
//! on that network sees the shopper's mannequin, without a name.

use std::io::{self, ErrorKind, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread;
use std::time::{Duration, Instant};

use toile_engine::frame_loop::thread_roles::{self, ThreadRole};

use crate::http::{LONGEST, read_request};

/// How long a picture is served.
pub const SERVED: Duration = Duration::from_secs(120);

/// Most answers to requests for one picture: a phone looks, loads and saves it, some of them twice.
const MOST_ANSWERS: usize = 16;

/// Random bytes of a name: 128 bits, too many to try out in two minutes.
const NAME_BYTES: usize = 16;

/// Time between two checks for a request and for a forgotten picture.
const LOOK: Duration = Duration::from_millis(30);

/// Bytes that are written between two looks at whether the picture is forgotten.
const PIECE: usize = 16 << 10;

/// A picture that is served until this is dropped, and for [`SERVED`] at most.
#[derive(Debug)]
pub struct PictureServer {
    url: String,
    forgotten: Arc<AtomicBool>,
}

impl PictureServer {
    /// Serves a PNG at this address. The address is bound when this returns.
    ///
    /// # Errors
    /// An address that is not this machine's or is taken, no thread, no random bytes.
    pub fn start(address: SocketAddr, png: Vec<u8>) -> io::Result<Self> {
        Self::start_for(address, png, SERVED)
    }

    fn start_for(address: SocketAddr, png: Vec<u8>, length: Duration) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let path = format!("/{}.png", name()?);
        let url = format!("http://{}{path}", listener.local_addr()?);
        let forgotten = Arc::new(AtomicBool::new(false));
        let mut served = ServedPicture { path, png, forgotten: forgotten.clone(), ends: Instant::now() + length };
        let serve = move || {
            thread_roles::apply(ThreadRole::Service);
            served.serve(&listener);
        };
        thread::Builder::new().name("toile-picture".into()).spawn(serve)?;
        Ok(Self { url, forgotten })
    }

    /// Where the picture is: for a code, and for nothing else.
    pub fn url(&self) -> &str {
        &self.url
    }
}

impl Drop for PictureServer {
    fn drop(&mut self) {
        // Relaxed: a flag that stands for itself. The thread sees it within one look or one piece.
        self.forgotten.store(true, Relaxed);
    }
}

/// A name that is used once.
fn name() -> io::Result<String> {
    let mut bytes = [0; NAME_BYTES];
    getrandom::fill(&mut bytes).map_err(io::Error::other)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

struct ServedPicture {
    path: String,
    png: Vec<u8>,
    forgotten: Arc<AtomicBool>,
    ends: Instant,
}

impl ServedPicture {
    fn is_over(&self) -> bool {
        self.forgotten.load(Relaxed) || Instant::now() >= self.ends
    }

    fn serve(&mut self, listener: &TcpListener) {
        let mut answers = 0;
        while !self.is_over() && answers < MOST_ANSWERS {
            match listener.accept() {
                // A client that goes away before the answer has no use for it.
                Ok((stream, _)) => answers += usize::from(self.answer(stream).unwrap_or(false)),
                Err(e) if e.kind() == ErrorKind::WouldBlock => thread::sleep(LOOK),
                // The other end hung up while it waited, or a file more than the system gives: later.
                Err(_) => thread::sleep(LOOK),
            }
        }
        self.png.fill(0);
    }

    /// Answers one request; says whether it was for the picture.
    fn answer(&self, mut stream: TcpStream) -> io::Result<bool> {
        stream.set_nonblocking(false)?;
        stream.set_write_timeout(Some(LONGEST))?;
        let request = read_request(&mut stream)?;
        let mut words = request.split(|b| *b == b' ');
        let (method, path) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        let has_body = match method {
            b"GET" => true,
            b"HEAD" => false,
            _ => return refuse(&mut stream, "405 Method Not Allowed").map(|()| false),
        };
        if path != self.path.as_bytes() {
            return refuse(&mut stream, "404 Not Found").map(|()| false);
        }
        let head = format!(
            "HTTP/1.1 200 OK\r\nContent-Type: image/png\r\nContent-Length: {}\r\nContent-Disposition: inline; \
             filename=\"fitting.png\"\r\nCache-Control: no-store\r\nReferrer-Policy: no-referrer\r\nConnection: close\r\n\r\n",
            self.png.len()
        );
        stream.write_all(head.as_bytes())?;
        if has_body {
            for piece in self.png.chunks(PIECE) {
                if self.is_over() {
                    break;
                }
                stream.write_all(piece)?;
            }
        }
        Ok(has_body)
    }
}

fn refuse(stream: &mut TcpStream, status: &str) -> io::Result<()> {
    let head = format!("HTTP/1.1 {status}\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    stream.write_all(head.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;
    use std::net::Ipv4Addr;

    const ANY: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 0);

    fn png() -> Vec<u8> {
        (0..100_000_u32).map(|i| (i % 251) as u8).collect()
    }

    /// Where a server listens, and the path of its picture.
    fn parts(server: &PictureServer) -> (SocketAddr, String) {
        let rest = server.url().strip_prefix("http://").unwrap();
        let (address, name) = rest.split_once('/').unwrap();
        (address.parse().unwrap(), format!("/{name}"))
    }

    fn ask(address: SocketAddr, request: &str) -> io::Result<Vec<u8>> {
        let mut stream = TcpStream::connect(address)?;
        stream.set_read_timeout(Some(Duration::from_secs(20)))?;
        stream.write_all(request.as_bytes())?;
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer)?;
        Ok(answer)
    }

    fn get(address: SocketAddr, path: &str) -> io::Result<Vec<u8>> {
        ask(address, &format!("GET {path} HTTP/1.1\r\nHost: here\r\n\r\n"))
    }

    /// Waits until no server answers there any more.
    fn wait_until_closed(address: SocketAddr) {
        let end = Instant::now() + Duration::from_secs(30);
        while TcpStream::connect(address).is_ok() {
            assert!(Instant::now() < end, "it still listens");
            thread::sleep(LOOK);
        }
    }

    #[test]
    fn only_the_name_gives_the_picture() {
        let server = PictureServer::start(ANY, png()).unwrap();
        let (address, path) = parts(&server);
        let answer = get(address, &path).unwrap();
        assert!(answer.starts_with(b"HTTP/1.1 200 OK") && answer.ends_with(&png()));
        let text = String::from_utf8_lossy(&answer[..400]).into_owned();
        assert!(
            text.contains("image/png") && text.contains("no-store") && text.contains("Content-Length: 100000"),
            "{text}"
        );
        let head = ask(address, &format!("HEAD {path} HTTP/1.1\r\n\r\n")).unwrap();
        assert!(head.ends_with(b"\r\n\r\n") && head.len() < 400);
        for (request, status) in [
            ("GET / HTTP/1.1\r\n\r\n".to_owned(), "404"),
            (format!("GET {}0 HTTP/1.1\r\n\r\n", &path[..path.len() - 5]), "404"),
            (format!("POST {path} HTTP/1.1\r\n\r\n"), "405"),
        ] {
            let answer = ask(address, &request).unwrap();
            assert!(String::from_utf8_lossy(&answer).contains(status), "{request}");
        }
    }

    #[test]
    fn names_differ_and_are_long() {
        let [a, b] = [name().unwrap(), name().unwrap()];
        assert!(a != b && a.len() == 2 * NAME_BYTES);
    }

    #[test]
    fn it_ends_when_it_is_forgotten_when_its_time_is_over_and_after_its_answers() {
        let server = PictureServer::start(ANY, png()).unwrap();
        let (address, _) = parts(&server);
        drop(server);
        wait_until_closed(address);
        let server = PictureServer::start_for(ANY, png(), Duration::from_millis(80)).unwrap();
        wait_until_closed(parts(&server).0);
        let server = PictureServer::start(ANY, png()).unwrap();
        let (address, path) = parts(&server);
        for _ in 0..MOST_ANSWERS {
            assert!(get(address, &path).unwrap().ends_with(&png()));
        }
        wait_until_closed(address);
    }

    #[test]
    fn noise_and_silent_clients_block_only_briefly() {
        let server = PictureServer::start(ANY, png()).unwrap();
        let (address, path) = parts(&server);
        let silent = TcpStream::connect(address).unwrap();
        let _ = ask(address, &"x".repeat(5_000));
        let begun = Instant::now();
        assert!(get(address, &path).unwrap().ends_with(&png()));
        assert!(begun.elapsed() < Duration::from_secs(15), "{:?}", begun.elapsed());
        drop(silent);
    }

    #[test]
    fn an_address_that_is_taken_is_refused() {
        let taken = TcpListener::bind(ANY).unwrap();
        assert!(PictureServer::start(taken.local_addr().unwrap(), png()).is_err());
    }
}
