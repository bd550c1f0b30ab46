# SPDX-License-Identifier: Apache-2.0
"""A launch file's processes that are no nodes of the plan -> what starts them for one robot.

Commands, scripts and includes of packages that are not here are kept word by word; what stands in a
``ros2`` command for a node, a topic or a manager becomes the robot's.
"""

import os
import re
from collections.abc import Iterator, Sequence

from multibot_rewrite.base.naming import TF_TOPICS, Naming
from multibot_rewrite.base.rosnames import check_topic_name
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import path_for
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.planning.of_runs import placed, target_of
from multibot_rewrite.planning.start import File, Start
from multibot_rewrite.producers.launch.handed_on import for_robot, handed_on
from multibot_rewrite.producers.launch.records import LaunchedNode
from multibot_rewrite.system.records import TOPIC

_NO_NAME = "unnamed"
# The words of ros2 behind which nodes stand, and those with topics, services and actions.
_CONTROL, _MANAGER_IN_ROOT = "control", "/controller_manager"
_OF_NODES, _OF_NAMES = ("lifecycle", "param", "control", "node"), ("topic", "service", "action")
# Where the first name stands behind ros2, its verb and what that does; what ends a command of a shell.
_FIRST, _NEXT = 3, ("&&", "||", ";", "|", "&")


def own_processes(plan: FleetPlan, robot: RewrittenRobot) -> Iterator[Start]:
    """Yield the processes of launch files that are no nodes, with the robot's parameter files."""
    own = {os.path.realpath(it): it for it in robot.spec.related_files.get("params", ())}
    for it in (one for one in plan.evidence_of(robot).processes if not one.once):
        made = process_for(it.node, robot.spec.name, robot.spec.namespace, plan.fleet.naming)
        words = []
        for word in made.arguments:
            path = own.get(os.path.realpath(str(word))) if made.process.is_include else None
            words.append(word if path is None else File(path_for(robot, path)))
        yield made._replace(arguments=tuple(words))


def _own_command(it: LaunchedNode, space: str, naming: Naming) -> tuple[str, ...]:
    """Return a command; nodes and topics in ``ros2`` commands are the robot's."""
    words, verb = (it.executable, *it.arguments), ""
    found: list[str] = []
    for at, word in enumerate(words):
        if any(one.isspace() for one in word) and "ros2" in word:
            verb, parts = "", re.split(r"(\s+)", word)
            for number, part in enumerate(parts):
                before = parts[number - 2] if number > 1 else ""
                verb = part if os.path.basename(before) == "ros2" else verb
                verb = "" if part in _NEXT or before.endswith(";") else verb
                parts[number] = renamed_word(part, verb, space, naming)
            found.append("".join(_with_own_manager(parts, " ", space, naming)))
            continue
        verb = word if at == 1 and os.path.basename(words[0]) == "ros2" else verb
        # ros2 takes a name without a slash for one in the root.
        is_name = at == _FIRST and verb not in ("", _CONTROL) and word[:1] not in ("-", "/")
        own = f"/{word}" if is_name else word
        named = renamed_word(own, verb, space, naming)
        found.append(word if named == own else named)
    return tuple(_with_own_manager(found, "", space, naming))


def _with_own_manager(
    words: Sequence[str], between: str, space: str, naming: Naming
) -> Iterator[str]:
    """Yield the words of a command, with the robot's manager for ``ros2 control``."""
    # Without a name it asks for one in the root (ros2controlcli, add_controller_mgr_parsers).
    own = [it for it in words if not it.isspace()]
    is_open = not {*own} & {"-c", "--controller-manager"}
    spaced = [between, "-c", between, renamed_word(_MANAGER_IN_ROOT, _CONTROL, space, naming)]
    before = ["", "", ""]
    for word in words:
        before = before if word.isspace() else [*before[1:], word]
        asks = is_open and os.path.basename(before[0]) == "ros2" and before[1] == _CONTROL
        bare = word.rstrip(";") if asks else word
        yield bare
        yield from filter(None, (*spaced, word[len(bare) :]) if asks else ())
        is_open = is_open and not asks


def renamed_word(word: str, verb: str, space: str, naming: Naming) -> str:
    """Return the robot's spelling of an absolute name behind a verb of ``ros2``, else the word."""
    if not word.startswith("/") or check_topic_name(word):
        return word
    if verb in _OF_NODES:
        above, name = placed(space, word, naming)
        return f"{above.rstrip('/')}/{name}"
    target = target_of(word, TOPIC, space, naming) if verb in _OF_NAMES else ""
    return f"/{space}/{target}" if target and target[0] != "/" else target or word


def process_for(it: LaunchedNode, robot: str, space: str, naming: Naming | None) -> Start:
    """Return a process of a robot; without a naming one for all robots, as it is."""
    made: LaunchedNode = for_robot(it, robot)
    namespace, name = made.namespace, made.name
    if naming is not None:
        above = made.namespace.strip("/")
        namespace, spelled = placed(space, f"{above}/{name or _NO_NAME}", naming)
        name = spelled if name else ""
    given = handed_on(made, made.name).values if not made.process.is_include else {}
    rules = made.remappings
    if made.process.is_include and naming is not None:
        topics = ((f"/{it}", target_of(f"/{it}", TOPIC, space, naming)) for it in TF_TOPICS)
        rules = tuple((old, new) for old, new in topics if new)
    is_node, words, program = bool(made.package), made.arguments, made.executable
    if naming and not is_node:
        program, *own_words = _own_command(made, space, naming)
        words = tuple(own_words)
    if made.process.is_include:
        words = tuple(part for word in words for part in word.split(":=", 1))
    return Start(
        made.package,
        program,
        namespace if is_node else "",
        name,
        (given,) if given else (),
        rules,
        words,
        environment=dict(made.environment),
        process=made.process,
        number=made.number,
    )
