# SPDX-License-Identifier: Apache-2.0
"""Launch files are programs: they are read in a process of their own, behind fences and in limited
time."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

from multibot_rewrite.base.bounded import load_json
from multibot_rewrite.base.child import python, variables
from multibot_rewrite.base.file_kinds import LAUNCH, refuse_others
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.producers.launch.kept_paths import FOLDER
from multibot_rewrite.producers.launch.records import LaunchGraph, LaunchOrder, graph_of
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
    if os.environ.get(_INSIDE):
        return LaunchGraph()
    (found,) = read_launch_files([order], SECONDS)
    if isinstance(found, InputError):
        raise found
    if not found.nodes and not found.notes:
        raise InputError(
            f"{order.file}: this launch file starts no node with these arguments; correct them"
        )
    return found


def read_launch_files(
    orders: Sequence[LaunchOrder], seconds: float
) -> list[LaunchGraph | InputError]:
    """What each of some launch files starts, or why it cannot be read; each has so many seconds."""
    with tempfile.TemporaryDirectory(prefix=FOLDER) as folder:
        said = _run(json.dumps([seconds, orders]), folder)
    try:
        answers = load_json(said)
        return [_read(*it) for it in zip(orders, answers, strict=True)]
    except ValueError:
        why = "its process gave no answer; a file that tampers with it is not read"
        return [InputError(f"{it.file}: the launch file cannot be read: {why}") for it in orders]


def _read(order: LaunchOrder, answer: Mapping[str, Any]) -> LaunchGraph | InputError:
    why = answer.get("error")
    try:
        if why is None:
            return graph_of(answer["graph"])
    except (ValueError, TypeError, LookupError, AttributeError):
        why = "its process gave a wrong answer; a file that tampers with it is not read"
    return InputError(f"{order.file}: the launch file cannot be read: {why}")


def _run(orders: str, folder: str) -> bytes:
    """What the process says that reads launch files. What one of them starts itself ends with it, and
    what they make is in ``folder``."""
    environ = {**variables(), _INSIDE: "1", "TMPDIR": folder}
    process = subprocess.Popen(
        python(_MODULE),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=None,
        env=environ,
        start_new_session=True,
    )
    try:
        return process.communicate(orders.encode())[0]
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
