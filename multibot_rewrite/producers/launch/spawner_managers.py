# SPDX-License-Identifier: Apache-2.0
"""Spawners and the controller managers that launch files start: each asks for one that runs.

Source: ros2_control humble 2.37 and jazzy, ``controller_manager/spawner.py``: a relative name of a
manager is below the namespace that the spawner gets, by ``--namespace`` or as a node.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, declare
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.producers.launch.spawners import Spawned

NO_MANAGER = declare("MG723", "no-controller-manager", ERROR, formats=("fleet",))


def under_managers(
    spawned: Iterable[Spawned], started: Collection[str]
) -> tuple[list[Spawned], list[Finding]]:
    """Return the controllers; those of a manager that is not among the ``started`` ones get the one
    that is meant, if there is just one. With it findings of spawners that ask for another manager
    than the one that runs."""
    meant = next(iter(started)) if len(started) == 1 else ""
    every = tuple(spawned)
    lost = [it for it in every if meant and it.manager not in started]
    found = [it._replace(manager=meant) if it in lost else it for it in every]
    # One finding a spawner.
    spawners = lists_by_key(((it.place.file, it.place.line, it.manager), it.name) for it in lost)
    findings = []
    for (file, line, manager), names in spawners.items():
        message = f"the spawner of {', '.join(names)} asks for {manager}, which nothing starts"
        hint = f"{meant} is started; give the namespace once; the plan has them there"
        where = {"file": file, "line": line, "column": 1}
        findings.append(NO_MANAGER.finding(message, hint, level=WARNING, **where))
    return found, findings
