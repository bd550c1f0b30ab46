# SPDX-License-Identifier: Apache-2.0
"""What a related file is rewritten with, and a text with slots for each robot's names."""

import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import Naming
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.model_namespaces import NO_WORDS, Stems
from multibot_rewrite.knowledge.records import NodeFacts
from multibot_rewrite.planning.of_runs import placed
from multibot_rewrite.related_files.names.rename_map import NO_OWN, RelatedNames
from multibot_rewrite.related_files.yaml_text import Splice

# Stand for the robot's namespace, and for the tag (prefix or postfix) in its frames and joints:
# ordinary letters, so that quoting and checks of names treat them as they will treat the names.
NAMESPACE_SLOT, TAG_SLOT = "multibotNamespaceSlot", "multibotTagSlot"
# Before the number that the first robot has, and what each further one has more.
_NUMBER, NUMBER_STEP = "multibotNumber", 10
_SLOT = re.compile(rf"({NAMESPACE_SLOT}|{TAG_SLOT}|{_NUMBER}\d+Slot)")


class FileTemplate(NamedTuple):
    """Pieces of text, every second one a slot."""

    pieces: tuple[str, ...]


def number_slot(first: int) -> str:
    """Return the slot for a number of the robot, which is ``first`` for the first robot."""
    return f"{_NUMBER}{first}Slot"


def check_no_slots(text: str, file: str) -> None:
    """Raise InputError for a file that contains the text of a slot."""
    found = _SLOT.search(text)
    if found:
        raise InputError(f"{file}: the word {found[0]} is reserved for this tool; use another word")


def make_template(text: str, splices: Iterable[Splice]) -> FileTemplate:
    """Return the text with the splices applied; their new text may hold slots. They do not overlap."""
    held: list[str] = [""]
    at = 0
    for start, end, new in sorted(set(splices)):
        assert start >= at, "two splices overlap"
        first, *rest = _SLOT.split(new)
        held[-1] += text[at:start] + first
        held += rest
        at = end
    held[-1] += text[at:]
    return FileTemplate(tuple(held))


def fill_template(template: FileTemplate, namespace: str, tag: str, number: int = 0) -> str:
    """Return the text for a robot, the ``number``-th one after the first that has the file."""
    pieces = list(template.pieces)
    pieces[1::2] = [_filled_slot(slot, namespace, tag, number) for slot in pieces[1::2]]
    return "".join(pieces)


def _filled_slot(slot: str, namespace: str, tag: str, number: int) -> str:
    if slot in (NAMESPACE_SLOT, TAG_SLOT):
        return namespace if slot == NAMESPACE_SLOT else tag
    return str(int(slot[len(_NUMBER) : -len("Slot")]) + number * NUMBER_STEP)


Frames = Mapping[tuple[str, str], str]
NO_FRAMES: Frames = {}


class Context(NamedTuple):
    """The rename maps, nodes and release with which a related file is rewritten.

    ``names`` is the map of links, joints and frames, ``topics`` that of ROS names, both with a
    slot for the robot. ``nodes`` maps a node's name in the node set to its full name; nodes that
    serve all robots keep theirs. ``frames`` replace defaults: by the node's last name and the
    parameter. ``of_world`` are models of the simulator's world and gz topics that it names."""

    names: RelatedNames
    topics: RelatedNames
    nodes: Mapping[str, str]
    distro: str
    frames: Frames = NO_FRAMES
    of_world: frozenset[str] = frozenset()


def make_context(
    declared: Declared,
    naming: Naming,
    facts: Iterable[NodeFacts],
    distro: str,
    own: Mapping[tuple[str, str], str] = NO_OWN,
    words: Stems = NO_WORDS,
    given: frozenset[str] = frozenset(),
) -> Context:
    """Return the context of a description (not rewritten) and its robots' nodes."""
    # ``own``, ``words`` and ``given`` are those of ``RelatedNames``.
    nodes = {
        it.name: f"/{it.name}" if it.shared else full_name(it.name, naming, it.apart)
        for it in facts
    }
    names = RelatedNames(declared, naming, TAG_SLOT, own, words, given)
    return Context(names, names._replace(robot=NAMESPACE_SLOT), nodes, distro)


def full_name(node: str, naming: Naming, apart: bool = False) -> str:
    """Return the full name of a robot's node, with a slot for the robot; ``apart``: ``NodeFacts``."""
    namespace, name = placed(NAMESPACE_SLOT, node, naming, apart)
    return f"{namespace.rstrip('/')}/{name}"
