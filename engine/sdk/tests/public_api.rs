//! Every public item of this crate, as a caller sees it, against the list that was agreed, so that it does not change by accident.

use std::collections::BTreeSet;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use syn::punctuated::Punctuated;
use syn::{Attribute, Fields, ImplItem, Item, ItemImpl, Type, UseTree, Visibility, parse_quote};

/// The list, beside the crate's manifest.
const LIST: &str = "public-api.txt";

/// Set to 1, the list is written anew.
const RENEW: &str = "TOILE_RENEW_API";

/// Files of other crates that define what this one shows of them, from the workspace's folder.
const BORROWED: [&str; 5] = [
    "assets/base/src/body.rs",
    "assets/src/scene_file/mod.rs",
    "assets/base/src/skeleton/joint.rs",
    "engine/core/src/cloth/step/settings.rs",
    "assets/base/src/frame.rs",
];

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn parsed(path: &Path) -> syn::File {
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("{} cannot be read: {e}", path.display()));
    syn::parse_file(&text).unwrap_or_else(|e| panic!("{} is not Rust: {e}", path.display()))
}

/// Every source file below a folder, sorted.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        match path.is_dir() {
            true => sources(&path, found),
            false => found.push(path),
        }
    }
}

/// The names that a `use` brings.
fn names(tree: &UseTree, to: &mut BTreeSet<String>) {
    match tree {
        UseTree::Path(path) => names(&path.tree, to),
        UseTree::Group(group) => group.items.iter().for_each(|tree| names(tree, to)),
        UseTree::Name(name) => _ = to.insert(name.ident.to_string()),
        UseTree::Rename(name) => _ = to.insert(name.rename.to_string()),
        UseTree::Glob(_) => panic!("a `pub use` of everything shows unlisted items; name the items"),
    }
}

/// Without documentation: words change nothing for a caller.
fn without_words(attributes: &mut Vec<Attribute>) {
    attributes.retain(|a| a.path().is_ident("derive") || a.path().is_ident("non_exhaustive"));
}

/// Without private fields, for which one stands: callers cannot build such a struct.
fn shown_fields(fields: &mut Fields) {
    let Fields::Named(named) = fields else { return };
    let all = std::mem::take(&mut named.named);
    let count = all.len();
    let shown: Punctuated<_, _> = all.into_iter().filter(|field| matches!(field.vis, Visibility::Public(_))).collect();
    named.named = shown;
    named.named.iter_mut().for_each(|field| without_words(&mut field.attrs));
    if named.named.len() < count {
        named.named.push(parse_quote!(_private: ()));
    }
}

/// The type that an implementation is of.
fn implemented(block: &ItemImpl) -> Option<String> {
    let Type::Path(path) = &*block.self_ty else { return None };
    path.path.segments.last().map(|segment| segment.ident.to_string())
}

/// What an item shows to callers who know only `known`; none where they see nothing of it.
fn shown(item: Item, known: &BTreeSet<String>) -> Option<Item> {
    let public =
        |vis: &Visibility, name: &syn::Ident| matches!(vis, Visibility::Public(_)) && known.contains(&name.to_string());
    match item {
        Item::Struct(mut of) if public(&of.vis, &of.ident) => {
            without_words(&mut of.attrs);
            shown_fields(&mut of.fields);
            Some(Item::Struct(of))
        }
        Item::Enum(mut of) if public(&of.vis, &of.ident) => {
            without_words(&mut of.attrs);
            for variant in &mut of.variants {
                without_words(&mut variant.attrs);
                variant.fields.iter_mut().for_each(|field| without_words(&mut field.attrs));
            }
            Some(Item::Enum(of))
        }
        Item::Fn(mut of) if public(&of.vis, &of.sig.ident) => {
            of.attrs.clear();
            of.block = parse_quote!({});
            Some(Item::Fn(of))
        }
        Item::Const(mut of) if public(&of.vis, &of.ident) => {
            of.attrs.clear();
            Some(Item::Const(of))
        }
        Item::Type(mut of) if public(&of.vis, &of.ident) => {
            of.attrs.clear();
            Some(Item::Type(of))
        }
        Item::Impl(mut of) if implemented(&of).is_some_and(|name| known.contains(&name)) => {
            of.attrs.clear();
            if of.trait_.is_some() {
                of.items.clear();
                return Some(Item::Impl(of));
            }
            of.items.retain_mut(open_method);
            (!of.items.is_empty()).then_some(Item::Impl(of))
        }
        // Enums whose variants are listed once, with their names.
        Item::Macro(of) if of.mac.path.segments.last().is_some_and(|s| s.ident == "named") => {
            shown(Item::Enum(syn::parse2(of.mac.tokens).ok()?), known)
        }
        _ => None,
    }
}

/// Whether callers can name an item of an implementation, which is left without its body.
fn open_method(item: &mut ImplItem) -> bool {
    match item {
        ImplItem::Fn(of) if matches!(of.vis, Visibility::Public(_)) => {
            of.attrs.clear();
            of.block = parse_quote!({});
            true
        }
        ImplItem::Const(of) if matches!(of.vis, Visibility::Public(_)) => {
            of.attrs.clear();
            true
        }
        _ => false,
    }
}

/// Items as text.
fn written(items: Vec<Item>) -> String {
    let mut file = syn::parse_file("").unwrap();
    file.items = items;
    prettyplease::unparse(&file)
}

/// The whole of it, as Rust without bodies: what is re-exported, then what each file defines of it.
fn list() -> String {
    let root = parsed(&here("src/lib.rs"));
    let private = |item: &Item| match item {
        Item::Use(of) => matches!(of.vis, Visibility::Inherited),
        Item::Mod(of) => matches!(of.vis, Visibility::Inherited),
        _ => false,
    };
    let opened: Vec<Item> = root.items.into_iter().filter(|item| !private(item)).collect();
    let mut known = BTreeSet::new();
    for item in &opened {
        match item {
            Item::Use(of) => names(&of.tree, &mut known),
            other => {
                panic!("the crate's root exports more than `pub use` of names; this list does not know it: {other:?}")
            }
        }
    }
    let mut files = Vec::new();
    sources(&here("src"), &mut files);
    files.extend(BORROWED.iter().map(|path| here("../..").join(path)));
    let mut items = opened;
    for file in files {
        items.extend(parsed(&file).items.into_iter().filter_map(|item| shown(item, &known)));
    }
    written(items)
}

#[test]
fn the_public_items_are_those_that_were_agreed() {
    let (path, now) = (here(LIST), list());
    if env::var(RENEW).is_ok_and(|value| value == "1") {
        fs::write(&path, &now).unwrap();
        return;
    }
    let agreed = fs::read_to_string(&path).unwrap_or_default();
    if now == agreed {
        return;
    }
    let only = |a: &str, b: &str, sign: &str| -> String {
        let others: BTreeSet<&str> = b.lines().collect();
        a.lines().filter(|line| !others.contains(line)).map(|line| format!("{sign} {line}\n")).collect()
    };
    panic!(
        "the public items of toile-sdk are no longer those of engine/sdk/{LIST}:\n{}{}If that is meant, write the list anew with\n  \
         {RENEW}=1 cargo test -p toile-sdk --test main public_api\nand raise the version as the crate's front page promises: what is gone \
         or changed breaks callers.",
        only(&agreed, &now, "-"),
        only(&now, &agreed, "+")
    );
}

#[test]
fn every_item_that_is_re_exported_is_found() {
    let text = list();
    let mut known = BTreeSet::new();
    for item in parsed(&here("src/lib.rs")).items {
        if let Item::Use(of) = item {
            names(&of.tree, &mut known);
        }
    }
    known.remove("glam");
    let ends = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    let defined = |name: &String| {
        ["struct", "enum", "fn", "const", "type"].iter().any(|kind| {
            let wanted = format!("pub {kind} {name}");
            text.match_indices(&wanted).any(|(at, found)| ends(&text[at + found.len()..]))
        })
    };
    let missing: Vec<&String> = known.iter().filter(|name| !defined(name)).collect();
    assert!(missing.is_empty(), "defined in none of the files that are looked through: {missing:?}");
}

#[test]
fn what_callers_cannot_name_is_left_out_and_what_they_can_is_kept() {
    let known = BTreeSet::from(["Open".to_owned()]);
    let file: syn::File = parse_quote! {
        /// Words.
        #[derive(Debug)]
        pub struct Open { /// Words.
            pub a: u8, b: u8 }
        pub struct Hidden { pub a: u8 }
        impl Open { pub fn of(a: u8) -> Self { Self { a, b: 0 } } fn own(&self) {} pub(crate) fn ours(&self) {} }
        impl Drop for Open { fn drop(&mut self) {} }
        impl Hidden { pub fn of() {} }
        pub fn open() {}
    };
    let items = file.items.into_iter().filter_map(|item| shown(item, &known)).collect();
    let text = written(items);
    let words: Vec<&str> = text.split_whitespace().collect();
    let wanted = "#[derive(Debug)] pub struct Open { pub a: u8, _private: (), } impl Open { pub fn of(a: u8) -> Self {} } \
                  impl Drop for Open {}";
    assert_eq!(words, wanted.split_whitespace().collect::<Vec<_>>());
}
