# SPDX-License-Identifier: Apache-2.0
"""Where a value is, as reports write it: ``robot/gazebo/plugin[libfoo.so]/frameName``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from multibot_rewrite.base.loose_xml import NAMESPACES

if TYPE_CHECKING:
    from lxml.etree import _Element

_PREFIXES = {uri: prefix for prefix, uri in NAMESPACES.items()}
_NAMED = ("param", "parameter")


def tag_path(element: _Element, attribute: str) -> str:
    """Where a value is: the tags from the root on, and the attribute."""
    steps = [_step(element), *(_step(above) for above in element.iterancestors())]
    path = "/".join(reversed(steps))
    return f"{path}@{short_name(attribute)}" if attribute else path


def _step(element: _Element) -> str:
    tag = short_name(str(element.tag), element.prefix)
    if tag == "plugin":
        return f"{tag}[{plugin_name(element)}]"
    name = element.get("name") if tag in _NAMED else None
    return f"{tag}[{name}]" if name else tag


def short_name(name: str, prefix: str | None = None) -> str:
    """A tag or attribute as the vocabulary writes it; ``prefix`` is for a namespace it lacks."""
    uri, brace, local = name.removeprefix("{").partition("}")
    short = _PREFIXES.get(uri, prefix) if brace else None
    return f"{short}:{local}" if short else name


def plugin_name(element: _Element) -> str:
    """What a ``<plugin>`` is called: its library without folders, else its class."""
    library = element.get("filename", "").strip().rpartition("/")[2]
    return library or element.get("name", "").strip()
