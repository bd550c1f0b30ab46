# SPDX-License-Identifier: Apache-2.0
"""What is wrong with the rows of the bridges that a launch starts, beside the models that it spawns."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import suppress

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.rosnames import resolve_bound
from multibot_rewrite.producers.launch.bridges import bridged_by
from multibot_rewrite.producers.launch.launched import Launched
from multibot_rewrite.producers.launch.running import bound_of
from multibot_rewrite.rules.declaration import launch_rule
from multibot_rewrite.rules.places import at
from multibot_rewrite.spelling.records import Run
from multibot_rewrite.system.records import SUBSCRIBES, TOPIC


class _Row(NamedTuple):
    """A row of a bridge: the name in ROS and in Gazebo, whether it goes to Gazebo, who has it."""

    ros: str
    gz: str
    inwards: bool
    node: Run


def _rows(launched: Launched) -> Iterator[_Row]:
    for it in launched.nodes:
        for end, inside in bridged_by(it):
            # A node with a name that ROS refuses does not start.
            with suppress(UsageError):
                if end.kind == TOPIC:
                    bound = bound_of(it.name, it.namespace, it.rules)
                    full = resolve_bound(end.name, end.kind, bound)
                    yield _Row(full, inside, end.role == SUBSCRIBES, it)


def into_gazebo(launched: Launched) -> set[str]:
    """The topics in Gazebo that bridges pass something on to."""
    return {it.gz for it in _rows(launched) if it.inwards}


def out_of_gazebo(launched: Launched) -> set[str]:
    """The topics in Gazebo that bridges bring to ROS."""
    return {it.gz for it in _rows(launched) if not it.inwards}


@launch_rule("MG705", "bridge-to-another-robot")
def to_another_robot(launched: Launched) -> Iterator[Finding]:
    """By the names of the models, where they are in the names of their topics."""
    models = launched.simulated
    called = {it.name: {it.name, *it.words.get("-topic", "").split("/")} - {""} for it in models}
    sent = {(f"/{one.gz.lstrip('/')}", it.name) for it in models for one in it.topics}
    of_several = Counter(topic for topic, _ in sent)
    # A topic that models share, such as one tf for all, is of none of them.
    owners = {topic: name for topic, name in sent if of_several[topic] == 1}
    names = {it.name for it in models if it.topics}
    rows = [it for it in _rows(launched) if owners.get(it.gz) and len(names) > 1]
    spaces = {word for it in launched.nodes for word in it.namespace.split("/") if word}
    usual = {_plain(it, owners[it.gz]) for it in rows if owners[it.gz] in it.ros.split("/")}
    for it in rows:
        own, words = owners[it.gz], set(it.ros.split("/"))
        # A word that both sides have says no other robot, whatever else is called so.
        others = sorted(names & words - {*it.gz.split("/"), *called[own]})
        if others and words.isdisjoint(called[own]):
            message = f"{it.ros} of {others[0]} is bridged to gz topic {it.gz} of {own}"
        elif not words & {own, *spaces} and _plain(it, own) in usual:
            message = f"{it.ros} is bridged to gz topic {it.gz} of {own}, and has no robot's name"
        else:
            continue
        hint = f"write the name of {own} on both sides"
        yield at(to_another_robot, it.node.place, message, hint, names=(it.ros,))


def _plain(row: _Row, own: str) -> tuple[str, str]:
    """The row without the robot's name."""
    ros, gz = ("/".join(w for w in it.split("/") if w != own) for it in (row.ros, row.gz))
    return ros, gz
