# SPDX-License-Identifier: Apache-2.0
"""Names of a description that other files of its package hold: code, parameters, worlds.

A prefix does not reach them. In code it is a literal that is exactly the name, in YAML and XML a word.
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterator
from contextlib import suppress
from itertools import chain

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.findings.finding import locate
from multibot_rewrite.base.left_out import source_folders
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.refactor.launch_argument import OF_ROBOT
from multibot_rewrite.refactor.placing import Left
from multibot_rewrite.related_files.params.sections import MANAGER

_CODE = (".py", ".cpp", ".hpp", ".cc", ".hh", ".h", ".c", ".lua")
_SECTION = re.compile(rb"^([A-Za-z]\w*):[^\n]*\n(?:\s*#[^\n]*\n)*\s+ros__parameters:", re.MULTILINE)
# Of one file so many lines are listed.
_MOST = 20


def named_elsewhere(
    folder: str, names: Collection[str], without: Collection[str]
) -> Iterator[Left]:
    """Yield each line of a file that holds a name; ``without`` are files to leave out."""
    if not names:
        return
    some = "|".join(re.escape(it) for it in sorted(names, key=len, reverse=True))
    literal = re.compile(rf"([\"'])({some})\1".encode())
    word = re.compile(rf"(?<![\w./$-])()({some})(?![\w./-])".encode())
    for path in files_below(folder, (*_CODE, ".yaml", ".yml", ".world", ".sdf", ".srdf", ".rviz")):
        if os.path.realpath(path) in without:
            continue
        pattern = literal if path.endswith(_CODE) else word
        why = "its code names" if path.endswith(_CODE) else "it names"
        try:
            data = read_file(path)
        except InputError:
            continue
        found: dict[int, str] = {}
        for it in pattern.finditer(data):
            found.setdefault(locate(data, it.start())[0], it[2].decode())
        for line, name in list(found.items())[:_MOST]:
            yield Left(f"{path}:{line}", f"{why} {name!r}, which a prefix does not reach")
        if len(found) > _MOST:
            yield Left(path, f"{why} such names in {len(found) - _MOST} lines more")


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
    with suppress(InputError, UnicodeDecodeError):
        sections = load_yaml(data.decode(), "")
        manager = sections.get(MANAGER) if isinstance(sections, dict) else None
        given = manager.get("ros__parameters") if isinstance(manager, dict) else None
        for name, value in given.items() if isinstance(given, dict) else ():
            if isinstance(value, dict) and "type" in value:
                yield str(name)


def files_below(folder: str, endings: tuple[str, ...]) -> Iterator[str]:
    """Yield the files with such endings, without those that a build made."""
    for at, folders, names in os.walk(folder):
        folders[:] = source_folders(at, folders)
        for name in sorted(names):
            path = os.path.normpath(os.path.join(at, name))
            if name.endswith(endings) and os.path.isfile(path):
                yield path
