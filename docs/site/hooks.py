# SPDX-License-Identifier: Apache-2.0
"""Pages that are made of what the package knows, pages that are not in docs/, and where links lead.

On GitHub all links are to files of the repository, and to a section of reference.md in place of a made
page. On the site a page that is linked is a page, too; the repository's host shows any other file.
"""

from __future__ import annotations

import posixpath
import re
import sys
from functools import cache
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from tools.pages.every import STANDS_FOR, every_page, meant  # noqa: E402

# Where they are in the repository, and in the site's folder of pages.
OUTSIDE = ("CONTRIBUTING.md", "SECURITY.md", "examples/*/README.md")
EARLY, LATE = {"Tutorials", "How-to"}, {"Contributing"}
# Its text is needed where it is one word, as a code is.
LINK = re.compile(r"((?:\[(\w+))?\]\()([^)\s:#]+)((?:#[^)\s]*)?)\)")
FENCED = re.compile(r"(^```.*?^```$)", re.MULTILINE | re.DOTALL)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are made, and those outside docs/."""
    for name, text in made().items():
        files.append(File.generated(config, name, content=text))
    for pattern in OUTSIDE:
        for path in sorted(ROOT.glob(pattern)):
            name = path.relative_to(ROOT).as_posix()
            files.append(File.generated(config, name, abs_src_path=str(path)))
    changes = (ROOT / "CHANGELOG.rst").read_text()
    files.append(File.generated(config, "CHANGELOG.md", content=as_markdown(changes)))
    return files


@cache
def made() -> dict[str, str]:
    """Return the made pages, once for all builds of this process."""
    return every_page()


def as_markdown(text: str) -> str:
    """Return the change log, which catkin's tools want in reStructuredText."""
    text = re.sub(r"^\^+\n(.*)\n\^+$", r"# \1", text, flags=re.MULTILINE)
    text = re.sub(r"^(.+)\n-+$", r"## \1", text, flags=re.MULTILINE)
    return text.replace("``", "`")


def boost(page: Page) -> float:
    """How early the search shows a page: tables of measurements have every word."""
    sections = {it.title for it in page.ancestors}
    return 0.2 if sections & LATE else 2 if sections & EARLY else 1


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Links as they lead from where the page is on the site."""
    page.meta["search"] = {"boost": boost(page)}
    there = place(page.file.src_uri)

    def lead(found: re.Match[str]) -> str:
        start, words, link, anchor = found.groups()
        path = posixpath.normpath(posixpath.join(posixpath.dirname(there), link))
        own = meant(words or "", anchor[1:], made()) if path == f"docs/{STANDS_FOR}" else ""
        path, anchor = (f"docs/{own}", "") if own else (path, anchor)
        return f"{start}{target(path, page, config, files)}{anchor})"

    parts = FENCED.split(markdown)
    return "".join(it if it.startswith("```") else LINK.sub(lead, it) for it in parts)


def place(uri: str) -> str:
    """Return the path in the repository of a page of the site."""
    return uri if (ROOT / uri).exists() else f"docs/{uri}"


def target(path: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Return what leads from a page to a file of the repository."""
    uri = "index.md" if path == "README.md" else path.removeprefix("docs/")
    if files.get_file_from_path(uri):
        return posixpath.relpath(uri, posixpath.dirname(page.file.src_uri) or ".")
    if (ROOT / path).exists():
        kind = "tree" if (ROOT / path).is_dir() else "blob"
        return f"{config.extra['repository']}/{kind}/HEAD/{path}"
    return f"missing/{path}"
