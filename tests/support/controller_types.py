# SPDX-License-Identifier: Apache-2.0
"""The controller types that the plugin files of packages register.

Source: pluginlib class_loader_imp.hpp (``<class>`` with ``name``, or ``type`` where it has none, and
``base_class_type``, below ``<library>`` or ``<class_libraries>``).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from lxml import etree

_BASE = re.compile(r"controller_interface::(?:Chainable)?ControllerInterface")
_NOT_SHIPPED = {"test", "tests"}


def registered(folder: Path) -> Iterator[str]:
    """Yield the types in plugin files below a folder, but of tests; a type may come twice."""
    for file in sorted(folder.rglob("*.xml")):
        if _NOT_SHIPPED & set(file.relative_to(folder).parts[:-1]):
            continue
        text = file.read_bytes()
        if b"controller_interface::" in text:
            yield from _of(text)


def _of(text: bytes) -> Iterator[str]:
    try:
        root = etree.fromstring(text)
    except etree.XMLSyntaxError:
        return
    for it in root.iter("class"):
        if _BASE.fullmatch(it.get("base_class_type", "")):
            yield it.get("name") or it.get("type", "")
