# SPDX-License-Identifier: Apache-2.0
"""Names that all robots of a description share, and why a rewrite is not verified."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import TypeVar

from lxml.etree import _Element

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import InputError, ProofError
from multibot_rewrite.base.naming import NAMESPACE, TWIN, Naming, spelled
from multibot_rewrite.base.wording import plural
from multibot_rewrite.description.checks.hazards import ALONE
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.readback import meeting
from multibot_rewrite.description.readback.active import active_parts
from multibot_rewrite.description.readback.nodes import SERVICE, TOPIC, RuntimeName
from multibot_rewrite.description.readback.reading import Reading, read, read_tree
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions
from multibot_rewrite.description.steps.apply import fill
from multibot_rewrite.description.steps.document import Document

LOST_RULE, SAME_TEXT, PARTED, NO_LINK = "MB436", "MB437", "MB438", "MB502"
ELSEWHERE = "MB439"
ALL = "all robots would"
BESIDE = "use --topics namespace, which keeps both in one place"
NAMED = "use a layout that gives each robot names of its own, as --layout both"
# Names in code stay in every layout: another one that renames links and joints breaks the plugin.
OWN = (
    "names are fixed in a plugin's code: use --layout frame-prefix where sensors name their frames; "
    f"else {ALONE}"
)
BY_HAND = "write it for each robot by hand, as by an argument of a xacro"


def shared_by_all(
    document: Document, pieces: list[bytes], naming: Naming, definitions: Definitions
) -> Iterator[Problem]:
    """Yield the names that every robot of a description would have, each at its element in the source.

    ``pieces`` are the text between the robot's names: a name in the running system that does not hold
    the robot's is the same for all. Raises ProofError for a text that is no XML, and for a frame that
    was left below the name of the model.
    """
    robot = _unused_robot_name(document)
    return shared_with(document, fill(pieces, robot), robot, naming, definitions)


Said = TypeVar("Said", Problem, Finding)


def said_of(robot: str, found: Iterable[Said]) -> Iterator[Said]:
    """Yield findings about a placeholder robot with the name of this one in its place."""
    for it in found:
        message, hint = it.message.replace(TWIN, robot), it.hint.replace(TWIN, robot)
        yield it._replace(message=message, hint=hint)


def _unused_robot_name(document: Document) -> str:
    robot = TWIN
    while robot.encode() in document.source:
        robot += "x"
    return robot


def shared_by_both(
    document: Document,
    pieces: list[bytes],
    robots: tuple[str, str],
    naming: Naming,
    definitions: Definitions,
) -> Iterator[Problem]:
    """Yield names that two robots share, not all: ``arm_left`` of ``b``, ``arm`` of ``left_b``."""
    twin = _unused_robot_name(document)
    named = {it: read(fill(pieces, it), document.file, definitions).names for it in (*robots, twin)}
    every = {(it.kind, it.name) for it in meeting.same_for_all(named.pop(twin), twin, naming)}
    for met in meeting.meetings(named, naming):
        it = met.name
        if (it.kind, it.name) not in every:
            message = meeting.said(f"{met.robot} and {met.other} would both", it)
            hint = "rename a robot or choose another separator"
            yield Problem(document.root, message, None, hint, (), meeting.code_of(it))


def shared_with(
    document: Document, text: bytes, robot: str, naming: Naming, definitions: Definitions
) -> Iterator[Problem]:
    """Yield the names in the text of ``robot``, a unique name, that every robot would have."""
    try:
        reading = read(text, document.file, definitions)
    except InputError as error:
        raise ProofError(str(error)) from None
    for it in reading.missed:
        raise ProofError(
            f"{document.file}: {it.name[1:]!r} below the model's name ({it.path}) is a frame that tf "
            "does not have"
        )
    found = [*_changed(document, reading, robot, naming, definitions)]
    shared = list(meeting.same_for_all(reading.names, robot, naming))
    for it in (it for it in shared if not it.of_controllers):
        element, message = it.element_in(document.root), meeting.said(ALL, it)
        found.append(Problem(element, message, None, meeting.advice(it), (), meeting.code_of(it)))
    for names in lists_by_key((it.number, it) for it in shared if it.of_controllers).values():
        plugin = names[0].element_in(document.root)
        found.append(_of_controllers(plugin, names, naming, definitions.release))
    yield from found
    if not found and robot.encode() not in text:
        yield from _same_text(document, naming, definitions)
    if all(
        document.root.find(it) is None for it in ("link", "webots", ".//model/link", ".//include")
    ):
        from multibot_rewrite.description.sources.included_by import robot_instead  # few ask for it

        hint = robot_instead(document.file)
        yield Problem(document.root, "the robot has no link", None, hint, (), NO_LINK)


def _same_text(document: Document, naming: Naming, definitions: Definitions) -> Iterator[Problem]:
    """Yield a problem if all robots get one text with names that no namespace keeps apart."""
    parts = list(active_parts(document.root, definitions))
    for part in parts:
        if part.opens_something and not (naming.topics == NAMESPACE and part.is_apart):
            what = f"{part.kind} {part.name!r}, which may open the same topics or services in each"
            message = f"all robots get the same text with {what}"
            is_fixed = any(it.section and it.section.hardwired for it in parts)
            yield Problem(part.element, message, None, OWN if is_fixed else NAMED, (), SAME_TEXT)
            return


def _changed(
    document: Document, reading: Reading, robot: str, naming: Naming, definitions: Definitions
) -> Iterator[Problem]:
    """Yield the names that were shared or matched before the rewrite, and are not after it."""
    images = any(meeting.CAMERA_INFO in it.name for it in reading.names)
    if b":=" not in document.source and not images and not _differ_in_place_only(reading, robot):
        return
    before = read_tree(document.root, definitions)
    for lost in meeting.lost_rules(before, reading):
        if lost.name.strip("/") not in naming.shared_topics:
            plugin = next(islice(document.root.iter("plugin"), lost.number, None), document.root)
            message = f"{lost.rule!r} is for {lost.name}, and matches nothing after the rewrite"
            hint = "write the topic and the left side of its rule the same way"
            yield Problem(plugin, message, None, hint, (), LOST_RULE)
    for it, other in meeting.parted(before, reading):
        one, two = (name.name.replace(robot, TWIN) for name in (it, other))
        message = (
            f"{it.path} is {one!r} after the rewrite and {other.path} is {two!r}: "
            "they were the same topic"
        )
        left = next((name.path for name in (it, other) if name in reading.other_ends), "")
        hint = f"write both the same way, or {BESIDE}"
        if left:
            hint = f"{left} stays as it is: {BY_HAND}"
        yield Problem(it.element_in(document.root), message, None, hint, (), PARTED)
    for it, *pair in meeting.undescribed(before, reading):
        image, asked, info = (name.replace(robot, TWIN) for name in (it.name, *pair))
        message = f"image_transport and RViz look for {asked!r} next to {image!r}: it is {info!r}"
        hint = f'start what shows it with --ros-args -r "{asked}:={info}", or {BESIDE}'
        yield Problem(it.element_in(document.root), message, None, hint, (), ELSEWHERE)


def _differ_in_place_only(reading: Reading, robot: str) -> bool:
    """Return whether topics differ only in the place of the robot's name."""
    every = (*reading.names, *reading.other_ends)
    topics = {it.name for it in every if it.kind in (TOPIC, SERVICE)}
    bare = {it.replace(robot, "").replace("/", "").replace("_", "") for it in topics}
    return len(bare) < len(topics)


def _of_controllers(
    element: _Element, names: Sequence[RuntimeName], naming: Naming, release: str
) -> Problem:
    """Return the problem that a plugin's controllers share names in spite of the plugin's rules."""
    shared = [it.name for it in names]
    message = (
        f"{ALL} have {', '.join(shared)} of their controllers, which take no rules of this plugin "
        f"on {release}"
    )
    # What each robot calls it; TWIN stands for its name.
    own = [it.strip("/") for it in shared]
    if naming.topics != NAMESPACE:
        own = [spelled(naming, TWIN, "topic", it) for it in shared]
    rules = " ".join(f"-r {name}:={to}" for name, to in zip(shared, own, strict=True))
    hint = (
        f'start each controller with its spawner and --controller-ros-args "{rules}"; multibot plan'
        " and build print the lines"
    )
    return Problem(element, message, None, hint, (), meeting.NOT_TAKEN)


# Code -> what is counted and what is said of it. A rewrite with one of these findings is not verified.
REASONS = {code: (what, why) for code, what, why in own_rows(__file__, "reasons.schema")}

# What is verified of a description and hangs on what starts it: a code, and how the summary says it.
GIVEN = {
    meeting.NOT_TAKEN: "where each controller is spawned with its rules",
    ELSEWHERE: "where what shows an image has the rule for its camera_info",
    meeting.NUMBERED: "where what each robot talks to has its number",
}


def given(findings: Iterable[Finding], of_world: Iterable[str] = ()) -> str:
    """Return the conditions on which a rewrite with these findings is verified, in words; or ""."""
    codes = {it.code for it in findings}
    said = [words for code, words in GIVEN.items() if code in codes]
    systems = ", ".join(sorted(set(of_world)))
    return " and ".join([*said, *([f"where the world loads {systems}"] if systems else [])])


def not_verified(findings: Iterable[Finding]) -> tuple[str, ...]:
    """Return why a rewrite with these findings is not verified, with counts; empty where it is."""
    counts = Counter(it.code for it in findings)
    found = ((counts[code], *words) for code, words in REASONS.items() if counts[code])
    return tuple(f"{plural(count, what)} {why}" for count, what, why in found)
