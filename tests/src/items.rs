//! What a Rust source defines: types, functions, modules, with the lines they stand on.

use crate::scan::Token;

/// What an item is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ItemKind {
    /// A struct, an enum, a union, a trait or a type alias.
    Type,
    /// A function or a method.
    Function,
    /// A module.
    Module,
    /// A constant, a static or a macro.
    Other,
}

/// An item of a source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// Kind of the item.
    pub kind: ItemKind,
    /// Name of the item.
    pub name: String,
    /// Its first line, from 1, attributes and comments not counted.
    pub line: usize,
    /// Last line of the item.
    pub last_line: usize,
}

impl Item {
    /// How many lines it takes.
    pub fn lines(&self) -> usize {
        self.last_line + 1 - self.line
    }
}

/// The items of a source, nested ones too; types that belong to an `impl` or a trait are not items of their own.
pub fn items(tokens: &[Token]) -> Vec<Item> {
    let mut found = Vec::new();
    // What each open brace belongs to, and what the statement at hand began with.
    let mut open: Vec<&str> = Vec::new();
    let mut statement = "";
    for (at, token) in tokens.iter().enumerate() {
        let text = token.text.as_str();
        match text {
            "{" => open.push(std::mem::take(&mut statement)),
            "}" => {
                open.pop();
                statement = "";
            }
            ";" => statement = "",
            "impl" | "trait" | "fn" | "mod" | "struct" | "enum" | "const" if statement.is_empty() => statement = text,
            _ => {}
        }
        let kind = match text {
            "type" if open.last().is_some_and(|of| ["impl", "trait"].contains(of)) => continue,
            "struct" | "enum" | "union" | "trait" | "type" => ItemKind::Type,
            "fn" => ItemKind::Function,
            "mod" => ItemKind::Module,
            "const" | "static" => ItemKind::Other,
            "!" if at > 0 && tokens[at - 1].text == "macro_rules" => ItemKind::Other,
            _ => continue,
        };
        let after = |by: usize| tokens.get(at + by).map_or("", |t| t.text.as_str());
        let name = if after(1) == "mut" { after(2) } else { after(1) };
        // `fn(u8)` is a type, `*const u8` a pointer, `const {` a block, `const fn` a function, `union` also
        // a plain word, and what a macro builds may read `impl $trait for`.
        let pointer = text == "const" && at > 0 && tokens[at - 1].text == "*";
        let named =
            name.starts_with(|c: char| c.is_alphabetic() || c == '_') && !["fn", "unsafe", "for"].contains(&name);
        let union = text != "union" || after(2) == "{" || after(2) == "<";
        if named && union && !pointer {
            let last_line = end_line(&tokens[at..]);
            found.push(Item { kind, name: name.to_owned(), line: token.line, last_line });
        }
    }
    found
}

/// The line on which an item ends: of its closing brace, or of the `;` before any brace opens.
fn end_line(tokens: &[Token]) -> usize {
    let mut depth = 0_usize;
    let mut braced = 0_usize;
    for token in tokens {
        match token.text.as_str() {
            "(" | "[" => depth += 1,
            ")" | "]" => depth = depth.saturating_sub(1),
            "{" => braced += 1,
            "}" => {
                braced = braced.saturating_sub(1);
                if braced == 0 && depth == 0 {
                    return token.line;
                }
            }
            ";" if depth == 0 && braced == 0 => return token.line,
            _ => {}
        }
    }
    tokens.last().map_or(0, |t| t.line)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan;

    fn found(source: &str) -> Vec<(ItemKind, String, usize)> {
        items(&scan::tokens(source)).into_iter().map(|i| (i.kind, i.name.clone(), i.lines())).collect()
    }

    #[test]
    fn items_are_found_with_their_lines() {
        let source = "pub struct A<T>(T);\nenum B {\n    C,\n}\nconst fn d(x: [u8; 3]) -> u8 {\n    let e = |f: u8| {\n        f\n    };\n    e(x[0])\n}\nstatic mut G: u8 = 0;\nmacro_rules! h { () => {} }";
        let expected = [
            (ItemKind::Type, "A".to_owned(), 1),
            (ItemKind::Type, "B".to_owned(), 3),
            (ItemKind::Function, "d".to_owned(), 6),
            (ItemKind::Other, "G".to_owned(), 1),
            (ItemKind::Other, "h".to_owned(), 1),
        ];
        assert_eq!(found(source), expected);
    }

    #[test]
    fn types_of_a_trait_and_types_of_functions_are_no_items() {
        let source = "impl Iterator for A { type Item = u8; fn next(&mut self) -> Option<u8> { None } }\n\
                      fn f(g: fn(u8) -> u8, h: impl Fn(u8), p: *const u8) { const { 1 }; type Local = u8; }";
        let names: Vec<String> = found(source).into_iter().map(|(_, name, _)| name).collect();
        assert_eq!(names, ["next", "f", "Local"]);
    }
}
