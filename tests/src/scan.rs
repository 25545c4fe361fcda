//! A small scanner of Rust sources: enough to find which paths a file names, outside comments, strings and tests.

/// A word or a mark of a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Token {
    /// The word, `::`, or a single mark.
    pub text: String,
    /// Its line, from 1.
    pub line: usize,
}

/// A path that a source names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedPath {
    /// Its segments; a group is spread out into one path a member.
    pub segments: Vec<String>,
    /// The line it starts on, from 1.
    pub line: usize,
    /// How the source names it.
    pub role: Role,
    /// The name it has in this file: what stands after `as`, or else its last segment.
    pub alias: String,
}

/// How a source names a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// In code, outside of any `use`.
    Code,
    /// By a private `use`.
    Import,
    /// By a `use` that hands it on: `pub use`, `pub(crate) use`.
    ReExport,
}

/// The tokens of a source without comments; a string or character is left as the single mark `"`.
pub fn tokens(source: &str) -> Vec<Token> {
    let mut reader = Reader { rest: source, line: 1 };
    let mut found = Vec::new();
    while let Some(c) = reader.rest.chars().next() {
        let line = reader.line;
        let text = if reader.rest.starts_with("//") {
            reader.skip(reader.rest.find('\n').unwrap_or(reader.rest.len()));
            continue;
        } else if reader.rest.starts_with("/*") {
            reader.block_comment();
            continue;
        } else if c.is_whitespace() {
            reader.skip(c.len_utf8());
            continue;
        } else if let Some(length) = literal(reader.rest) {
            reader.skip(length);
            "\"".to_owned()
        } else if reader.rest.starts_with("::") {
            reader.skip(2).to_owned()
        } else if is_word(c) {
            let end = reader.rest.find(|c| !is_word(c)).unwrap_or(reader.rest.len());
            reader.skip(end).to_owned()
        } else {
            reader.skip(c.len_utf8()).to_owned()
        };
        found.push(Token { text, line });
    }
    found
}

struct Reader<'a> {
    rest: &'a str,
    line: usize,
}

impl<'a> Reader<'a> {
    fn skip(&mut self, bytes: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(bytes);
        self.line += taken.matches('\n').count();
        self.rest = rest;
        taken
    }

    /// Block comments nest in Rust.
    fn block_comment(&mut self) {
        let mut depth = 0;
        while !self.rest.is_empty() {
            if self.rest.starts_with("/*") {
                depth += 1;
                self.skip(2);
            } else if self.rest.starts_with("*/") {
                depth -= 1;
                self.skip(2);
                if depth == 0 {
                    return;
                }
            } else {
                self.skip(self.rest.chars().next().map_or(0, char::len_utf8));
            }
        }
    }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Length of the string or character literal that a text begins with, if it does.
fn literal(text: &str) -> Option<usize> {
    if text.starts_with('\'') {
        return character(text);
    }
    let prefix = ["br", "cr", "b", "c", "r", ""].into_iter().find(|p| {
        let after = text.strip_prefix(p).map(|t| t.trim_start_matches('#'));
        after.is_some_and(|t| t.starts_with('"'))
    })?;
    let after = &text[prefix.len()..];
    let hashes = after.len() - after.trim_start_matches('#').len();
    let open = prefix.len() + hashes + 1;
    if prefix.ends_with('r') {
        let close = format!("\"{}", "#".repeat(hashes));
        return Some(text[open..].find(&close).map_or(text.len(), |at| open + at + close.len()));
    }
    // Hashes without an `r` are not a string: `#"` occurs in macros only.
    (hashes == 0).then(|| open + quoted(&text[open..], '"'))
}

/// Length of a quoted text up to and with its end, past escapes.
fn quoted(text: &str, end: char) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            c if c == end => return at + c.len_utf8(),
            _ => {}
        }
    }
    text.len()
}

/// A character literal, as opposed to a lifetime, which has no closing quote.
fn character(text: &str) -> Option<usize> {
    let mut chars = text[1..].chars();
    let first = chars.next()?;
    if first == '\\' {
        return Some(1 + quoted(&text[1..], '\''));
    }
    (chars.next() == Some('\'')).then(|| 2 + first.len_utf8())
}

/// The tokens less the items under `#[cfg(test)]` or `#[cfg(all(test, ..))]`.
pub fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let mut kept = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        if let Some(mark) = test_mark(&tokens[at..]) {
            at += mark + item_length(&tokens[at + mark..]);
        } else {
            kept.push(tokens[at].clone());
            at += 1;
        }
    }
    kept
}

/// Length of the attribute that keeps the item behind it for tests, if the tokens begin with one.
fn test_mark(tokens: &[Token]) -> Option<usize> {
    let opens = |words: &[&str]| tokens.len() > words.len() && tokens.iter().zip(words).all(|(t, w)| t.text == *w);
    let plain = opens(&["#", "[", "cfg", "(", "test", ")"]);
    let with_more = opens(&["#", "[", "cfg", "(", "all", "(", "test", ","]);
    (plain || with_more).then(|| tokens.iter().position(|t| t.text == "]").map_or(tokens.len(), |end| end + 1))
}

/// Tokens of one item: up to a `;` or the end of its braces, whichever comes first outside brackets.
fn item_length(tokens: &[Token]) -> usize {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate() {
        match token.text.as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => {
                depth = depth.saturating_sub(1);
                if depth == 0 && token.text == "}" {
                    return at + 1;
                }
            }
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
    }
    tokens.len()
}

/// Every path that starts with `crate`, `super`, `self` or one of the project's crates, and every path of a `use`.
pub fn paths(tokens: &[Token]) -> Vec<NamedPath> {
    let of_the_project = |word: &str| ["crate", "super", "self", "toile"].contains(&word) || word.starts_with("toile_");
    all_paths(tokens).into_iter().filter(|p| p.role != Role::Code || of_the_project(&p.segments[0])).collect()
}

/// Every path of a `use`, and every path of two or more segments in the code.
pub fn all_paths(tokens: &[Token]) -> Vec<NamedPath> {
    let mut found = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let text = tokens[at].text.as_str();
        let behind = |by: usize| at.checked_sub(by).map_or("", |b| tokens[b].text.as_str());
        let followed = tokens.get(at + 1).is_some_and(|t| t.text == "::");
        let imported = behind(1) == "use";
        let role = match behind(2) {
            "pub" | ")" if imported => Role::ReExport,
            _ if imported => Role::Import,
            _ => Role::Code,
        };
        let begins = text.starts_with(is_word) && text != "use" && behind(1) != "::";
        if begins && (followed || imported) {
            at = spread(tokens, at, &[], role, &mut found);
        } else {
            at += 1;
        }
    }
    found
}

/// Reads one path or use tree from `at`, adds what it names, and returns where it ends.
fn spread(tokens: &[Token], mut at: usize, prefix: &[String], role: Role, found: &mut Vec<NamedPath>) -> usize {
    let Some(first) = tokens.get(at) else { return at };
    let line = first.line;
    let mut segments = prefix.to_vec();
    let text = |at: usize| tokens.get(at).map_or("", |t| t.text.as_str());
    loop {
        if text(at) == "{" {
            at += 1;
            while at < tokens.len() && text(at) != "}" {
                at = if text(at) == "," { at + 1 } else { spread(tokens, at, &segments, role, found).max(at + 1) };
            }
            return at + 1;
        }
        if !(text(at).starts_with(is_word) || text(at) == "*") {
            break;
        }
        segments.push(text(at).to_owned());
        at += 1;
        if text(at) != "::" {
            break;
        }
        at += 1;
    }
    // `a::{self}` names `a`.
    if segments.len() > 1 && segments.last().is_some_and(|last| last == "self") {
        segments.pop();
    }
    let mut alias = segments.last().cloned().unwrap_or_default();
    if role != Role::Code && text(at) == "as" {
        text(at + 1).clone_into(&mut alias);
        at += 2;
    }
    found.push(NamedPath { segments, line, role, alias });
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(source: &str) -> Vec<String> {
        paths(&without_tests(&tokens(source))).into_iter().map(|p| p.segments.join("::")).collect()
    }

    #[test]
    fn groups_are_spread_out() {
        let source = "use crate::{a::{b, c as d}, e, f::*};\npub use super::g::H;";
        assert_eq!(named(source), ["crate::a::b", "crate::a::c", "crate::e", "crate::f::*", "super::g::H"]);
    }

    #[test]
    fn paths_in_code_are_found() {
        let source = "fn f(x: &crate::a::B) -> u8 { toile_base::frame::g::<u8>(x) + super::h() }";
        assert_eq!(named(source), ["crate::a::B", "toile_base::frame::g", "super::h"]);
    }

    #[test]
    fn comments_strings_and_tests_name_nothing() {
        let source = r###"
            //! crate::a
            /* crate::b /* crate::c */ crate::d */
            const S: &str = "crate::e \" crate::f";
            const R: &[u8] = br##"crate::g "# crate::h"##;
            fn life<'a>(c: char) -> bool { c == '"' || c == '\'' || c == 'x' }
            #[cfg(test)]
            #[expect(unused)]
            mod tests { use crate::i::J; fn f() { crate::k() } }
            #[cfg(test)]
            use crate::l::M;
            use crate::kept::N;
        "###;
        assert_eq!(named(source), ["crate::kept::N"]);
    }

    #[test]
    fn a_path_has_the_name_that_the_file_gives_it() {
        let found = all_paths(&tokens("pub use a::{B as C, d::{self, E}}; use f::G; fn h() { G::new::<u8>() }"));
        let found_roles: Vec<(&str, Role)> = found.iter().map(|p| (p.alias.as_str(), p.role)).collect();
        let again = Role::ReExport;
        assert_eq!(found_roles, [("C", again), ("d", again), ("E", again), ("G", Role::Import), ("new", Role::Code)]);
    }

    #[test]
    fn visibility_and_plain_use_are_no_arrows_of_their_own() {
        assert_eq!(named("pub(crate) fn f() {} pub(super) struct S; use part::{Item};"), ["part::Item"]);
    }

    #[test]
    fn lines_are_counted_through_comments_and_strings() {
        let found = paths(&tokens("/*\n\n*/\nconst S: &str = \"\n\";\nuse crate::a::B;"));
        assert_eq!(found[0].line, 6);
    }
}
