# SPDX-License-Identifier: Apache-2.0
"""Values of a configuration file -> settings; a wrong value is a UsageError in one line."""

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import NamedTuple

from multibot_rewrite.base.config import listed_files, type_name
from multibot_rewrite.base.findings.codes import find_codes
from multibot_rewrite.base.findings.finding import LEVELS
from multibot_rewrite.base.findings.selection import OFF
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.base.rosnames.names import check_robot_names
from multibot_rewrite.rules.settings import EVERY_FILE, TARGETS, ArgumentSet


class KeyValue(NamedTuple):
    """A key's value; ``where`` names it in messages, ``folder`` is that of the file."""

    where: str
    folder: str
    value: object


def _texts(given: KeyValue) -> tuple[str, ...]:
    if not isinstance(given.value, list):
        raise UsageError(f"{given.where} is {type_name(given.value)}, write a list of texts")
    wrong = next((it for it in given.value if not isinstance(it, str)), None)
    if wrong is not None:
        raise UsageError(f"{given.where} holds {type_name(wrong)}, write texts in quotes")
    return tuple(given.value)


def _non_empty_text(given: KeyValue) -> str:
    if not isinstance(given.value, str):
        raise UsageError(f"{given.where} is {type_name(given.value)}, write a text in quotes")
    if not given.value:
        raise UsageError(f"{given.where} is empty, write a text")
    return given.value


def _table_of(given: KeyValue) -> Iterator[tuple[str, KeyValue]]:
    """Yield the keys of a table and their values."""
    if not isinstance(given.value, dict):
        raise UsageError(f"{given.where} is {type_name(given.value)}, write a table")
    for key, value in given.value.items():
        yield key, given._replace(where=f"{given.where}: {key!r}", value=value)


def _codes(given: KeyValue) -> tuple[str, ...]:
    return find_lint_codes(_texts(given), given.where)


def find_lint_codes(words: Sequence[str], where: str) -> tuple[str, ...]:
    """Return what ``find_codes`` returns for the rules of the lint."""
    if not words:
        return ()
    from multibot_rewrite.lint.registry import RULES  # most lints name none, and it imports all

    return find_codes(words, where, RULES)


def _levels_by_code(given: KeyValue) -> dict[str, str]:
    levels = {}
    for word, it in _table_of(given):
        (code,) = find_lint_codes((word,), given.where)
        levels[code] = _allowed_text(it, (*LEVELS, OFF))
    return levels


def _allowed_text(given: KeyValue, allowed: Sequence[str]) -> str:
    word = _non_empty_text(given)
    if word not in allowed:
        raise UsageError(f"{given.where} is {word!r}, use one of {', '.join(allowed)}")
    return word


def targets(given: KeyValue) -> tuple[str, ...]:
    """Return the targets that a key lists; raises for an unknown one."""
    return tuple(_allowed_text(given._replace(value=it), TARGETS) for it in _texts(given))


def checked_robots(robots: Sequence[str], where: str) -> tuple[str, ...]:
    """Return the robots' names; raises UsageError for one that is not valid."""
    try:
        return check_robot_names(robots)
    except UsageError as error:
        raise UsageError(f"{where}: {error}") from None


def _path_from_folder(given: KeyValue) -> str:
    """Return a path from the folder of its configuration file; raises UsageError for another value."""
    return os.path.join(given.folder, _non_empty_text(given))


def _existing_file(given: KeyValue) -> str:
    path = _path_from_folder(given)
    if not os.path.isfile(path):
        raise UsageError(f"{given.where}: {given.folder} has no {given.value!r}; correct the path")
    return path


def _existing_folders(given: KeyValue) -> tuple[str, ...]:
    paths = tuple(os.path.join(given.folder, it) for it in _texts(given))
    wrong = next((it for it in paths if not os.path.isdir(it)), None)
    if wrong is not None:
        raise UsageError(f"{given.where}: there is no folder {wrong}; correct the path")
    return paths


def _seconds(given: KeyValue) -> float:
    value = given.value
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise UsageError(f"{given.where} is {type_name(value)}, write a number of seconds")
    if not 0 < value <= 86400:
        raise UsageError(f"{given.where} is {value}, write more than 0 and at most 86400")
    return float(value)


def _codes_by_pattern(given: KeyValue) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Return pairs: a pattern of paths, and the codes listed for it."""
    return tuple(
        (pattern, _codes(it)) for key, it in _table_of(given) for pattern in _patterns(key, given)
    )


def _excluded_patterns(given: KeyValue) -> tuple[str, ...]:
    return tuple(it for key in _texts(given) for it in _patterns(key, given))


def _argument_sets(given: KeyValue) -> tuple[ArgumentSet, ...]:
    if not isinstance(given.value, list):
        raise UsageError(f"{given.where} is {type_name(given.value)}, write tables [[xacro]]")
    found: list[ArgumentSet] = []
    for number, value in enumerate(given.value, 1):
        one = given._replace(where=f"{given.where}, number {number}", value=value)
        parts = dict(_table_of(one))
        for key in parts:
            if key not in ("files", "arguments"):
                raise UsageError(f"{one.where}: unknown key {key!r}, use files, arguments")
        if "arguments" not in parts:
            raise UsageError(f"{one.where}: no arguments, write arguments = {{name = 'value'}}")
        arguments = tuple((name, _argument(it)) for name, it in _table_of(parts["arguments"]))
        files = _non_empty_text(parts["files"]) if "files" in parts else ""
        patterns = anchored(files, one.folder, one.where) if files else (EVERY_FILE,)
        found += (ArgumentSet(pattern, arguments) for pattern in patterns)
    return tuple(found)


def _argument(given: KeyValue) -> str:
    """Return the value as text, as on xacro's command line."""
    value = given.value
    if isinstance(value, bool):
        return str(value).lower()
    if not isinstance(value, str | int | float):
        raise UsageError(f"{given.where} is {type_name(value)}, write a text in quotes")
    return str(value)


READERS: Mapping[str, Callable[[KeyValue], object]] = {
    "select": _codes,
    "ignore": _codes,
    "per-file-ignores": _codes_by_pattern,
    "levels": _levels_by_code,
    "robots": lambda it: checked_robots(_texts(it), it.where),
    "layout": _non_empty_text,
    "affix": _non_empty_text,
    "topics": _non_empty_text,
    "groups": _non_empty_text,
    "separators": lambda it: {kind: _non_empty_text(one) for kind, one in _table_of(it)},
    "shared-frames": _texts,
    "shared-topics": _texts,
    "targets": targets,
    "roots": _existing_folders,
    "distro": partial(_allowed_text, allowed=RELEASES),
    "urdf": _existing_file,
    "definitions": lambda it: listed_files(*it),
    "xacro": _argument_sets,
    "exclude": _excluded_patterns,
    "baseline": _path_from_folder,
    "fail-on": partial(_allowed_text, allowed=LEVELS),
    "seconds": _seconds,
}
# Keys whose field has another name.
FIELDS = {"per-file-ignores": "per_file", "xacro": "arguments"}


def anchored(pattern: str, folder: str, where: str) -> tuple[str, ...]:
    """Return one or two patterns of whole paths; one without a slash is a name in any folder."""
    _check_pattern(pattern, where)
    if os.path.isabs(pattern):
        return (pattern,)
    pattern = pattern.removeprefix("./")
    tail = pattern.removeprefix("**/")
    anywhere = tail != pattern or "/" not in tail.rstrip("/")
    from glob import escape  # most configurations have no pattern

    top = escape(folder).rstrip("/")
    if not anywhere or tail.startswith("*"):
        return (f"{top}/{tail}",)
    return f"{top}/{tail}", f"{top}/*/{tail}"


def _check_pattern(pattern: str, where: str) -> None:
    if not pattern:
        raise UsageError(f"{where}: a pattern is empty, remove it")
    if pattern.startswith("!"):
        raise UsageError(f"{where}: {pattern!r}: '!' takes no file back in, name what is left out")
    if "}" in pattern.partition("{")[2]:
        raise UsageError(f"{where}: {pattern!r}: write one pattern each instead of {{a,b}}")
    if not all(it[1] for it in re.finditer(r"\[!?\]?[^\]]*(\]?)", pattern)):
        raise UsageError(f"{where}: {pattern!r}: a bracket is not closed, write ]")
    if ".." in pattern.split("/"):
        raise UsageError(f"{where}: {pattern!r} leads out of the folder, write the whole path")


def _patterns(pattern: str, given: KeyValue) -> Iterator[str]:
    """Yield patterns of whole paths for a pattern; one that matches a folder is for all in it."""
    for it in anchored(pattern, given.folder, given.where):
        yield from (it, f"{it}/*") if not it.endswith("/") else (f"{it}*",)
