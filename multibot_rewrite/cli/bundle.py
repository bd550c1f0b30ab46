"""The compiled modules of this package in one file: a command needs some two hundred, and to find and
open as many files takes a third of the time of its imports.

A module's code counts as that of a ``.pyc`` does: while its source has the time and the size that are
noted with it. Whatever is missing or changed is imported as ever, and the file is written anew when the
process ends. It lies beside the ``.pyc`` files: who may write there may change the sources as well.
"""

from __future__ import annotations

import atexit
import marshal
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from importlib.machinery import ModuleSpec, SourceFileLoader
from types import CodeType, ModuleType

_PACKAGE = __name__.partition(".")[0]
_FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# Another interpreter has other code, and a package that was moved has other paths in it.
_MADE_FOR = (sys.version, _FOLDER)
# Of the table at the start of the file: the digits of its length.
_DIGITS = 8
_State = tuple[int, int]
# Its source, whether that is a package, its state; where the code begins, and how long it is.
_Piece = tuple[str, bool, _State, int, int]
# The module's name, the same of its source, and the code.
_Entry = tuple[str, str, bool, _State, bytes]


class Bundle:
    """An open file of modules, which Python asks for how they are loaded; it has none if there is
    no such file, or one for another Python."""

    def __init__(self, path: str) -> None:
        self.path, self.file, self.first = path, -1, 0
        self.pieces: Mapping[str, _Piece] = {}
        with suppress(OSError, ValueError, EOFError, TypeError):  # not there, or not a whole one
            self.file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
            length = int(os.pread(self.file, _DIGITS, 0), 16)
            made_for, pieces = marshal.loads(os.pread(self.file, length, _DIGITS))
            self.first = _DIGITS + length
            self.pieces = pieces if made_for == _MADE_FOR else {}

    def find_spec(
        self, name: str, _path: Sequence[str] | None = None, _target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """How a module is loaded; None for one that is not in the file or has changed since."""
        if not self.has(name):
            return None
        source, is_package, *_ = self.pieces[name]
        loader = _Loader(name, source, self)
        spec = ModuleSpec(name, loader, origin=source, is_package=is_package)
        if spec.submodule_search_locations is not None:
            spec.submodule_search_locations.append(os.path.dirname(source))
        spec.has_location, spec.cached = True, self.path
        return spec

    def has(self, name: str) -> bool:
        """Is the code of that module here, and still that of its source?"""
        piece = self.pieces.get(name)
        return piece is not None and _state(piece[0]) == piece[2]

    def code(self, name: str) -> bytes:
        """The code of a module that is here, as ``marshal`` writes it."""
        *_, start, length = self.pieces[name]
        return os.pread(self.file, length, self.first + start)


class _Loader(SourceFileLoader):
    """As for any source, but the code is in the bundle."""

    def __init__(self, name: str, source: str, bundle: Bundle) -> None:
        super().__init__(name, source)
        self.bundle = bundle

    def get_code(self, fullname: str) -> CodeType:
        code: CodeType = marshal.loads(self.bundle.code(fullname))
        return code


def use_bundle() -> None:
    """Take modules from the bundle from now on, and see to it that it has them the next time; for a
    process of its own."""
    cached = __spec__.cached
    if not cached or not os.path.isabs(__file__):
        return  # Python keeps no compiled modules here
    bundle = Bundle(f"{os.path.splitext(cached)[0]}.modules")
    sys.meta_path.insert(0, bundle)
    if not sys.dont_write_bytecode:
        atexit.register(keep, bundle)


def keep(bundle: Bundle) -> None:
    """Write the file anew if this process has loaded modules that are not in it."""
    new = [it for it in _loaded() if not bundle.has(it.name)]
    if not new:
        return
    temporary = f"{bundle.path}.{os.getpid()}"
    with suppress(OSError):  # an installation that is not the user's
        try:
            with open(temporary, "xb") as file:
                file.write(_written(bundle, new))
            os.replace(temporary, bundle.path)
        except BaseException:
            os.unlink(temporary)
            raise


def _loaded() -> Iterator[SourceFileLoader]:
    """How the modules of this package were loaded that did not come from a bundle."""
    for name, module in list(sys.modules.items()):
        loader = getattr(module, "__loader__", None)
        if name.partition(".")[0] == _PACKAGE and type(loader) is SourceFileLoader:
            yield loader


def _written(bundle: Bundle, new: Sequence[SourceFileLoader]) -> bytes:
    """The bytes of a file: what is in the bundle and still holds, and the new modules."""
    pieces: dict[str, _Piece] = {}
    codes: list[bytes] = []
    start = 0
    for name, source, is_package, state, code in (*_kept(bundle), *map(_made, new)):
        pieces[name] = source, is_package, state, start, len(code)
        codes.append(code)
        start += len(code)
    table = marshal.dumps((_MADE_FOR, pieces))
    return b"".join([f"{len(table):0{_DIGITS}x}".encode(), table, *codes])


def _kept(bundle: Bundle) -> Iterator[_Entry]:
    for name, (source, is_package, state, *_) in bundle.pieces.items():
        if bundle.has(name):
            yield name, source, is_package, state, bundle.code(name)


def _made(loader: SourceFileLoader) -> _Entry:
    source = os.fspath(loader.path)
    state = _state(source)  # before its code is read: what is changed meanwhile is out of date
    code = marshal.dumps(loader.get_code(loader.name))
    return loader.name, source, loader.is_package(loader.name), state, code


def _state(source: str) -> _State:
    try:
        it = os.stat(source)
    except OSError:  # it is gone
        return 0, 0
    return it.st_mtime_ns, it.st_size
