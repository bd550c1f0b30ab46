# SPDX-License-Identifier: Apache-2.0
"""The pages of the plugin definitions, one for each of its files."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby

from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.description.rewriters.lookup import facts
from multibot_rewrite.description.rewriters.plugin_definitions import (
    TYPES,
    PluginDefinition,
    load_definitions,
)
from tools.pages.markdown import plain

HEAD = """\
# Plugins, elements and hardware classes

Everything the rewriters know, from `multibot_rewrite/description/rewriters/plugin_definitions/*.vocab`;
`multibot inspect NAME` prints one.

`declares` and `uses` name kinds, tried in order until one resolves; `keep` values are never renamed.
A default is inserted where the element is absent, or put into an empty one that means the same, if it
would be the same for every robot.
Topics under *only a remap moves* get a remap rule unless the file has one.

| page | sections |
|---|--:|
"""


def pages() -> dict[str, str]:
    """Path below docs/ -> Markdown: a page for each file, and the list of them."""
    sections = load_definitions((), "", packages=False).sections(*TYPES)
    by_file = groupby(sorted(sections, key=lambda r: (r.file, r.line)), lambda r: r.file)
    files = {file.removesuffix(".vocab"): list(found) for file, found in by_file}
    rows = (f"| [{name}]({name}.md) | {len(found)} |\n" for name, found in files.items())
    return {
        "plugins/index.md": HEAD + "".join(rows),
        **{f"plugins/{name}.md": _page(name, found) for name, found in files.items()},
    }


def _page(name: str, sections: Iterable[PluginDefinition]) -> str:
    return f"# {name}\n{''.join(map(_section, sections))}"


def _section(section: PluginDefinition) -> str:
    lines = [f"\n## {section.name}\n"]
    known = facts(section)
    about = known.pop("about", "")
    others = "; ".join(f"{what}: {text}" for what, text in known.items())
    lines += [f"\n{plain(text)}\n" for text in (about, others) if text]
    own = [site for site in section.sites if site.section == f"{section.type} {section.names[0]}"]
    if own:
        lines.append("\n| where | what | default | note |\n|---|---|---|---|\n")
        lines += [
            f"| `{site.path}` | {site.role} {' '.join(site.kinds)}{_form(site.form)} "
            f"| {plain(site.default)} | {plain(_note(site))} |\n"
            for site in own
        ]
    return "".join(lines)


def _note(site: SiteRow) -> str:
    end = f"{site.does} {site.type}" if site.does else ""
    return "; ".join(filter(None, (end, site.releases and f"in {site.releases}", site.note)))


def _form(form: str) -> str:
    return "" if form == "whole" else f" ({form})"
