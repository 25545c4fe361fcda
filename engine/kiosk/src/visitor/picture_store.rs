//! Picture store: the one picture of a visit, in memory alone and only for minutes, and the choice of its code.

use std::sync::Arc;

use super::picture::PictureCode;
use super::picture_link::{PictureServer, SERVED};

/// A link to a picture that is served.
#[derive(Debug, Clone)]
pub struct PictureLink {
    /// The link as a code.
    pub code: PictureCode,
    /// Name of the network that it works in, where it is known.
    pub network: Option<String>,
    /// Serves the picture for as long as this value lives.
    pub server: Arc<PictureServer>,
}

impl PartialEq for PictureLink {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.server, &other.server)
    }
}

/// A picture as it is offered: by a link, by a code that holds it, or by both.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OfferedPicture {
    /// The link, where the shop serves pictures and could.
    pub link: Option<PictureLink>,
    /// The code that holds the picture, unless it is too rich for one.
    pub own: Option<PictureCode>,
}

#[derive(Debug, Clone)]
struct HeldPicture {
    offered: OfferedPicture,
    /// Whether the code that holds the picture is shown, of both.
    own: bool,
    until_ns: u64,
}

/// Where the one picture is kept.
#[derive(Debug, Clone, Default)]
pub struct PictureStore {
    held: Option<HeldPicture>,
}

impl PictureStore {
    /// Keeps a picture until a time (ns), and no longer than its link is served; one before it is gone.
    pub fn put(&mut self, offered: OfferedPicture, now_ns: u64, until_ns: u64) {
        self.wipe();
        let served = if offered.link.is_some() { now_ns + SERVED.as_nanos() as u64 } else { u64::MAX };
        let own = offered.link.is_none();
        self.held = Some(HeldPicture { offered, own, until_ns: until_ns.min(served) });
    }

    /// The code that is shown, while a picture is kept.
    pub fn code(&self) -> Option<&PictureCode> {
        let HeldPicture { offered, own, .. } = self.held.as_ref()?;
        if *own { offered.own.as_ref() } else { offered.link.as_ref().map(|link| &link.code) }
    }

    /// The link, where it is what is shown.
    pub fn link(&self) -> Option<&PictureLink> {
        self.held.as_ref().filter(|held| !held.own)?.offered.link.as_ref()
    }

    /// Whether there are two codes to choose from.
    pub fn has_both(&self) -> bool {
        self.held.as_ref().is_some_and(|held| held.offered.link.is_some() && held.offered.own.is_some())
    }

    /// Shows the other code, where there are two.
    pub fn show_other(&mut self) {
        let has_both = self.has_both();
        if let Some(held) = self.held.as_mut().filter(|_| has_both) {
            held.own = !held.own;
        }
    }

    /// How long it is still kept (ns); 0 where there is none.
    pub fn left_ns(&self, now_ns: u64) -> u64 {
        self.held.as_ref().map_or(0, |held| held.until_ns.saturating_sub(now_ns))
    }

    /// Forgets the picture when its time is over; says whether it did.
    pub fn expire(&mut self, now_ns: u64) -> bool {
        let over = self.held.is_some() && self.left_ns(now_ns) == 0;
        if over {
            self.wipe();
        }
        over
    }

    /// Forgets the picture at once; it is served no longer.
    pub fn wipe(&mut self) {
        if let Some(HeldPicture { offered, .. }) = &mut self.held {
            let codes = offered.own.iter_mut().chain(offered.link.as_mut().map(|link| &mut link.code));
            codes.for_each(|code| code.dark.fill(false));
        }
        self.held = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::{Ipv4Addr, SocketAddr, TcpStream};

    fn own() -> OfferedPicture {
        OfferedPicture { link: None, own: Some(PictureCode { side: 1, dark: vec![true] }) }
    }

    fn with_link() -> OfferedPicture {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let server = Arc::new(PictureServer::start(address, vec![7; 100]).unwrap());
        let code = PictureCode { side: 2, dark: vec![true; 4] };
        OfferedPicture { link: Some(PictureLink { code, network: None, server }), ..own() }
    }

    #[test]
    fn a_picture_is_kept_for_its_time_and_can_be_deleted_before() {
        let mut store = PictureStore::default();
        store.put(own(), 0, 100);
        assert!(!store.expire(99) && store.code().is_some() && !store.has_both());
        assert_eq!(store.left_ns(60), 40);
        assert!(store.expire(100) && store.code().is_none());
        store.put(own(), 0, 100);
        store.wipe();
        assert!(store.code().is_none() && !store.expire(200));
    }

    #[test]
    fn a_link_comes_first_lasts_two_minutes_and_ends_with_the_picture() {
        let mut store = PictureStore::default();
        store.put(with_link(), 1_000, u64::MAX);
        assert_eq!(store.left_ns(1_000), 120_000_000_000);
        let shown = |store: &PictureStore| store.code().map(|code| code.side);
        assert_eq!((shown(&store), store.link().is_some()), (Some(2), true));
        store.show_other();
        assert_eq!((shown(&store), store.link().is_some()), (Some(1), false));
        store.show_other();
        let url = store.link().unwrap().server.url().to_owned();
        let address: SocketAddr = url.strip_prefix("http://").unwrap().split_once('/').unwrap().0.parse().unwrap();
        assert!(TcpStream::connect(address).is_ok());
        store.wipe();
        let mut tries = 0;
        while TcpStream::connect(address).is_ok() {
            tries += 1;
            assert!(tries < 500, "it is still served");
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
    }
}
