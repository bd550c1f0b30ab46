# SPDX-License-Identifier: Apache-2.0
"""YAML checked against a JSON Schema: plain data with its lines, or one line with the error."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.file_kinds import FLEET, refuse_others
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of, other_words
from multibot_rewrite.related_files.yaml_text import line_of, pairs, read_yaml, refuse_anchors

Path = tuple[Any, ...]
# JSON Schema's types in plain words.
TYPES = {
    "array": "a list",
    "object": "keys with values",
    "string": "text",
    "number": "a number",
    "integer": "a whole number",
    "boolean": "true or false",
}
SHOWN = 60
# The key under which a fleet file names the files beside a description.
BELOW = "related_files"
# What fleet files of 0.2.0 call otherwise.
_OLD_KEYS = {"companions": BELOW, "vocabulary": "definitions", "stack": "node_sets"}


class CheckedYaml(NamedTuple):
    """The data of a file, and the line of each of its values by path."""

    data: dict[str, Any]
    lines: Mapping[Path, int]


def text_checked(text: bytes, path: str, schema: Mapping[str, Any], hint: str) -> CheckedYaml:
    """Return a file's data; raises InputError with line and key; ``hint`` is for an empty file."""
    refuse_others(text, path, FLEET)
    document = read_yaml(text, path)
    if document.root is None:
        raise InputError(f"{path}: the file is empty; {hint}")
    refuse_anchors(document)
    if not isinstance(document.root, yaml.MappingNode):
        raise InputError(f"{path}:1: the file must hold keys with values; {hint}")
    lines = dict(_lines(document.root, path, ()))
    data = _in_new_keys(load_yaml(document.text, path, "write plain keys and values"))
    found = [it for error in _errors(data, schema) for it in _faults(error, lines, schema)]
    if found:
        (line, words), *others = dict.fromkeys(sorted(found, key=lambda it: it[0]))
        also = "".join(f"; line {at}: {text}" for at, text in others)
        raise InputError(f"{path}:{line}: {words}{also}")
    return CheckedYaml(data, lines)


def _in_new_keys(data: Any) -> Any:
    """Return the data of a fleet or its robots with each old key under its new name."""
    if not isinstance(data, dict):
        return [*map(_in_new_keys, data)] if isinstance(data, list) else data
    new = {_OLD_KEYS.get(key, key): value for key, value in data.items()}
    return {**new, "robots": _in_new_keys(new["robots"])} if "robots" in new else new


def _lines(node: yaml.Node, file: str, path: Path) -> Iterator[tuple[Path, int]]:
    """Yield the path and line of every value and key; raises InputError for a repeated key."""
    yield path, line_of(node)
    if isinstance(node, yaml.SequenceNode):
        for at, item in enumerate(node.value):
            yield from _lines(item, file, (*path, at))
    seen: dict[str, int] = {}
    for key, value in pairs(node):
        name = str(_OLD_KEYS.get(key.value, key.value) if len(path) in (0, 2) else key.value)
        if name in seen:
            first = f"first in line {seen[name]}; remove one of them"
            raise InputError(f"{file}:{line_of(key)}: the key {name!r} is repeated, {first}")
        seen[name] = line_of(key)
        for below, line in _lines(value, file, (*path, name)):
            yield below, line_of(key) if below == (*path, name) else line


def _errors(data: Any, schema: Mapping[str, Any]) -> list[Any]:
    """Return every error, with the deepest reason of each."""
    # It says in a seventh of the time that nothing is wrong; no distribution of ROS has it.
    with suppress(ImportError, ValueError):
        from jsonschema_rs import is_valid

        if is_valid(dict(schema), data):
            return []
    try:
        import jsonschema
        from jsonschema.exceptions import best_match

        # Ubuntu 22.04 has 3.2; the schema says nothing that its draft reads differently.
        newest = getattr(jsonschema, "Draft202012Validator", None) or jsonschema.Draft7Validator
    except (ImportError, AttributeError) as error:
        what = "a fleet file is checked with jsonschema 3.2 or newer"
        hint = "install it: pip install 'jsonschema>=3.2'"
        raise UsageError(f"{what}; {hint} ({error})") from None
    return [best_match([it]) for it in newest(schema).iter_errors(data)]


def _faults(
    error: Any, lines: Mapping[Path, int], schema: Mapping[str, Any]
) -> Iterator[tuple[int, str]]:
    """Yield the line and the message of each fault in an error."""
    path = tuple(error.absolute_path)
    line = next(lines[path[:end]] for end in range(len(path), -1, -1) if path[:end] in lines)
    where = "".join(f"[{it}]" if isinstance(it, int) else f".{it}" for it in path).lstrip(".")
    where = f"{where}: " if where else ""
    if error.validator != "additionalProperties":
        yield line, f"{where}{_in_words(error)}"
        return
    known = error.schema["properties"]
    below = schema["$defs"].get(BELOW, {}).get("properties", ()) if BELOW in known else ()
    for key in (it for it in error.instance if it not in known):
        words = f"{where}unknown key {_short_repr(key)}; {_hint_for_unknown(key, known, below)}"
        yield lines.get((*path, key), line), words


def _in_words(error: Any) -> str:
    """Return a validation error in plain words, with what is allowed."""
    given, wanted = error.instance, error.validator_value
    if error.validator == "required":
        # There is an error for each key that is missing.
        missing = next(key for key in wanted if repr(key) in error.message and key not in given)
        return f"the key {missing!r} is missing; add it"
    if given is None:
        return "the value is missing; write one, or remove the key"
    if error.validator == "enum":
        return f"{_short_repr(given)} is not known; {_hint_for_unknown(given, wanted)}"
    if error.validator == "minItems" and not given:
        return "the list is empty; write at least one item"
    return f"{_short_repr(given)} is not valid; {_wanted_value_text(error)}"


def _wanted_value_text(error: Any) -> str:
    """Return what to write in place of a wrong value, by the schema; may be empty."""
    given, wanted = error.instance, error.validator_value
    about = error.schema.get("description", "")
    if error.validator == "type" and wanted == "string" and not isinstance(given, dict | list):
        return "write it in quotes"
    if isinstance(given, str) and "name" in error.schema.get("properties", ()):
        return f"write {{name: {given}}}"
    if error.validator == "type":
        types = [wanted] if isinstance(wanted, str) else wanted
        return f"write {' or '.join(TYPES[it] for it in types)}"
    if about:
        return f"write {about}"
    rules = {
        "minLength": "write some text",
        "minItems": f"write {wanted} items",
        "maxItems": f"write {wanted} items",
        "minimum": f"the minimum is {wanted}",
        "maximum": f"the maximum is {wanted}",
    }
    return rules.get(error.validator, "correct it")


def _short_repr(value: object) -> str:
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def _hint_for_unknown(word: object, known: Iterable[object], below: Collection[str] = ()) -> str:
    """Return what to write for an unknown key or value: the nearest known one, otherwise all."""
    # ``below`` are keys that are known one step down, in ``BELOW``.
    words = [str(it) for it in known]
    other = other_words("keys").get(str(word), str(word))
    if other in words:
        return f"use {other!r}"
    if other in below:
        return f"write {BELOW}: {{{other}: ...}}"
    return did_you_mean_one_of(str(word), words) or f"known are {', '.join(words)}"
