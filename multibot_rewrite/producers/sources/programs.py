# SPDX-License-Identifier: Apache-2.0
"""Where a program starts (setup.py, setup.cfg, CMakeLists.txt, installed files), and its files."""

import ast
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.packages import package_of
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.sources.cpp import COMPONENT, read_cpp
from multibot_rewrite.producers.sources.python import read_python
from multibot_rewrite.producers.sources.records import Place, Source, joined

READERS = {
    **dict.fromkeys((".cpp", ".cc", ".cxx", ".hpp", ".h", ".hh", ".hxx"), read_cpp),
    ".py": read_python,
}
NOT_RUN = ("test", "tests", "build")
MOST_FILES, MOST_LETTERS = 200, 1_000_000
Packages = Mapping[str, str]


class Read(NamedTuple):
    """What the files of a program say, and which they are."""

    source: Source
    files: tuple[str, ...]


def read_program(files: Sequence[str], packages: Packages) -> Read:
    """Return what files declare, with all that they import or include of these packages."""
    found: dict[str, Source] = {}
    waiting = [*files]
    while waiting and len(found) < MOST_FILES:
        path = os.path.realpath(waiting.pop(0))
        if path not in found:
            found[path] = _read_source(path)
            follow = _included if path.endswith(tuple(READERS)[:-1]) else _imported
            waiting += (it for one in found[path].imports for it in follow(path, one, packages))
    faults = [(Place("", "", it, 1), "is one file too many to be read") for it in waiting[:1]]
    left = Source(faults=tuple(faults) if len(found) >= MOST_FILES else ())
    return Read(joined([*found.values(), left]), tuple(found))


def _read_source(path: str) -> Source:
    place = Place("", "", path)
    try:
        data = read_file(path)
        changed = os.stat(path).st_mtime_ns
    except (InputError, OSError):
        return Source(faults=((place, "cannot be read"),))
    if len(data) > MOST_LETTERS:
        return Source(faults=((place, f"has more than {MOST_LETTERS} letters"),))
    return _parsed_once(path, data, changed)


@lru_cache(maxsize=512)
def _parsed_once(path: str, data: bytes, changed: int) -> Source:
    """Return a file's source, parsed once, however many programs have it."""
    place = Place("", "", path)
    text = data.decode("utf-8", "replace")
    reader = READERS.get(os.path.splitext(path)[1], read_python)
    found = reader(text, place)
    if "\ufffd" in text:
        found = found._replace(faults=(*found.faults, (place, "is not UTF-8")))
    return found


def _imported(path: str, module: str, packages: Packages) -> Iterator[str]:
    """Yield the file of a module: next to the one that imports it, or of a package that is found."""
    bare = module.lstrip(".")
    level = len(module) - len(bare)
    steps = bare.split(".") if bare else []
    folder = os.path.dirname(path)
    for _ in range(level - 1):
        folder = os.path.dirname(folder)
    roots = [folder]
    if not level and steps and steps[0] in packages:
        roots += [packages[steps[0]], os.path.join(packages[steps[0]], "src")]
    for root in roots:
        yield from module_files(root, steps)


def module_files(root: str, steps: Sequence[str]) -> Iterator[str]:
    """Yield the file of a Python module below a folder, if it exists."""
    base = os.path.join(root, *steps)
    both = (f"{base}.py", os.path.join(base, "__init__.py")) if steps else ()
    yield from (it for it in both if os.path.isfile(it))


def _included(path: str, name: str, packages: Packages) -> Iterator[str]:
    """Yield a header that is included, and the unit of the same name in its package."""
    head = name.partition("/")[0]
    own = _package_of(path, packages)
    near = [packages[head]] if head in packages else []
    folders = [os.path.dirname(path)]
    for it in dict.fromkeys((*near, *([own] if own else []))):
        folders += [os.path.join(it, "include"), os.path.join(it, "src"), it]
        folders.append(os.path.join(it, "include", os.path.basename(it)))
    for it in folders:
        header = os.path.normpath(os.path.join(it, name))
        if os.path.isfile(header) and header.endswith(tuple(READERS)):
            yield header
            package = _package_of(header, packages)
            stem = os.path.splitext(os.path.basename(header))[0]
            units = {f"{stem}{end}" for end in (".cpp", ".cc", ".cxx")}
            every = sources_in(package) if package else ()
            yield from (one for one in every if os.path.basename(one) in units)
            return


def _package_of(path: str, packages: Packages) -> str:
    folders = (it for it in packages.values() if path.startswith(f"{os.path.realpath(it)}{os.sep}"))
    return next(folders, "")


def start_of_file(*path: str) -> str:
    """Return the text of a file, as far as it is read; empty for what is none."""
    file = os.path.join(*path)
    try:
        with open(file if os.path.isfile(file) else os.devnull, "rb") as opened:
            return opened.read(MOST_LETTERS).decode("utf-8", "replace")
    except OSError:
        return ""


@lru_cache(maxsize=64)
def sources_in(folder: str) -> tuple[str, ...]:
    """Return the files of a package that can be read, except its tests."""
    found: list[str] = []
    for above, folders, names in os.walk(folder):
        folders[:] = sorted(it for it in folders if it[0] != "." and it not in NOT_RUN)
        found += (os.path.join(above, it) for it in sorted(names) if it.endswith(tuple(READERS)))
        if len(found) > MOST_FILES * 10:
            break
    return tuple(found)


LIST = "CMakeLists.txt"
_CALL = re.compile(r"\b([A-Za-z_]\w*)[ \t\r\n]*\(([^()]*)\)")
_WORD = re.compile(r"\"[^\"]*\"|[^\s\";]+")
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_HERE = ("CMAKE_CURRENT_SOURCE_DIR", "CMAKE_SOURCE_DIR", "PROJECT_SOURCE_DIR")
_NAMES = ("PROJECT_NAME", "CMAKE_PROJECT_NAME")
MOST_CALLS, DEEPEST = 10_000, 6


class CmakeCall(NamedTuple):
    """A call: its name in small letters, and its words; paths are below the ``folder``."""

    name: str
    words: tuple[str, ...]
    folder: str

    def after(self, word: str) -> str:
        """Return the argument behind this word; empty for none."""
        return self.words[self.words.index(word) + 1] if word in self.words[:-1] else ""


@lru_cache(maxsize=64)
def cmake_calls(folder: str) -> tuple[CmakeCall, ...]:
    """Return the calls of the CMakeLists.txt of a package, and of the folders that it adds."""
    own = package_of(os.path.join(folder, LIST))
    known = {**dict.fromkeys(_HERE, folder), **dict.fromkeys(_NAMES, own[0] if own else "")}
    return tuple(_calls_of_file(folder, known, 0))[:MOST_CALLS]


def _calls_of_file(folder: str, known: dict[str, str], depth: int) -> Iterator[CmakeCall]:
    text = "\n".join(it.partition("#")[0] for it in start_of_file(folder, LIST).splitlines())
    calls = [(it[1].lower(), it[2]) for it in _CALL.finditer(text)][:MOST_CALLS]
    at = 0
    while at < len(calls):
        name, raw = calls[at]
        at += 1
        if name == "foreach":
            end = next((it for it in range(at, len(calls)) if calls[it][0] == "endforeach"), at)
            variable, *values = (*_argument_words(raw, known), "")[:-1] or ("",)
            for value in values if values[:1] != ["IN"] else values[2:]:
                inner = {**known, variable: value}
                yield from (
                    CmakeCall(it, _argument_words(one, inner), folder) for it, one in calls[at:end]
                )
            at = end
            continue
        call = CmakeCall(name, _argument_words(raw, known), folder)
        known |= dict(_variables_set_by(call))
        yield call
        if name == "add_subdirectory" and call.words and depth < DEEPEST:
            yield from _calls_of_file(os.path.join(folder, call.words[0]), dict(known), depth + 1)


def _variables_set_by(call: CmakeCall) -> Iterator[tuple[str, str]]:
    """Yield (variable, value) for each variable that a call sets."""
    name, words = call.name, call.words
    if name == "set" and words:
        yield words[0], ";".join(words[1:])
    elif name == "project" and words:
        yield "PROJECT_NAME", words[0]
    elif name == "list" and words[:1] == ("APPEND",) and len(words) > 1:
        yield words[1], ";".join((f"${{{words[1]}}}", *words[2:]))
    elif name == "file" and words[:1] in (("GLOB",), ("GLOB_RECURSE",)):
        files: list[str] = []
        for it in words[2:]:
            above, _, last = os.path.join(call.folder, it).rpartition(os.sep)
            inside = (one for one in sources_in(call.folder) if one.startswith(above.rstrip("*")))
            files += (one for one in inside if one.endswith(last.lstrip("*")))
        yield words[1], ";".join(files)


def _argument_words(raw: str, known: dict[str, str]) -> tuple[str, ...]:
    text = raw
    for _ in range(DEEPEST if "$" in raw else 0):
        text = _VARIABLE.sub(lambda it: known.get(it[1], it[0]), text)[:MOST_CALLS]
    return tuple(it.strip('"') for it in _WORD.findall(text))


_ENTRY = re.compile(r"\s*([\w.+-]+)\s*=\s*([\w.]+)\s*:\s*([\w.]+)\s*")
_SCRIPT = re.compile(r"\A#!.*python")
_MAIN = re.compile(r"\bmain\s*\(")


class Start(NamedTuple):
    """Where a program starts: its files, the function or the class, and the file that has it."""

    files: tuple[str, ...]
    path: str
    function: str = ""
    class_: str = ""


def start_of(folder: str, program: str) -> Start | None:
    """Return where an executable, or a component by its class, starts; None without its source."""
    if "::" in program:
        return _component_start(folder, program)
    calls = (_start_by_call(folder, it, program) for it in cmake_calls(folder))
    if found := _python_start(folder, program) or next(filter(None, calls), None):
        return found
    # The one file of that name that can be started: a rule for its folder installs it.
    scripts = [it for it in _scripts(folder) if os.path.basename(it) == program]
    return _start_in((scripts[0],)) if len(scripts) == 1 else None


def _start_in(files: tuple[str, ...], function: str = "", class_: str = "") -> Start:
    real = tuple(map(os.path.realpath, files))
    return Start(real, real[0], function, class_)


def _python_start(folder: str, program: str) -> Start | None:
    for name, module, function in _entry_points(folder):
        if name == program:
            for root in (folder, os.path.join(folder, "src")):
                for it in module_files(root, module.split(".")):
                    return _start_in((it,), function)
    return None


@lru_cache(maxsize=64)
def _entry_points(folder: str) -> tuple[tuple[str, str, str], ...]:
    """Return (name, module, function) of each entry point."""
    lines = start_of_file(folder, "setup.cfg").splitlines()
    words = [*_setup_strings(start_of_file(folder, "setup.py")), *lines]
    found = (_ENTRY.fullmatch(it) for it in words)
    return tuple((it[1], it[2], it[3]) for it in found if it)


def _setup_strings(text: str) -> Iterator[str]:
    """Yield the texts of a setup.py, with its constants filled in."""
    try:
        tree = ast.parse(text)
        sets = [it for it in ast.walk(tree) if isinstance(it, ast.Assign)]
        names = [(it.targets[0], it.value) for it in sets]
        known = {it.id: _text_of(value, {}) for it, value in names if isinstance(it, ast.Name)}
        yield from [_text_of(it, known) for it in ast.walk(tree)]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return


def _text_of(node: ast.AST, known: dict[str, str]) -> str:
    """Return the text of an expression of constants; empty for unknown parts."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else ""
    if isinstance(node, ast.JoinedStr):
        return "".join(_text_of(it, known) for it in node.values)
    if isinstance(node, ast.FormattedValue):
        return _text_of(node.value, known)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return _text_of(node.left, known) + _text_of(node.right, known)
    return known.get(node.id, "") if isinstance(node, ast.Name) else ""


def _start_by_call(folder: str, call: CmakeCall, program: str) -> Start | None:
    """Return where this program starts by a call; None if the call is about something else."""
    if call.name.endswith("add_executable") and call.words[:1] == (program,):
        files = [*_existing_sources(call.folder, call.words[1:])]
        files.sort(key=lambda it: _MAIN.search(start_of_file(it)) is None)
        return _start_in(tuple(files), "main") if files else None
    if call.name == "rclcpp_components_register_node" and call.after("EXECUTABLE") == program:
        return _component_start(folder, call.after("PLUGIN"))
    if call.name == "install" and call.words[:1] == ("PROGRAMS",):
        for it in _existing_sources(call.folder, call.words[1:], any_end=True):
            if program == (call.after("RENAME") or os.path.basename(it)):
                return _start_in((it,))
    return None


def _existing_sources(folder: str, words: tuple[str, ...], any_end: bool = False) -> Iterator[str]:
    for it in words:
        path = os.path.join(folder, it)
        if (any_end or it.endswith(tuple(READERS))) and os.path.isfile(path):
            yield path


def _component_start(folder: str, class_: str) -> Start | None:
    """Return where a component starts: its class, and the file that registers it; None without."""
    last = class_.rpartition("::")[2]
    for path in sources_in(folder):
        names = () if path.endswith(".py") else COMPONENT.findall(start_of_file(path))
        if class_ in names or any(it.rpartition("::")[2] == last for it in names):
            return _start_in((path,), class_=last)
    return None


@lru_cache(maxsize=64)
def _scripts(folder: str) -> tuple[str, ...]:
    """Return the Python files and scripts of a package that can be started."""
    found: list[str] = []
    for above, folders, names in os.walk(folder):
        folders[:] = sorted(it for it in folders if it[0] != "." and it not in NOT_RUN)
        paths = (os.path.join(above, it) for it in sorted(names))
        for it in paths:
            is_plain = "." not in os.path.basename(it)
            if it.endswith(".py") or (is_plain and _SCRIPT.match(start_of_file(it)[:80])):
                found.append(it)
    return tuple(found)
