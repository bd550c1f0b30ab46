# SPDX-License-Identifier: Apache-2.0
"""Where results and messages go: standard output or a file, and standard error."""

from __future__ import annotations

import argparse
import io
import os
import stat
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import TextIO, TypeGuard, TypeVar

from multibot_rewrite.base import editors
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.wording import for_terminal, one_line, plural
from multibot_rewrite.cli.walk import check_link, check_target

AUTO, ALWAYS = "auto", "always"
MANY = 20
STANDARD = "-"
# Options and arguments that name files to read.
READ = (
    *("input", "plan", "fleet", "snapshot", "urdf", "xacro", "definitions", "nodes"),
    *("suggest", "config", "baseline"),
)
# What makes a file that such an option names.
MADE_BY = {
    "fleet": "multibot init PATH... writes a fleet file",
    "plan": "multibot build and multibot plan write one",
    "snapshot": "multibot snapshot -o FILE writes one",
}
# Commands whose input may be a fleet file.
TAKE_FLEETS = ("plan", "rehearse", "view")
_T = TypeVar("_T")
_PAINT = {b"+": b"\033[32m", b"-": b"\033[31m", b"@": b"\033[36m"}
_PLAIN = b"\033[0m"
# In a text of more lines, those that are often there, as ``</joint>``, may be shown as changed.
_COMPARED_EXACTLY = 1500
# To the start of the line, which is emptied.
_CLEARED = "\r\033[K"


def is_coloured(when: str, stream: TextIO | None) -> bool:
    """Return whether output is coloured: by ``--color``, NO_COLOR, FORCE_COLOR, or for a terminal."""
    if when != AUTO:
        return when == ALWAYS
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"


def deliver(options: argparse.Namespace, data: bytes, schema: str = "") -> None:
    """Write a command's result where ``-o`` says, or print it; ``schema`` is that of a YAML file."""
    if options.output in (None, STANDARD):
        print_bytes(data)
    else:
        check_target(options.output, (it for _, it in _read_files(options)))
        check_link(options.output)
        write_files(options, with_schema(options.output, data, schema))


def with_schema(path: str, data: bytes, schema: str) -> list[tuple[str, bytes]]:
    """Return the files to write for a YAML file: its own, and the schema for editors."""
    # A device has none, nor a file next to another one of the schema's name.
    beside = os.path.join(os.path.dirname(path), editors.schema_name(schema))
    is_file = os.path.isfile(path) or not os.path.exists(path)
    if not (schema and is_file and editors.may_be_written(schema, beside)):
        return [(path, data)]
    line = f"{editors.schema_line(schema)}\n".encode()
    return [(path, line + data), (beside, editors.schema_text(schema))]


def _read_files(options: argparse.Namespace) -> Iterator[tuple[str, str]]:
    """Yield (option, path) for each file that an option names to be read."""
    for name in READ:
        value = getattr(options, name, None) or ()
        yield from ((name, it) for it in ([value] if isinstance(value, str) else value))


def check_there(options: argparse.Namespace) -> None:
    """Raise UsageError for a missing input file, with a similar name or what makes it."""
    # A word without an ending may be a package or a folder.
    written = {"suggest", "fleet"} if vars(options).get("undo") else {"suggest"}
    for option, path in _read_files(options):
        folder, name = os.path.split(path)
        if not os.path.splitext(name)[1] or os.path.lexists(path) or option in written:
            continue
        from multibot_rewrite.base.nearest import did_you_mean  # a mistake alone needs it

        beside = os.listdir(folder or ".") if os.path.isdir(folder or ".") else []
        is_fleet = path.endswith((".yaml", ".yml")) and options.command in TAKE_FLEETS
        kind = "fleet" if option == "input" and is_fleet else option
        hint = did_you_mean(name, sorted(beside)) or MADE_BY.get(kind, "correct the path")
        raise UsageError(f"{path} is not there; {hint}")


def write_files(options: argparse.Namespace, items: Iterable[tuple[str, bytes]]) -> None:
    """Write all (path, data) or none; ``--verbose`` names them."""
    written: list[str] = []

    def noting_paths() -> Iterable[tuple[str, bytes]]:
        for path, data in items:
            written.append(path)
            yield path, data

    from multibot_rewrite.cli.files import write_all  # most commands of a lint write none

    write_all(noting_paths())
    for path in written:
        detail(options, f"wrote {path}")


def goes_to_file(options: argparse.Namespace) -> bool:
    """Return whether the result leaves standard output free."""
    return options.output not in (None, STANDARD)


def serves_a_program(options: argparse.Namespace) -> bool:
    """Return whether a program reads result and messages through pipes, as launch's ``Command``.

    That takes any text on standard error for a failure. A terminal, a log file, ``-o`` and
    ``--verbose`` get all messages.
    """
    if options.output or options.in_place or options.verbose:
        return False
    pipes = {_pipe_number(it) for it in (sys.stdout, sys.stderr)}
    return None not in pipes and len(pipes) == 2


def _pipe_number(stream: TextIO | None) -> int | None:
    """Return the number of the pipe that a stream writes to; None if it is none."""
    try:
        found = os.fstat(stream.fileno()) if stream else None
    except OSError:
        return None
    return found.st_ino if found and stat.S_ISFIFO(found.st_mode) else None


def watched(items: Iterable[_T], total: int, doing: str) -> Iterable[_T]:
    """Return the items unchanged; many on a terminal show a progress bar."""
    if total < MANY or not sys.stderr.isatty():
        return items
    from rich.console import Console
    from rich.progress import track

    return track(items, doing, total, console=Console(stderr=True), transient=True)


def is_screen(stream: TextIO | None) -> TypeGuard[TextIO]:
    """Return whether a line on the stream can be replaced by another."""
    return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"


def status() -> Callable[[str], None]:
    """Return a function that replaces the last line about the work; an empty line removes it."""
    # Nothing is shown if standard error is no terminal.
    screen = sys.stderr
    if not is_screen(screen):
        return lambda _: None
    import shutil  # only a terminal has a width

    def show(text: str) -> None:
        width = shutil.get_terminal_size().columns - 1
        screen.write(f"{_CLEARED}{one_line(text)[:width]}")
        screen.flush()

    return show


@contextmanager
def shown(text: str) -> Iterator[Callable[[str], None]]:
    """Show ``status`` with a line as long as the block runs, which may show another one."""
    show = status()
    show(text)
    try:
        yield show
    finally:
        show("")


def print_bytes(data: bytes) -> None:
    """Write to standard output, now: a failure must be reported before the summary."""
    if sys.stdout is None:
        raise UsageError("standard output is closed; name a file with -o")
    try:
        # A program gets the bytes; a terminal would obey some of them.
        if sys.stdout.isatty():
            data = for_terminal(data.decode("utf-8", "surrogateescape")).encode()
        sys.stdout.buffer.write(data)
        sys.stdout.buffer.flush()
    except OSError as error:
        # Python would complain again when it closes standard output.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        if isinstance(error, BrokenPipeError):
            raise
        raise UsageError(f"standard output: cannot be written: {error.strerror}") from None


def print_lines(lines: Iterable[object]) -> None:
    """Print each line to standard output; odd characters are escaped."""
    print_bytes("".join(f"{one_line(str(line))}\n" for line in lines).encode())


def prints_colour(options: argparse.Namespace) -> bool:
    """Return whether standard output is coloured."""
    return not goes_to_file(options) and is_coloured(options.color, sys.stdout)


def say(text: str, program: str) -> None:
    """Print a line to standard error."""
    sys.stderr.write(f"{one_line(f'{program}: {text}')}\n")


def note(options: argparse.Namespace, text: str) -> None:
    """Print a summary or remark to standard error, unless ``--quiet``."""
    if not options.quiet:
        say(text, options.program)


def detail(options: argparse.Namespace, text: str) -> None:
    """Print a line to standard error with ``--verbose`` only."""
    if options.verbose and not options.quiet:
        say(text, options.program)


def diff(old: bytes, new: bytes, name: str, new_name: str, colour: bool = False) -> bytes:
    """Return a unified diff that patch reads; empty if nothing is different."""
    if old == new:
        return b""
    from difflib import SequenceMatcher

    # Unlike splitlines, this ends lines at line feeds only, as patch does.
    before, after = io.BytesIO(old).readlines(), io.BytesIO(new).readlines()
    lines = [b"--- %b\n" % _escaped_path(name), b"+++ %b\n" % _escaped_path(new_name)]
    matcher = SequenceMatcher(None, before, after, len(after) > _COMPARED_EXACTLY)
    for group in matcher.get_grouped_opcodes():
        (_, first, _, new_first, _), (_, _, last, _, new_last) = group[0], group[-1]
        old_lines = first + (last > first), last - first
        new_lines = new_first + (new_last > new_first), new_last - new_first
        lines.append(b"@@ -%d,%d +%d,%d @@\n" % (*old_lines, *new_lines))
        for tag, start, end, new_start, new_end in group:
            mark = b" " if tag == "equal" else b"-"
            lines += (mark + line for line in before[start:end])
            lines += (b"+" + line for line in after[new_start:new_end] if tag != "equal")
    cut_short = b"\n\\ No newline at end of file\n"
    whole = (line if line.endswith(b"\n") else line + cut_short for line in lines)
    return b"".join(map(_painted_line, whole) if colour else whole)


def _escaped_path(path: str) -> bytes:
    """Return the bytes of a path, with control characters escaped."""
    return os.fsencode("".join(it if it >= " " else one_line(it) for it in path))


def _painted_line(line: bytes) -> bytes:
    paint = _PAINT.get(line[:1], b"")
    return paint + line[:-1] + _PLAIN + b"\n" if paint else line


def deliver_changed(
    options: argparse.Namespace,
    before: Mapping[str, bytes],
    after: Mapping[str, bytes],
    write: bool,
) -> None:
    """Write the files, or what ``git apply`` takes in this folder: to ``-o``, or printed."""
    if write:
        from multibot_rewrite.cli.files import write_all

        write_all(after.items())
        return
    colour = prints_colour(options)
    names = {path: os.path.relpath(path) for path in after}
    patches = (
        diff(before[path], data, f"a/{names[path]}", f"b/{names[path]}", colour)
        for path, data in after.items()
    )
    deliver(options, b"".join(patches))


def verified_words(unread: Mapping[str, str]) -> str:
    """Return the word for a verified change, with the number of descriptions that were not read."""
    return f"verified, {plural(len(unread), 'description')} not read" if unread else "verified"


def note_unread(options: argparse.Namespace, unread: Mapping[str, str]) -> None:
    """Name the descriptions that could not be read, each with the reason."""
    for path, why in unread.items():
        note(options, f"not checked: {why or path}")
