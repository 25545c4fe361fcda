//! Which file of a crate imports which: the arrows between files, by the items that they name.
//!
//! An arrow runs from a file that names an item to the file that defines it, past every re-export on the way. Handing on
//! (`pub use child::Item;`) and declaring (`mod child;`) are a parent's work and no arrows, unless the parent's own code uses
//! the name. So a parent may show its children, and a child may use its siblings by way of the parent; but a child that
//! uses what its parent defines, while the parent uses the child, is a circle of two files. Tests are passed over.
//! Methods are not seen: who calls `x.f()` names no file.

use std::collections::{BTreeMap, BTreeSet};

use crate::items;
use crate::scan::{self, NamedPath, Role, Token};
use crate::tree;

/// A module's place in its crate: `[cloth, contact]`; the root is empty.
pub type Module = Vec<String>;

/// The files of a crate, each with what it defines and names.
#[derive(Debug, Default)]
pub struct CrateFiles {
    files: BTreeMap<Module, Source>,
}

#[derive(Debug)]
struct Source {
    place: String,
    defines: BTreeSet<String>,
    paths: Vec<NamedPath>,
    words: BTreeMap<String, usize>,
}

/// One file of a crate imports another.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Arrow {
    /// The module that names.
    pub from: Module,
    /// The module that defines.
    pub to: Module,
    /// Path of the item that is named.
    pub item: String,
    /// The file and line.
    pub place: String,
}

/// Whether a module holds tests: by its name, or because it is declared for tests only.
fn is_file_of_tests(module: &[String], tests: &BTreeSet<Module>) -> bool {
    let named_so = module.iter().any(|part| part == "tests");
    named_so || (1..=module.len()).any(|length| tests.contains(&module[..length]))
}

/// The modules that a file declares for tests only.
fn declared_for_tests(module: &[String], all: &[Token]) -> Vec<Module> {
    let declared = |tokens: &[Token]| -> BTreeSet<String> {
        let mods = tokens.windows(3).filter(|w| w[0].text == "mod" && w[2].text == ";");
        mods.map(|w| w[1].text.clone()).collect()
    };
    let real = declared(&scan::without_tests(all));
    let only = declared(all).into_iter().filter(|name| !real.contains(name));
    only.map(|name| module.iter().cloned().chain([name]).collect()).collect()
}

impl CrateFiles {
    /// The files below a crate's `src`.
    pub fn read(folder: &str) -> Self {
        let src = tree::root().join(folder).join("src");
        let files = tree::rust_files(&src);
        // A program's own file is no module of the library.
        let inside = files.iter().filter(|f| !f.ends_with("src/main.rs"));
        let sources = inside.map(|f| (tree::module_path(&src, f), tree::name(f), tree::read(f)));
        Self::new(&sources.collect::<Vec<_>>())
    }

    /// From modules, places and texts.
    pub fn new(sources: &[(Module, String, String)]) -> Self {
        let scanned: Vec<_> = sources.iter().map(|(m, place, text)| (m, place, scan::tokens(text))).collect();
        let tests: BTreeSet<Module> = scanned.iter().flat_map(|(m, _, t)| declared_for_tests(m, t)).collect();
        let real = scanned.into_iter().filter(|(module, ..)| !is_file_of_tests(module, &tests));
        let files = real.map(|(module, place, all)| (module.clone(), Source::new(place, &scan::without_tests(&all))));
        Self { files: files.collect() }
    }

    /// The modules of the crate that are not tests.
    pub fn modules(&self) -> impl Iterator<Item = &Module> {
        self.files.keys()
    }

    /// The file of a module, as people name it.
    pub fn place(&self, module: &[String]) -> &str {
        self.files.get(module).map_or("", |source| &source.place)
    }

    /// Every arrow from one file of the crate to another.
    pub fn arrows(&self) -> BTreeSet<Arrow> {
        let mut found = BTreeSet::new();
        for (module, source) in &self.files {
            for path in source.paths.iter().filter(|path| source.uses(path)) {
                let full = self.absolute(module, &path.segments, path.role == Role::Code);
                let Some((to, item)) = full.and_then(|full| self.definition(&full, 0)) else { continue };
                if to != *module {
                    let place = format!("{}:{}", source.place, path.line);
                    found.insert(Arrow { from: module.clone(), to, item, place });
                }
            }
        }
        found
    }

    /// A path from the crate's root, where it lies in the crate.
    fn absolute(&self, module: &[String], path: &[String], by_alias: bool) -> Option<Module> {
        let ups = path.iter().take_while(|s| *s == "super").count();
        match path.first()?.as_str() {
            "crate" => return Some(path[1..].to_vec()),
            "self" => return Some([module, &path[1..]].concat()),
            "super" => return Some([&module[..module.len().checked_sub(ups)?], &path[ups..]].concat()),
            _ => {}
        }
        let child = [module, &path[..1]].concat();
        if self.files.contains_key(&child) {
            return Some([module, path].concat());
        }
        // In code a path may begin with a name that a `use` brought in.
        let imported = self.files[module].paths.iter().find(|p| p.role != Role::Code && p.alias == path[0])?;
        let through = by_alias.then(|| self.absolute(module, &imported.segments, false))??;
        Some([&through, &path[1..]].concat())
    }

    /// The module that defines what a path from the root names, and the item's name; none where it names a module.
    fn definition(&self, path: &[String], hops: usize) -> Option<(Module, String)> {
        let depth = (0..=path.len()).rev().find(|length| self.files.contains_key(&path[..*length]))?;
        let (module, rest) = path.split_at(depth);
        let source = &self.files[module];
        let item = rest.first()?;
        let here = Some((module.to_vec(), item.clone()));
        if source.defines.contains(item) || item == "*" || hops > 8 {
            return here;
        }
        let handed_on = source.paths.iter().filter(|p| p.role != Role::Code);
        let (globs, named): (Vec<_>, Vec<_>) = handed_on.partition(|p| p.alias == "*");
        if let Some(import) = named.iter().find(|p| p.alias == *item) {
            let full = [&self.absolute(module, &import.segments, false)?, &rest[1..]].concat();
            return self.definition(&full, hops + 1);
        }
        let through = globs.iter().filter_map(|glob| {
            let from = self.absolute(module, &glob.segments[..glob.segments.len() - 1], false)?;
            let found = self.definition(&[&from, rest].concat(), hops + 1)?;
            self.files[&found.0].defines.contains(&found.1).then_some(found)
        });
        { through }.next().or(here)
    }
}

impl Source {
    fn new(place: &str, tokens: &[Token]) -> Self {
        let mut words = BTreeMap::new();
        for token in tokens {
            *words.entry(token.text.clone()).or_default() += 1;
        }
        let defines = items::items(tokens).into_iter().map(|i| i.name).collect();
        Self { place: place.to_owned(), defines, paths: scan::all_paths(tokens), words }
    }

    /// Whether the file itself uses a path: in code, by a private `use`, or by a re-export whose name the code names too.
    fn uses(&self, path: &NamedPath) -> bool {
        let named_by_uses = || {
            let uses = self.paths.iter().filter(|p| p.role != Role::Code);
            uses.flat_map(|p| &p.segments).filter(|s| **s == path.alias).count()
        };
        path.role != Role::ReExport || self.words.get(&path.alias).is_some_and(|all| *all > named_by_uses())
    }
}

/// The circles among arrows: each a set of nodes that all reach each other.
pub fn circles<N: Ord + Clone>(arrows: &[(N, N)]) -> Vec<BTreeSet<N>> {
    let mut next: BTreeMap<&N, BTreeSet<&N>> = BTreeMap::new();
    for (from, to) in arrows {
        next.entry(from).or_default().insert(to);
    }
    let reached = |start: &N| -> BTreeSet<N> {
        let mut seen = BTreeSet::new();
        let mut open: Vec<&N> = next.get(start).into_iter().flatten().copied().collect();
        while let Some(node) = open.pop() {
            if seen.insert(node.clone()) {
                open.extend(next.get(node).into_iter().flatten());
            }
        }
        seen
    };
    let reach: BTreeMap<&N, BTreeSet<N>> = next.keys().map(|node| (*node, reached(node))).collect();
    let meets = |a: &N, b: &N| reach.get(a).is_some_and(|of| of.contains(b));
    let mut found: Vec<BTreeSet<N>> = Vec::new();
    for node in reach.keys().filter(|node| meets(node, node)) {
        let circle: BTreeSet<N> = reach[*node].iter().filter(|other| meets(other, node)).cloned().collect();
        if !found.contains(&circle) {
            found.push(circle);
        }
    }
    found
}

/// The groups of modules that a crate's root declares, in the order of the file: groups are parted by blank lines.
pub fn groups(root: &str) -> Vec<Vec<String>> {
    let mut found = vec![Vec::new()];
    for line in root.lines().map(str::trim) {
        let name = line
            .strip_suffix(';')
            .and_then(|l| l.rsplit_once("mod "))
            .filter(|(before, _)| before.is_empty() || before.trim_end() == "pub" || before.starts_with("pub("));
        if let Some((_, name)) = name {
            found.last_mut().expect("there is a group").push(name.to_owned());
        } else if line.is_empty() && found.last().is_some_and(|group| !group.is_empty()) {
            found.push(Vec::new());
        }
    }
    found.retain(|group| !group.is_empty());
    found
}
