# SPDX-License-Identifier: Apache-2.0
"""The files that a launch file reads: of a description that a node gets, the file is known."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType
from typing import Any, NamedTuple, cast

from multibot_rewrite.producers.launch.commands import xacro_of
from multibot_rewrite.producers.launch.records import FileRead, ParameterText

# Descriptions, and what else robots have: an XML file may be a manifest.
_ENDINGS = (".urdf", ".sdf", ".xml", ".model")
_KEPT = (".urdf", ".sdf", ".model", ".srdf", ".yaml", ".yml")
_XACRO = ".xacro"
_ENDS = (*_ENDINGS, *_KEPT, _XACRO)
_LIMIT = 1 << 24
# What this package reads for itself is no file of a robot.
_OWN = os.path.abspath(__file__).removesuffix(os.path.join("producers", "launch", "read_files.py"))


class Reads(NamedTuple):
    """What is read in this process: a robot's files, and xacros expanded with arguments."""

    paths: list[str]
    xacros: list[FileRead]


def keep_reads() -> Reads:
    """Keep from now on which files this process reads; return the record that grows."""
    found = Reads([], [])

    def opened(event: str, words: tuple[Any, ...]) -> None:
        path = words[0] if event == "open" else None
        if isinstance(path, str) and path.endswith(_ENDS) and not path.startswith(_OWN):
            found.paths.append(path)

    sys.addaudithook(opened)
    sys.meta_path.insert(0, _Xacro(found))
    return found


class _Xacro:
    """Finds the module xacro, with a function that keeps what it is given."""

    def __init__(self, found: Reads) -> None:
        self.found = found

    def find_spec(self, name: str, *_: object) -> ModuleSpec | None:
        """Return how xacro is loaded; None for other modules."""
        if name != "xacro":
            return None
        sys.meta_path.remove(cast(Any, self))
        spec = find_spec(name)
        loader: Any = spec.loader if spec else None
        if loader:
            load = loader.exec_module
            loader.exec_module = lambda module: self.keep(module, load)
        return spec

    def keep(self, module: ModuleType, load: Callable[[ModuleType], None]) -> None:
        """Load the xacro module, and keep the arguments of each file that it expands from then on."""
        load(module)
        expand = vars(module)["process_doc"]

        def process_doc(doc: Any, *words: Any, **options: Any) -> Any:
            given = {"mappings": next(iter(words), None), **options}["mappings"] or {}
            pairs = tuple((key, it) for key, it in dict(given).items() if isinstance(it, str))
            last = [it for it in self.found.paths if it.endswith(_XACRO)][-1:]
            self.found.xacros.extend(FileRead(it, pairs) for it in last)
            return expand(doc, *words, **options)

        vars(module)["process_doc"] = process_doc


def files_read(lines: Iterable[str], reads: Reads) -> tuple[FileRead, ...]:
    """Return the xacros that ``lines`` of programs and the file expand, and other files read."""
    expanded = {it: xacro_of(it) for it in lines}
    xacros = (*filter(None, expanded.values()), *reads.xacros)
    words = (word for line, it in expanded.items() if it is None for word in line.split())
    given = (FileRead(it) for it in words if it.endswith(_ENDS) and os.path.isfile(it))
    other = (FileRead(it) for it in reads.paths if it.endswith(_KEPT))
    real = (it._replace(file=os.path.realpath(it.file)) for it in (*xacros, *given, *other))
    return tuple(dict.fromkeys(real))


def descriptions_in(paths: Iterable[str]) -> Iterator[tuple[str, ParameterText]]:
    """Yield the text of each of these files that a node may get for its description."""
    plain = (it for it in paths if it.endswith(_ENDINGS))
    for path in dict.fromkeys(map(os.path.realpath, plain)):
        if os.path.isfile(path) and os.path.getsize(path) < _LIMIT:
            with open(path, encoding="utf-8", errors="replace") as file:
                yield path, ParameterText(path, file.read(), path)
