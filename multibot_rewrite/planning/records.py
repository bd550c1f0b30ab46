# SPDX-License-Identifier: Apache-2.0
"""Nodes as they run: their rules, and the names that these lead to."""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeAlias

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.knowledge.records import UNKNOWN, Endpoint, NodeFacts
from multibot_rewrite.system.parameters import ANY_NAME, Value
from multibot_rewrite.system.records import NOWHERE, Place
from multibot_rewrite.system.words import is_viewer

# A remap rule, as rcl takes it: what it matches, and what comes in its place.
Rule: TypeAlias = tuple[str, str]
Rules: TypeAlias = tuple[Rule, ...]
# The ends of a node, each with its full name.
Names: TypeAlias = tuple[tuple[Endpoint, str], ...]


class Given(NamedTuple):
    """The value of a parameter, with the type that rcl gives it, and where it is set."""

    value: Value
    place: Place


NOTHING: Mapping[str, Given] = {}


class Run(NamedTuple):
    """A node as it runs: its names, remap rules as rcl takes them, parameters, what is known of it.

    ``robot`` is empty for a node of all robots, or if not known, ``node`` its name in a node set.
    ``written`` is true for a plugin of a description, ``process_wide`` if its rules hold for its
    whole process. ``names`` are its ends with their names under the rules, ``host_name`` is what
    the node is called whose process it is in. ``process`` tells the processes apart; helper nodes
    in it have ``process_rules`` and run in ``process_namespace``, controllers that no node set
    names have the rules that are ``handed_on``. ``values`` are its parameters, ``texts`` other
    files that a parameter names, ``untold`` parameters whose values only a run tells. ``program``
    is its package and executable, started with ``arguments`` at ``place``.

    What a robot's files set for a node is one, too: ``fact.known`` is the known node that it is (empty
    for none), ``program`` the type of a controller, ``host_name`` the manager that has it as one.
    ``unknown_type`` is true if the type is not known and ``fact.known`` is a guess by its parameters,
    ``like`` the known type that may be meant.
    """

    robot: str
    node: str
    namespace: str
    name: str
    rules: Rules
    fact: NodeFacts = UNKNOWN
    written: bool = False
    process_wide: bool = False
    names: Names = ()
    host_name: str = ""
    process: str = ""
    process_namespace: str = ""
    process_rules: Rules = ()
    handed_on: Rules = ()
    values: Mapping[str, Given] = NOTHING
    texts: tuple[str, ...] = ()
    untold: tuple[str, ...] = ()
    program: str = ""
    arguments: tuple[str, ...] = ()
    place: Place = NOWHERE
    unknown_type: bool = False
    like: str = ""

    @property
    def full_name(self) -> str:
        """The node's namespace and name."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def code_name(self) -> str:
        """The node's name in its code."""
        return self.node.rpartition("/")[2]

    @property
    def other_name(self) -> str:
        """The node's name, if that is not the one in its code; otherwise empty."""
        return self.name if self.name != self.code_name else ""

    @property
    def has_fact(self) -> bool:
        """Return whether anything is known of what the node does."""
        return self.fact.is_known

    @property
    def is_known(self) -> bool:
        """Return whether all that the node does is known, or that it only looks on."""
        return self.has_fact or is_viewer(self.name)

    def value(self, name: str) -> object:
        """Return the value of a parameter; None if nothing sets it."""
        given = self.values.get(name)
        return given.value if given else None

    def is_untold(self, name: str) -> bool:
        """Return whether only a run shows a parameter's value, or whether it has one."""
        return name in self.untold or (ANY_NAME in self.untold and name not in self.values)


class Table(NamedTuple):
    """The remap table of a fleet for a release of ROS, and what it cannot do or does wrongly."""

    layout: str
    runs: tuple[Run, ...]
    problems: tuple[Finding, ...]
    release: str

    @property
    def ends(self) -> Iterator[tuple[Run, Endpoint, str]]:
        """Every end, with its node and its full name."""
        yield from ((run, end, name) for run in self.runs for end, name in run.names)

    def by_robot(self, robots: Iterable[str]) -> "dict[str, Table]":
        """Return the nodes of each of the robots as a table without problems."""
        runs = lists_by_key((run.robot, run) for run in self.runs)
        return {it: self._replace(runs=tuple(runs[it]), problems=()) for it in robots}
