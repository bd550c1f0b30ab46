# SPDX-License-Identifier: Apache-2.0
"""What every fact may say besides itself: the releases that have it, and where that can be read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES, has_release, is_release_words
from multibot_rewrite.knowledge.conditions import parse_condition
from multibot_rewrite.knowledge.yaml_with_lines import (
    YamlItem,
    table,
    unknown,
    word,
    word_of,
    words_of,
    wrong,
)

RELEASES_KEY, SOURCE_KEY = "releases", "source"
FACT_KEYS = (RELEASES_KEY, SOURCE_KEY)
# OWNER/NAME@TAG-OR-COMMIT PATH[:LINE]
_WORD = lazy_compile(r"[A-Za-z]+")
_SOURCE = lazy_compile(r"[\w.-]+/[\w.-]+@[\w./+-]+ [^\s:]+(?::[0-9]+)?")


def releases_of(keys: Mapping[str, YamlItem], key: str = RELEASES_KEY) -> str:
    """The release words of a key, empty for all releases."""
    words = word_of(keys, key)
    if words and not is_release_words(words):
        for name in _WORD.findall(words):
            if name not in RELEASES:
                wrong(keys[key], unknown("release", name, RELEASES))
        hint = "write jazzy, kilted+, <=jazzy or jazzy 1.3.9+, with commas between"
        wrong(keys[key], f"{key} {words!r} names no releases; {hint}")
    return words


def source_of(keys: Mapping[str, YamlItem]) -> tuple[str, ...]:
    """The places where a fact can be read: ``OWNER/NAME@TAG PATH[:LINE]``, one or a list."""
    found = words_of(keys, SOURCE_KEY)
    for text in found:
        if not _SOURCE.fullmatch(text):
            hint = "write OWNER/NAME@TAG PATH or OWNER/NAME@COMMIT PATH:LINE"
            wrong(keys[SOURCE_KEY], f"source {text!r} names no place; {hint}")
    return found


def variants(item: YamlItem) -> tuple[YamlItem, ...]:
    """A fact, or a list of what it is in one release and another."""
    return item.value if isinstance(item.value, tuple) else (item,)


def check_apart(item: YamlItem, what: str, words: Sequence[str]) -> None:
    """A fact has a variant, and no two of them hold in one release."""
    if not words:
        wrong(item, f"{what} is an empty list; write what it is")
    for release in RELEASES if len(words) > 1 else ():
        if sum(has_release(it, release) for it in words) > 1:
            wrong(item, f"{what} is there twice in {release}; give each its own {RELEASES_KEY}")


def text_and_words(item: YamlItem, what: str, key: str) -> Mapping[str, YamlItem]:
    """The keys of a value that is a text alone, which is its ``key``, or a mapping with it."""
    if not isinstance(item.value, Mapping):
        return {key: item._replace(value=word(item, what))}
    found = table(item, what, (key, *FACT_KEYS))
    if key not in found:
        wrong(item, f"{what} has no {key}; add {key}:")
    return found


def condition_of(keys: Mapping[str, YamlItem], key: str = "if") -> str:
    """What ``if`` or ``when`` says; a text that is no condition is an error at its line."""
    return checked_condition(keys[key], word_of(keys, key)) if key in keys else ""


def checked_condition(item: YamlItem, text: str) -> str:
    """The text, if it is a condition; else an error at the line of the item."""
    try:
        parse_condition(text)
    except UsageError as error:
        wrong(item, str(error))
    return text
