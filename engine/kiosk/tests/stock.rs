//! A stock that changes on the disk while it is watched: changed files are read again, bad ones are left out, and the last good stock stays.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use toile_assets::catalogue::package;
use toile_fitting::dress::session;
use toile_kiosk::service::config::Config;
use toile_kiosk::service::stock::Stock;
use toile_kiosk::service::stock_watch::{StockChange, StockWatch, WatchStart};

/// Time between two looks of a test.
const EVERY: Duration = Duration::from_millis(10);

/// Longest that a change is waited for, beside compilers.
const LONGEST: Duration = Duration::from_secs(60);

/// A shop's folder, removed when it is dropped.
struct Shop(PathBuf);

impl Shop {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("toile-stock-{name}-{}", std::process::id()));
        _ = fs::remove_dir_all(&path);
        fs::create_dir_all(path.join("source")).unwrap();
        let shop = Self(path);
        shop.write("catalogue.toml", "shop = \"Corner shop\"\n");
        for (file, article) in [("a", "A-1"), ("b", "B-1"), ("c", "C-1")] {
            shop.write(&format!("{file}.toile"), packed(&shop.0, article, "scarf", "20.00 EUR"));
        }
        shop
    }

    fn folder(&self) -> PathBuf {
        self.0.join("shop")
    }

    /// Writes a file as a careful shop does: beside it, then in its place.
    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::create_dir_all(self.folder()).unwrap();
        let beside = self.0.join("new");
        fs::write(&beside, content).unwrap();
        fs::rename(beside, self.folder().join(name)).unwrap();
    }

    fn config(&self) -> Config {
        let mut config = Config::default();
        config.wear.catalogue = Some(self.folder());
        config.wear.quality = "draft".into();
        config
    }
}

impl Drop for Shop {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

fn packed(scratch: &Path, article: &str, garment: &str, price: &str) -> Vec<u8> {
    let source = scratch.join("source");
    let text =
        format!("article = \"{article}\"\ngarment = \"{garment}\"\nname = {{ en = \"Ours\" }}\nprice = \"{price}\"\n");
    fs::write(source.join("garment.toml"), text).unwrap();
    package::pack(&source).unwrap().0
}

struct Watched {
    watch: StockWatch<usize>,
    lines: Vec<String>,
}

impl Watched {
    fn start(config: Config) -> Self {
        let stock = Stock::read(&config).unwrap();
        let pose = session::standing(&session::open(None, None).unwrap()).unwrap()[0];
        let left_out = stock.left_out.clone();
        let hang = Box::new(|stock: &Stock, _: &mut Vec<_>| Ok(stock.catalogue.as_ref().map_or(0, |c| c.items.len())));
        let start = WatchStart { config, stock, left_out, pose, every: EVERY, hang };
        Self { watch: StockWatch::start(start).unwrap().unwrap(), lines: Vec::new() }
    }

    /// Polls until something is so.
    fn until(&mut self, what: &str, mut is_so: impl FnMut(&mut StockWatch<usize>, &[String]) -> bool) {
        let begun = Instant::now();
        loop {
            self.watch.poll();
            self.lines.extend(self.watch.lines());
            if is_so(&mut self.watch, &self.lines) {
                return;
            }
            assert!(begun.elapsed() < LONGEST, "{what}: {:?}, {}", self.lines, self.watch.figures());
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    /// The next stock that is offered.
    fn change(&mut self, what: &str) -> StockChange<usize> {
        let mut change = None;
        self.until(what, |watch, _| {
            change = watch.take();
            change.is_some()
        });
        change.unwrap()
    }

    /// Waits until a line has these words.
    fn line(&mut self, words: &str) {
        self.until(words, |_, lines| lines.iter().any(|line| line.contains(words)));
    }

    /// Time enough for a few looks, in which nothing is offered.
    fn nothing(&mut self) {
        std::thread::sleep(20 * EVERY);
        self.watch.poll();
        assert!(self.watch.take().is_none(), "{:?}", self.watch.lines());
    }
}

fn articles(change: &StockChange<usize>) -> Vec<&str> {
    change.stock.catalogue.iter().flat_map(|c| &c.items).map(|item| item.manifest.article.as_str()).collect()
}

#[test]
fn what_is_added_replaced_and_removed_is_offered_and_what_is_the_same_is_not_read_again() {
    let shop = Shop::new("changes");
    let mut watched = Watched::start(shop.config());
    watched.nothing();
    shop.write("d.toile", packed(&shop.0, "D-1", "blazer", "90.00 EUR"));
    let added = watched.change("a fourth garment");
    assert_eq!((articles(&added), added.hung), (vec!["A-1", "B-1", "C-1", "D-1"], 4));
    assert!(added.mannequin.is_none(), "the first garment is as it was");
    shop.write("b.toile", packed(&shop.0, "B-1", "scarf", "15.00 EUR"));
    let cheaper = watched.change("another price");
    let price = |change: &StockChange<usize>, place: usize| {
        change.stock.catalogue.as_ref().unwrap().items[place].manifest.price.as_ref().unwrap().to_string()
    };
    assert_eq!((price(&cheaper, 0), price(&cheaper, 1)), ("20.00 EUR".into(), "15.00 EUR".into()));
    fs::remove_file(shop.folder().join("c.toile")).unwrap();
    assert_eq!(articles(&watched.change("a garment less")), ["A-1", "B-1", "D-1"]);
    // What is worn first is another one now: the mannequin has it on. Scarf and poncho are the garments that are draped soonest.
    shop.write("a.toile", packed(&shop.0, "A-2", "poncho", "50.00 EUR"));
    let other = watched.change("another first garment");
    assert_eq!(articles(&other), ["A-2", "B-1", "D-1"]);
    let mannequin = other.mannequin.expect("a mannequin in the poncho");
    assert!(mannequin.request.garments[0].name.ends_with("a.toile"));
    fs::remove_file(shop.folder().join("a.toile")).unwrap();
    assert!(watched.change("the first garment gone").mannequin.is_some());
    assert_eq!(watched.watch.figures().to_string(), "catalogue of 2 garments, read again 5 times");
}

#[test]
fn what_is_broken_is_left_out_by_name_and_comes_back_when_it_is_whole() {
    let shop = Shop::new("broken");
    let mut watched = Watched::start(shop.config());
    let whole = packed(&shop.0, "B-1", "scarf", "20.00 EUR");
    // Half-written, and not by way of a rename.
    fs::write(shop.folder().join("b.toile"), &whole[..whole.len() / 2]).unwrap();
    assert_eq!(articles(&watched.change("half a package")), ["A-1", "C-1"]);
    assert!(watched.watch.figures().to_string().ends_with("left out: b.toile"), "{}", watched.watch.figures());
    watched.line("left out of the catalogue: ");
    let said = watched.lines.iter().filter(|line| line.contains("b.toile") && line.contains("no garment package"));
    assert_eq!(said.count(), 1, "{:?}", watched.lines);
    shop.write("b.toile", &whole);
    assert_eq!(articles(&watched.change("the whole package")), ["A-1", "B-1", "C-1"]);
    assert!(watched.watch.figures().left_out.is_empty());
    // An article twice: the first keeps it.
    shop.write("d.toile", packed(&shop.0, "A-1", "blazer", "90.00 EUR"));
    assert_eq!(articles(&watched.change("a double")), ["A-1", "B-1", "C-1"]);
    watched.line("its article number A-1 is that of a.toile");
}

#[test]
fn a_catalogue_that_cannot_be_read_leaves_everything_as_it_was() {
    let shop = Shop::new("kept");
    let mut watched = Watched::start(shop.config());
    for broken in ["shop = 3\n", "shop = \"A\"\n[theme]\ntext = [0.1, 0.1, 0.1]\n", "", "shop = \"A\"\ngarments = []\n"]
    {
        watched.lines.clear();
        shop.write("catalogue.toml", broken);
        watched.line("the catalogue stays as it was: ");
        assert!(watched.lines.iter().all(|line| !line.contains('\n') && line.contains("; ")), "{:?}", watched.lines);
        watched.nothing();
        assert!(watched.watch.figures().to_string().ends_with("a change that cannot be used"));
    }
    fs::remove_file(shop.folder().join("catalogue.toml")).unwrap();
    watched.lines.clear();
    watched.line("the catalogue stays as it was: ");
    shop.write("catalogue.toml", "shop = \"Corner shop\"\ngarments = [\"c.toile\", \"a.toile\"]\n");
    assert_eq!(articles(&watched.change("another order")), ["C-1", "A-1"]);
    assert!(!watched.watch.figures().kept);
    // A garment that cannot be put on the mannequin is never worn.
    let manifest = "article = \"C-1\"\ngarment = \"torn.obj\"\nname = { en = \"Torn\" }\n";
    fs::write(shop.0.join("source/garment.toml"), manifest).unwrap();
    fs::write(shop.0.join("source/torn.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    shop.write("c.toile", package::pack(&shop.0.join("source")).unwrap().0);
    watched.until("an unwearable garment", |watch, lines| {
        let kept = lines.iter().any(|line| line.contains("stays as it was"));
        kept || watch.take().is_some_and(|change| change.stock.first.garments[0].name.ends_with("a.toile"))
    });
    fs::remove_dir_all(shop.folder()).unwrap();
    watched.lines.clear();
    watched.line("the catalogue stays as it was: ");
}

#[test]
fn a_file_that_is_named_is_watched_without_a_catalogue_too() {
    let shop = Shop::new("named");
    let file = shop.folder().join("b.toile").display().to_string();
    let mut config = shop.config();
    (config.wear.catalogue, config.wear.is_named) = (None, true);
    config.wear.garments = vec!["shorts".into(), file.clone()];
    let mut watched = Watched::start(config.clone());
    shop.write("b.toile", packed(&shop.0, "B-2", "scarf", "90.00 EUR"));
    let change = watched.change("another garment");
    assert_eq!(change.stock.first.names(), ["shorts", file.as_str()]);
    assert!(change.mannequin.is_some());
    fs::remove_file(&file).unwrap();
    let change = watched.change("one garment less");
    assert_eq!(change.stock.first.names(), ["shorts"]);
    assert!(watched.watch.figures().to_string().contains("left out: b.toile"));
    // Nothing that is built in changes: nothing is watched.
    config.wear.garments = vec!["shorts".into()];
    assert!(!Stock::read(&config).unwrap().is_of_files());
}

/// Memory of the process that is resident (kB).
#[cfg(target_os = "linux")]
fn resident_kb() -> i64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    line.trim().trim_end_matches(" kB").parse().unwrap()
}

#[test]
#[cfg(target_os = "linux")]
fn fifty_changes_leave_no_more_memory_taken_than_ten() {
    const CHILD: &str = "TOILE_STOCK_MEMORY_CHILD";
    // A process of its own, because tests that run beside this one take memory too.
    if std::env::var_os(CHILD).is_none() {
        let test = "stock::fifty_changes_leave_no_more_memory_taken_than_ten";
        let mut child = std::process::Command::new(std::env::current_exe().unwrap());
        let output = child.args(["--exact", test, "--nocapture"]).env(CHILD, "1").output().unwrap();
        let printed = String::from_utf8_lossy(&output.stdout);
        println!("{printed}{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.status.success() && printed.contains("1 passed"), "the test fails in its own process");
        return;
    }
    let shop = Shop::new("memory");
    let logo = include_bytes!("../../app/tests/screens/1-attract.png");
    shop.write("logo.png", logo);
    shop.write("catalogue.toml", "shop = \"Corner shop\"\n[theme]\nlogo = \"logo.png\"\n");
    let mut watched = Watched::start(shop.config());
    let mut held = watched.watch.take();
    let mut after_ten = 0;
    for i in 0..50 {
        shop.write("catalogue.toml", format!("# {i}\nshop = \"Corner shop\"\n[theme]\nlogo = \"logo.png\"\n"));
        shop.write("c.toile", packed(&shop.0, "C-1", "scarf", &format!("{i}.00 EUR")));
        held = Some(watched.change("a change"));
        if i == 10 {
            after_ten = resident_kb();
        }
    }
    assert!(held.is_some_and(|change| change.stock.catalogue.unwrap().theme.is_some()));
    let grown = resident_kb() - after_ten;
    println!("resident memory grew by {grown} kB over 40 changes");
    // A logo alone is half a megabyte: kept, forty of them would be twenty.
    assert!(grown < 8_000, "{grown} kB");
}
