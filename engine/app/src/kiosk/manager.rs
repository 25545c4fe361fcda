//! Who manages the service: told when it is ready and that it is alive, and listened to when it says that it shall end.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::SeqCst;
use std::time::Duration;

/// What a manager is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum News {
    /// The first step and the first picture were made.
    Ready,
    /// Physics and render got on since the last time.
    Alive,
    /// It was told to end and does.
    Stopping,
}

/// Who manages the service.
pub trait Manager {
    /// How long it waits for [`News::Alive`]; none where it does not.
    fn patience(&self) -> Option<Duration>;

    /// Tells it.
    ///
    /// # Errors
    /// Where it cannot be reached.
    fn tell(&self, news: News) -> io::Result<()>;
}

/// systemd, where it has started the service (`NOTIFY_SOCKET`, `WATCHDOG_USEC`); nobody elsewhere.
#[derive(Debug, Clone, Copy, Default)]
pub struct Systemd;

#[cfg(unix)]
impl Manager for Systemd {
    fn patience(&self) -> Option<Duration> {
        sd_notify::watchdog_enabled().filter(|patience| !patience.is_zero())
    }

    fn tell(&self, news: News) -> io::Result<()> {
        sd_notify::notify(&[match news {
            News::Ready => sd_notify::NotifyState::Ready,
            News::Alive => sd_notify::NotifyState::Watchdog,
            News::Stopping => sd_notify::NotifyState::Stopping,
        }])
    }
}

#[cfg(not(unix))]
impl Manager for Systemd {
    fn patience(&self) -> Option<Duration> {
        None
    }

    fn tell(&self, _news: News) -> io::Result<()> {
        Ok(())
    }
}

/// Whether the service was told to end, by SIGTERM or SIGINT. A service whose only state is its configuration has nothing to
/// save: before it runs, and where it is told a second time, it ends on the spot.
///
/// SeqCst: a signal comes once; what it costs does not matter.
#[derive(Debug, Clone, Default)]
pub struct Ending(Arc<AtomicBool>);

impl Ending {
    /// Listens from now on; on the spot until [`Ending::orderly`].
    ///
    /// # Errors
    /// Where the system takes no handler.
    #[cfg(unix)]
    pub fn listen() -> io::Result<Self> {
        use signal_hook::consts::{SIGINT, SIGTERM};
        let told = Arc::new(AtomicBool::new(true));
        for signal in [SIGTERM, SIGINT] {
            // In this order: the first one sees what was set before.
            signal_hook::flag::register_conditional_shutdown(signal, 0, told.clone())?;
            signal_hook::flag::register(signal, told.clone())?;
        }
        Ok(Self(told))
    }

    /// Where there are no such signals, the system's own way of ending a program is left as it is.
    ///
    /// # Errors
    /// None here.
    #[cfg(not(unix))]
    pub fn listen() -> io::Result<Self> {
        Ok(Self::default())
    }

    /// From now on the first signal only asks.
    pub fn orderly(&self) {
        self.0.store(false, SeqCst);
    }

    /// Asks to end, as a signal does.
    pub fn ask(&self) {
        self.0.store(true, SeqCst);
    }

    /// Whether it was asked for.
    pub fn is_asked(&self) -> bool {
        self.0.load(SeqCst)
    }
}
