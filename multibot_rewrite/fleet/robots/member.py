# SPDX-License-Identifier: Apache-2.0
"""A robot of a fleet, with all that its rewritten description says."""

from itertools import islice
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.base.rosnames import RemapRule, bind, resolve_bound
from multibot_rewrite.description.checks.links_and_joints import read_robot, weighs
from multibot_rewrite.description.checks.references import UNREAD
from multibot_rewrite.description.library import Rewrite
from multibot_rewrite.description.readback.meeting import SHARED_CODES
from multibot_rewrite.description.readback.nodes import RuntimeName, rules_of
from multibot_rewrite.description.readback.reading import FRAME, Reading, read
from multibot_rewrite.description.readback.xml import read_xml
from multibot_rewrite.description.rewriters.plugin_definitions import Definitions
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.sources.own_names import NameTexts
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import Document, read_document


class Member(NamedTuple):
    """A robot of a fleet, with what its rewritten description holds and starts.

    ``described`` is what robot_state_publisher gets, made from ``sent``; where the simulator
    gets another file, all else is of that. ``source`` is the description before, ``tree`` what
    is known of plugins; ``shared`` are findings about names that any two robots of it would
    have, ``unread`` about arguments that its xacro does not know; ``plain`` maps names without
    xacro arguments to those with them. ``handed_on`` are the remap rules of a plugin with a
    controller manager. ``published`` are frames of ``described`` that the simulator's file has
    not."""

    robot: str
    tag: str
    name: str
    described: Inventory
    inventory: Inventory
    reading: Reading
    source: Document
    sent: Document
    tree: Tree
    shared: tuple[Finding, ...]
    unread: tuple[Finding, ...]
    read: tuple[str, ...]
    plain: NameTexts
    handed_on: tuple[RemapRule, ...] = ()
    published: tuple[RuntimeName, ...] = ()

    @property
    def definitions(self) -> Definitions:
        """What is known of plugins; raises nothing."""
        return self.tree.definitions


def member(
    source: Rewrite, data: bytes, tag: str, real: bool = False, described: Member | None = None
) -> Member:
    """Return the robot of a rewrite; a ``real`` one takes nothing that is for a simulator.

    ``data`` is its final description, ``described`` has what it publishes if that is another
    one. Raises InputError where ROS refuses the names of a plugin."""
    document, tree = source.template.inventory.document, source.template.tree
    data = without_simulator(data, document.file) if real else data
    written = collect(read_document(data, document.file), tree)
    reading = read(data, document.file, tree.definitions)
    for node in reading.nodes:
        try:
            bound = bind(node.name, node.namespace, [it.rule for it in node.rules])
            for it in node.endpoints:
                resolve_bound(it.code_name, it.kind, bound)
        except UsageError as error:
            place = f"{document.file}:{line_of(document, 'plugin', node.number)}"
            raise InputError(f"{place}: {error}; change it in the description") from None
    shared = tuple(it for it in source.findings if it.code in SHARED_CODES)
    unread = tuple(it for it in source.findings if it.code == UNREAD)
    job = source.prepared.job
    wide = (it for it, section in source.template.inventory.served if section.process_wide)
    handed_on = () if real else tuple(rule for it in wide for rule in rules_of(it))
    words = (shared, unread, job.read.files, job.own.plain, handed_on)
    if not described:
        return Member(
            *(source.robot, tag, source.robot, written, written, reading, document, document),
            *(tree, *words),
        )
    frames = {it.name for it in reading.names if it.kind == FRAME}
    others = (it for it in described.reading.names if it.kind == FRAME and it.name not in frames)
    files = (described.described, written, reading, document, described.sent)
    return Member(source.robot, tag, source.robot, *files, tree, *words, published=tuple(others))


def with_text(it: Member, data: bytes) -> Member:
    """Return the robot with another text of what the simulator gets."""
    file = it.inventory.document.file
    written = collect(read_document(data, file), it.tree)
    described = written if it.described is it.inventory else it.described
    reading = read(data, file, it.definitions)
    return it._replace(described=described, inventory=written, reading=reading)


def without_simulator(data: bytes, file: str) -> bytes:
    """Return a description without its plugins and sensors for simulators; raises InputError."""
    root = read_xml(data, file)
    tags = ("plugin", "sensor") if root.tag == "sdf" else ("gazebo",)
    for element in list(root.iter(*tags)):
        above = element.getparent()
        if above is not None:
            above.remove(element)
    return etree.tostring(root)


def line_of(document: Document, tag: str, number: int) -> int:
    """Return the line of the ``number``-th element with this tag, 1 without one."""
    element = next(islice(document.root.iter(tag), number, None), document.root)
    line: int = element.sourceline or 1  # type: ignore[assignment]
    return line


def is_for_simulator(member: Member) -> bool:
    """Return whether a simulator may run the robot."""
    # It may not if nothing in its description is for one, and it drives hardware or has no mass:
    # Gazebo spawns nothing of that.
    root: etree._Element = member.inventory.document.root
    if root.tag == "sdf" or has_parts_for_simulator(member):
        return True
    return next(root.iter("ros2_control"), None) is None and weighs(read_robot(root))


def has_parts_for_simulator(member: Member) -> bool:
    """Return whether its description has a plugin or sensor of a simulator."""
    root: etree._Element = member.inventory.document.root
    parts = [root] if root.tag == "sdf" else root.findall("gazebo")
    return any(it.find(f".//{tag}") is not None for it in parts for tag in ("plugin", "sensor"))
