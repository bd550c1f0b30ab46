"""What changed, as a unified diff."""

from __future__ import annotations

import io
import os

from multibot_rewrite.base.printable import one_line

_PAINT = {b"+": b"\033[32m", b"-": b"\033[31m", b"@": b"\033[36m"}
_PLAIN = b"\033[0m"


def diff(old: bytes, new: bytes, name: str, new_name: str, colour: bool = False) -> bytes:
    """A unified diff that patch reads."""
    from difflib import diff_bytes, unified_diff

    # Unlike splitlines, this ends lines at line feeds only, as patch does.
    before, after = io.BytesIO(old).readlines(), io.BytesIO(new).readlines()
    lines = diff_bytes(unified_diff, before, after, _named(name), _named(new_name))
    cut_short = b"\n\\ No newline at end of file\n"
    whole = (line if line.endswith(b"\n") else line + cut_short for line in lines)
    return b"".join(map(_painted, whole) if colour else whole)


def _named(path: str) -> bytes:
    """The bytes of a path; what would end its line is escaped."""
    return os.fsencode("".join(it if it >= " " else one_line(it) for it in path))


def _painted(line: bytes) -> bytes:
    paint = _PAINT.get(line[:1], b"")
    return paint + line[:-1] + _PLAIN + b"\n" if paint else line
