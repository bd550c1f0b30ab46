"""What all robots of a description would share, by the second reading of what was written."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice

from lxml.etree import _Element

from multibot_rewrite.base.model import InputError, ProofError
from multibot_rewrite.base.naming import NAMESPACE, TOPIC_KINDS, TWIN, Naming, spelled
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.readback.lost_rules import lost_rules
from multibot_rewrite.description.readback.meeting import meetings, same_for_all
from multibot_rewrite.description.readback.reading import FRAME, NODE, Reading, RuntimeName, read
from multibot_rewrite.description.rewriters.vocabulary import Vocabulary
from multibot_rewrite.description.steps.apply import fill
from multibot_rewrite.description.steps.document import Document

SHARED_TOPIC, SHARED_NODE, SHARED_FRAME, SHARED_LOOKUP = "MB430", "MB431", "MB432", "MB425"
CONTROLLERS, LOST_RULE = "MB435", "MB436"
# Stands for the name of a robot in a hint.
ROBOT = "ROBOT"
SHARED_CODES = frozenset({SHARED_TOPIC, SHARED_NODE, SHARED_FRAME, SHARED_LOOKUP, CONTROLLERS})


def shared_by_all(
    document: Document, pieces: list[bytes], naming: Naming, vocabulary: Vocabulary
) -> Iterator[Problem]:
    """The names that every robot of a description would have, each at its element in the source.

    ``pieces`` are the text between the robot's names: a name in the running system that does not
    hold the robot's is the same for all. Raises ProofError for a text that is no XML, and for a frame
    that was left below the name of the model.
    """
    robot = _unused(document)
    return shared_with(document, fill(pieces, robot), robot, naming, vocabulary)


def _unused(document: Document) -> str:
    robot = TWIN
    while robot.encode() in document.source:
        robot += "x"
    return robot


def shared_by_both(
    document: Document,
    pieces: list[bytes],
    robots: tuple[str, str],
    naming: Naming,
    vocabulary: Vocabulary,
) -> Iterator[Problem]:
    """The names that these two robots would have, but not every robot, as ``arm_left`` of ``b`` and
    ``arm`` of ``left_b``."""
    twin = _unused(document)
    readings = {it: read(fill(pieces, it), document.file, vocabulary) for it in (*robots, twin)}
    every = {(it.kind, it.name) for it in same_for_all(readings.pop(twin), twin, naming)}
    for robot, other, it in meetings(readings, naming):
        if (it.kind, it.name) not in every:
            message = f"{robot} and {other} would both have the {it.kind} {it.name!r}"
            hint = "rename a robot or choose another separator"
            yield Problem(document.root, message, None, hint, (), "MB421")


def shared_with(
    document: Document, text: bytes, robot: str, naming: Naming, vocabulary: Vocabulary
) -> Iterator[Problem]:
    """The same for the text of a ``robot`` that nothing else is called like."""
    try:
        reading = read(text, document.file, vocabulary)
    except InputError as error:
        raise ProofError(str(error)) from None
    for it in reading.missed:
        raise ProofError(
            f"{document.file}: {it.name!r} ({it.path}) is a frame that tf does not have"
        )
    yield from _lost(document, reading, naming, vocabulary)
    of_plugins: dict[int, list[RuntimeName]] = {}
    for it in same_for_all(reading, robot, naming):
        if it.of_controllers:
            of_plugins.setdefault(it.number, []).append(it)
        else:
            yield Problem(
                _element(document, it), _message(it), None, _hint(it, naming), (), code_of(it)
            )
    for names in of_plugins.values():
        yield _of_controllers(_element(document, names[0]), names, naming, vocabulary.release)


def _lost(
    document: Document, reading: Reading, naming: Naming, vocabulary: Vocabulary
) -> Iterator[Problem]:
    """Rules of the file that match no name any more."""
    before = (
        read(document.source, document.file, vocabulary) if b":=" in document.source else reading
    )
    for it in lost_rules(before, reading):
        if it.name.strip("/") not in naming.shared_topics:
            plugin = next(islice(document.root.iter("plugin"), it.number, None), document.root)
            message = f"{it.rule!r} is for {it.name}, and matches nothing after the rewrite"
            hint = "write the topic and the left side of its rule the same way"
            yield Problem(plugin, message, None, hint, (), LOST_RULE)


def _element(document: Document, name: RuntimeName) -> _Element:
    return next(islice(document.root.iter(name.tag), name.number, None), document.root)


def _of_controllers(
    element: _Element, names: Sequence[RuntimeName], naming: Naming, release: str
) -> Problem:
    """What the controllers of a plugin would share, though the plugin has rules for it."""
    shared = ", ".join(it.name for it in names)
    message = (
        f"all robots would have {shared} of their controllers, which take no rules of this plugin on"
        f" {release}"
    )
    rules = " ".join(f"-r {_rule(it.name, naming)}" for it in names)
    hint = (
        f'start each controller with its spawner and --controller-ros-args "{rules}"; multibot plan'
        " and build print the lines"
    )
    return Problem(element, message, None, hint, (), CONTROLLERS)


def code_of(name: RuntimeName) -> str:
    """The rule that a shared name of this kind is about."""
    if name.of_controllers:
        return CONTROLLERS
    if name.kind in TOPIC_KINDS:
        return SHARED_TOPIC
    return {NODE: SHARED_NODE, FRAME: SHARED_FRAME}.get(name.kind, SHARED_LOOKUP)


def _message(name: RuntimeName) -> str:
    if code_of(name) == SHARED_LOOKUP:
        return (
            f"the {name.kind} {name.name!r} is looked up by bare name in the whole world: "
            "it may find that of another robot"
        )
    return f"all robots would have the {name.kind} {name.name!r} ({name.path})"


def _hint(name: RuntimeName, naming: Naming) -> str:
    if name.kind in TOPIC_KINDS:
        return "set a topic that is renamed for each robot, or allow it with --shared-topics"
    if name.kind == NODE:
        return "give the plugin a namespace or another name"
    if code_of(name) == SHARED_LOOKUP:
        return f"use --layout both, which renames {name.kind}s for each robot"
    return "set the frame for each robot, or allow it with --shared-frames"


def _rule(name: str, naming: Naming) -> str:
    """The rule that gives each robot a name of its own; ROBOT stands for its name."""
    if naming.topics == NAMESPACE:
        return f"{name}:={name.strip('/')}"
    return f"{name}:={spelled(naming, ROBOT, 'topic', name)}"
