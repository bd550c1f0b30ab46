# SPDX-License-Identifier: Apache-2.0
"""A command on a system without what POSIX alone has, as on Windows: ``python without_posix.py PROGRAM
WORD...``. It says nothing of paths and line ends there."""

import os
import signal
import sys
from importlib.abc import MetaPathFinder


class _Missing(MetaPathFinder):
    def find_spec(self, name: str, *_: object) -> None:
        if name in ("fcntl", "grp", "pwd", "resource", "termios"):
            raise ModuleNotFoundError(name)


for module, names in (
    (os, "fork geteuid getuid uname fchmod sched_getaffinity posix_fadvise O_NONBLOCK O_CLOEXEC"),
    (signal, "SIGALRM SIGHUP SIGKILL SIGPIPE SIGXCPU ITIMER_REAL setitimer"),
):
    for word in names.split():
        delattr(module, word)
sys.meta_path.insert(0, _Missing())
program, *sys.argv[1:] = sys.argv[1:]

from multibot_rewrite.cli import entry  # noqa: E402

sys.exit(getattr(entry, program)())
