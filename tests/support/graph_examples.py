# SPDX-License-Identifier: Apache-2.0
"""Small plans and graphs as lines of text, in which the examples of graph rules are written.

Each line begins with ``planned:`` (it is in the plan), ``running:`` (it is in the graph) or
``as planned:`` (it is in both); of a graph and an earlier look at it with ``earlier:``, ``running:`` or
``as before:``. Behind it comes one of:

    NODE                                a node; a second such line is a second node of that name
    NODE ROLE NAME [TYPE] [as CODE_NAME] [QOS ...]     the node publishes, subscribes, serves or calls
                                        NAME, which is CODE_NAME in its code
    frames of ROBOT on TOPIC: FRAMES    the frames of a robot's description, and its tf topic
    shared topic NAME, shared frame NAME    what all robots use
    topic NAME from NODES [QOS ...]     who may publish a topic, and what they offer
    topic NAME from one node            only one node at a time publishes it
    topic NAME over a bridge that ROLE TYPE     what a ros_gz_bridge has to do
    one of NODES                        one of these nodes runs
    enclave PATH of NODE                the enclave of SROS2 that a running node is in
    transform PARENT -> CHILD on TOPIC [at X Y Z] [by NODES] [twice]    a transform, who publishes
                                                     there, and whether several of them send it
    frame_id FRAME on TOPIC [NUMBER s old] [at NUMBER Hz]    the frame of a message, its age and rate
    description on TOPIC: no links, or links NAMES; joints NAMES     what a latched description names
    joints NAME on TOPIC                the joint that a message on the topic names
    /clock runs, /clock goes back NUMBER s     the time on it
    NODE is STATE, NODE has PARAMETER VALUE          what it answers when it is asked for its state
    state of NODE: STATE, parameter NAME of NODE: VALUE     what it is planned to answer
    host of NODE: WORD, NODE on machine NUMBER       where it is planned to run, and where it runs
    TOPIC came NUMBER times             how many messages of it came in a minute
    NODE controls INTERFACE by CONTROLLER, NODE keeps CONTROLLER STATE    a controller manager's answer
    NODE exports KIND INTERFACE, NODE claims KIND INTERFACE     of the hardware, of a controller

QOS are words of DDS in small letters: reliable, best_effort, volatile, transient_local. A robot is
every ``robot1``, ``robot2`` ... in the plan. In the code of its node a planned name has no robot:
``/robot1/scan`` is ``/scan`` there. ``map`` is a shared frame.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator

from graph_cases import environment, qos
from node_answers import told
from plans import PlannedRobot, planned, planned_end, told as planned_told

from multibot_rewrite.base.conventions import SENT_BY_EVERY_NODE
from multibot_rewrite.system.guess import GuessedRobot, whose_by_guess, with_frames
from multibot_rewrite.system.index import Index, Known, index
from multibot_rewrite.system.parameters import Answer, with_answers
from multibot_rewrite.system.records import (
    ACTION,
    MAY,
    PUBLISHES,
    SERVICE,
    SUBSCRIBES,
    TOPIC,
    Address,
    Description,
    Edge,
    End,
    Heard,
    Interface,
    Lookup,
    Node,
    Parameter,
    Qos,
    System,
    Topic,
)

LINE = re.compile(r"(planned|running|as planned): (.+)")
NODE = re.compile(
    r"(/\S+)(?: (publishes|subscribes|serves|calls) (\S+)(?: (\w+/\w+/\w+))?(?: as (\S+))?((?: \w+)*))?"
)
FRAMES = re.compile(r"frames of (\w+) on (\S+): (.+)")
SHARED = re.compile(r"shared (topic|frame) (\S+)")
TRANSFORM = re.compile(
    r"transform (\S+) -> (\S+) on (\S+)(?: at ([-\d. ]+))?(?: by (.+?))?( twice)?"
)
TOPIC_OF = re.compile(r"topic (\S+) from (one node|/\S+(?:, /\S+)*)((?: \w+)*)")
ENCLAVE = re.compile(r"enclave (/\S+) of (/\S+)")
BRIDGED = re.compile(r"topic (\S+) over a bridge that (publishes|subscribes) (\S+)")
ONE_OF = re.compile(r"one of (.+)")
STATE = re.compile(r"(/\S+) is (\w+)")
SIM_TIME = re.compile(r"(/\S+) has use_sim_time (true|false)")
HAS = re.compile(r"(/\S+) has (?!use_sim_time)(\w+) ([\w/]+)")
PLANNED_STATE = re.compile(r"state of (/\S+): (\w+)")
PLANNED_PARAMETER = re.compile(r"parameter (\w+) of (/\S+): ([\w/]+)")
HOST = re.compile(r"host of (/\S+): (\w+)")
MACHINE = re.compile(r"(/\S+) on machine (\d)")
INTERFACE = re.compile(r"(/\S+) (exports|claims) (command|state|joint) (\S+)")
HOLDS = re.compile(r"(/\S+) holds (device|calibration|computer|own) (\S+) (\S+)")
LOOKS_UP = re.compile(r"(/\S+) looks up (\S+)")
CONTROLS = re.compile(r"(/\S+) controls (\S+) by (\w+)")
CAME = re.compile(r"(/\S+) came (\d+) times")
JOINTS = re.compile(r"joints (\S+) on (/\S+)")
DESCRIBED = re.compile(r"description on (/\S+): (?:no links|links ([^;]+)(?:; joints (.+))?)")
CLOCK_TIME = re.compile(r"(/clock) (?:runs|goes back ([\d.]+) s)")
FRAME_ID = re.compile(r"frame_id (\S+) on (/\S+)(?: ([\d.]+) s old)?(?: at ([\d.]+) Hz)?")
KEEPS = re.compile(r"(/\S+) keeps (\w+) (\w+)")
ANSWERS = (STATE, SIM_TIME, CONTROLS, KEEPS, HAS, MACHINE)
ROBOT = re.compile(r"robot\d+")
PLANNED, RUNNING, BOTH = "planned", "running", "as planned"
# Words of QOS -> the policy that they are of.
POLICIES = {
    "reliable": "reliability",
    "best_effort": "reliability",
    "volatile": "durability",
    "transient_local": "durability",
}


def read_example(text: str) -> tuple[System, System]:
    """Return the plan and graph of an example; AssertionError for a line not in the language."""
    lines = [LINE.fullmatch(line) for line in text.splitlines()]
    assert all(lines), f"a line does not begin with planned:, running: or as planned:\n{text}"
    pairs = [(it[1], it[2]) for it in lines if it]
    planned = [rest for where, rest in pairs if where in (PLANNED, BOTH)]
    running = [rest for where, rest in pairs if where in (RUNNING, BOTH)]
    for line in (*planned, *running):
        assert _is_known(line), f"not in the language of examples: {line}"
    return read_plan(planned), read_graph(running)


def read_looks(text: str) -> tuple[System, System]:
    """Return the earlier look and the graph of an example."""
    pairs = [line.split(": ", 1) for line in text.splitlines()]
    assert {where for where, _ in pairs} <= {"earlier", "running", "as before"}, text
    before, after = (
        [rest for where, rest in pairs if where in (own, "as before")]
        for own in ("earlier", "running")
    )
    return read_graph(before), read_graph(after)


def read_system(text: str) -> Index:
    """Return the graph of an example without a plan."""
    plan, graph = read_example(text)
    assert not plan.ends, "a danger needs no plan: begin its lines with running:"
    robots = sorted({*ROBOT.findall(text)})
    frames = [name for frame in graph.edges for name in (frame.child, frame.parent)]
    guessed = with_frames((GuessedRobot(it, f"/{it}") for it in robots), frames)
    running = [line.removeprefix("running: ") for line in text.splitlines()]
    messages = {name: int(count) for name, count in _words(CAME, running)}
    return index(graph, whose_by_guess(guessed), Known(messages=messages, seconds=60.0))


def read_states(lines: list[str]) -> tuple[Answer, ...]:
    """Return what the nodes of an example answer."""
    managed = (told(node, state) for node, state in _words(STATE, lines))
    timed = (told(node, sim_time=it == "true") for node, it in _words(SIM_TIME, lines))
    active = [
        told(node, controllers=[(name, "active", (claim,))])
        for node, claim, name in _words(CONTROLS, lines)
    ]
    kept = [
        told(node, controllers=[(name, state, ())]) for node, name, state in _words(KEEPS, lines)
    ]
    having = (
        told(node, parameters=[(name, _text(value))]) for node, name, value in _words(HAS, lines)
    )
    return (*managed, *timed, *active, *kept, *having)


def _text(value: str) -> str:
    """Return a word as text, unless it is a number or a truth value."""
    plain = value in ("true", "false") or value.isdigit()
    return value if plain else f'"{value}"'


def in_states(plan: System, lines: list[str]) -> System:
    """Return the plan with what its nodes are planned to answer, and where they run."""
    for node, state in _words(PLANNED_STATE, lines):
        plan = planned_told(_with_node(plan, node), node, lifecycle=state)
    for node, host in _words(HOST, lines):
        plan = planned_told(_with_node(plan, node), node, host=host)
    return plan


def _with_node(plan: System, name: str) -> System:
    if any(it.name == name for it in plan.nodes):
        return plan
    return plan._replace(nodes=(*plan.nodes, Node(name, robot=name.split("/")[1], sure=MAY)))


def _is_known(line: str) -> bool:
    states = (PLANNED_STATE, PLANNED_PARAMETER, HOST)
    planned = (FRAMES, SHARED, TOPIC_OF, BRIDGED, ONE_OF, ENCLAVE, *states)
    every = (
        NODE,
        TRANSFORM,
        FRAME_ID,
        JOINTS,
        CLOCK_TIME,
        DESCRIBED,
        INTERFACE,
        HOLDS,
        LOOKS_UP,
        CAME,
        *planned,
        *ANSWERS,
    )
    return any(it.fullmatch(line) for it in every)


def _words(pattern: re.Pattern[str], lines: Iterable[str]) -> Iterator[tuple[str, ...]]:
    """Return the words of the lines that are such a pattern; what is left out is empty."""
    found = filter(None, map(pattern.fullmatch, lines))
    return (it.groups(default="") for it in found)


def read_plan(lines: list[str]) -> System:
    """Return what the lines plan."""
    shared = defaultdict(list, {"topic": [*SENT_BY_EVERY_NODE, "/clock"], "frame": ["map"]})
    for kind, name in _words(SHARED, lines):
        shared[kind].append(name)
    nodes = list(dict.fromkeys(node for node, *_ in _words(NODE, lines)))
    frames = {robot: (tf, names.split(", ")) for robot, tf, names in _words(FRAMES, lines)}
    robots = []
    for name in sorted({found for line in lines for found in ROBOT.findall(line)}):
        tf, own = frames.get(name, ("/tf", []))
        robots.append(PlannedRobot(name, tuple(it for it in nodes if name in it), tuple(own), tf))
    made = planned(
        "an example",
        tuple(robots),
        tuple(it for it in nodes if not ROBOT.search(it)),
        tuple(shared["topic"]),
        tuple(shared["frame"]),
        tuple(_planned_endpoint(*words[:4]) for words in _words(NODE, lines) if words[1]),
        topics=(
            *(_planned_topic(*words) for words in _words(TOPIC_OF, lines)),
            *(
                Topic(name, bridge=(role,), type=type_)
                for name, role, type_ in _words(BRIDGED, lines)
            ),
        ),
        one_of=tuple(tuple(words[0].split(", ")) for words in _words(ONE_OF, lines)),
        parameters=tuple(
            Parameter(node, name, _text(value))
            for name, node, value in _words(PLANNED_PARAMETER, lines)
        ),
    )
    return in_states(made, lines)


def _planned_topic(name: str, senders: str, qos_words: str) -> Topic:
    offered = tuple((POLICIES[word], word.upper()) for word in qos_words.split())
    if senders == "one node":
        return Topic(name, (), True, offered)
    return Topic(name, tuple(senders.split(", ")), False, offered)


def _planned_endpoint(node: str, role: str, name: str, type_: str) -> End:
    return planned_end(node, _kind(role, type_), role, name, type_, re.sub("/robot\\d+", "", name))


def _kind(role: str, type_: str) -> str:
    if "/action/" in type_:
        return ACTION
    return TOPIC if role in (PUBLISHES, SUBSCRIBES) else SERVICE


def _heard(lines: list[str]) -> Iterator[Heard]:
    for frame, topic, age, rate in _words(FRAME_ID, lines):
        yield Heard(topic, frame, float(age or 0), float(rate or 0))
    for joint, topic in _words(JOINTS, lines):
        yield Heard(topic, "", joints=(joint,))
    for topic, back in _words(CLOCK_TIME, lines):
        yield Heard(topic, "", back=float(back or 0))


def read_graph(lines: list[str]) -> System:
    """Return what the lines say is running."""
    ends = [words for words in _words(NODE, lines) if words[1]]
    alone = [node for node, role, *_ in _words(NODE, lines) if not role]
    asked = [words[0] for it in ANSWERS for words in _words(it, lines)]
    alone += [it for it in dict.fromkeys(asked) if it not in {node for node, *_ in ends}]
    nodes = [*alone, *dict.fromkeys(node for node, *_ in ends if node not in alone)]
    enclaves = {node: path for path, node in _words(ENCLAVE, lines)}
    # Fast DDS: vendor, then the machine.
    processes = {node: f"010f{it:0>4}{it:0>16}" for node, it in _words(MACHINE, lines)}
    seen = System(
        tuple(Node(node, processes.get(node, ""), enclaves.get(node, "")) for node in nodes),
        tuple(_endpoint(*words) for words in ends),
        tuple(_transform(*words) for words in _words(TRANSFORM, lines)),
        environment(),
        tuple(_heard(lines)),
        interfaces=tuple(
            Interface(kind, name, node, role) for node, role, kind, name in _words(INTERFACE, lines)
        ),
        addresses=tuple(
            Address(kind, name, value, node) for node, kind, name, value in _words(HOLDS, lines)
        ),
        lookups=tuple(Lookup(node, frame) for node, frame in _words(LOOKS_UP, lines)),
        descriptions=tuple(
            Description(topic, *(tuple(filter(None, it.split(", "))) for it in named))
            for topic, *named in _words(DESCRIBED, lines)
        ),
    )
    return with_answers(seen, read_states(lines))


def _endpoint(node: str, role: str, name: str, type_: str, code: str, words: str) -> End:
    return End(_kind(role, type_), role, name, type_, "", node, _qos(words.split()), "", code)


def _qos(words: list[str]) -> Qos | None:
    return qos(**{POLICIES[word]: word.upper() for word in words}) if words else None


def _transform(parent: str, child: str, topic: str, at: str, nodes: str, twice: str) -> Edge:
    publishers = tuple(nodes.split(", ")) if nodes else ()
    place = (*map(float, at.split()), 0.0, 0.0, 0.0, 1.0) if at else ()
    return Edge(child, parent, topic, "tf_static" in topic, publishers, bool(twice), place)
