# SPDX-License-Identifier: Apache-2.0
"""XML and YAML launch files: ``$(multibot ...)``, and the actions ``multibot_...``.

launch imports this through the entry point ``launch.frontend.launch_extension``; without launch it
does nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any

from multibot_rewrite.launch import actions
from multibot_rewrite.launch.actions import FROM_THE_FLEET
from multibot_rewrite.launch.context import (
    FILE,
    HERE,
    SIM_TIME,
    WORDS,
    Text,
    as_value,
    substitution_class,
)
from multibot_rewrite.producers.launch.door import missing, of_launch, of_launch_ros

COMPONENT = "multibot_composable_node"
# launch knows typing.List[...], and not list[...].
_SEVERAL: Any = vars(import_module("typing"))["List"]
Parsed = tuple[Any, dict[str, Any]]


def words(data: Sequence[Text]) -> Parsed:
    """Parse ``$(multibot WORD [NAME] [robot:=ROBOT] [fleet:=FILE])``; return class and keywords."""
    if not data:
        raise ValueError(f"$(multibot) needs one of: {', '.join((*WORDS, FILE))}")
    return substitution_class(), {"words": data, "of": HERE}


def robots(entity: Any, parser: Any) -> Parsed:
    """Parse ``multibot_robots fleet= [robots=]``; return ``each_robot`` and its keywords."""
    given = {**action_options(entity, parser), **_texts(entity, parser, "fleet", "robots")}
    if "fleet" not in given:
        raise ValueError("multibot_robots: the fleet is missing; add fleet=FILE")
    children = entity.children
    # An action runs once, so each robot needs its own.
    given["make"] = lambda robot: [parser.parse_action(child) for child in children]
    return actions.each_robot, given


def node(entity: Any, parser: Any) -> Parsed:
    """Parse ``multibot_node``; return ``launch.node`` and its keywords."""
    return actions.node, _node("multibot_node", actions.node_class(), entity, parser)


def lifecycle_node(entity: Any, parser: Any) -> Parsed:
    """Parse ``multibot_lifecycle_node``; return ``launch.lifecycle_node`` and its keywords."""
    made = _node("multibot_lifecycle_node", actions.node_class(), entity, parser)
    return actions.lifecycle_node, made


def container(entity: Any, parser: Any) -> Parsed:
    """Parse ``multibot_container``; return ``launch.container`` and its keywords."""
    base = of_launch_ros("actions").ComposableNodeContainer
    given = _node("multibot_container", base, entity, parser)
    inside = _nested(entity, COMPONENT)
    own = [{**action_options(it, parser), **_component(it, parser)} for it in inside]
    for it in inside:
        it.assert_entity_completely_parsed()
    known = given.pop("composable_node_descriptions", [])
    both = [*known, *(actions.composable_node(**it) for it in own)]
    return actions.container, {**given, "composable_node_descriptions": both}


def composable_node(entity: Any, parser: Any) -> Parsed:
    """Parse ``multibot_composable_node node= pkg= plugin=``; return ``launch.node`` and keywords."""
    return actions.node, {**action_options(entity, parser), **_component(entity, parser)}


def spawn(entity: Any, parser: Any) -> Parsed:
    """Parse ``multibot_spawn simulator= [robot=] [fleet=]``; return ``launch.spawn`` and keywords."""
    simulator = parser.parse_substitution(entity.get_attr("simulator"))
    return actions.spawn, {"simulator": simulator, **_program_options(entity, parser)}


def place(entity: Any, parser: Any) -> Parsed:
    """Parse ``multibot_place [robot=] [fleet=]``; return ``launch.place`` and its keywords."""
    return actions.place, _program_options(entity, parser)


def action_options(entity: Any, parser: Any) -> dict[str, Any]:
    """Return the options of every action in an XML or YAML launch file, such as its condition."""
    options: dict[str, Any] = of_launch().Action.parse(entity, parser)[1]
    return options


def expose(
    substitutions: Mapping[str, Callable[..., Any]], made: Mapping[str, Callable[..., Any]]
) -> None:
    """Register parsing functions for XML and YAML launch files."""
    frontend = of_launch("frontend")
    for name, parse in substitutions.items():
        frontend.expose_substitution(name)(parse)
    for name, parse in made.items():
        frontend.expose_action(name)(parse)


def _node(word: str, base: Any, entity: Any, parser: Any) -> dict[str, Any]:
    """Return the options of a node that its class ``base`` reads, and ours."""
    _, given = base.parse(_Programless(entity), parser)
    if entity.get_attr("exec", optional=True) is None:
        given.pop("executable", None)
    for it in FROM_THE_FLEET:
        if it in given:
            raise ValueError(f"{word}: {it} comes from the fleet file; remove {it}=")
    return {**given, **_parameters(given), **_own_attributes(entity, parser)}


class _Programless:
    """An element whose program need not be said, since the node's node set has it."""

    def __init__(self, entity: Any) -> None:
        self._entity = entity

    def __getattr__(self, name: str) -> Any:
        return getattr(self._entity, name)

    def get_attr(self, name: str, **options: Any) -> Any:
        """Return an attribute of the element."""
        if name != "exec":
            return self._entity.get_attr(name, **options)
        return self._entity.get_attr(name, **{**options, "optional": True}) or "later"


def _own_attributes(entity: Any, parser: Any) -> dict[str, Any]:
    """Return the options of an element that launch_ros does not read."""
    name = parser.parse_substitution(entity.get_attr("node"))
    describe = entity.get_attr("describe", data_type=bool, optional=True, can_be_str=False)
    texts = _texts(entity, parser, "files", "robot", "fleet", SIM_TIME)
    return {**texts, "name_in_set": name, "describe": bool(describe)}


def _component(entity: Any, parser: Any) -> dict[str, Any]:
    """Return the options of a component: launch_ros reads them only where its name is given."""
    given: dict[str, Any] = {
        option: parser.parse_substitution(text)
        for option, word in (("package", "pkg"), ("plugin", "plugin"))
        if (text := entity.get_attr(word, optional=True)) is not None
    }
    if params := _nested(entity, "param"):
        given["parameters"] = actions.node_class().parse_nested_parameters(params, parser)
    if remaps := _nested(entity, "remap"):
        given["remappings"] = [_remap_rule(it, parser) for it in remaps]
    return {**given, **_parameters(given), **_own_attributes(entity, parser)}


def _nested(entity: Any, word: str) -> list[Any]:
    """Return the elements of this name in an element."""
    several = _SEVERAL[of_launch("frontend").Entity]
    return entity.get_attr(word, data_type=several, optional=True) or []


def _remap_rule(entity: Any, parser: Any) -> tuple[Any, Any]:
    source, target = (parser.parse_substitution(entity.get_attr(it)) for it in ("from", "to"))
    entity.assert_entity_completely_parsed()
    return source, target


def _parameters(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters; a value of this package's substitutions with its type."""
    found = [
        {key: as_value(value) for key, value in it.items()} if isinstance(it, dict) else it
        for it in given.get("parameters", ())
    ]
    return {"parameters": found} if found else {}


def _program_options(entity: Any, parser: Any) -> dict[str, Any]:
    texts = _texts(entity, parser, "robot", "fleet", SIM_TIME, "output")
    return {**texts, **action_options(entity, parser)}


def _texts(entity: Any, parser: Any, *names: str) -> dict[str, Any]:
    """Return the attributes that are set, with their substitutions."""
    found = {name: entity.get_attr(name, optional=True) for name in names}
    return {name: parser.parse_substitution(it) for name, it in found.items() if it is not None}


if not missing():
    expose(
        substitutions={"multibot": words},
        made={
            "multibot_robots": robots,
            "multibot_node": node,
            "multibot_lifecycle_node": lifecycle_node,
            "multibot_container": container,
            COMPONENT: composable_node,
            "multibot_spawn": spawn,
            "multibot_place": place,
        },
    )
