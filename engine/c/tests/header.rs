//! The header is that of the sources, and declares every function.

use std::fs;
use std::path::Path;

fn generated() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(folder.join("cbindgen.toml")).expect("the configuration can be read");
    let header = cbindgen::Builder::new().with_crate(folder).with_config(config).generate().expect("a header is made");
    let mut bytes = Vec::new();
    header.write(&mut bytes);
    with_plain_pointers(&String::from_utf8(bytes).expect("the header is UTF-8"))
}

/// The header with the pointers themselves in place of the names that cbindgen gives to `In<T>`, `Out<T>`, `Buffer<T>` and `Text`, by
/// which the sources check what C hands over.
fn with_plain_pointers(header: &str) -> String {
    let (mut kept, mut pointers) = (Vec::new(), Vec::new());
    let mut lines = header.lines().peekable();
    while let Some(line) = lines.next() {
        let pointer = line.strip_prefix("typedef ").and_then(|line| line.strip_suffix(';')?.rsplit_once('*'));
        let Some((of, name)) = pointer else {
            kept.push(line.to_owned());
            continue;
        };
        // A pointer to a constant text has its `const` behind the star of the text.
        pointers.push((name.to_owned(), format!("{of}*").replace("const Text ", "const char *const ")));
        // Its comment goes with it, and the empty line behind it.
        let comment = kept.iter().rposition(|line| line == "/**").expect("each type has a comment");
        kept.truncate(comment);
        lines.next_if(|line| line.is_empty());
    }
    let mut text = kept.join("\n") + "\n";
    // Longer names first, since one may be the end of another.
    pointers.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
    for (name, pointer) in pointers {
        for before in ["(", ", ", "    ", " "] {
            text = text.replace(&format!("{before}{name} "), &format!("{before}{pointer}"));
        }
    }
    text
}

#[test]
fn pointers_are_put_in_place_of_their_names() {
    let header = "/**\n * A text.\n *\n */\ntypedef const char *Text;\n\n/**\n * An array.\n */\ntypedef const Text *In_Text;\n\n/**\n * A call.\n */\n\
                  int f(Text name,\n      In_Text all);\n";
    assert_eq!(
        with_plain_pointers(header),
        "/**\n * A call.\n */\nint f(const char *name,\n      const char *const *all);\n"
    );
}

#[test]
fn the_header_is_that_of_the_sources() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/toile.h");
    let generated = generated();
    if std::env::var_os("TOILE_RENEW_API").is_some() {
        fs::write(&path, &generated).expect("the header can be written");
    }
    let committed = fs::read_to_string(&path).expect("the header can be read");
    let differs = committed.lines().zip(generated.lines()).position(|(a, b)| a != b);
    assert!(
        committed == generated,
        "include/toile.h is not that of the sources from line {:?} on; run TOILE_RENEW_API=1 cargo test -p toile-c --test main header",
        differs.map(|at| at + 1)
    );
}

/// The functions of C that a text names, each followed by what it takes.
fn functions(text: &str) -> Vec<&str> {
    let begins = text
        .match_indices("toile_")
        .filter(|(at, _)| !text[..*at].ends_with(|c: char| c.is_alphanumeric() || c == '_'));
    let mut found: Vec<&str> = begins
        .filter_map(|(at, _)| {
            let name = &text[at..];
            let end = name.find(|c: char| !(c.is_alphanumeric() || c == '_'))?;
            name[end..].starts_with('(').then_some(&name[..end])
        })
        .collect();
    found.sort_unstable();
    found.dedup();
    found
}

#[test]
fn bad_input_is_given_to_every_call() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let header = fs::read_to_string(folder.join("include/toile.h")).unwrap();
    let all = functions(&header);
    assert!(all.len() > 60, "only {} functions are in the header", all.len());
    let tried = fs::read_to_string(folder.join("tests/c/bad_input.c")).unwrap();
    let tried = functions(&tried);
    let left: Vec<&&str> = all.iter().filter(|name| !tried.contains(name)).collect();
    assert!(left.is_empty(), "tests/c/bad_input.c calls none of {left:?}");
}

#[test]
fn examples_are_short() {
    for name in ["dressed.c", "recorded.c"] {
        let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(name)).unwrap();
        assert!(text.lines().count() <= 60, "{name} has {} lines, more than 60", text.lines().count());
    }
}
