# SPDX-License-Identifier: Apache-2.0
"""Launch files are programs: they are read in a process of their own, which has limited time."""

from __future__ import annotations

import os
import subprocess

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
    environ = {**variables(), _INSIDE: "1"}
    command = python(_MODULE)
    try:
        done = subprocess.run(
            command,
            input=to_json(order),
            capture_output=True,
            text=True,
            errors="replace",
            env=environ,
            timeout=SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise InputError(f"{order.file}: reading it took more than {SECONDS} s; stopped") from None
    if done.returncode == 0 and done.stdout:
        return graph_of(done.stdout)
    lines = [it.strip() for it in done.stderr.splitlines() if it.strip()]
    last = lines[-1] if lines else f"exit code {done.returncode}"
    raise InputError(f"{order.file}: the launch file cannot be read: {last}")
