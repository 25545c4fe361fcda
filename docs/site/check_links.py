"""Follows every link of a built site that stays within it: the file is there, and so is the place that a fragment names.

Usage: check_links.py SITE
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


# What rustdoc takes over from the standard library's own words, whose pages are not here.
ELSEWHERE = ("std/", "core/", "alloc/")


class Page(HTMLParser):
    """Links of a page, and the places in it that a link may name."""

    def __init__(self, path: Path):
        super().__init__()
        self.links: list[str] = []
        self.places: set[str] = set()
        self.sends_on_to: str | None = None
        self.feed(path.read_text(encoding="utf-8", errors="replace"))

    def handle_starttag(self, tag, attributes):
        # Where rustdoc moves a page, its script takes the fragment along.
        if tag == "meta" and ("http-equiv", "refresh") in attributes:
            self.sends_on_to = dict(attributes).get("content", "").partition("URL=")[2] or None
        for key, value in attributes:
            if key in ("href", "src") and value and not (tag == "link" and key == "href" and value.startswith("data:")):
                self.links.append(value)
            elif key in ("id", "name") and value:
                self.places.add(value)


def broken(site: Path) -> tuple[int, int, list[str]]:
    """How many pages and links there are, and a sentence for each link that leads to nothing."""
    pages = {path.resolve(): Page(path) for path in sorted(site.rglob("*.html"))}
    followed, sentences = 0, []
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or link.startswith(("#:~:", "javascript:")):
                continue
            if parts.path.removeprefix("../" * parts.path.count("../")).startswith(ELSEWHERE):
                continue
            followed += 1
            home = site if parts.path.startswith("/") else path.parent
            to = (home / unquote(parts.path).lstrip("/")).resolve() if parts.path else path
            if to.is_dir():
                to /= "index.html"
            where = f"{path.relative_to(site.resolve())}: {link}"
            if not to.is_file():
                sentences.append(f"{where} leads to no file")
            elif parts.fragment and to in pages and not named(sent_on(pages, to), parts.fragment):
                sentences.append(f"{where} names no place there")
    return len(pages), followed, sentences


def sent_on(pages: dict[Path, Page], path: Path) -> Page:
    """The page that a reader comes to see in the end."""
    page = pages[path]
    to = (path.parent / page.sends_on_to).resolve() if page.sends_on_to else path
    return pages.get(to, page)


def named(page: Page, fragment: str) -> bool:
    # Lines of a source file (`#10-20`) are made by the page's own script.
    return fragment in page.places or unquote(fragment) in page.places or fragment.replace("-", "").isdigit()


def main() -> None:
    site = Path(sys.argv[1])
    pages, links, sentences = broken(site)
    if sentences:
        sys.exit("\n".join(f"site: {s}" for s in sentences[:50]) + f"\nsite: {len(sentences)} links of {links} are broken")
    print(f"site: {pages} pages, {links} links, each leads somewhere")


main()
