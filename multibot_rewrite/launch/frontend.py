"""XML and YAML launch files: ``$(multibot ...)``, and the actions ``multibot_...``.

launch imports this through the entry point ``launch.frontend.launch_extension``; without launch it
does nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from multibot_rewrite import launch
from multibot_rewrite.launch.robot_words import WORDS

# The fleet decides these; a launch file that sets them would contradict it.
_FROM_THE_FLEET = ("name", "namespace")


def words(data: Sequence[launch.Text]) -> tuple[Any, dict[str, Any]]:
    """``$(multibot WORD [NAME] [robot:=ROBOT] [fleet:=FILE])``, see ``launch.value``."""
    if not data:
        raise ValueError(f"$(multibot) needs one of: {', '.join((*WORDS, launch.FILE))}")
    return launch.substitution(), {"words": data, "of": launch.HERE}


def robots(entity: Any, parser: Any) -> tuple[Any, dict[str, Any]]:
    """``multibot_robots fleet= [robots=]``: its children for every robot, see ``launch.each_robot``."""
    given = {
        **launch.action_options(entity, parser),
        **_texts(entity, parser, "fleet", "robots"),
    }
    if "fleet" not in given:
        raise ValueError("multibot_robots: the fleet is missing; add fleet=FILE")
    children = entity.children
    # An action runs once, so each robot needs its own.
    given["make"] = lambda robot: [parser.parse_action(child) for child in children]
    return launch.each_robot, given


def node(entity: Any, parser: Any) -> tuple[Any, dict[str, Any]]:
    """``multibot_node node= [files=] [describe=] [robot=] [fleet=]`` and what ``node`` takes, see
    ``launch.node``."""
    _, given = launch.node_class().parse(entity, parser)
    for word in _FROM_THE_FLEET:
        if word in given:
            raise ValueError(f"multibot_node: {word} comes from the fleet file; remove {word}=")
    name = parser.parse_substitution(entity.get_attr("node"))
    describe = entity.get_attr("describe", data_type=bool, optional=True, can_be_str=False)
    texts = _texts(entity, parser, "files", "robot", "fleet")
    return launch.node, {**given, **texts, "name": name, "describe": bool(describe)}


def spawn(entity: Any, parser: Any) -> tuple[Any, dict[str, Any]]:
    """``multibot_spawn simulator= [robot=] [fleet=]``, see ``launch.spawn``."""
    simulator = parser.parse_substitution(entity.get_attr("simulator"))
    texts = _texts(entity, parser, "robot", "fleet")
    return launch.spawn, {
        "simulator": simulator,
        **texts,
        **launch.action_options(entity, parser),
    }


def place(entity: Any, parser: Any) -> tuple[Any, dict[str, Any]]:
    """``multibot_place [robot=] [fleet=]``, see ``launch.place``."""
    texts = _texts(entity, parser, "robot", "fleet")
    return launch.place, {**texts, **launch.action_options(entity, parser)}


def _texts(entity: Any, parser: Any, *names: str) -> dict[str, Any]:
    """The attributes that are set, with their substitutions."""
    found = {name: entity.get_attr(name, optional=True) for name in names}
    return {name: parser.parse_substitution(it) for name, it in found.items() if it is not None}


if not launch.missing():
    launch.expose(
        substitutions={"multibot": words},
        actions={
            "multibot_robots": robots,
            "multibot_node": node,
            "multibot_spawn": spawn,
            "multibot_place": place,
        },
    )
