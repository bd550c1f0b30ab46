# SPDX-License-Identifier: Apache-2.0
"""What a file has below what it is of: the nodes of a robot, the ends and parameters of a node.

A plan is written so, as people edit it. An end of which only a plan knows is a row. Pure.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import chain
from sys import intern
from typing import Any

from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.system.parameters import parameter_text, parameter_value
from multibot_rewrite.system.record_values import (
    Reader,
    WrongValue,
    plain_value,
    read_list,
    reader,
    unexpected,
)
from multibot_rewrite.system.records import (
    KINDS,
    MAY,
    NOWHERE,
    ROLES,
    RUNS,
    End,
    Node,
    Parameter,
    Robot,
    Sure,
    System,
)

ROW = ("role", "kind", "name", "type", "code_name")
# What a row of an end that only may be there says besides.
WHEN = "when"
# Between the types of a row.
OR = " | "
_ROLES, _KINDS = frozenset(ROLES), frozenset(KINDS)


def fields_of(system: System) -> dict[str, object]:
    """Return what a file has of a system by key, settings first: records, or plain values of them."""
    usual = system._field_defaults
    fields = {name: it for name, it in system._asdict().items() if it != usual[name]}
    nested = _below_robots(system) if system.layout else {}
    fields = {name: it for name, it in {**nested, **fields, **nested}.items() if it}
    return {**{name: it for name, it in fields.items() if not has_rows(it)}, **fields}


def has_rows(value: Any) -> bool:
    """Return whether the value is a list of records or rows, and not of texts or numbers."""
    return type(value) in (list, tuple) and any(
        isinstance(it, list | dict | tuple) for it in value[:1]
    )


def _below_robots(system: System) -> dict[str, object]:
    """Return robots with their nodes, nodes with ends and parameters, and what is left."""
    nodes: dict[str, list[object]] = defaultdict(list)
    ends = lists_by_key((it.node, it) for it in system.ends)
    parameters = lists_by_key((it.node, it) for it in system.parameters)
    robots = {it.name for it in system.robots}
    for node in system.nodes:
        whose = node.robot if node.robot in robots else ""
        own = plain_value(node._replace(robot="") if whose else node)
        if values := _parameter_values(parameters.get(node.name, ())):
            own["parameters"] = values
            del parameters[node.name]
        if node.name in ends:
            own["ends"] = [_row_of_end(it) for it in ends.pop(node.name)]
        nodes[whose].append(own)
    below = {name: {"nodes": own} for name, own in nodes.items()}
    return {
        "robots": [{**plain_value(it), **below.get(it.name, {})} for it in system.robots],
        "nodes": nodes[""],
        "ends": [*chain.from_iterable(ends.values())],
        "parameters": [*chain.from_iterable(parameters.values())],
    }


def _parameter_values(own: Sequence[Parameter]) -> dict[str, object]:
    """Return the values of a node's parameters by name; empty where more is known of one."""
    values = {it.name: parameter_value(it.value) for it in own}
    if not all(map(_is_plain, values.values())):
        return {}
    read_back = [Parameter(own[0].node, name, parameter_text(it)) for name, it in values.items()]
    return values if read_back == [*own] else {}


def _is_plain(value: object) -> bool:
    """Return whether a value is a text, number or bool, or a list of these."""
    items = value if isinstance(value, list) else [value]
    return all(isinstance(it, bool | int | float | str) for it in items)


def _row_of_end(end: End) -> object:
    """Return a row of the texts of an end; an object where more is known of it."""
    when = end.sure.why
    if (end.type_hash, end.qos, end.process, end.place) == ("", None, "", NOWHERE) and (
        end.sure == RUNS or (when and end.sure == Sure(MAY.word, when))
    ):
        row = [end.role, end.kind, end.name, OR.join((end.type, *end.also)), end.code_name]
        return [*row, when] if when else row
    return plain_value(end._replace(node=""))


def system_from(value: dict[str, Any]) -> System:
    """Return the system that the value of a file describes; raises WrongValue."""
    found: dict[str, list[Any]] = defaultdict(list)
    _read_below("robots", partial(_read_robot, found), value.pop("robots", ()))
    _read_below("nodes", partial(_read_node, found, ""), value.pop("nodes", ()))
    system: System = reader(System)(value)
    return system._replace(
        robots=tuple(found["robots"]),
        nodes=tuple(found["nodes"]),
        ends=(*found["ends"], *system.ends),
        parameters=(*found["parameters"], *system.parameters),
    )


def _read_below(key: str, read: Reader, values: object) -> Any:
    """Return what ``read`` makes of the values below a key, which errors name."""
    try:
        return read_list(read, values)
    except WrongValue as wrong:
        wrong.keys.append(f".{key}")
        raise


def _pop_list(value: object, key: str) -> Any:
    """Return what is below a key, taken out of the value; empty where there is nothing."""
    found = value.pop(key, None) if isinstance(value, dict) else None
    return () if found is None else found


def _read_robot(found: Mapping[str, list[Any]], value: object) -> None:
    nodes = _pop_list(value, "nodes")
    robot = reader(Robot)(value)
    found["robots"].append(robot)
    _read_below("nodes", partial(_read_node, found, robot.name), nodes)


def _read_node(found: Mapping[str, list[Any]], robot: str, value: object) -> None:
    ends, parameters = _pop_list(value, "ends"), _pop_list(value, "parameters")
    node = reader(Node)(value)
    found["nodes"].append(node if node.robot or not robot else node._replace(robot=robot))
    found["ends"].extend(_read_below("ends", partial(_read_end, node.name), ends))
    found["parameters"].extend(_read_parameters(node.name, parameters) if parameters != () else ())


def _read_end(node: str, value: object) -> Any:
    """Return the end that a row or an object is; raises WrongValue."""
    if type(value) is not list:
        return reader(End)({"node": node, **value} if isinstance(value, dict) else value)
    if len(value) - len(ROW) not in (0, 1) or {*map(type, value)} != {str}:
        raise unexpected("[role, kind, name, type, name in the node's code]", value)
    # Many nodes have the same names, types and words.
    role, kind, name, types, code_name, *when = map(intern, value)
    sure = Sure(MAY.word, when[0]) if when else RUNS
    also: tuple[str, ...] = ()
    if OR in types:
        types, *others = types.split(OR)
        also = (*others,)
    if role in _ROLES and kind in _KINDS and name.startswith("/"):
        return End(kind, role, name, types, "", node, None, "", code_name, also, sure)
    # The reader of an end says which text is wrong.
    return reader(End)({"kind": kind, "role": role, "name": name, "type": types, "node": node})


def _read_parameters(node: str, values: object) -> Iterator[Parameter]:
    if not isinstance(values, Mapping):
        raise WrongValue(unexpected("a mapping of names to values", values).reason, ".parameters")
    for name, value in values.items():
        if not _is_plain(value):
            what = "write a text, a number, true or false, or a list of one"
            raise WrongValue(what, f".{name}", ".parameters")
        yield Parameter(node, name, parameter_text(value))
