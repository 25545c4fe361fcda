"""Lays out the pages of the site: links that lead out of docs/ are turned to where the site has them.

Usage: lay_out.py REPOSITORY PAGES      PAGES holds copies of the documents; what they name elsewhere is copied to PAGES/files
"""

import re
import shutil
import sys
from pathlib import Path

LINK = re.compile(r"(\]\()([^)\s]+)(\))")
# Documents that lie elsewhere in the repository, and how the site calls them.
MOVED = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")


def place(repository: Path, pages: Path, home: Path, link: str) -> str:
    """Where `link`, as it stands in a document of the folder `home`, leads in the site."""
    path, _, fragment = link.partition("#")
    if "://" in link or not path:
        return link
    found = (home / path).resolve()
    if not found.exists():
        # What the build lays beside the pages later; a link that leads nowhere is found when all of them are followed.
        return link
    name = found.relative_to(repository).as_posix()
    if name.startswith("docs/"):
        return join(name.removeprefix("docs/").removeprefix("site/"), fragment)
    if name in MOVED:
        return join(name, fragment)
    if name.endswith(".md"):
        # No page of the site: a text, which mdBook leaves as it is.
        name = name.removesuffix(".md") + ".txt"
    return join(copy(found, pages / "files" / name, name), fragment)


def copy(found: Path, to: Path, name: str) -> str:
    """Copies a file, or a folder with a page that lists it; where it is then."""
    to.parent.mkdir(parents=True, exist_ok=True)
    if found.is_file():
        shutil.copyfile(found, to)
        return f"files/{name}"
    shutil.copytree(found, to, dirs_exist_ok=True)
    entries = "".join(f'<li><a href="{e.name}">{e.name}</a></li>' for e in sorted(found.iterdir()))
    page = f"<!doctype html><meta charset=utf-8><title>{name}</title><h1>{name}</h1><ul>{entries}</ul>\n"
    (to / "index.html").write_text(page)
    return f"files/{name}/index.html"


def join(path: str, fragment: str) -> str:
    return f"{path}#{fragment}" if fragment else path


def main() -> None:
    repository, pages = (Path(p).resolve() for p in sys.argv[1:3])
    for page in sorted(pages.glob("*.md")):
        homes = [repository, repository / "docs", repository / "docs/site"]
        home = next(h for h in homes if (h / page.name).is_file())
        text = page.read_text()
        page.write_text(LINK.sub(lambda m: m[1] + place(repository, pages, home, m[2]) + m[3], text))


main()
