# SPDX-License-Identifier: Apache-2.0
"""What ``Command`` substitutions print, without their programs, and what is seen of the machine.

A xacro file is expanded behind the boundary that all xacro files have, and ``urdf-postfix`` is this
package's own. ``ros2 param get`` prints a robot's description, of which only a run tells which it is.
Other programs are not started: their output is empty. Source: launch jazzy,
substitutions/command.py (the line is split as a shell does), find_executable.py."""

import io
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from errno import ENOENT
from functools import lru_cache
from importlib import import_module
from types import MappingProxyType
from typing import Any, NamedTuple

from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.description.sources.expand import expand
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.describe import OFF, text
from multibot_rewrite.producers.launch.door import of_launch, of_launch_ros
from multibot_rewrite.producers.launch.handed_on import DESCRIPTION
from multibot_rewrite.producers.launch.kept_paths import is_made, is_of_machine
from multibot_rewrite.producers.launch.records import FileRead
from multibot_rewrite.producers.launch.source_packages import NOT_INSTALLED

_POSTFIX = "multibot_rewrite.cli.urdf_postfix"
_FAULTS = "multibot_command_faults"
# Its options that write no other file; each has a value.
_OPTIONS = frozenset(("--layout", "--affix", "--separator", "--topics", "--shared", "--distro"))


class Output(NamedTuple):
    """What a program prints, empty where that is not known; and why, where it ought to be known."""

    text: str
    fault: str = ""


def read_commands() -> list[str]:
    """Let ``Command`` run nothing and return known output; return a list that gets its lines."""
    lines: list[str] = []
    known = of_launch("substitutions")
    known.Command.perform = lambda self, context: _command_output(self, context, lines)
    known.FindExecutable.perform = lambda self, context: text(self.name, context)
    _find_programs(of_launch_ros("substitutions").ExecutableInPackage)
    return lines


def _find_programs(substitution: Any) -> None:
    """Let ``ExecutableInPackage`` find programs of packages that are there as sources, unbuilt."""
    installed = substitution.perform

    def found(self: Any, context: Any) -> str:
        folder = super(substitution, self).perform(context)
        names = text(self.package, context), text(self.executable, context)
        path = os.path.join(folder, "lib", *names)
        return path if is_made(path) else installed(self, context)

    substitution.perform = found


def start_nothing(lines: list[str]) -> list[str]:
    """Let a launch file start no program; return a list that gets what is unknown of output.

    ``lines`` gets the command lines of the programs. Nothing waits for a time."""
    lost: list[str] = []
    started: Any = type("Popen", (_Program,), {"lost": lost, "lines": lines})
    vars(subprocess)["Popen"] = started
    vars(os)["system"] = lambda line: started(line).returncode
    vars(time)["sleep"] = lambda seconds: None
    return lost


class _Program:
    """A program that is not started: it has ended, and has printed what is known of it."""

    lost: list[str]
    lines: list[str]
    pid = returncode = 0
    stdin: Any = None

    def __init__(self, line: Any, *_: object, **options: Any) -> None:
        words = [line] if isinstance(line, str | bytes | os.PathLike) else [*line]
        plain = [os.fsdecode(it) for it in words]
        command = plain[0] if len(plain) == 1 else shlex.join(plain)
        self.lines.append(command)
        found = output_of(command)
        said = found.fault or f"it starts {' '.join(plain)!r} itself, which is not started here"
        if (found.fault or not found.text) and said not in self.lost:
            self.lost.append(said)
        as_text = any(options.get(it) for it in ("text", "universal_newlines", "encoding"))
        self.args, self.made = line, found.text if as_text else found.text.encode()
        self.stdout: Any = io.StringIO(found.text) if as_text else io.BytesIO(found.text.encode())
        self.stderr = type(self.stdout)()

    def __enter__(self) -> "_Program":
        return self

    def __exit__(self, *_: object) -> None:
        """Do nothing: there is nothing to wait for."""

    def communicate(self, *_: object, **__: object) -> tuple[Any, Any]:
        """Return what the command printed, and an empty error output."""
        return self.made, self.made[:0]

    def wait(self, timeout: float | None = None) -> int:
        """Return 0, the exit code: the program is over."""
        return 0

    poll = kill = terminate = wait


# What Python tells before it asks for addresses; the fences refuse that.
_NETWORK = frozenset(("socket.__new__", "socket.getaddrinfo", "socket.gethostbyname"))


def see_no_machine(lost: list[str]) -> None:
    """Hide devices and all that only one machine has; ``lost`` gets what a file asks for."""

    def tell(what: str) -> None:
        said = f"it looks at {what} of the machine, and sees nothing of it here; --trust shows it"
        if said not in lost:
            lost.append(said)

    def blind(look: Callable[..., Any], answer: Callable[[str], Any]) -> Callable[..., Any]:
        """Return a function: ``answer`` for a path of the machine, for another what ``look`` does."""

        def looked(path: Any = os.curdir, *words: Any, **options: Any) -> Any:
            named = path is not None and not isinstance(path, int)
            place = os.path.abspath(os.fsdecode(path)) if named else ""
            if not (place and is_of_machine(place)):
                return look(path, *words, **options)
            tell(place)
            return answer(place)

        return looked

    def is_not_there(path: str) -> Any:
        raise FileNotFoundError(ENOENT, os.strerror(ENOENT), path)

    scan = os.scandir
    answers: Mapping[str, Callable[[str], Any]] = {
        "listdir": lambda _: [],
        "scandir": lambda _: scan(tempfile.mkdtemp()),
        "access": lambda _: False,
        "stat": is_not_there,
        "lstat": is_not_there,
    }
    # Python 3.10 has a copy of them for its paths.
    for holder in (os, getattr(pathlib, "_NormalAccessor", None)):
        for name in answers if holder else ():
            made = blind(getattr(holder, name, vars(os)[name]), answers[name])
            setattr(holder, name, made if holder is os else staticmethod(made))
    sys.addaudithook(lambda event, _: tell("the network") if event in _NETWORK else None)


def faults(context: Any) -> list[str]:
    """Return what went wrong in the outputs that a launch asked for."""
    return [*context.get_locals_as_dict().get(_FAULTS, ())]


def _command_output(self: Any, context: Any, lines: list[str]) -> str:
    """Return what a ``Command`` substitution prints, as far as known; note its line and faults."""
    line = text(self.command, context)
    # What is kept off reads nothing of this robot.
    if OFF not in context.launch_configurations:
        lines.append(line)
    found = output_of(line)
    if found.fault and found.fault not in faults(context):
        context.extend_globals({_FAULTS: [*faults(context), found.fault]})
    return found.text


@lru_cache
def output_of(line: str) -> Output:
    """Return what a program prints, as far as that is known without running it."""
    try:
        program, *words = shlex.split(line)
        read = _READERS.get(os.path.basename(program))
        return Output(read(words) if read else "")
    except (ValueError, MultibotError, OSError) as error:
        # A launch fails here, unless it is the boundary, or a package that is told, that is in the way.
        if NOT_INSTALLED in line:
            return Output("")
        reason = " ".join(f"{error}".split())
        return Output("", f"the output of {line!r} is not known: {reason}")


def xacro_of(line: str) -> FileRead | None:
    """Return the xacro that a line of a program expands; None for another program."""
    try:
        program, *words = shlex.split(line)
    except ValueError:
        return None
    is_xacro = os.path.basename(program) == "xacro"
    return _xacro_in(words) if is_xacro else None


def _xacro_in(words: Sequence[str]) -> FileRead | None:
    """Return the one xacro and its arguments in a command; None for none or several."""
    files = [it for it in words if ":=" not in it and not it.startswith("-")]
    given = (it.partition(":=") for it in words if ":=" in it)
    pairs = tuple((name, value) for name, _, value in given)
    return FileRead(files[0], pairs) if len(files) == 1 else None


def _xacro_text(words: Sequence[str]) -> str:
    found = _xacro_in(words)
    return expand(found.file, dict(found.arguments)).decode() if found else ""


def _cat_text(words: Sequence[str]) -> str:
    return "".join(read_file(it).decode("utf-8", "replace") for it in words)


def _ros2_text(words: Sequence[str]) -> str:
    """Return what ``ros2 param get`` prints for a description: words that stand for it."""
    is_description = [*words[:2], *words[-1:]] == ["param", "get", DESCRIPTION]
    return "the description of a running node" if is_description else ""


def _postfix_text(words: Sequence[str]) -> str:
    """Return what ``urdf-postfix`` prints for these arguments; empty where it would write a file."""
    if any(it.startswith("-") and it.partition("=")[0] not in _OPTIONS for it in words):
        return ""
    main = import_module(_POSTFIX).main
    with redirect_stdout(_Kept()) as out, redirect_stderr(_Kept()) as errors:
        code = main([*words])
    if code:
        raise ValueError(errors.text)
    return out.text


class _Kept(io.TextIOWrapper):
    """What is written to it, as a text."""

    def __init__(self) -> None:
        super().__init__(io.BytesIO(), "utf-8", newline="")

    @property
    def text(self) -> str:
        """All of it."""
        self.flush()
        written: Any = self.buffer
        return str(written.getvalue().decode())


_READERS: Mapping[str, Callable[[Sequence[str]], str]] = MappingProxyType(
    {"xacro": _xacro_text, "cat": _cat_text, "urdf-postfix": _postfix_text, "ros2": _ros2_text}
)
