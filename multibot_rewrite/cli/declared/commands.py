# SPDX-License-Identifier: Apache-2.0
"""Reads every command line of the package from its page ``NAME.txt``.

A line that is not indented begins a part: ``key: text``, or ``[title]`` with the options of a
group, each ``KIND NAME METAVAR ...: what it is for``. What many commands take is in
``shared.txt``: its groups by their titles alone, its options by ``--name``, with a text of their
own behind it or not."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from itertools import pairwise

from multibot_rewrite.base.conventions import SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.findings.finding import LEVELS
from multibot_rewrite.base.findings.formats import FORMATS
from multibot_rewrite.base.naming import DEFAULT_LAYOUT, LAYOUTS, SEPARATORS, WORLD_SYSTEMS
from multibot_rewrite.base.releases import NEWEST_LTS, RELEASES, VARIABLE
from multibot_rewrite.cli.declared.options import KINDS, Command, Example, Option, OptionGroup
from multibot_rewrite.cli.values import MAX_DOMAIN

# What pages say of other modules: the words of a choice, and how they are explained.
_KNOWN = {
    "LAYOUTS": "|".join(name for it in LAYOUTS for name in (it.name, it.short)),
    "layouts": "; ".join(f"{it.name} ({it.short}): {it.about}" for it in LAYOUTS),
    "layout names": ", ".join(it.name for it in LAYOUTS),
    "layout": DEFAULT_LAYOUT,
    "WORLD_SYSTEMS": "|".join(WORLD_SYSTEMS),
    "separators": " ".join(f"{kind}={mark}" for kind, mark in SEPARATORS.items()),
    "shared": ", ".join((*WORLD_FRAMES, *SHARED_TOPICS)),
    "LEVELS": "|".join(LEVELS),
    "FORMATS": "|".join(FORMATS),
    "formats": ", ".join(FORMATS),
    "RELEASES": "|".join(RELEASES),
    "releases": ", ".join(RELEASES),
    "variable": VARIABLE,
    "release": NEWEST_LTS,
    "domains": str(MAX_DOMAIN),
}
_Part = tuple[str, Sequence[str]]


@cache
def read_command(name: str) -> Command:
    """Return the command of a page; raises FileNotFoundError where there is none."""
    fields: dict[str, str] = {}
    groups: list[OptionGroup] = []
    examples: tuple[Example, ...] = ()
    for head, below in _page_parts(name):
        key, _, text = head.partition(":")
        if head.startswith("["):
            groups.append(_parse_group(head.strip("[]"), below))
        elif key == "examples":
            examples = tuple(Example(*it.partition("    # ")[::2]) for it in below if it)
        else:
            # Paragraphs in one line each; one that is indented keeps its lines.
            parts = "\n".join(below).strip("\n").split("\n\n")
            lines = (it if it.startswith(" ") else it.replace("\n", " ") for it in parts)
            fields[key] = text.strip() or "\n\n".join(lines)
    return Command(
        name,
        fields.get("module", name.replace("-", "_")),
        fields["usage"],
        fields["about"],
        examples,
        tuple(groups),
        fields["exit codes"],
        fields.get("more", ""),
        fields.get("fail on", ""),
        "findings first" in fields,
    )


def _page_parts(name: str) -> Iterator[_Part]:
    path = os.path.join(os.path.dirname(__file__), f"{name}.txt")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for word, said in _KNOWN.items():
        text = text.replace(f"{{{word}}}", said)
    return _split_parts(text.splitlines())


def _split_parts(lines: Sequence[str]) -> Iterator[_Part]:
    """Yield each line without indent, with the lines below it, two spaces less indented."""
    starts = [at for at, it in enumerate(lines) if it.strip() and not it.startswith(" ")]
    for start, end in pairwise((*starts, len(lines))):
        yield lines[start], [it[2:] for it in lines[start + 1 : end]]


def _parse_group(title: str, lines: Sequence[str]) -> OptionGroup:
    """Return a group of options; one with a title only is the shared group."""
    options = tuple(_parse_option(" ".join((it, *more))) for it, more in _split_parts(lines))
    return OptionGroup(title, options) if options else _shared_groups()[title]


def _parse_option(text: str) -> Option:
    """Return the option that a line declares; one without a kind is shared."""
    head, _, about = " ".join(text.split()).partition(": ")
    kind, *words = head.split()
    if words or kind in KINDS:
        return KINDS[kind](about, *words)
    every = (it for group in _shared_groups().values() for it in group.options)
    found = next(it for it in every if kind in it.names)
    return found._replace(help=about) if about else found


@cache
def _shared_groups() -> Mapping[str, OptionGroup]:
    groups = (_parse_group(head.strip("[]"), below) for head, below in _page_parts("shared"))
    return {it.title: it for it in groups}


class _Pages(Mapping[str, Command]):
    """Commands by name, each read when it is asked for."""

    def __init__(self, *names: str) -> None:
        self._names = names

    def __getitem__(self, name: str) -> Command:
        if name not in self._names:
            raise KeyError(name)
        return read_command(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


COMMANDS: Mapping[str, Command] = _Pages(
    *("adopt", "build", "check", "check-launch", "completion", "init", "inspect", "join"),
    *("plan", "rehearse", "rename", "snapshot", "view"),
)
# The commands that are programs of their own.
PROGRAMS: Mapping[str, Command] = _Pages("urdf-postfix", "urdf-lint")
