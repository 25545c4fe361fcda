//! The stock's watch: checks whether the files of the stock have changed, reads them again on a thread of its own, and offers the
//! result to the controller, which takes it when no person is in view.

use std::collections::BTreeSet;
use std::fmt::{self, Display, Formatter};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, SyncSender, TryRecvError, channel, sync_channel};
use std::thread;
use std::time::Duration;

use toile_assets::catalogue::Catalogue;
use toile_base::frame::Joints;
use toile_engine::frame_loop::thread_roles::{self, ThreadRole};
use toile_fitting::dress::try_on::DressedWorld;

use super::config::Config;
use super::stock::{self, FilesSeen, LeftOut, Stock};
use crate::error::KioskError;

/// Time between two looks: two hundred files take a millisecond. A change is read when two looks have found the same.
pub const LOOK_EVERY: Duration = Duration::from_secs(2);

/// Most names of what is left out that the health line has.
const MOST_NAMES: usize = 3;

/// What hangs of a stock, in the form that a controller wants it; what cannot be used is added to the list.
pub type Hang<H> = Box<dyn FnMut(&Stock, &mut Vec<LeftOut>) -> Result<H, KioskError> + Send>;

/// A stock that was read again.
pub struct StockChange<H> {
    /// The stock.
    pub stock: Stock,
    /// What hangs of it.
    pub hung: H,
    /// A mannequin in what is worn first, where that has changed.
    pub mannequin: Option<Box<DressedWorld>>,
}

/// What the health line says of the stock.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct StockFigures {
    /// Garments of the catalogue that can be worn, where there is one.
    pub garments: Option<usize>,
    /// Names of what cannot.
    pub left_out: Vec<String>,
    /// Times that it was read again.
    pub read_again: u32,
    /// Whether the last change could not be used, so that all is as it was before.
    pub kept: bool,
}

impl StockFigures {
    /// Of a stock, with all that is left out of it.
    pub fn of(stock: &Stock, left_out: &[LeftOut]) -> Self {
        let names: BTreeSet<&String> = left_out.iter().map(|left| &left.name).collect();
        let hangs = |catalogue: &Arc<Catalogue>| {
            catalogue.items.len().saturating_sub(names.len().saturating_sub(catalogue.refused.len()))
        };
        let garments = stock.catalogue.as_ref().map(hangs);
        Self { garments, left_out: names.into_iter().cloned().collect(), read_again: 0, kept: false }
    }
}

impl Display for StockFigures {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.garments {
            Some(garments) => write!(f, "catalogue of {garments} garments")?,
            None => write!(f, "garments")?,
        }
        write!(f, ", read again {} times", self.read_again)?;
        if !self.left_out.is_empty() {
            let names = &self.left_out[..self.left_out.len().min(MOST_NAMES)];
            write!(f, ", left out: {}", names.join(" "))?;
            match self.left_out.len() - names.len() {
                0 => {}
                more => write!(f, " and {more} more")?,
            }
        }
        if self.kept { write!(f, ", as it was before a change that cannot be used") } else { Ok(()) }
    }
}

/// What a look has brought.
struct StockNews<H> {
    lines: Vec<String>,
    figures: StockFigures,
    change: Option<StockChange<H>>,
}

/// The watch, as a controller holds it.
pub struct StockWatch<H> {
    news: Receiver<StockNews<H>>,
    /// Dropped with the watch, by which its thread ends.
    _end: Sender<()>,
    next: Option<StockChange<H>>,
    lines: Vec<String>,
    figures: StockFigures,
    ended: bool,
}

/// What a watch begins with.
pub struct WatchStart<H> {
    /// The configuration that names the files.
    pub config: Config,
    /// The stock as it is.
    pub stock: Stock,
    /// What was left out of it, also when it was hung.
    pub left_out: Vec<LeftOut>,
    /// How the mannequin stands.
    pub pose: Joints,
    /// Time between two looks.
    pub every: Duration,
    /// Hangs a stock.
    pub hang: Hang<H>,
}

impl<H: Send + 'static> StockWatch<H> {
    /// Starts to watch; nothing where no file can change.
    ///
    /// # Errors
    /// Where the system gives no thread.
    pub fn start(start: WatchStart<H>) -> Result<Option<Self>, KioskError> {
        if !start.stock.is_of_files() {
            return Ok(None);
        }
        let (news_in, news) = sync_channel(1);
        let (end, ended) = channel();
        let figures = StockFigures::of(&start.stock, &start.left_out);
        let said = start.left_out.iter().map(|left| left.why.clone()).collect();
        let WatchStart { config, stock, pose, every, hang, .. } = start;
        let (read, last) = (stock.seen.clone(), stock.seen.clone());
        let watcher = Watcher { config, stock, pose, hang, read, last, said, figures: figures.clone() };
        let thread = thread::Builder::new().name("toile-stock".into());
        let watch = move || {
            thread_roles::apply(ThreadRole::Background);
            watcher.run(every, &ended, &news_in);
        };
        thread.spawn(watch).map_err(KioskError::internal)?;
        Ok(Some(Self { news, _end: end, next: None, lines: Vec::new(), figures, ended: false }))
    }

    /// Takes in what the watch has found: the newest counts.
    pub fn poll(&mut self) {
        loop {
            match self.news.try_recv() {
                Ok(news) => {
                    self.lines.extend(news.lines);
                    self.figures = news.figures;
                    if let Some(change) = news.change {
                        let before = self.next.take().and_then(|before| before.mannequin);
                        self.next = Some(StockChange { mannequin: change.mannequin.or(before), ..change });
                    }
                }
                Err(TryRecvError::Empty) => return,
                Err(TryRecvError::Disconnected) => {
                    if !std::mem::replace(&mut self.ended, true) {
                        self.lines
                            .push("the catalogue is watched no more; start the kiosk again to see changes".into());
                    }
                    return;
                }
            }
        }
    }

    /// The newest stock that was not taken yet.
    pub fn take(&mut self) -> Option<StockChange<H>> {
        self.next.take()
    }

    /// Lines for the operator, each once.
    pub fn lines(&mut self) -> Vec<String> {
        std::mem::take(&mut self.lines)
    }

    /// What the health line says.
    pub fn figures(&self) -> &StockFigures {
        &self.figures
    }
}

/// The line that says that something is left out.
pub fn line(left: &LeftOut) -> String {
    format!("left out of the catalogue: {}", left.why)
}

/// What watches, on its thread.
struct Watcher<H> {
    config: Config,
    /// The last stock that could be used.
    stock: Stock,
    pose: Joints,
    hang: Hang<H>,
    /// The files as they were read last, and as they were looked at last.
    read: FilesSeen,
    last: FilesSeen,
    /// What was said already of the stock as it is.
    said: BTreeSet<String>,
    figures: StockFigures,
}

impl<H> Watcher<H> {
    fn run(mut self, every: Duration, ended: &Receiver<()>, news_in: &SyncSender<StockNews<H>>) {
        while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(every) {
            if let Some(news) = self.look()
                && news_in.send(news).is_err()
            {
                return;
            }
        }
    }

    /// Looks at the files, and reads them where they have changed and come to rest.
    fn look(&mut self) -> Option<StockNews<H>> {
        let now = stock::look(&self.config);
        let settled = now == self.last;
        self.last = now;
        if !settled || self.last == self.read {
            return None;
        }
        let mut left_out = Vec::new();
        let read = self.read_again(&mut left_out);
        if stock::look(&self.config) != self.last {
            let line = "the catalogue was changed while it was read; it is read again".to_owned();
            return Some(StockNews { lines: vec![line], figures: self.figures.clone(), change: None });
        }
        self.read.clone_from(&self.last);
        Some(match read {
            Ok(change) => self.changed(change, &left_out),
            Err(why) => {
                self.figures.kept = true;
                let line = format!("the catalogue stays as it was: {why}");
                StockNews { lines: vec![line], figures: self.figures.clone(), change: None }
            }
        })
    }

    fn read_again(&mut self, left_out: &mut Vec<LeftOut>) -> Result<StockChange<H>, KioskError> {
        let stock = self.stock.read_again(&self.config)?;
        left_out.extend(stock.left_out.iter().cloned());
        let hung = (self.hang)(&stock, left_out)?;
        // The first outfit is tried here, before a visitor wears it.
        let mannequin = if stock.wears_the_same(&self.stock) {
            None
        } else {
            Some(Box::new(stock.first.on_mannequin(&self.pose)?))
        };
        Ok(StockChange { stock, hung, mannequin })
    }

    fn changed(&mut self, change: StockChange<H>, left_out: &[LeftOut]) -> StockNews<H> {
        self.stock = change.stock.clone();
        let read_again = self.figures.read_again + 1;
        self.figures = StockFigures { read_again, ..StockFigures::of(&change.stock, left_out) };
        let mut lines: Vec<String> = left_out.iter().filter(|left| !self.said.contains(&left.why)).map(line).collect();
        lines.push(format!("stock: {}", self.figures));
        self.said = left_out.iter().map(|left| left.why.clone()).collect();
        StockNews { lines, figures: self.figures.clone(), change: Some(change) }
    }
}
