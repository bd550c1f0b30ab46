# SPDX-License-Identifier: Apache-2.0
"""The new keys above the sections of a parameter file."""

from __future__ import annotations

import re
from collections.abc import Sequence

import yaml

from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.yaml_text import Splice, YamlText, found_at, replaced

_PATTERN = re.compile(r"/[A-Za-z0-9_/*]+")

MIXED_KEY = declare("MF101", "mixed-section-key", ERROR, formats=("params",))


def key_splices(document: YamlText, sections: Sequence[ParamSection]) -> list[Splice | Finding]:
    """The new keys above the sections."""
    new: dict[int, tuple[yaml.ScalarNode, str]] = {}
    made: list[Splice | Finding] = []
    for section in sections:
        kept = section.shared or section.full == section.path
        texts = [key.value for key in section.keys] if kept else _texts(section)
        for key, text in zip(section.keys, texts, strict=True):
            _, other = new.setdefault(id(key), (key, text))
            if other != text:
                message = f"the sections below {key.value!r} need different names: {other}, {text}"
                hint = "write each section under its own key, as in node: ros__parameters:"
                made.append(found_at(document, key, MIXED_KEY, message, hint))
    made += [_key_splice(key, text) for key, text in new.values() if text != key.value]
    return made


def _key_splice(key: yaml.ScalarNode, text: str) -> Splice:
    """A pattern needs no quotes unless it starts with a star."""
    splice = replaced(key, text)
    return splice if key.style or not _PATTERN.fullmatch(text) else splice._replace(new=text)


def _texts(section: ParamSection) -> list[str]:
    """The full name, divided over the keys as before; the namespace goes into the first key."""
    tokens = section.full.strip("/").split("/")
    texts = []
    for key in reversed(section.keys[1:]):
        count = key.value.strip("/").count("/") + 1
        texts.append("/".join(tokens[-count:]))
        tokens = tokens[:-count]
    # Without namespaces nothing is left of a key that was the robot's own.
    first = "/" + ("/".join(tokens) or "**")
    return [first, *reversed(texts)]
