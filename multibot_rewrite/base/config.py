# SPDX-License-Identifier: Apache-2.0
"""What ``[tool.multibot-rewrite]`` of a project's pyproject.toml says. Only the commands read it.

[tool.multibot-rewrite]
definitions = ["definitions/acme.vocab"]
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from importlib import import_module
from typing import Any

from multibot_rewrite.base.bounded import read_bytes
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError

TABLE = "multibot-rewrite"
KEYS = ("definitions",)
# Parsing costs more than the rest of a start: most projects hold neither spelling of the table.
MARKS = (b"multibot-rewrite", b"tool.multibot_rewrite")
_PARTS = 1000
# Of Python 3.11 and later; for 3.10 what pip installs, or Ubuntu 22.04 by the key that rosdep has.
_PARSERS = ("tomllib", "tomli", "toml")
_PLACE = lazy_compile(r" \((?:at )?line (\d+),? column (\d+)(?!\d)[^()]*\)$")


def configured_definitions(near: str) -> tuple[str, ...]:
    """Return the files of plugin definitions that the nearest pyproject.toml above ``near`` lists.

    ``near`` is the input file, a folder, or ``-`` for standard input: then the working directory
    counts. Raises UsageError, naming the pyproject.toml, for whatever is wrong with its table.
    """
    above = (os.path.join(folder, "pyproject.toml") for folder in folders_above(near))
    project = next(filter(os.path.isfile, above), "")
    if not project:
        return ()
    data = read(project)
    if not any(mark in data for mark in MARKS):
        return ()
    table = _table(project, data)
    where = f"{project}: [tool.{TABLE}] definitions"
    return listed_files(where, os.path.dirname(project), table.get("definitions", []))


def folders_above(near: str) -> Iterator[str]:
    """Yield ``near`` and the folders above it, the closest first; ``-`` is the working directory."""
    folder = os.path.abspath("." if near == "-" else near)
    above = ""
    while folder != above:
        yield folder
        folder, above = os.path.dirname(folder), folder


def read(path: str) -> bytes:
    """Return the bytes of a configuration file; raises UsageError with the reason."""
    try:
        return read_bytes(path)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", "") or error
        raise UsageError(f"{path}: cannot be read: {reason}") from None


def _table(project: str, data: bytes) -> dict[str, object]:
    """Return the table of this package in a pyproject.toml; raises UsageError for a wrong one."""
    tool = parse(project, data).get("tool", {})
    tool = tool if isinstance(tool, dict) else {}
    if "multibot_rewrite" in tool:
        raise UsageError(f"{project}: [tool.multibot_rewrite] is not read, write [tool.{TABLE}]")
    table = tool.get(TABLE, {})
    if not isinstance(table, dict):
        what = type_name(table)
        raise UsageError(f"{project}: tool.{TABLE} is {what}, write a table [tool.{TABLE}]")
    unknown = next((key for key in table if key not in KEYS), None)
    if unknown is not None:
        raise UsageError(
            f"{project}: [tool.{TABLE}] has an unknown key {unknown!r}, use {', '.join(KEYS)}"
        )
    return table


def parse(path: str, data: bytes) -> dict[str, object]:
    """Return the content of a TOML file; raises UsageError with the place of an error."""
    toml = _parser(path)
    try:
        text = data.decode()
        # Python's parser takes the square of a key's parts.
        for number, each in enumerate(text.splitlines(), 1):
            if each.count(".") > _PARTS:
                what = f"a line with more than {_PARTS} dots"
                raise UsageError(f"{path}:{number}: {what}; write several")
        found: dict[str, object] = toml.loads(text)
        return found
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise UsageError(f"{path}:{line}: it is not UTF-8; save it as UTF-8") from None
    except _broken(toml) as error:
        at = _PLACE.search(str(error))
        place = f":{at[1]}:{at[2]}" if at else ""
        reason = _PLACE.sub("", str(error))
        raise UsageError(f"{path}{place}: broken TOML, correct it: {reason}") from None
    except (RecursionError, ValueError, LookupError, TypeError) as error:
        # Brackets in thousands, a number of thousands of digits: no parser's own error. That of Python
        # 3.10 fails in more ways.
        raise UsageError(f"{path}: TOML that cannot be read, correct it: {error}") from None


def _parser(path: str) -> Any:
    """Return the module that reads TOML; raises UsageError where Python 3.10 has none."""
    for name in _PARSERS:
        try:
            return import_module(name)
        except ModuleNotFoundError:
            continue
    hint = "pip install tomli, or sudo apt install python3-toml"
    raise UsageError(f"{path}: Python 3.10 reads no TOML by itself: {hint}")


def _broken(toml: Any) -> type[Exception]:
    """Return the exception that a parser raises for a text that is no TOML."""
    name = "TOMLDecodeError" if hasattr(toml, "TOMLDecodeError") else "TomlDecodeError"
    error: type[Exception] = getattr(toml, name)
    return error


def listed_files(where: str, folder: str, listed: object) -> tuple[str, ...]:
    """Return a list of files as paths below ``folder``; ``where`` names the value in errors."""
    if not isinstance(listed, list):
        raise UsageError(f'{where} is {type_name(listed)}, write a list: ["acme.vocab"]')
    wrong = next((item for item in listed if not isinstance(item, str)), None)
    if wrong is not None:
        raise UsageError(f"{where} holds {type_name(wrong)}, write paths in quotes")
    for item in listed:
        if not os.path.isfile(os.path.join(folder, item)):
            raise UsageError(f"{where}: no file {item!r} in {folder}; correct the path")
    return tuple(os.path.join(folder, item) for item in listed)


def type_name(value: object) -> str:
    """Return the type of a value in TOML's words, with its article."""
    words = {str: "a string", bool: "a boolean", dict: "a table", list: "a list"}
    return words.get(type(value), "a number" if isinstance(value, int | float) else "a date")
