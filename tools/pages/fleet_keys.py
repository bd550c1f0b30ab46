# SPDX-License-Identifier: Apache-2.0
"""The page of the keys of a fleet file, from its schema."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from multibot_rewrite.fleet.file.fleet_data import schema
from tools.pages.markdown import ESCAPED

HEAD = """\
# Keys of the fleet file

Made from the schema that editors read, `multibot_rewrite/fleet/fleet.schema.json`. How they work
together: [the fleet file](fleet-file.md).
"""
TITLES = {
    "The fleet": (),
    "A robot": ("$defs", "robot"),
    "RelatedFiles": ("$defs", "related_files"),
    "A cell": ("properties", "cell"),
    "Zenoh": ("properties", "zenoh"),
}


def page() -> str:
    """Return the page, Markdown."""
    return "\n".join((HEAD, *(line for it in TITLES.items() for line in _table(*it))))


def _table(title: str, path: tuple[str, ...]) -> Iterator[str]:
    part = schema()
    for key in path:
        part = part[key]
    yield from (f"## {title}", "", "| key | meaning | default |", "|---|---|---|")
    for key, value in sorted(part["properties"].items()):
        yield _row(key, value, key in part.get("required", ()))
    yield ""


def _row(key: str, value: Mapping[str, Any], required: bool) -> str:
    about, _, default = value["description"].partition("; default: ")
    page = value.get("$comment", "").removeprefix("docs/")
    more = f" ([more]({page}))" if page else ""
    choices = ", ".join(f"`{it}`" for it in value.get("enum", ()))
    meaning = f"{about.translate(ESCAPED)}{': ' * bool(choices)}{choices}{more}"
    return f"| `{key}` | {meaning} | {'required' if required else default.translate(ESCAPED)} |"
