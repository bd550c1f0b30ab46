# SPDX-License-Identifier: Apache-2.0
"""How the examples of rules are put together: an element a line."""

from __future__ import annotations


def block(opening: str, *inside: str) -> str:
    """An element with what is inside of it, indented; ``opening`` is its start tag."""
    if not inside:
        return f"{opening[:-1]}/>\n"
    tag = opening[1:-1].partition(" ")[0]
    lines = "".join(map(_indented, inside))
    return f"{opening}\n{lines}</{tag}>\n"


def _indented(text: str) -> str:
    # What textwrap.indent makes, which is slow to import, as examples have no empty lines.
    return "".join(f"  {line}\n" for line in text.rstrip().split("\n"))


def a_link(name: str) -> str:
    """A link without anything in it."""
    return f'<link name="{name}"/>\n'


def a_joint(name: str, type_: str, parent: str, child: str, *inside: str) -> str:
    """A joint between two links."""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return block(f'<joint name="{name}" type="{type_}">', ends, *inside)
