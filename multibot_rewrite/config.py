"""What ``[tool.multibot-rewrite]`` of a project's pyproject.toml says. Only the commands read it.

[tool.multibot-rewrite]
vocabulary = ["vocabulary/acme.vocab"]
"""

from __future__ import annotations

import os
import re
import sys

from multibot_rewrite.model import UsageError

TABLE = "multibot-rewrite"
KEYS = ("vocabulary",)
# Parsing costs more than the rest of a start: most projects hold neither spelling of the table.
MARKS = (b"multibot-rewrite", b"tool.multibot_rewrite")
_PLACE = re.compile(r" \(at line (\d+), column (\d+)\)$")


def configured_vocabulary(near: str) -> tuple[str, ...]:
    """The vocabulary files that the pyproject.toml nearest above ``near`` asks for, in its order.

    ``near`` is the input file, a folder, or ``-`` for standard input: then the working directory
    counts. Raises UsageError, naming the pyproject.toml, for whatever is wrong with its table.
    """
    project = _nearest(near)
    if not project:
        return ()
    data = _read(project)
    if not any(mark in data for mark in MARKS):
        return ()
    return _vocabulary(project, _table(project, data))


def _nearest(near: str) -> str:
    """The pyproject.toml of the closest folder that has one, or an empty string."""
    folder = os.path.abspath("." if near == "-" else near)
    above = ""
    while folder != above:
        path = os.path.join(folder, "pyproject.toml")
        if os.path.isfile(path):
            return path
        folder, above = os.path.dirname(folder), folder
    return ""


def _read(project: str) -> bytes:
    try:
        with open(project, "rb") as file:
            return file.read()
    except OSError as error:
        raise UsageError(f"{project}: cannot be read: {error.strerror}") from None


def _table(project: str, data: bytes) -> dict[str, object]:
    tool = _parse(project, data).get("tool", {})
    tool = tool if isinstance(tool, dict) else {}
    if "multibot_rewrite" in tool:
        raise UsageError(f"{project}: [tool.multibot_rewrite] is not read, write [tool.{TABLE}]")
    table = tool.get(TABLE, {})
    if not isinstance(table, dict):
        raise UsageError(f"{project}: tool.{TABLE} is {_type(table)}, write a table [tool.{TABLE}]")
    unknown = next((key for key in table if key not in KEYS), None)
    if unknown is not None:
        raise UsageError(
            f"{project}: [tool.{TABLE}] has an unknown key {unknown!r}, use {', '.join(KEYS)}"
        )
    return table


def _parse(project: str, data: bytes) -> dict[str, object]:
    if sys.version_info >= (3, 11):
        import tomllib
    else:
        import tomli as tomllib
    try:
        return tomllib.loads(data.decode())
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise UsageError(f"{project}:{line}: it is not UTF-8; save it as UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        at = _PLACE.search(str(error))
        place = f":{at[1]}:{at[2]}" if at else ""
        reason = _PLACE.sub("", str(error))
        raise UsageError(f"{project}{place}: broken TOML, correct it: {reason}") from None


def _vocabulary(project: str, table: dict[str, object]) -> tuple[str, ...]:
    listed = table.get("vocabulary", [])
    where = f"{project}: [tool.{TABLE}] vocabulary"
    if not isinstance(listed, list):
        raise UsageError(f'{where} is {_type(listed)}, write a list: ["acme.vocab"]')
    wrong = next((item for item in listed if not isinstance(item, str)), None)
    if wrong is not None:
        raise UsageError(f"{where} holds {_type(wrong)}, write paths in quotes")
    folder = os.path.dirname(project)
    for item in listed:
        if not os.path.isfile(os.path.join(folder, item)):
            raise UsageError(f"{where}: no file {item!r} in {folder}; correct the path")
    return tuple(os.path.join(folder, item) for item in listed)


def _type(value: object) -> str:
    """What a value is, in TOML's words."""
    words = {str: "a string", bool: "a boolean", dict: "a table", list: "a list"}
    return words.get(type(value), "a number" if isinstance(value, int | float) else "a date")
