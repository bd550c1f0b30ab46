# SPDX-License-Identifier: Apache-2.0
"""Launch files read by the stand-in in the process of the tests, as the child reads them in its own.

What the child changes for good (its environment, command line, what classes of launch keep) is as it
was when the test is over.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from multibot_rewrite import InputError
from multibot_rewrite.producers.launch import child
from multibot_rewrite.producers.launch.read import UnreadableError, read_graph
from multibot_rewrite.producers.launch.records import (
    LaunchGraph,
    LaunchOrder,
    graph_of,
    orders_of,
)
from multibot_rewrite.producers.launch.source_packages import link_sources
from multibot_rewrite.producers.launch.stand_in import (
    actions,
    packages,
    parameters,
    ros,
    standing_in,
    values,
)

# Each with its method that is replaced.
_CHANGED = (
    (actions.Action, "__init__"),
    (ros.ComposableNode, "__init__"),
    (values.Substitution, "__init__"),
    (parameters.ParameterFile, "evaluate"),
    (values.Command, "perform"),
    (values.FindExecutable, "perform"),
    (packages.ExecutableInPackage, "perform"),
)


def read_here(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """From now on ``launch_graph`` asks no other process; ``folder`` gets its temporary files."""
    monkeypatch.setattr(
        child, "read_launch_files", lambda orders, _: [_read(it, folder) for it in orders]
    )


def _read(order: LaunchOrder, folder: Path) -> LaunchGraph | InputError:
    with pytest.MonkeyPatch.context() as kept:
        for kind, method in _CHANGED:
            kept.setattr(kind, method, getattr(kind, method))
        kept.setattr(tempfile, "tempdir", tempfile.mkdtemp(dir=folder))
        kept.setattr(sys, "argv", sys.argv)
        # It stays for good, and sees the process that expands xacros as well, which is another one.
        kept.setattr(sys, "addaudithook", lambda _: None)
        for name in ("system", "listdir", "scandir", "stat", "lstat", "access"):
            kept.setattr(os, name, getattr(os, name))
        kept.setattr(subprocess, "Popen", subprocess.Popen)
        kept.setattr(sys, "path", [*sys.path])
        before = {**os.environ}
        os.environ[child._INSIDE] = "1"
        try:
            with standing_in():
                (given,) = orders_of(json.dumps([0, [order]]))[1]
                link_sources(given.file, given.roots, tempfile.gettempdir())
                graph = read_graph(given, tempfile.gettempdir())
        except UnreadableError as error:
            return InputError(f"{order.file}: the launch file cannot be read: {error}")
        finally:
            os.environ.clear()
            os.environ.update(before)
        return graph_of(json.loads(json.dumps(graph._replace(stood_in=True))))
