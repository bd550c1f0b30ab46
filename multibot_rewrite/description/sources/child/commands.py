"""What the process that forks children is told: start one (with a socket for it), end one, or see
how one ended that tells nothing more."""

from __future__ import annotations

import struct

# A letter and the number of a process; the answer is such a number, or that of a signal.
COMMAND, REPLY = struct.Struct(">ci"), struct.Struct(">i")
START, END, ENDED = b"s", b"e", b"d"
