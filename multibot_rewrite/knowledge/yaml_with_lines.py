# SPDX-License-Identifier: Apache-2.0
"""YAML with the file and line of every value, for errors; and the keys that any fact may have."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, NoReturn, TypeAlias, TypeVar

from multibot_rewrite.base.bounded import compose_own_yaml, compose_yaml
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.nearest import unknown

if TYPE_CHECKING:
    import yaml
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.releases import RELEASES, has_release, is_release_words
from multibot_rewrite.knowledge.conditions import parse_condition
from multibot_rewrite.knowledge.packages import by_version

_BOOLEAN = "tag:yaml.org,2002:bool"
Known = TypeVar("Known")
Value: TypeAlias = "str | bool | Mapping[str, YamlItem] | tuple[YamlItem, ...] | None"


class YamlItem(NamedTuple):
    """A value of a YAML file; ``where`` is ``file:line``."""

    where: str
    value: Value


def read_yaml_with_lines(text: str, file: str, own: bool = False) -> YamlItem:
    """Return the document of a YAML text, without limits for an own one; raises UsageError."""
    try:
        node = compose_own_yaml(text) if own else compose_yaml(text, file)
        return YamlItem(f"{file}:1", None) if node is None else _yaml_item(node, f"{file}:1", file)
    except InputError as error:
        raise UsageError(str(error)) from None


def _yaml_item(node: "yaml.Node", where: str, file: str) -> YamlItem:
    if isinstance(node.value, str):
        if node.tag == "tag:yaml.org,2002:null":
            return YamlItem(where, None)
        return YamlItem(where, _is_true(node.value) if node.tag == _BOOLEAN else node.value)
    import yaml

    if isinstance(node, yaml.MappingNode):
        return YamlItem(where, _read_mapping(node, file))
    inner = (_yaml_item(it, f"{file}:{it.start_mark.line + 1}", file) for it in node.value)
    return YamlItem(where, tuple(inner))


def _is_true(word: str) -> bool:
    return word.lower() in ("true", "yes", "on")


def _read_mapping(node: "yaml.Node", file: str) -> dict[str, YamlItem]:
    found: dict[str, YamlItem] = {}
    for key, value in node.value:
        where = f"{file}:{key.start_mark.line + 1}"
        if not isinstance(key.value, str):
            raise UsageError(f"{where}: a key is a mapping or a list; use a name as key")
        if key.value in found:
            raise UsageError(f"{where}: the key {key.value!r} is repeated; remove one of them")
        # A block value starts a line below its key; a reader looks for the key.
        found[key.value] = _yaml_item(value, where, file)
    return found


def table(item: YamlItem, what: str, allowed: Sequence[str] = ()) -> Mapping[str, YamlItem]:
    """Return the keys of a mapping, empty without a value; keys not ``allowed`` are an error."""
    if item.value is None:
        return {}
    if not isinstance(item.value, Mapping):
        wrong(item, f"{what} is {_type_in_words(item)}; write keys and values")
    for key in item.value if allowed and item.value.keys() - allowed else ():
        if key not in allowed:
            wrong(item.value[key], unknown("key", key, allowed))
    return item.value


def word(item: YamlItem, what: str) -> str:
    """Return the text of an item, which may be empty; raises UsageError for another value."""
    if not isinstance(item.value, str):
        wrong(item, f"{what} is {_type_in_words(item)}; write a text, in quotes if needed")
    return item.value


def table_of(keys: Mapping[str, YamlItem], key: str) -> Mapping[str, YamlItem]:
    """Return the mapping of a key, empty if it is missing."""
    return table(keys[key], key) if key in keys else {}


def entries_of(keys: Mapping[str, YamlItem], key: str) -> tuple[YamlItem, ...]:
    """Return the list of a key, empty if it is missing; a single word is a list of one."""
    return entries(keys[key], key) if key in keys else ()


def entries(item: YamlItem, what: str) -> tuple[YamlItem, ...]:
    """Return the entries of a list; a single word is a list of one."""
    if isinstance(item.value, str):
        return (item,)
    if not isinstance(item.value, tuple):
        wrong(item, f"{what} is {_type_in_words(item)}; write a list")
    return item.value


def words_of(keys: Mapping[str, YamlItem], key: str) -> tuple[str, ...]:
    """Return the words listed by a key, empty if it is missing."""
    return tuple(word(entry, key) for entry in entries_of(keys, key)) if key in keys else ()


def word_of(keys: Mapping[str, YamlItem], key: str, otherwise: str = "") -> str:
    """Return the text of a key, ``otherwise`` if it is missing."""
    return word(keys[key], key) if key in keys else otherwise


def flag_of(keys: Mapping[str, YamlItem], key: str, otherwise: bool = False) -> bool:
    """Return True or False as a key has it, ``otherwise`` if it is missing."""
    if key not in keys:
        return otherwise
    value = keys[key].value
    if not isinstance(value, bool):
        wrong(keys[key], f"{key} is {_type_in_words(keys[key])}; write true or false")
    return value


def known_word(item: YamlItem, what: str, known: Mapping[str, Known]) -> Known:
    """Return what ``known`` has for the text of an item; raises UsageError for another text."""
    name = word(item, what)
    if name not in known:
        wrong(item, unknown(what, name, known))
    return known[name]


def one_of(item: YamlItem, what: str, value: str, allowed: Sequence[str]) -> str:
    """Return the value; raises UsageError for one that is not allowed."""
    if value not in allowed:
        wrong(item, unknown(what, value, allowed))
    return value


def wrong(item: YamlItem, message: str) -> NoReturn:
    """Raise UsageError at the place of ``item``."""
    raise UsageError(f"{item.where}: {message}")


def _type_in_words(item: YamlItem) -> str:
    if isinstance(item.value, str):
        return f"the text {item.value!r}"
    if isinstance(item.value, bool):
        return "true or false"
    if item.value is None:
        return "empty"
    return "a mapping" if isinstance(item.value, Mapping) else "a list"


RELEASES_KEY, SOURCE_KEY = "releases", "source"
FACT_KEYS = (RELEASES_KEY, SOURCE_KEY)
# OWNER/NAME@TAG-OR-COMMIT PATH[:LINE]
_WORD = lazy_compile(r"[A-Za-z]+")
_SOURCE = lazy_compile(r"[\w.-]+/[\w.-]+@[\w./+-]+ [^\s:]+(?::[0-9]+)?")


def releases_of(keys: Mapping[str, YamlItem], key: str = RELEASES_KEY) -> str:
    """Return the release words of a key, empty for all releases."""
    words = by_version(word_of(keys, key))
    if words and not is_release_words(words):
        for name in _WORD.findall(words):
            if name not in RELEASES:
                wrong(keys[key], unknown("release", name, RELEASES))
        hint = (
            "write jazzy, kilted+, <=jazzy, jazzy 1.3.9+ or twist_mux 4.4.0+, with commas between"
        )
        wrong(keys[key], f"{key} {words!r} names no releases; {hint}")
    return words


def source_of(keys: Mapping[str, YamlItem]) -> tuple[str, ...]:
    """Return the places where a fact can be read: ``OWNER/NAME@TAG PATH[:LINE]``, one or a list."""
    found = words_of(keys, SOURCE_KEY)
    for text in found:
        if not _SOURCE.fullmatch(text):
            hint = "write OWNER/NAME@TAG PATH or OWNER/NAME@COMMIT PATH:LINE"
            wrong(keys[SOURCE_KEY], f"source {text!r} names no place; {hint}")
    return found


def variants(item: YamlItem) -> tuple[YamlItem, ...]:
    """Return the variants of a fact in different releases as a list, also a single one."""
    return item.value if isinstance(item.value, tuple) else (item,)


def check_apart(item: YamlItem, what: str, words: Sequence[str]) -> None:
    """Raise UsageError unless a fact has variants, no two of which hold in one release."""
    if not words:
        wrong(item, f"{what} is an empty list; write what it is")
    for release in RELEASES if len(words) > 1 else ():
        if sum(has_release(it, release) for it in words) > 1:
            wrong(item, f"{what} is there twice in {release}; give each its own {RELEASES_KEY}")


def text_and_words(item: YamlItem, what: str, key: str) -> Mapping[str, YamlItem]:
    """Return the keys of a mapping, or of a text alone, which is its ``key``."""
    if not isinstance(item.value, Mapping):
        return {key: item._replace(value=word(item, what))}
    found = table(item, what, (key, *FACT_KEYS))
    if key not in found:
        wrong(item, f"{what} has no {key}; add {key}:")
    return found


def condition_of(keys: Mapping[str, YamlItem], key: str = "if") -> str:
    """Return the condition under ``if`` or ``when``; another text is an error at its line."""
    return checked_condition(keys[key], word_of(keys, key)) if key in keys else ""


def checked_condition(item: YamlItem, text: str) -> str:
    """Return the text, if it is a condition; otherwise raise an error at the line of the item."""
    try:
        parse_condition(text)
    except UsageError as error:
        wrong(item, str(error))
    return text
