# SPDX-License-Identifier: Apache-2.0
"""One system: what runs on some robots and what it needs, from whatever source. Frozen, pure.

Names of nodes and ends are fully qualified, as rcl resolved them. What a file says has its place.
Texts for people decide nothing.
"""

from typing import Annotated, NamedTuple

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.releases import RELEASE_OR_NONE

TOPIC, SERVICE, ACTION = "topic", "service", "action"
KINDS = (TOPIC, SERVICE, ACTION)
PUBLISHES, SUBSCRIBES, SERVES, CALLS = "publishes", "subscribes", "serves", "calls"
ROLES = (PUBLISHES, SUBSCRIBES, SERVES, CALLS)
# Kinds and roles of an interface of ros2_control, or of MoveIt.
COMMAND, STATE, JOINT = "command", "state", "joint"
EXPORTS, CLAIMS = "exports", "claims"
# What the node of a hardware component is known as.
HARDWARE_NODE = "hardware_component"
# How a node gets its remap rules.
PROCESS, HOST, COMPONENT = "process", "host", "component"
SPAWNER, PLUGIN = "spawner", "plugin"
WAYS = (PROCESS, HOST, COMPONENT, SPAWNER, PLUGIN)
# Kinds of addresses.
DEVICE, CALIBRATION, COMPUTER, OWN = "device", "calibration", "computer", "own"
# Why an observation ended: all expected nodes are there, the graph no longer changes, the timeout
# is over. CHANGING: it has not ended, the graph is being watched.
EXPECTED, QUIET, TIMEOUT, CHANGING = "expected", "quiet", "timeout", "changing"
# The node name in rmw of an end whose participant has not announced its nodes yet.
UNKNOWN_NODE = "_NODE_NAME_UNKNOWN_"
# The RMW of a view from a Zenoh router.
ZENOH = "rmw_zenoh_cpp"
# The parameter of every node that says which clock it goes by.
SIM_TIME = "use_sim_time"
# The value of a parameter that only a run tells.
UNTOLD = ""
# What a file may have in a field, besides its type: words, what a text begins with, how many numbers.
FullName = Annotated[str, "^/"]
MaybeFullName = Annotated[str, "^(/|$)"]
Transform = Annotated[tuple[float, ...], 7]
ADDRESSES = (DEVICE, CALIBRATION, COMPUTER, OWN)
SURE_WORDS = ("runs", "may", "unknown", "off")


class Place(NamedTuple):
    """Where something is written; lines and columns count from 1, 0 is not known."""

    file: str
    line: int = 0
    column: int = 0

    def __str__(self) -> str:
        numbers = (self.line, self.column)[: bool(self.line) + bool(self.line and self.column)]
        return ":".join((self.file, *map(str, numbers)))


NOWHERE = Place("")


def place_of(text: str) -> Place:
    """Return the place in ``file:line`` or ``file:line:column``; a text without a line is a file."""
    file, _, last = text.rpartition(":")
    if not (file and last.isdecimal() and len(last) < 10):
        return Place(text) if text else NOWHERE
    above, _, line = file.rpartition(":")
    if above and line.isdecimal():
        return Place(above, int(line), int(last))
    return Place(file, int(last))


# What a plan writes before the name of a node set that names a node.
_NODE_SET = "node set"


class Origin(NamedTuple):
    """What names a node: a node set, or a place in a file; as a text, it is what a plan writes."""

    node_set: str = ""
    place: Place = NOWHERE

    def __str__(self) -> str:
        text = str(self.place)
        # A file of such a name is no node set.
        text = f"./{text}" if text.startswith(f"{_NODE_SET} ") else text
        return f"{_NODE_SET} {self.node_set}" if self.node_set else text


NO_ORIGIN = Origin()


def origin_of(text: str) -> Origin:
    """Return the origin that a plan writes as this text."""
    if text.startswith(f"{_NODE_SET} "):
        return Origin(text.removeprefix(f"{_NODE_SET} "))
    return Origin(place=place_of(text))


class Sure(NamedTuple):
    """Whether something exists: it ``runs``, ``may`` on a condition, is ``off`` or ``unknown``.

    ``why`` is the condition, or why it is not known, for people. Of the nodes ``instead`` exactly one
    runs."""

    word: Annotated[str, SURE_WORDS]
    why: str = ""
    instead: tuple[str, ...] = ()


RUNS, MAY, UNKNOWN, OFF = map(Sure, SURE_WORDS)
# The code of a caveat: nodes that no source names may run, such as the driver of a robot.
UNKNOWN_NODES = "unknown-nodes"
# The code of a finding: what a part of a launch file starts is not in the plan.
NOT_READ = "MF823"
# The code of a process that is no node that is known.
NOT_KNOWN_PROCESS = "MF859"
# The code of a caveat: a node that was waited for did not come.
WAITED_FOR = "expected-not-seen"
# That of nodes that were asked for their state and did not answer.
SILENT = "silent-nodes"
# That of a look that waited for a processor: what it measured in time is doubtful, too.
BUSY_MACHINE = "busy-machine"


class Qos(NamedTuple):
    """The quality of service an end offers or requests; words as in ``rosgraph_msgs``.

    Times are seconds, ``inf`` (null in JSON) is no limit. Fast DDS does not announce history and
    depth to other processes: they are ``UNKNOWN`` and 0 then.
    """

    history: str
    depth: int
    reliability: str
    durability: str
    deadline: float
    lifespan: float
    liveliness: str
    liveliness_lease_duration: float


class Robot(NamedTuple):
    """One robot: its tf topic, the frames of its description.

    ``other_frames`` are further frames that its nodes may send. ``tag`` is its name in frames,
    ``namespace`` that in nodes and topics, where it is another one than its name.
    """

    name: str
    frames: tuple[str, ...] = ()
    tf_topic: FullName = "/tf"
    other_frames: tuple[str, ...] = ()
    tag: str = ""
    namespace: str = ""

    @property
    def space(self) -> str:
        """The robot's name in nodes and topics, without a slash in front."""
        return self.namespace or self.name


class Node(NamedTuple):
    """One node. Two nodes with one name are two records; in a plan a ``*`` of a name is any word.

    ``process`` identifies its process, empty where it is not known; ``enclave`` is that of its process
    (SROS2), empty for none. ``robot`` is its robot's name, empty for a node of all robots or where that
    is not known. ``lifecycle`` is the label of its state, empty for a node that is not managed.
    ``host`` is any word: nodes of one host run on one machine, those of two on two. ``way`` is how it
    gets its remap rules if not by --ros-args of its own (of ``WAYS``), ``taker`` the node that takes
    them for it. ``plugin`` is where a description has the plugin that starts it, ``place`` what else
    names it, ``node_set`` the node set that it is from. ``known`` is what its node set or file
    calls it, ``untold`` what its source does not tell before it runs, each with its place.
    """

    name: FullName
    process: str = ""
    enclave: str = ""
    robot: str = ""
    lifecycle: str = ""
    host: str = ""
    way: str = ""
    taker: str = ""
    node_set: str = ""
    sure: Sure = RUNS
    place: Place = NOWHERE
    plugin: Place = NOWHERE
    known: str = ""
    untold: tuple[str, ...] = ()


class End(NamedTuple):
    """A node's end of a topic, service or action.

    ``kind`` and ``role`` are words of ``KINDS`` and ``ROLES``. ``type`` is empty where it is not known;
    ``also`` are other types that it may have, by parameter or release. ``type_hash``, ``qos`` and the
    end's own ``process`` are known only where the topic was queried; otherwise they are empty, None
    and the process of the node. ``code_name`` is the name in the node's code, before any remap rule,
    ``place`` is where a file names it, or its node.
    """

    kind: Annotated[str, KINDS]
    role: Annotated[str, ROLES]
    name: FullName
    type: str
    type_hash: str = ""
    node: FullName = ""
    qos: Qos | None = None
    process: str = ""
    code_name: str = ""
    also: tuple[str, ...] = ()
    sure: Sure = RUNS
    place: Place = NOWHERE


class Edge(NamedTuple):
    """A transform on ``topic``, which is empty in a plan that says who sends it.

    ``publishers`` are all nodes that may have sent it: a tf message does not say which one did;
    ``several`` is whether more than one did. ``transform`` is the last one: x, y, z in metres and a
    quaternion x, y, z, w; empty if not known, or if several static ones differ; inf for NaN.
    ``rate`` is how often it came a second, 0 if not known, ``age`` as in ``Heard``. ``OFF``: a
    parameter forbids it."""

    child: str
    parent: str
    topic: MaybeFullName = ""
    static: bool = False
    publishers: tuple[str, ...] = ()
    several: bool = False
    transform: Transform = ()
    rate: float = 0.0
    sure: Sure = RUNS
    place: Place = NOWHERE
    age: float = 0.0


def edge_of(parent: str, child: str, static: bool = False) -> Edge:
    """Return a transform of unknown topic and sender."""
    return Edge(child, parent, static=static)


class Heard(NamedTuple):
    """The ``header.frame_id`` of a message that came on ``topic``.

    It was stamped ``age`` seconds before; inf for a stamp of 0, and for a stopped clock, 0 for less
    than a second or not known. ``rate`` are messages a second, 0 if not known, ``child`` the
    ``child_frame_id`` of odometry, ``joints`` the names in a message about joints, which has no
    frame, ``back`` by how much a clock went back, ``pose`` that of odometry or a pose, as the
    numbers of an edge; ``link`` is that of the sensor in a simulator which sends it, and ``place``
    where that is written."""

    topic: FullName
    frame: str
    age: float = 0.0
    rate: float = 0.0
    child: str = ""
    joints: tuple[str, ...] = ()
    back: float = 0.0
    pose: Transform = ()
    link: str = ""
    place: Place = NOWHERE


class Description(NamedTuple):
    """The description on ``topic``: links, and joints that are not fixed; neither if it is no URDF."""

    topic: FullName
    links: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()


class Lookup(NamedTuple):
    """A transform that ``node`` needs: from ``parent``, empty for any frame, to ``frame``."""

    node: FullName
    frame: str
    parent: str = ""
    place: Place = NOWHERE


class Parameter(NamedTuple):
    """A parameter of a node; ``value`` is what ``parameter_text`` makes of it."""

    node: FullName
    name: str
    value: str
    place: Place = NOWHERE


class Controller(NamedTuple):
    """A controller of the node ``manager``; ``claims``: command interfaces while it is active."""

    manager: FullName
    name: str
    state: str
    claims: tuple[str, ...] = ()


class Interface(NamedTuple):
    """An interface of ros2_control (``kind``: command or state) that ``node`` exports or claims.

    For MoveIt a ``joint`` is exported by the controller that moves it, and claimed by the planning
    node."""

    kind: str
    name: str
    node: str
    role: str
    place: Place = NOWHERE


class Address(NamedTuple):
    """What only one process can have, such as a device or a port; ``name`` is the parameter with it."""

    kind: Annotated[str, ADDRESSES]
    name: str
    value: str
    node: FullName
    place: Place = NOWHERE


class Topic(NamedTuple):
    """What holds of a topic besides who has it.

    ``senders`` are patterns of the nodes that may publish it, empty where any may; with
    ``one_sender`` only one node at a time does. ``qos`` are policies with the word that each publisher
    offers, both as in ``Qos``. ``bridge`` is what a ros_gz_bridge does with it: publishes,
    subscribes, both, or nothing; ``type`` is its type then. It serves a service.
    """

    name: FullName
    senders: tuple[str, ...] = ()
    one_sender: bool = False
    qos: tuple[tuple[str, str], ...] = ()
    bridge: tuple[Annotated[str, ROLES], ...] = ()
    type: str = ""


class Caveat(NamedTuple):
    """What to know about a view; with ``incomplete`` something may be missing in it."""

    code: str
    incomplete: bool
    message: str


class Environment(NamedTuple):
    """How a running system was observed, and how complete the view is; all is empty for other sources.

    ``participants`` counts the DDS participants without the observer's own. ``settled`` is
    ``EXPECTED``, ``QUIET``, ``TIMEOUT`` or ``CHANGING``, reached after ``seconds``.
    """

    domain: int = 0
    range: str = ""
    static_peers: tuple[str, ...] = ()
    rmw: str = ""
    discovery_server: str = ""
    super_client: bool = False
    participants: int = 0
    settled: Annotated[str, (EXPECTED, QUIET, TIMEOUT, CHANGING)] = EXPECTED
    seconds: float = 0.0
    caveats: tuple[Caveat, ...] = ()


class Domain(NamedTuple):
    """The ROS_DOMAIN_ID of the nodes of a robot, or of all robots (empty name)."""

    robot: str
    number: int


class System(NamedTuple):
    """What runs, or would run, on some robots; what no source says is empty.

    ``heard`` are frames that messages name, one message a topic, ``descriptions`` what latched ones
    name, ``lookups`` what nodes ask of tf,
    ``addresses`` what only one of them can have.
    ``parameters`` and ``controllers`` are what nodes answered, or what files set. A plan has a
    ``layout``; ``topics`` say more of some of its topics, ``ignored_nodes`` are patterns of nodes that
    may come and go, besides the usual tools.
    ``release`` is the one for which it was made. ``gaps`` are findings about what is open in the
    robots as they are planned: a name that is read and not sent, for example. ``domains`` are those
    of a plan whose robots are not in one.
    """

    nodes: tuple[Node, ...] = ()
    ends: tuple[End, ...] = ()
    edges: tuple[Edge, ...] = ()
    environment: Environment = Environment()
    heard: tuple[Heard, ...] = ()
    parameters: tuple[Parameter, ...] = ()
    controllers: tuple[Controller, ...] = ()
    interfaces: tuple[Interface, ...] = ()
    robots: tuple[Robot, ...] = ()
    topics: tuple[Topic, ...] = ()
    layout: str = ""
    release: Annotated[str, RELEASE_OR_NONE] = ""
    shared_topics: tuple[str, ...] = ()
    shared_frames: tuple[str, ...] = ()
    ignored_nodes: tuple[str, ...] = ()
    gaps: tuple[Finding, ...] = ()
    lookups: tuple[Lookup, ...] = ()
    addresses: tuple[Address, ...] = ()
    domains: tuple[Domain, ...] = ()
    descriptions: tuple[Description, ...] = ()


def surely(system: System) -> System:
    """Return the system without the ends that only may exist."""
    # One object for most, which is told sooner than that all of its fields are the same.
    ends = [it for it in system.ends if it.sure is RUNS or it.sure == RUNS]
    return system if len(ends) == len(system.ends) else system._replace(ends=tuple(ends))


def incomplete(system: System) -> tuple[Caveat, ...]:
    """Return why something may be missing in the view; empty for a complete one."""
    return tuple(caveat for caveat in system.environment.caveats if caveat.incomplete)


def doubts(system: System) -> tuple[Caveat, ...]:
    """Return the limitations that make a view incomplete.

    That an expected node did not come is not one of them: once the graph is quiet it is missing.
    """
    return tuple(caveat for caveat in incomplete(system) if caveat.code != WAITED_FOR)


def unseen(system: System) -> tuple[Caveat, ...]:
    """Return the doubts whether all nodes and ends are seen, without those about silent nodes."""
    return tuple(caveat for caveat in doubts(system) if caveat.code != SILENT)


def clocks(system: System) -> dict[str, bool]:
    """Return whether each node uses simulated time, if known."""
    told = (it for it in system.parameters if it.name == SIM_TIME and it.value != UNTOLD)
    return {it.node: it.value == "true" for it in told}


def without_clock(system: System) -> set[str]:
    """Return the nodes of which only a run shows whether they use simulated time."""
    return {it.node for it in system.parameters if (it.name, it.value) == (SIM_TIME, UNTOLD)}


def nodes_by_robot(system: System) -> dict[str, list[str]]:
    """Return the node names of each robot, and under "" those of no robot, each once."""
    found: dict[str, list[str]] = {"": [], **{it.name: [] for it in system.robots}}
    for name, robot in {it.name: it.robot for it in system.nodes}.items():
        found.setdefault(robot, []).append(name)
    return found


def alternatives(system: System) -> tuple[tuple[str, ...], ...]:
    """Return the groups of nodes of which exactly one runs."""
    return tuple(dict.fromkeys(it.sure.instead for it in system.nodes if it.sure.instead))


def may_miss(node: Node) -> bool:
    """Return whether the node need not run: on a condition, or if another may run in its place."""
    return node.sure.word != RUNS.word or bool(node.sure.instead)


def answering(system: System) -> frozenset[str]:
    """Return the nodes of which a state, parameter or controller is known."""
    states = (it.name for it in system.nodes if it.lifecycle)
    parameters = (it.node for it in system.parameters)
    return frozenset((*states, *parameters, *(it.manager for it in system.controllers)))
