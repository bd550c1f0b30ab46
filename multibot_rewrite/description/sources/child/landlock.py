# SPDX-License-Identifier: Apache-2.0
"""Landlock: the kernel refuses this process every file, TCP port, and signal to others.

No rule is added to the set, so nothing of what it handles is left. Source: Linux,
include/uapi/linux/landlock.h and Documentation/userspace-api/landlock.rst.
"""

from __future__ import annotations

import ctypes
import struct

from multibot_rewrite.description.sources.child.system import SYSTEM, no_new_privileges

# The same numbers on every architecture (since Linux 5.13).
CREATE_RULESET, RESTRICT_SELF = 444, 446
_ASK_VERSION = 1
# Bits of rights to files by the version of the interface that first has them all.
_FILES = {1: 0x1FFF, 2: 0x3FFF, 3: 0x7FFF, 5: 0xFFFF}
# Bind and connect of TCP; abstract sockets and signals of other processes.
_PORTS, _PORTS_SINCE = 0b11, 4
_SCOPES, _SCOPES_SINCE = 0b11, 6


def version() -> int:
    """The version of the kernel's interface, 0 where it has none."""
    found = SYSTEM.syscall(CREATE_RULESET, None, ctypes.c_size_t(0), _ASK_VERSION) if SYSTEM else 0
    return max(0, int(found))


def enclose() -> bool:
    """Take all of it from this process, and from what it starts; False where that is not possible."""
    known = version()
    if not known or not SYSTEM or not no_new_privileges():
        return False
    files = max(bits for since, bits in _FILES.items() if since <= known)
    ports = _PORTS if known >= _PORTS_SINCE else 0
    scopes = _SCOPES if known >= _SCOPES_SINCE else 0
    size = 24 if scopes else 16 if ports else 8
    rules = struct.pack("=QQQ", files, ports, scopes)[:size]
    ruleset = SYSTEM.syscall(CREATE_RULESET, rules, ctypes.c_size_t(size), 0)
    return bool(ruleset >= 0 and SYSTEM.syscall(RESTRICT_SELF, ruleset, 0) == 0)
