# SPDX-License-Identifier: Apache-2.0
"""Names of a description that other files of its package hold: code, parameters, worlds.

A prefix does not reach them. In code it is a literal that is exactly the name, in YAML and XML a word.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from itertools import chain

from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.left_out import source_folders
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.refactor.launch_argument import OF_ROBOT
from multibot_rewrite.refactor.placing import Left
from multibot_rewrite.related_files.params.sections import controller_types, raw_sections
from multibot_rewrite.related_files.yaml_text import read_yaml

_CODE = (".py", ".cpp", ".hpp", ".cc", ".hh", ".h", ".c", ".lua")
_PAGES = (".md", ".rst", ".txt")
_DATA = (".yaml", ".yml", ".world", ".sdf", ".srdf", ".rviz", ".setup_assistant")
_BESIDE = (*_CODE, *_PAGES, *_DATA, ".xml")
_LAUNCH = re.compile(r"[._]launch\.\w+$|/launch/[^/]*$")
_SECTION = re.compile(rb"^([A-Za-z]\w*):[^\n]*\n(?:\s*#[^\n]*\n)*\s+ros__parameters:", re.MULTILINE)
# Of one file so many lines are listed with their name, the others as numbers.
_MOST = 20


def named_elsewhere(
    folder: str, names: Collection[str], without: Collection[str]
) -> Iterator[Left]:
    """Yield each line with a name, except in files ``without``; in code a literal or part of one."""
    if not names:
        return
    some = "|".join(re.escape(it) for it in sorted(names, key=len, reverse=True))
    literal = re.compile(rf"(?:(?<=[\"'/}}])|(?<=}}_))({some})(?=[\"'/{{])".encode())
    word = re.compile(rf"(?<![\w./$-])({some})(?![\w./-])".encode())
    for path in files_below(folder, _BESIDE):
        with suppress(InputError):
            data = b"" if os.path.realpath(path) in without else read_file(path)
            yield from _lines(path, data, literal if path.endswith(_CODE) else word)


def plain_named(folder: str, xacros: Iterable[str]) -> Iterator[Left]:
    """Yield each line with a plain description that has become one of ``xacros``."""
    # Such as a launch file that reads an SRDF as it is.
    some = "|".join({re.escape(os.path.basename(it).removesuffix(".xacro")) for it in xacros})
    word = re.compile(rf"(?<![\w./-])([\w./-]*\b(?:{some}))(?![\w.-])".encode())
    for path in files_below(folder, _BESIDE) if some else ():
        with suppress(InputError):
            why = ", which has no prefix; expand the .xacro next to it in its place"
            yield from _lines(path, read_file(path), word, why)


def mentions(
    folders: Iterable[str], old: str, new: str, changed: Mapping[str, bytes]
) -> Iterator[Left]:
    """Yield each line that still has the old name; ``changed`` are texts by real path."""
    # The new name may hold the old one; that of a file is none.
    left = rf"(?<!\w)(?!(?<=/){re.escape(old)}\.\w)({re.escape(old)})(?!\w)"
    word = re.compile(rf"{re.escape(new)}(?!\w)|{left}".encode())
    for path in chain.from_iterable(
        files_below(it, (*_BESIDE, ".xacro", ".urdf")) for it in folders
    ):
        with suppress(InputError):
            data = changed.get(os.path.realpath(path)) or read_file(path)
            yield from _lines(path, data, word, "")


def _lines(
    path: str, data: bytes, pattern: re.Pattern[bytes], why: str = ", which a prefix does not reach"
) -> Iterator[Left]:
    """Yield the lines with a name, each once, with the reason why it stays."""
    kinds = {_CODE: "its code", _PAGES: "a page"}
    who = next((it for ends, it in kinds.items() if path.endswith(ends)), "it")
    who = "the launch file" if _LAUNCH.search(path) else who
    found: dict[int, tuple[str, str]] = {}
    for match in pattern.finditer(data):
        if match[1] is not None:
            at = match.start(1)
            is_put_together = at and data[at - 1 : at] in b"/}_" and path.endswith(_CODE)
            verb = "puts together" if is_put_together else "names"
            found.setdefault(locate(data, at)[0], (verb, match[1].decode()))
    most = _MOST if why else len(found)
    for line, (verb, name) in list(found.items())[:most]:
        yield Left(f"{path}:{line}", f"{who} {verb} {name!r}{why}")
    if more := ", ".join(map(str, [*found][most:])):
        yield Left(path, f"{who} names such names in other lines, too: {more}")


def root_sections(paths: Collection[str]) -> Iterator[Left]:
    """Yield parameter sections outside namespaces, of nodes that get one."""
    # The robot's own and its controllers. Source: rcl_yaml_param_parser.
    texts = {path: read_file(path) for path in paths}
    own = {*OF_ROBOT, *chain.from_iterable(map(_controllers, texts.values()))}
    for path, data in texts.items():
        every = [(locate(data, it.start())[0], it[1].decode()) for it in _SECTION.finditer(data)]
        if found := [(line, name) for line, name in every if name in own]:
            line, name = found[0]
            more = f", and {plural(len(found) - 1, 'section')} more" if len(found) > 1 else ""
            why = f"{name!r} matches no node in a namespace{more}; write /**/{name}"
            yield Left(f"{path}:{line}", why)


def _controllers(data: bytes) -> Iterator[str]:
    """Yield the controllers that a parameter file gives its manager."""
    with suppress(InputError):
        yield from controller_types(raw_sections(read_yaml(data, "")))


def files_below(folder: str, endings: tuple[str, ...]) -> Iterator[str]:
    """Yield the files with such endings, without those that a build made."""
    for at, folders, names in os.walk(folder):
        folders[:] = source_folders(at, folders)
        for name in sorted(names):
            path = os.path.normpath(os.path.join(at, name))
            if name.endswith(endings) and os.path.isfile(path):
                yield path
