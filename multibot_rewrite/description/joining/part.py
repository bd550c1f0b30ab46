# SPDX-License-Identifier: Apache-2.0
"""A part: what its file has, with its own prefix, and whether it can be joined at all.

Sources: urdfdom model.cpp (``initTree``, ``initRoot``: one root, one joint above each link).
"""

import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import NamedTuple

from multibot_rewrite.base.findings.finding import ERROR, Finding, RewriteRefused
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.naming import PREFIX, Naming, make_naming
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.checks import links_and_joints
from multibot_rewrite.description.checks.audit import audit
from multibot_rewrite.description.joining.kept import is_joined, is_joined_whole
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.included_by import robot_instead
from multibot_rewrite.description.sources.read import Source
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.description.steps.renames import make_renames

# What carries the prefix; topics and nodes are the robot's, and the name of a model is its spawner's.
PREFIXED = (
    *("link", "joint", "frame", "sensor", "light", "transmission", "actuator", "hardware", "gpio"),
    "shape",
)
# Two of one name are not read, or are taken for one.
ONCE = ("link", "joint", "transmission", "hardware", "gpio", "sensor")
ZERO = (0.0,) * 6
# Names that have no prefix: in a value that is not known, or in a plugin's code.
MISSED = ("MB901", "MB428")
# The same, and plugins and hardware classes that are not known.
TOLD = (*MISSED, "MB902", "MB903")
_PREFIX = lazy_compile(r"(?:[A-Za-z]\w*)?", re.ASCII)


class Part(NamedTuple):
    """One description of a joined robot.

    ``description`` is a path, XML text or bytes; a xacro is expanded with ``xacro_args``. ``at`` is the
    link of an earlier part that it is fixed to, by its name in the joined robot; the first part has
    none. ``pose`` is where its root is in that link: x, y, z, roll, pitch, yaw in metres and radians.
    ``prefix`` goes before its own names. ``name`` is what messages, the new joint and ``split`` call
    it; default: its prefix, or its file. ``srdf`` is its SRDF, ``controllers`` are parameter files of
    its controllers. With ``one_system`` its ros2_control is put into an earlier one of the same
    hardware. ``moveit`` are MoveIt's files for it, ``rviz`` is its RViz config.
    """

    description: Source
    at: str = ""
    pose: Sequence[float] = ZERO
    prefix: str = ""
    name: str = ""
    xacro_args: Mapping[str, str] = {}
    srdf: Source | None = None
    controllers: Sequence[str] = ()
    one_system: bool = False
    moveit: Sequence[str] = ()
    rviz: str = ""


def files_of(part: Part) -> Iterator[str]:
    """Yield the files that a part names."""
    for it in (part.description, part.srdf, *part.controllers, *part.moveit, part.rviz or None):
        if isinstance(it, str | os.PathLike) and not str(it).lstrip().startswith("<"):
            yield os.fspath(it)


class ReadPart(NamedTuple):
    """A part as it was read: ``data`` before it got its prefix, the others with the prefix."""

    name: str
    file: str
    prefix: str
    data: bytes
    text: bytes
    inventory: Inventory
    robot: links_and_joints.Robot
    findings: tuple[Finding, ...]

    @property
    def root(self) -> str:
        """The name of its root link."""
        return links_and_joints.roots(self.robot)[0].name


def prefixing(kinds: Iterable[str] = PREFIXED, topics: str | None = None) -> Naming:
    """Return the naming that puts a literal prefix before these kinds of names."""
    named = make_naming("frames-per-robot", PREFIX, topics)
    return named._replace(separators=dict.fromkeys(kinds, ""))


@contextmanager
def in_one_line() -> Iterator[None]:
    """Turn a refused rewrite in the block into an InputError with its first error."""
    try:
        yield
    except RewriteRefused as refused:
        first = next(it for it in refused.findings if it.level == ERROR)
        raise InputError(str(first)) from None


def name_of(part: Part, file: str, robot: str) -> str:
    """Return the name of a part; one that is no file has the name of its ``robot``."""
    last = re.split(r"[/\\]", file.removesuffix(" (expanded)"))[-1]
    stem = robot if file.startswith("<") else last
    for ending in (".xacro", ".urdf", ".xml"):
        stem = stem.removesuffix(ending)
    found = part.name or part.prefix.strip("_") or stem
    return re.sub(r"\W+", "_", found, flags=re.ASCII).strip("_") or "part"


def read_part(part: Part, data: bytes, file: str, tree: Tree, first: bool) -> ReadPart:
    """Return the part with its prefix; raises UsageError, InputError if it cannot be joined."""
    if not _PREFIX.fullmatch(part.prefix):
        what = "write a word of letters, digits and _, such as left_"
        raise UsageError(f"{file}: prefix {part.prefix!r} cannot start a name; {what}")
    if is_joined(data) and not (first and not part.prefix and is_joined_whole(data)):
        raise InputError(
            f"{file}: it is joined itself; give its parts here, or give it first, as it is"
        )
    inventory = collect(read_document(data, file), tree)
    for what in reasons_against_joining(inventory):
        raise InputError(f"{file}: {what}")
    text = data
    findings: tuple[Finding, ...] = ()
    with in_one_line():
        if part.prefix:
            prepared = pipeline.prepare(data, file, prefixing(), tree)
            findings = tuple(it for it in prepared.findings if it.code in TOLD)
            text = next(pipeline.render(prepared, [part.prefix], again=True))
            inventory = collect(read_document(text, file), tree)
        else:
            # Raise RewriteRefused for what no rewrite takes, such as a xacro that is not expanded.
            found = tuple(audit(inventory, make_renames(inventory, prefixing(())), tree))
            if any(it.level == ERROR for it in found):
                raise RewriteRefused(found)
    robot = links_and_joints.read_robot(inventory.document.root)
    name = name_of(part, file, inventory.document.root.get("name", ""))
    return ReadPart(name, file, part.prefix, data, text, inventory, robot, findings)


def reasons_against_joining(inventory: Inventory) -> Iterator[str]:
    """Yield why a description cannot be joined: it is no tree of links."""
    if inventory.format != "robot":
        yield f"it is <{inventory.document.root.tag}>; only URDFs can be joined"
        return
    robot = links_and_joints.read_robot(inventory.document.root)
    if not robot.links:
        yield f"it has no link; {robot_instead(inventory.document.file)}"
    for kind, every in (("link", robot.links), ("joint", robot.joints)):
        names = [it.name for it in every]
        for name in (name for at, name in enumerate(names) if name in names[:at]):
            yield f"two {kind}s are called {name!r}"
    for link, above in robot.above.items():
        if len(above) > 1:
            names = [it.name for it in above]
            yield f"link {link!r} is the child of joints {names[0]!r} and {names[1]!r}"
    for joint in robot.joints:
        if joint.parent == joint.child:
            yield f"joint {joint.name!r} joins link {joint.child!r} to itself"
        for end, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in robot.link:
                yield f"joint {joint.name!r} has the {end} {name!r}, which is no link"
    for loop in links_and_joints.loops(robot):
        yield f"joints {', '.join(repr(it.name) for it in loop)} make a loop"
    found = [it.name for it in links_and_joints.roots(robot)]
    if len(found) != 1:
        first = " and ".join(map(repr, found[:2]))
        yield f"{len(found)} of its links have no parent ({first}); a URDF has one root link"


def names_of(inventory: Inventory) -> Iterator[tuple[str, str]]:
    """Yield kind and name of what a robot has only once; sensors are those of ros2_control."""
    for claim in inventory.claims:
        site = claim.site
        if site.role != "declares" or not claim.attribute or site.kinds[0] not in ONCE:
            continue
        if site.kinds[0] != "sensor" or site.section == "element ros2_control":
            yield site.kinds[0], claim.value


def check_meeting(part: ReadPart, known: Mapping[tuple[str, str], str]) -> None:
    """Raise InputError for a name that an earlier part has; ``known`` says which."""
    for kind, name in names_of(part.inventory):
        other = known.get((kind, name))
        if other is None or (kind, name) == ("link", links_and_joints.WORLD):
            continue
        more = (
            f"another prefix than {part.prefix!r}" if part.prefix else "a prefix (--prefix hand_)"
        )
        what = {"hardware": "ros2_control"}.get(kind, kind)
        raise InputError(f"{part.file}: {what} {name!r} is in {other}, too; give it {more}")


def with_names(known: dict[tuple[str, str], str], part: ReadPart) -> None:
    """Add the names of a part to the known ones."""
    known.update(dict.fromkeys(names_of(part.inventory), part.file))
