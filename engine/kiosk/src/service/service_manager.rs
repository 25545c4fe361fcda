//! The service manager: notified when the service is ready and alive, and obeyed when it asks the service to end.

use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering::SeqCst;
use std::time::Duration;

/// What the manager is notified of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ServiceStatus {
    /// The first step and the first picture were made.
    Ready,
    /// Physics and render got on since the last time.
    Alive,
    /// It was asked to end and does.
    Stopping,
}

/// The service manager.
pub trait ServiceManager {
    /// How long it waits for [`ServiceStatus::Alive`]; none where it does not.
    fn watchdog_timeout(&self) -> Option<Duration>;

    /// Notifies it.
    ///
    /// # Errors
    /// Where it cannot be reached.
    fn notify(&self, status: ServiceStatus) -> io::Result<()>;
}

/// systemd, where it has started the service (`NOTIFY_SOCKET`, `WATCHDOG_USEC`); none elsewhere.
#[derive(Debug, Clone, Copy, Default)]
pub struct Systemd;

#[cfg(unix)]
impl ServiceManager for Systemd {
    fn watchdog_timeout(&self) -> Option<Duration> {
        sd_notify::watchdog_enabled().filter(|timeout| !timeout.is_zero())
    }

    fn notify(&self, status: ServiceStatus) -> io::Result<()> {
        sd_notify::notify(&[match status {
            ServiceStatus::Ready => sd_notify::NotifyState::Ready,
            ServiceStatus::Alive => sd_notify::NotifyState::Watchdog,
            ServiceStatus::Stopping => sd_notify::NotifyState::Stopping,
        }])
    }
}

#[cfg(not(unix))]
impl ServiceManager for Systemd {
    fn watchdog_timeout(&self) -> Option<Duration> {
        None
    }

    fn notify(&self, _status: ServiceStatus) -> io::Result<()> {
        Ok(())
    }
}

/// Whether the service was asked to end, by SIGTERM or SIGINT. A service whose only state is its configuration has nothing to
/// save: before it runs, and where it is asked a second time, it ends on the spot.
///
/// SeqCst: a signal comes once; what it costs does not matter.
#[derive(Debug, Clone, Default)]
pub struct StopSignal(Arc<AtomicBool>);

impl StopSignal {
    /// Listens from now on; on the spot until [`StopSignal::graceful`].
    ///
    /// # Errors
    /// Where the system takes no handler.
    #[cfg(unix)]
    pub fn listen() -> io::Result<Self> {
        use signal_hook::consts::{SIGINT, SIGTERM};
        let requested = Arc::new(AtomicBool::new(true));
        for signal in [SIGTERM, SIGINT] {
            // In this order: the first one sees what was set before.
            signal_hook::flag::register_conditional_shutdown(signal, 0, requested.clone())?;
            signal_hook::flag::register(signal, requested.clone())?;
        }
        Ok(Self(requested))
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
    pub fn graceful(&self) {
        self.0.store(false, SeqCst);
    }

    /// Asks to end, as a signal does.
    pub fn request(&self) {
        self.0.store(true, SeqCst);
    }

    /// Whether it was asked for.
    pub fn is_requested(&self) -> bool {
        self.0.load(SeqCst)
    }
}
