//! A page of HTML that needs no other file and no script: headings, paragraphs, tables, drawings.

use super::Drawing;
use super::svg::{self, escaped};
use toile_assets::put_line;

const STYLE: &str = "body { font-family: system-ui, sans-serif; background: #fff; color: #222; max-width: 1080px; \
margin: 2em auto; padding: 0 1em; }\nsvg { max-width: 100%; height: auto; }\ntable { border-collapse: collapse; }\n\
th, td { padding: 0.2em 0.7em; text-align: right; border-bottom: 1px solid #ddd; }\nth:first-child, td:first-child, \
.words { text-align: left; }";

/// Content of a cell of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// A figure, to the right.
    Figure(String),
    /// Words, to the left.
    Words(String),
}

impl Entry {
    /// A number, set to the right.
    pub fn figure(value: impl ToString + Copy) -> Self {
        Self::Figure(value.to_string())
    }

    /// Words, set to the left.
    pub fn words(text: impl Into<String>) -> Self {
        Self::Words(text.into())
    }

    fn html(&self) -> String {
        match self {
            Self::Figure(text) => format!("<td>{}</td>", escaped(text)),
            Self::Words(text) => format!("<td class=\"words\">{}</td>", escaped(text)),
        }
    }
}

/// A page under construction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    html: String,
}

impl Page {
    /// An empty page of a title.
    pub fn new(title: &str) -> Self {
        let title = escaped(title);
        let head = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
        Self { html: format!("{head}<title>{title}</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n") }
    }

    /// The page's own heading.
    pub fn title(&mut self, text: &str) -> &mut Self {
        self.element("h1", text)
    }

    /// The heading of a section.
    pub fn section(&mut self, text: &str) -> &mut Self {
        self.element("h2", text)
    }

    /// A paragraph; a line break in the text is one on the page.
    pub fn paragraph(&mut self, text: &str) -> &mut Self {
        self.element("p", text)
    }

    fn element(&mut self, name: &str, text: &str) -> &mut Self {
        let text = escaped(text).replace('\n', "<br>\n");
        put_line!(self.html, "<{name}>{text}</{name}>");
        self
    }

    /// A table; its first column is words whatever it holds.
    pub fn table(&mut self, heads: &[&str], rows: impl IntoIterator<Item = Vec<Entry>>) -> &mut Self {
        let heads: String = heads.iter().map(|head| format!("<th>{}</th>", escaped(head))).collect();
        put_line!(self.html, "<table>\n<tr>{heads}</tr>");
        for row in rows {
            let cells: String = row.iter().map(Entry::html).collect();
            put_line!(self.html, "<tr>{cells}</tr>");
        }
        self.html.push_str("</table>\n");
        self
    }

    /// Adds a drawing to the page.
    pub fn drawing(&mut self, drawing: &Drawing) -> &mut Self {
        self.html.push_str(&svg::text(drawing));
        self
    }

    /// The text of the page.
    pub fn finish(self) -> String {
        self.html + "</body>\n</html>\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_page_would_read_as_its_own_signs_is_written_out() {
        let mut page = Page::new("a & b");
        page.title("1 < 2").paragraph("one\ntwo").paragraph("\"<script>\"");
        page.table(&["x"], [vec![Entry::words("<b>"), Entry::figure(7)]]);
        let html = page.finish();
        for text in ["<title>a &amp; b</title>", "1 &lt; 2", "one<br>\ntwo", "&lt;script&gt;", "&lt;b&gt;"] {
            assert!(html.contains(text), "{text} is not in {html}");
        }
        assert!(!html.contains("<script") && html.ends_with("</html>\n"));
    }
}
