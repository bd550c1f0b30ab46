"""What is known of the terminal: is the output to be coloured?"""

from __future__ import annotations

import os
from typing import TextIO

AUTO, ALWAYS, NEVER = "auto", "always", "never"


def is_coloured(when: str, stream: TextIO | None) -> bool:
    """``--color``, else NO_COLOR, else FORCE_COLOR, else whether a terminal reads the stream."""
    if when != AUTO:
        return when == ALWAYS
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return stream is not None and stream.isatty() and os.environ.get("TERM") != "dumb"
