# SPDX-License-Identifier: Apache-2.0
"""The topics and services that a plugin's code names, with the values of its parameters in them."""

from __future__ import annotations

from collections.abc import Iterator

from lxml.etree import _Element

from multibot_rewrite.description.readback.parameters import given_at, holds, values_of
from multibot_rewrite.description.rewriters.vocabulary import VocabularySection
from multibot_rewrite.description.rewriters.vocabulary.wired import WiredTopic, is_type


def wired_of(plugin: _Element, section: VocabularySection) -> Iterator[tuple[WiredTopic, str]]:
    """Each with the path of the parameter that it is below, empty without one."""
    for it in section.wired:
        if it.when and not holds(plugin, it.when):
            continue
        path = it.name.partition("{")[2].partition("}")[0]
        for name in _filled(plugin, section, it.name):
            yield it._replace(name=name, type=_type(plugin, it.type)), path


def _filled(plugin: _Element, section: VocabularySection, name: str) -> Iterator[str]:
    """The name for each value of the first path in it, and so on."""
    head, slot, rest = name.partition("{")
    if not slot:
        yield name
        return
    path, _, tail = rest.partition("}")
    for value in _values(plugin, section, path):
        yield from _filled(plugin, section, f"{head}{value}{tail}")


def _values(plugin: _Element, section: VocabularySection, path: str) -> list[str]:
    site = next((it for it in section.sites if it.path == path), None)
    return given_at(plugin, path) if site is None else values_of(plugin, site)


def _type(plugin: _Element, type_: str) -> str:
    """``{output_type:pkg/msg/A}``: what the plugin is told, which may be without ``msg``."""
    if not type_.startswith("{"):
        return type_
    path, _, usual = type_[1:-1].partition(":")
    text = next(iter(given_at(plugin, path)), "") or usual
    full = text if text.count("/") > 1 else text.replace("/", "/msg/")
    return full if is_type(full) else ""
