# SPDX-License-Identifier: Apache-2.0
"""The proof that runs on every rewrite: it reads the output bytes again and compares.

It trusts how the source was read and what the naming says. It does not trust the plan, nor what was
made of it.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterator
from functools import partial
from operator import attrgetter
from typing import NamedTuple

from lxml import etree

from multibot_rewrite.base.lazy import gc_paused
from multibot_rewrite.base.model import Claim, Edit, InputError, ProofError
from multibot_rewrite.base.naming import FRAME_KINDS, Naming, affix, removal, spelled
from multibot_rewrite.description.rewriters.contact import respell_collisions
from multibot_rewrite.description.rewriters.forms import Declared
from multibot_rewrite.description.rewriters.insert import insertions, query, without
from multibot_rewrite.description.rewriters.renaming import (
    ROBOT_SLOT,
    ResolvedName,
    is_reached,
    renamed_names,
)
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.description.rewriters.tree import Tree
from multibot_rewrite.description.steps import strip
from multibot_rewrite.description.steps.apply import cut
from multibot_rewrite.description.steps.collect import Inventory, collect
from multibot_rewrite.description.steps.document import read_document
from multibot_rewrite.description.steps.inserted import MARKER, Marker, markers, removals
from multibot_rewrite.description.steps.plan import Plan

Names = tuple[ResolvedName, ...]
_KIND, _STEM = attrgetter("kind"), "stem"


class Evidence(NamedTuple):
    """What the checks compare: the source as it was read, the plan, and the output read again.

    ``slots`` says how often a robot's name is put in; ``expected`` is what each claimed value is to
    become, with ``ROBOT_SLOT`` where that name goes. ``inserted`` are the spans of the output that
    the robot's ``markers`` say were inserted; ``added`` are the claims in them with their names,
    ``found`` all others.
    """

    inventory: Inventory
    plan: Plan
    slots: int
    robot: str
    naming: Naming
    expected: list[str]
    result: Inventory
    markers: list[Marker]
    inserted: list[Edit]
    found: list[tuple[Claim, Names]]
    added: list[tuple[Claim, Names]]

    @property
    def file(self) -> str:
        """The name of the source in messages."""
        return self.inventory.document.file


@gc_paused()
def verify(
    inventory: Inventory,
    plan: Plan,
    slots: int,
    output: bytes,
    robot: str,
    naming: Naming,
    tree: Tree,
    urdf_declarations: Declared,
) -> None:
    """Raise ProofError unless ``output`` is the input with its names renamed and nothing else changed.

    ``slots`` says how often the robot's name was put in; ``urdf_declarations`` is what the URDF of
    an SRDF declares."""
    file = inventory.document.file
    beside = renamed_names(urdf_declarations, naming, robot)
    # Byte offsets of elements are needed only if more than affixes has to be removed.
    asks_places = (
        MARKER in output or bool(naming.own) or any(edit.start < edit.end for edit in plan.edits)
    )
    try:
        read = read_document(output, f"{file} for {robot}", asks_places)
        result = collect(read, tree, beside, naming.read_as)
        mine = [marker for marker in markers(result.document) if marker.robot == robot]
        inserted = removals(result.document, robot)
    except InputError as error:
        raise ProofError(f"the output does not parse: {error}") from None
    is_inserted = strip.inside_of(inserted)
    if naming.own:
        result = result._replace(names=_names_as_in_source(inventory, result, is_inserted, naming))
    pairs = list(zip(result.claims, result.names, strict=True))
    added = [pair for pair in pairs if is_inserted(pair[0])] if inserted else []
    found = [pair for pair in pairs if not is_inserted(pair[0])] if inserted else pairs
    expected = list(_expected(inventory, naming))
    it = Evidence(
        inventory, plan, slots, robot, naming, expected, result, mine, inserted, found, added
    )
    for check in CHECKS:
        check(it)


def _names_as_in_source(
    inventory: Inventory, result: Inventory, is_inserted: Callable[[Claim], bool], naming: Naming
) -> list[Names]:
    """Return the names of the output, resolved as in the source."""
    # If argument and rewrite gave it the same word, it is one name of its site.
    before = iter(inventory.names)
    found: list[Names] = []
    for claim, names in zip(result.claims, result.names, strict=True):
        old = () if is_inserted(claim) else next(before, ())
        alone = names[0] if len(names) == 1 and names != old else None
        below = alone and alone.kind == _STEM and (_STEM, alone.text) in naming.own
        kinds = claim.site.kinds
        found.append((ResolvedName(0, claim.value, kinds[0], kinds),) if below else names)
    return found


def same_names(it: Evidence) -> None:
    """Raise ProofError unless each site has the value that the naming gives it."""
    claims, file = it.inventory.claims, it.inventory.document.file
    if len(it.found) != len(claims):
        raise ProofError(f"{file}: {len(claims)} names went in, {len(it.found)} came out")
    for claim, (new, _), slotted in zip(claims, it.found, it.expected, strict=True):
        value = slotted.replace(ROBOT_SLOT, it.robot)
        if new.site is not claim.site or new.value != value:
            raise ProofError(f"{file}: {claim.value!r} became {new.value!r}, expected {value!r}")


def _expected(inventory: Inventory, naming: Naming) -> Iterator[str]:
    """Yield the expected text of each claimed value; claims with the same names share one."""
    collisions = _collisions(inventory, naming)
    known: dict[tuple[int, bool], str] = {}
    for claim, names in zip(inventory.claims, inventory.names, strict=True):
        if not names or not is_reached(claim, naming):
            yield collisions.get((claim.start, claim.attribute), claim.value)
            continue
        key = id(names), claim.site.namespaced
        if key not in known:
            known[key] = _renamed_value(claim, names, naming)
        yield known[key]


def _renamed_value(claim: Claim, names: Names, naming: Naming) -> str:
    value, namespaced = claim.value, claim.site.namespaced
    if names[0].text == value:
        return spelled(naming, ROBOT_SLOT, names[0].kind, value, namespaced)
    for name in reversed(names):
        new = spelled(naming, ROBOT_SLOT, name.kind, name.text, namespaced)
        # Names may be inside one another; of these at most one changes.
        if new != name.text:
            value = value[: name.at] + new + value[name.at + len(name.text) :]
    return value


def _collisions(inventory: Inventory, naming: Naming) -> dict[tuple[int, str], str]:
    """Return the contact collisions that change, by the place of their elements."""
    document, claims, _, declared, *_ = inventory
    respell = partial(spelled, naming, ROBOT_SLOT)
    found = respell_collisions(document.root, claims, declared, respell)
    return {(claim.start, claim.attribute): new for claim, new in found}


def same_targets(it: Evidence) -> None:
    """Check that every name means what it meant: a use finds what it named, and nothing else does."""
    file, own = it.inventory.document.file, it.naming.own
    # Claims share the names of equal values, so few are different.
    seen: set[tuple[int, int]] = set()
    for names, (new, now) in zip(it.inventory.names, it.found, strict=True):
        pair = id(names), id(now)
        if pair in seen:
            continue
        seen.add(pair)
        kept = {at for at, name in enumerate(names) if (name.kind, name.text) in own} if own else ()
        kinds = _kinds(now, kept)
        # Of what refers to nothing now, a declared name is one that did before.
        unused = (name for name in now if not name.kind) if "" in kinds else ()
        declared = it.inventory.declared
        lost = any(one.text in declared.get(kind, ()) for one in unused for kind in one.kinds)
        if lost or kinds != _kinds(names, kept):
            raise ProofError(f"{file}: {new.value!r} does not name what it named before")


def _kinds(names: Names, kept: Collection[int]) -> list[str]:
    """Return the kinds of names; a frame from a xacro argument may become that of a link."""
    if not kept:
        return [*map(_KIND, names)]
    return [
        "frame" if at in kept and name.kind in FRAME_KINDS else name.kind
        for at, name in enumerate(names)
    ]


def robots_own(it: Evidence) -> None:
    """Check that names in inserted elements which other robots also have contain this robot's name."""
    for name, reach in _inserted_names(it):
        # What must be declared and is not is of no kind: it is another robot's, or nobody's.
        if not name.kind or removal(it.naming, it.robot, name.kind, name.text, reach) is None:
            raise ProofError(
                f"{it.file}: {name.text!r} was inserted, which is not {it.robot}'s own"
            )


def _inserted_names(it: Evidence) -> Iterator[tuple[ResolvedName, bool]]:
    """Yield (name, whether a namespace reaches it) of names in inserted elements that change."""
    for claim, names in it.added:
        if _is_own_namespace(claim, it):
            continue
        reach = claim.site.namespaced
        for name in names:
            if not name.kind or affix(it.naming, name.kind, name.text, reach) is not None:
                yield name, reach


def nothing_to_add(it: Evidence) -> None:
    """Check that no plugin is left with a default or fixed topic that another robot would share."""
    for item in insertions(it.result.served, it.result.declared, it.naming):
        raise ProofError(
            f"{it.file}: {without(item, it.inventory.release)} {item.old!r}: nothing was inserted"
        )


def added_once(it: Evidence) -> None:
    """Check that no inserted element exists already: readers take the first, or both."""
    for marker in it.markers:
        behind = list(marker.comment.itersiblings("*"))
        added = behind[: marker.elements]
        _check_single(it, added, [*behind, *marker.comment.itersiblings("*", preceding=True)])
        for element in added:
            _check_single(it, list(element), list(element))


def _check_single(it: Evidence, added: list[etree._Element], beside: list[etree._Element]) -> None:
    there = Counter(map(_key, beside))
    for element in added:
        if there[_key(element)] > 1:
            raise ProofError(f"{it.file}: <{element.tag}> was inserted and is there already")


def _key(element: etree._Element) -> tuple[str, str | None, str]:
    """Return what an element is about: the name of its rule, or else tag and name."""
    rule, is_rule, _ = (element.text or "").strip().partition(":=")
    return str(element.tag), element.get("name"), rule if is_rule else ""


def as_decided(it: Evidence) -> None:
    """Raise ProofError unless the text has the insertions that the plan decided on."""
    output, robot, every = it.result.document.source, it.robot, it.plan.insertions
    inserted = b"".join(output[edit.start : edit.end] for edit in it.inserted)
    for item in every:
        if not item.step and item.xml.replace(ROBOT_SLOT, robot).encode() not in inserted:
            raise ProofError(f"{it.file}: {item.old!r} was to be replaced by {item.xml}")
    wanted = sorted(item.new.replace(ROBOT_SLOT, robot) for item in every if item.step)
    # What the markers say was empty.
    above = ((marker.comment.getparent(), marker.filled) for marker in it.markers)
    asked = ((parent, step) for parent, steps in above for step in steps if parent is not None)
    filled = (parent.find(query(step)) for parent, step in asked)
    if sorted(text_of(element) for element in filled if element is not None) != wanted:
        raise ProofError(f"{it.file}: empty elements were to be filled with {', '.join(wanted)}")


def as_planned(it: Evidence) -> None:
    """Raise ProofError unless the text is the source with the planned edits."""
    source, file, *_ = it.inventory.document
    robot, last = it.robot.encode(), 0
    pieces = []
    for start, end, before, after in it.plan.edits:
        pieces += [source[last:start], before, b"" if after is None else robot + after]
        last = end
    if b"".join((*pieces, source[last:])) != it.result.document.source:
        raise ProofError(f"{file}: the text is not the source with the planned edits")


def a_slot_each(it: Evidence) -> None:
    """Check that each name of this robot is in a slot, so that another robot gets its own there."""
    values = "".join(it.expected).count(ROBOT_SLOT)
    wanted = values + len(list(_inserted_names(it))) + len(it.markers)
    wanted += sum(_is_own_namespace(claim, it) for claim, _ in it.added)
    if it.slots != wanted:
        raise ProofError(f"{it.file}: {it.robot} is named {wanted} times, in {it.slots} slots")


def _is_own_namespace(claim: Claim, it: Evidence) -> bool:
    """Return whether a claim is the namespace that a plugin needs in a layout without namespaces."""
    return "namespace" not in it.naming.separators and claim.value == f"/{it.robot}"


def strips_to_source(it: Evidence) -> None:
    """Check that undoing the rewrite, by the output alone, gives the input back."""
    own = strip.own_places(it.inventory, it.naming)
    fills = any(marker.filled for marker in it.markers)
    replaces = any(edit.start < edit.end for edit in it.plan.edits)
    if not (_undoes(it, own) if own or fills or replaces else _adds_affixes(it)):
        raise ProofError(
            f"{it.file}: stripping {it.robot} from the output does not give the input back"
        )


def _undoes(it: Evidence, own: frozenset[strip.Place]) -> bool:
    """Return whether undoing the rewrite gives the source."""
    edits = strip.strip_edits(it.result, it.naming, it.robot, own)
    return b"".join(cut(it.result.document.source, edits)) == it.inventory.document.source


def _adds_affixes(it: Evidence) -> bool:
    """Return whether a text has only affixes and inserted elements more than its source."""
    # That equals undoing it: nothing is gone, and a byte added elsewhere would be one too many.
    more = len(it.result.document.source) - len(it.inventory.document.source)
    more -= sum(edit.end - edit.start for edit in it.inserted)
    known: dict[tuple[int, bool], str] = {}
    for old, (claim, names) in zip(it.inventory.claims, it.found, strict=True):
        key = id(names), claim.site.namespaced
        if names and key not in known:
            known[key] = strip.stripped(claim, names, it.naming, it.robot)
        if old.value != (known[key] if names else claim.value):
            return False
        more -= len(claim.value) - len(old.value)
    return more == 0


# In this order: the first ones say best what is wrong.
CHECKS = (
    *(same_names, same_targets, robots_own, nothing_to_add, added_once, a_slot_each),
    *(strips_to_source, as_decided, as_planned),
)
