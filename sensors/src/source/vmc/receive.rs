//! The socket: read without waiting, so many datagrams a call.

use std::io::{self, ErrorKind};
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};

use super::decode::{Decoder, Drops};
use crate::limits::{MAX_PACKET_BYTES, MAX_PACKETS_A_POLL};
use toile_base::clock::SECOND_NS;
use toile_base::frame::Joints;

/// The port to which senders of the protocol send.
pub const PORT: u16 = 39_539;

/// Silence (ns) after which another sender is followed: one that is started anew sends from another port.
const LONGEST_SILENCE_NS: u64 = SECOND_NS;

/// Receives one sender's figure.
#[derive(Debug)]
pub struct VmcReceiver {
    socket: UdpSocket,
    decoder: Decoder,
    /// The sender that is followed, and when it was last heard (ns): the first that sends anything of use.
    sender: Option<(SocketAddr, u64)>,
    /// A byte more than the longest datagram, so that longer ones are known.
    buffer: Box<[u8; MAX_PACKET_BYTES + 1]>,
}

impl VmcReceiver {
    /// Listens at an address, `("0.0.0.0", PORT)` by the protocol's custom.
    ///
    /// # Errors
    /// If the address cannot be bound.
    pub fn bind(address: impl ToSocketAddrs) -> io::Result<Self> {
        let socket = UdpSocket::bind(address)?;
        socket.set_nonblocking(true)?;
        let buffer = Box::new([0; MAX_PACKET_BYTES + 1]);
        Ok(Self { socket, decoder: Decoder::new(), sender: None, buffer })
    }

    /// Its address.
    ///
    /// # Errors
    /// The system's message.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.socket.local_addr()
    }

    /// Reads what has arrived, never waiting, and gives the newest complete frame, if there is one since the last call.
    /// `now_ns` is the session's time. Datagrams beyond the most that are read in a call are dropped and counted: what
    /// waits behind so many is old.
    ///
    /// # Errors
    /// If the socket is broken; a refused or interrupted receive is no error.
    pub fn poll(&mut self, now_ns: u64) -> io::Result<Option<Joints>> {
        for read in 0..2 * MAX_PACKETS_A_POLL {
            let (bytes, from) = match self.socket.recv_from(&mut self.buffer[..]) {
                Ok(got) => got,
                Err(e) if e.kind() == ErrorKind::WouldBlock => break,
                Err(e) if matches!(e.kind(), ErrorKind::Interrupted | ErrorKind::ConnectionReset) => continue,
                Err(e) => return Err(e),
            };
            if read >= MAX_PACKETS_A_POLL {
                self.decoder.drops_mut().overrun += 1;
                continue;
            }
            // Two senders' bones would make one figure of two.
            let silence = |heard_ns: u64| now_ns.saturating_sub(heard_ns);
            if self.sender.is_some_and(|(sender, heard_ns)| sender != from && silence(heard_ns) < LONGEST_SILENCE_NS) {
                self.decoder.drops_mut().stranger += 1;
                continue;
            }
            let before = self.decoder.drops().total();
            self.decoder.push(&self.buffer[..bytes], now_ns);
            if self.decoder.drops().total() == before {
                self.sender = Some((from, now_ns));
            }
        }
        Ok(self.decoder.take())
    }

    /// Counts of dropped messages so far.
    pub fn drops(&self) -> Drops {
        self.decoder.drops()
    }
}

#[cfg(test)]
mod tests {
    use rosc::{OscMessage, OscPacket, OscType, encoder};
    use toile_base::skeleton::Joint;

    use super::*;

    fn hips(x: f32) -> Vec<u8> {
        let numbers = [x, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0].map(OscType::Float);
        let args = std::iter::once(OscType::String("Hips".to_owned())).chain(numbers).collect();
        encoder::encode(&OscPacket::Message(OscMessage { addr: "/VMC/Ext/Bone/Pos".to_owned(), args })).unwrap()
    }

    /// Polls until something comes or a second has passed.
    fn wait(receiver: &mut VmcReceiver, enough: impl Fn(&VmcReceiver, Option<&Joints>) -> bool) -> Option<Joints> {
        let mut latest = None;
        for i in 0..200 {
            latest = receiver.poll(i * 5_000_000).unwrap().or(latest);
            if enough(receiver, latest.as_ref()) {
                break;
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        latest
    }

    #[test]
    fn datagrams_become_joints_garbage_is_counted_and_strangers_are_not_mixed_in() {
        let mut receiver = VmcReceiver::bind("127.0.0.1:0").unwrap();
        assert!(receiver.poll(0).unwrap().is_none(), "an empty socket does not wait");
        let to = receiver.address().unwrap();
        let [sender, stranger] = [(); 2].map(|()| UdpSocket::bind("127.0.0.1:0").unwrap());
        stranger.send_to(b"not OSC", to).unwrap();
        for x in [0.1, 0.2, 0.3] {
            sender.send_to(&hips(x), to).unwrap();
        }
        let joints = wait(&mut receiver, |_, j| j.is_some_and(|j| j.at(Joint::Pelvis).position.x < -0.25));
        assert!((joints.unwrap().at(Joint::Pelvis).position.x + 0.3).abs() < 1e-6);
        sender.send_to(&[b'/'; MAX_PACKET_BYTES + 100], to).unwrap();
        stranger.send_to(&hips(9.0), to).unwrap();
        wait(&mut receiver, |r, _| r.drops().total() == 3);
        let drops = receiver.drops();
        assert_eq!((drops.malformed, drops.oversize, drops.stranger), (1, 1, 1));
    }

    #[test]
    fn a_flood_is_bounded_and_counted() {
        let mut receiver = VmcReceiver::bind("127.0.0.1:0").unwrap();
        let to = receiver.address().unwrap();
        let sender = UdpSocket::bind("127.0.0.1:0").unwrap();
        // More than a call reads, and less than a socket's buffer loses.
        for _ in 0..MAX_PACKETS_A_POLL + 20 {
            sender.send_to(&hips(0.0), to).unwrap();
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
        receiver.poll(0).unwrap();
        assert!(receiver.drops().overrun <= 20);
        assert!(receiver.poll(1).unwrap().is_none());
    }
}
