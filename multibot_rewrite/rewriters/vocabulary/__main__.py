"""Print the reference page of the vocabulary: ``python -m multibot_rewrite.rewriters.vocabulary``."""

from __future__ import annotations

import sys
from itertools import groupby

from multibot_rewrite.model import Site
from multibot_rewrite.rewriters.vocabulary import (
    VocabularySection,
    check_vocabulary,
    load_vocabulary,
)
from multibot_rewrite.rewriters.vocabulary.describe import facts

HEAD = """\
# Plugins, elements and hardware classes

Everything the rewriters know, generated from `multibot_rewrite/rewriters/vocabulary/*.vocab` by
`python -m multibot_rewrite.rewriters.vocabulary > docs/plugins.md`.

`declares` and `uses` name kinds, tried in order until one resolves; `keep` values are never renamed.
A default is inserted where the element is absent, or put into an empty one that means the same, if it
would be the same for every robot.
Topics under *only a remap moves* get a remap rule unless the file has one.
"""


def page() -> str:
    """The whole page as Markdown."""
    sections = check_vocabulary(load_vocabulary((), "", packages=False))
    by_file = groupby(sorted(sections, key=lambda r: (r.file, r.line)), lambda r: r.file)
    parts = [HEAD]
    for file, rewriters in by_file:
        parts.append(f"\n## {file}\n")
        parts += [_section(section) for section in rewriters]
    return "".join(parts)


def _section(section: VocabularySection) -> str:
    lines = [f"\n### {section.name}\n"]
    known = facts(section)
    about = known.pop("about", "")
    others = "; ".join(f"{what}: {text}" for what, text in known.items())
    lines += [f"\n{text}\n" for text in (about, others) if text]
    own = [site for site in section.sites if site.section == f"{section.type} {section.names[0]}"]
    if own:
        lines.append("\n| where | what | default | note |\n|---|---|---|---|\n")
        lines += [
            f"| `{site.path}` | {site.role} {' '.join(site.kinds)}{_form(site.form)} "
            f"| {site.default} | {_note(site)} |\n"
            for site in own
        ]
    return "".join(lines)


def _note(site: Site) -> str:
    end = f"{site.does} {site.type}" if site.does else ""
    return "; ".join(filter(None, (end, site.releases and f"in {site.releases}", site.note)))


def _form(form: str) -> str:
    return "" if form == "whole" else f" ({form})"


if __name__ == "__main__":
    sys.stdout.write(page())
