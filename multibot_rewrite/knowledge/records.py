# SPDX-License-Identifier: Apache-2.0
"""What is known of a node: its endpoints, frames, transforms and claims, before any remap rule."""

from collections.abc import Mapping
from typing import NamedTuple

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.knowledge.controller_ways import controller_way
from multibot_rewrite.system.records import NO_ORIGIN, Origin

MANAGER, MOVE_GROUP, TWIST_MUX = "controller_manager", "move_group", "twist_mux"
CARTOGRAPHER = "cartographer_node"
# Topics that image_transport's plugins derive from a base name.
TRANSPORTS = ("compressed", "compressedDepth", "theora", "zstd")


NO_TYPES: Mapping[str, str] = {}


class Endpoint(NamedTuple):
    """A topic, service or action in a node's code, before any remap rule.

    It has the keys of its entry (``README.md``), the ``if`` as ``condition``.

    ``name`` is relative, absolute or private (``~/x``). ``remapped``: the table's rule must lead
    there, since only the first match counts. ``named_from`` is what its entry calls it, if a node
    set gives it another name. ``own`` is true where an argument of the robot's description makes
    the name: it is the robot's already."""

    kind: str
    role: str
    name: str
    type: str = ""
    transport: bool = False
    parameter: str = ""
    fixed: str = ""
    note: str = ""
    also: tuple[str, ...] = ()
    when: str = ""
    helper: bool = False
    remapped: str = ""
    condition: str = ""
    named_from: str = ""
    above: str = ""
    releases: str = ""
    source: tuple[str, ...] = ()
    by: str = ""
    types: tuple[tuple[str, str], ...] = ()
    beside: str = ""
    own: bool = False


class FrameParameter(NamedTuple):
    """A parameter that holds a frame id, and its default; no remap rule reaches frame ids.

    ``given`` is true where a robot's own files set it. ``in_code`` is true for a frame that no layout
    changes: its code writes it, or nobody sees that its parameter holds a frame; ``is_kept`` is true
    for a default that none changes where no file sets it.
    ``releases`` and ``source`` as in ``Endpoint``.
    """

    parameter: str
    default: str
    releases: str = ""
    source: tuple[str, ...] = ()
    given: bool = False
    in_code: bool = False
    is_kept: bool = False


class Param(NamedTuple):
    """A parameter by its dotted path: what its value is, and its default.

    ``releases`` are release words (``multibot_rewrite.base.releases``), ``absolute`` those in which a
    relative topic in it is not resolved in the robot's namespace, ``deprecated`` those that warn of
    it, both empty for none; ``source`` are the places where it can be read. ``own`` is true for a
    frame that the node itself makes, so no description has it. ``instead`` are parameters or nodes that
    do what a deprecated one did.
    """

    path: str
    kind: str
    default: str = ""
    releases: str = ""
    absolute: str = ""
    note: str = ""
    source: tuple[str, ...] = ()
    deprecated: str = ""
    own: bool = False
    instead: tuple[str, ...] = ()


class Branch(NamedTuple):
    """Parameters by the next segment of their paths; ``numbered`` are stems of names with digits."""

    exact: dict[str, "Branch"]
    numbered: dict[str, "Branch"]
    wild: dict[str, "Branch"]
    params: list[Param]


NO_PARAMS: Mapping[str, Param] = {}
NO_TREE = Branch({}, {}, {}, [])


class NodeParameters(NamedTuple):
    """A node in parameter files.

    ``forms`` are its parameters in all releases, ``types`` controller types, ``known_by``
    parameters that identify the node if its section has another name. ``strips`` are the releases
    in which the node takes off a slash that a frame starts with, empty for none;
    ``deprecated_types`` has those of types. ``declared_in`` are packages besides its own whose
    classes declare parameters on it: plugins, helpers, libraries. Of a release are the ``params``
    by path, as a ``tree``, and those that hold one name by ``defaults``: all are empty in the
    library."""

    name: str
    package: str
    forms: tuple[Param, ...] = ()
    aliases: tuple[str, ...] = ()
    types: tuple[str, ...] = ()
    known_by: tuple[str, ...] = ()
    releases: str = ""
    source: tuple[str, ...] = ()
    strips: str = ""
    deprecated_types: Mapping[str, str] = NO_TYPES
    declared_in: tuple[str, ...] = ()
    params: Mapping[str, Param] = NO_PARAMS
    tree: Branch = NO_TREE
    defaults: tuple[Param, ...] = ()


class SentTransform(NamedTuple):
    """A transform that a node publishes, as the parameters that hold its frames.

    ``condition`` is as in ``Endpoint``, ``static`` is true for one that holds for ever. A frame
    that its code makes of parameters stands for one itself (``made_of``)."""

    parent: str
    child: str
    condition: str = ""
    static: bool = False


_MADE_OF = lazy_compile(r"<([^<>=]+)(?:=([^<>]*))?>")


def made_of(text: str, values: Mapping[str, str]) -> str:
    """Return a frame that code makes, with each set ``<parameter=default>`` filled in."""
    return _MADE_OF.sub(lambda it: values.get(it[1], it[0] if it[2] is None else it[2]), text)


class Claim(NamedTuple):
    """Interfaces that a controller claims.

    ``kind`` is command or state, ``template`` a name with parameters in <> (``evidence.hardware``),
    ``condition`` and ``releases`` are as in ``Endpoint``."""

    kind: str
    template: str
    condition: str = ""
    releases: str = ""


class Untold(NamedTuple):
    """What a node's source leaves open until it runs, with its place; ``parameter`` decides it."""

    text: str
    parameter: str = ""


class NodeFacts(NamedTuple):
    """A known node: its default name, package, endpoints, and what else its entry (``README.md``) says.

    A name with slashes is a node in its own namespace below the robot's, such as a costmap. No rule
    reaches ``frames`` and ``fixed``. ``known`` is its name in its entry if it has another one.
    ``origin`` is where a robot's own files name it, or its node set. ``interface`` is the NoDL file
    that its endpoints are from, empty for the library. ``container`` is the node whose process it
    is loaded into as a component. ``of_hardware`` is true for a node that a hardware plugin makes
    in the process of the controller manager. ``unmanaged`` are the releases in which it has a life
    cycle and no manager of Nav2 knows it. ``usual`` are the parameters of the node set's own file,
    for a robot none of whose files has any. ``prefix_switch`` is a parameter: unless it is false,
    the node puts its namespace before its frames. ``is_known`` is false for a node that nobody
    knows: its ends are those that its remap rules name. ``untold`` is what its source does not
    tell. ``together`` are the nodes that its program always makes, where it makes several."""

    name: str
    package: str
    endpoints: tuple[Endpoint, ...]
    shared: bool = False
    note: str = ""
    host: str = ""
    when: str = ""
    frames: tuple[FrameParameter, ...] = ()
    fixed: tuple[str, ...] = ()
    sends: tuple[SentTransform, ...] = ()
    ids: tuple[tuple[str, str], ...] = ()
    claims: tuple[Claim, ...] = ()
    known: str = ""
    origin: Origin = NO_ORIGIN
    releases: str = ""
    source: tuple[str, ...] = ()
    programs: tuple[str, ...] = ()
    interface: str = ""
    container: str = ""
    plugin: str = ""
    apart: bool = False
    of_hardware: bool = False
    component: str = ""
    prefix_switch: str = ""
    unmanaged: str = ""
    usual: tuple[tuple[str, str | float], ...] = ()
    by_sensor: tuple[tuple[str, tuple[tuple[str, str | float], ...]], ...] = ()
    is_known: bool = True
    untold: tuple[Untold, ...] = ()
    together: tuple[str, ...] = ()

    @property
    def kind(self) -> str:
        """The name of its entry."""
        return self.known or self.name

    @property
    def is_controller(self) -> bool:
        """Return whether the controller manager loads it; nodes of hardware are in its process, too."""
        return self.host == MANAGER and not self.of_hardware


# What is known of a node that nobody knows.
UNKNOWN = NodeFacts("", "", (), is_known=False)


def names_its_process(kind: str, release: str) -> bool:
    """Return whether a rule ``__node`` for this node renames its whole process (ros2_control#1684)."""
    return kind == MANAGER and controller_way(release).process_wide
