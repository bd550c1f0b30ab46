# SPDX-License-Identifier: Apache-2.0
"""What the named robots would share in the running system, as the programs read the rewritten file."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from multibot_rewrite.base.conventions import SHARED_TOPICS
from multibot_rewrite.base.findings.finding import ERROR, URDF, WARNING, Rule, declare
from multibot_rewrite.base.naming import Naming, make_naming
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.planning import way_checks
from multibot_rewrite.rules.declaration import TWO
from multibot_rewrite.rules.description.multirobot.topics import APART, AS_WRITTEN
from multibot_rewrite.rules.facts.memo import memoized
from multibot_rewrite.rules.subject import Subject
from multibot_rewrite.rules.system import commands, names, sharing, states, transforms

ODOMETRY_APART = make_naming("tf-per-robot", shared_topics=[*SHARED_TOPICS, "tf_static"])

IN_FRONT = make_naming("postfix", affix="prefix")


@memoized
def _shared_names(subject: Subject) -> tuple[Problem, ...]:
    """Return what a rewrite for the named robots would report; nothing where it would be refused."""
    if not subject.settings.robots:
        return ()
    # Without robots a lint loads none of it.
    from multibot_rewrite.description.checks.meeting import said_of, shared_by_all
    from multibot_rewrite.description.steps.apply import cut
    from multibot_rewrite.description.steps.collect import collect
    from multibot_rewrite.description.steps.plan import make_plan

    naming, document = subject.settings.naming, subject.document
    inventory = subject.inventory
    if not naming.read_as.namespaced:
        inventory = collect(document, subject.tree, layout=naming.read_as)
    plan = make_plan(inventory, naming)
    if any(it.level == ERROR for it in plan.findings):
        return ()
    pieces = cut(document.source, plan.edits)
    found = shared_by_all(document, pieces, naming, subject.tree.definitions)
    return tuple(said_of(subject.settings.robots[0], found))


def _of_code(code: str, subject: Subject) -> Iterator[Problem]:
    return (it for it in _shared_names(subject) if it.code == code)


def _rule_for_left_names(known: Rule, naming: Naming = APART) -> Rule:
    """Return a rule of running systems for names that a rewrite leaves; its examples are URDFs."""
    options = {"robots": TWO, "naming": naming}
    own = known._replace(examples=f"{known.code}-urdf", formats=(URDF,), options=options)
    return own._replace(level=WARNING, check=partial(_of_code, known.code))


def _rule_for_descriptions(code: str, name: str, naming: Naming) -> Rule:
    """Return a rule about descriptions alone: no running system is asked."""
    options = {"robots": TWO, "naming": naming}
    return declare(code, name, WARNING, partial(_of_code, code), options=options)


shared_topic = _rule_for_left_names(sharing.topic_of_several_robots)
shared_node = _rule_for_left_names(states.nodes_of_one_name)
shared_frame = _rule_for_left_names(transforms.robots_frames_collide)
shared_command = _rule_for_left_names(commands.command_for_several_robots)
shared_service = _rule_for_left_names(names.service_of_two_nodes)
controllers_apart = _rule_for_left_names(way_checks.NOT_TAKEN, ODOMETRY_APART)

sensor_names_collide = _rule_for_descriptions("MB425", "lookup-in-the-world", AS_WRITTEN)
lost_rule = _rule_for_descriptions("MB436", "lost-remap-rule", IN_FRONT)
same_text = _rule_for_descriptions("MB437", "same-text-for-all", AS_WRITTEN)
parted_topic = _rule_for_descriptions("MB438", "parted-topic", APART)
camera_info_elsewhere = _rule_for_descriptions(
    "MB439", "camera-info-elsewhere", make_naming("postfix")
)
