# SPDX-License-Identifier: Apache-2.0
"""Launch files are programs: they are read in a process of their own, which has limited time."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
from contextlib import suppress

from multibot_rewrite.base.child import python, variables
from multibot_rewrite.base.file_kinds import LAUNCH, refuse_others
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder, graph_of, to_json
from multibot_rewrite.producers.launch.system_model import is_system_model, read_system_model

_MODULE = "multibot_rewrite.producers.launch"
SECONDS = 120
# A launch file may load the fleet that names it.
_INSIDE = "MULTIBOT_READS_LAUNCH"


def launch_graph(order: LaunchOrder) -> LaunchGraph:
    """What a launch file or system_model.yaml starts.

    Raises InputError for a file that cannot be read.
    """
    refuse_others(read_file(order.file), order.file, LAUNCH)
    if is_system_model(order.file):
        return read_system_model(order.file)
    if not order.trusted:
        hint = "a launch file is a program; --trust lets it run (SECURITY.md)"
        raise InputError(f"{order.file}: a fleet file names it; {hint}")
    if os.environ.get(_INSIDE):
        return LaunchGraph()
    found = _asked(order)
    if not found.nodes and not found.notes:
        raise InputError(
            f"{order.file}: this launch file starts no node with these arguments; correct them"
        )
    return found


def _asked(order: LaunchOrder) -> LaunchGraph:
    with tempfile.TemporaryDirectory(prefix="multibot_launch_") as folder:
        code, answer, said = _run(order, folder)
    if code == 0 and answer:
        return graph_of(answer)
    lines = [it.strip() for it in said.splitlines() if it.strip()]
    last = lines[-1] if lines else f"exit code {code}"
    raise InputError(f"{order.file}: the launch file cannot be read: {last}")


def _run(order: LaunchOrder, folder: str) -> tuple[int, str, str]:
    """Exit code, answer and errors. What a launch file starts itself ends with the process that reads
    it, and what it makes is in ``folder``."""
    environ = {**variables(), _INSIDE: "1", "TMPDIR": folder}
    with open(f"{folder}/answer", "w+b") as out, open(f"{folder}/said", "w+b") as said:
        process = subprocess.Popen(
            python(_MODULE),
            stdin=subprocess.PIPE,
            stdout=out,
            stderr=said,
            env=environ,
            start_new_session=True,
        )
        try:
            process.communicate(to_json(order).encode(), timeout=SECONDS)
        except subprocess.TimeoutExpired:
            problem = f"{order.file}: reading it took more than {SECONDS} s; stopped"
            raise InputError(problem) from None
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        texts = [it.read().decode("utf-8", "replace") for it in (out, said) if it.seek(0) == 0]
        return process.returncode, texts[0], texts[1]
