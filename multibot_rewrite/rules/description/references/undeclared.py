# SPDX-License-Identifier: Apache-2.0
"""Names that are used and not declared, parts among them, and frames with two parents."""

from collections.abc import Iterator, Mapping
from functools import partial
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.conventions import SENT_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, rule
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import Claim
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.nearest import HINTED, Guesses, meant_name
from multibot_rewrite.description.checks.audit import uses_xacro
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.references import (
    JOINT,
    Loose,
    doubtful,
    loose_ends,
    undeclared_names,
    where,
)
from multibot_rewrite.description.rewriters.contact import collisions
from multibot_rewrite.description.rewriters.own_defaults import frame_sites
from multibot_rewrite.description.rewriters.renaming import must_be_declared, names_in
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.steps.collect import Inventory
from multibot_rewrite.rules.facts.memo import lacking, level_of_absence, memoized, since_jazzy
from multibot_rewrite.rules.facts.simulators import simulated
from multibot_rewrite.rules.subject import Subject, name_of

# Its joints are those of the simulated PROTO, not of the URDF.
WEBOTS = "webots_ros2_control::"


class References(NamedTuple):
    """The uses that are not simply a declared link or joint, and by rule the undeclared names."""

    doubtful: list[Claim]
    loose: Mapping[str, list[Problem]]


@memoized
def references(subject: Subject) -> References:
    """Return the undeclared references of a document, for all rules; none of a xacro source."""
    inventory = subject.inventory
    claims = doubtful(inventory)
    if uses_xacro(inventory.document):
        return References(claims, lists_by_key(()))
    ends = loose_ends(claims, inventory.declared, subject.settings.naming.shared_frames)
    loose = [it for it in ends if not _is_declared_elsewhere(it, inventory)]
    found = undeclared_names(loose, inventory.declared)
    return References(claims, lists_by_key((it.code, it) for it in found))


def _is_declared_elsewhere(loose: Loose, inventory: Inventory) -> bool:
    """Return whether a name is declared in another file, in the robot's scope, or in a PROTO."""
    claim, part = loose
    root = inventory.document.root
    is_part = not inventory.declared["link"] or (root.tag == "robot" and "name" not in root.attrib)
    if is_part and part.kinds[0] != "group":
        return True
    scope, _, name = part.text.rpartition("::")
    if scope and scope == root.get("name"):
        return any(name in inventory.declared.get(kind, ()) for kind in part.kinds)
    above = claim.element.iterancestors("include", "model") if root.tag == "sdf" else ()
    # In an <include>, or in a model that another one is merged into.
    if any(it.tag == "include" or it.find("include[@merge]") is not None for it in above):
        return True
    if claim.site.section != "element ros2_control":
        return False
    system = next(claim.element.iterancestors("ros2_control"), None)
    return system is not None and text_at(system, "hardware/plugin").startswith(WEBOTS)


def undeclared(code: str, subject: Subject) -> Iterator[Problem]:
    """Yield the undeclared names of one rule; ``checks.references`` gives each place its code."""
    for it in lacking(subject, references(subject).loose.get(code, ())):
        inside = {one.tag for one in it.element.iterancestors("ros2_control", "plugin")}
        level = it.level
        if "ros2_control" in inside:
            level = level or since_jazzy(subject)
        elif inside and code == JOINT and subject.settings.simulated:
            # Its plugins run: for certain, if it is an error that they find no joint.
            level = ERROR if level_of_absence(subject) == ERROR else level
        yield it._replace(level=level)


undeclared_link = rule("MB202", "undeclared-link", ERROR)(partial(undeclared, "MB202"))

undeclared_joint = rule("MB211", "undeclared-joint", ERROR)(partial(undeclared, "MB211"))

undeclared_sdf_name = rule("MB219", "undeclared-sdf-name", WARNING)(partial(undeclared, "MB219"))


@rule("MB221", "padded-reference", ERROR)
def padded_reference(subject: Subject) -> Iterator[Problem]:
    """Report attributes that are the name of a link or joint."""
    declared = subject.inventory.declared
    for claim in references(subject).doubtful:
        name = claim.value.strip()
        if not claim.attribute or name == claim.value or claim.site.form != "whole":
            continue
        found = [declared[kind][name] for kind in claim.site.kinds if name in declared[kind]]
        if found and all(it.value != claim.value for it in found):
            message = f"{where(claim)} is {claim.value!r}, the {claim.site.kinds[0]} is {name!r}"
            yield Problem(claim.element, message, claim.attribute, "delete the white space")


AS_WRITTEN = make_naming("tf-per-robot")


@rule("MB230", "frame-of-joint-and-plugin", WARNING)
def frame_with_two_parents(subject: Subject) -> Iterator[Problem]:
    """Report plugins that send odometry to a link below the root."""
    for plugin, parent, child in _odometry_sent(subject):
        sends = f"sends {parent} -> {child}"
        if parent == child:
            hint = "name the odometry frame and the robot's root link"
            yield Problem(plugin, f"{sends}, a frame to itself", None, hint)
        for joint in subject.robot.above.get(child, ())[:1]:
            message = f"{sends}, and so does joint {joint.name!r} from {joint.parent}"
            hint = f"name the robot's root link, or switch one of them off; joint {joint.name}"
            line = "" if subject.origins else f": line {joint.element.sourceline}"
            yield Problem(plugin, message, None, hint + line)


def _odometry_sent(subject: Subject) -> Iterator[tuple[_Element, str, str]]:
    """Yield each plugin with the transform of odometry that it sends."""
    root, served = subject.document.root, subject.inventory.served
    for host, section in served:
        # gz-sim's send theirs by a bridge.
        frames = [text_at(host, it.path) for it in frame_sites(host, section, AS_WRITTEN)]
        if len(frames) == 2 and all(frames):
            yield host, frames[0], frames[1]
    if any("/tf" in section.publishes for _, section in served):
        # Most descriptions need none of it.
        from multibot_rewrite.description.readback.reading import transforms_sent

        yield from transforms_sent(root, subject.tree.definitions)


@rule("MB217", "frame-not-a-link", WARNING)
def frame_not_a_link(subject: Subject) -> Iterator[Problem]:
    """Report frames that the robot lacks; misspelt ones only: others may be a localization's."""
    declared = subject.inventory.declared
    links = declared["link"]
    meant: dict[str, str] = {}
    for claim in references(subject).doubtful if links else ():
        site = claim.site
        if "frame" not in site.kinds or must_be_declared(site) or site.form != "whole":
            continue
        for name in (part.text for part in names_in(claim, declared)):
            # A frame_prefix or namespace may come before the link's name at run time.
            own = name.rpartition("/")[2]
            known = (it in declared[kind] for it in (own, name) for kind in ("link", *site.kinds))
            if own in SENT_FRAMES or f"/{own}" in links or any(known):
                continue
            if name not in meant:
                meant[name] = meant_name(own, links) if len(meant) < HINTED else ""
            message = f"{where(claim)} names the frame {name!r}, which is not a link"
            place = (claim.element, message, claim.attribute)
            if meant[name]:
                yield Problem(*place, f"did you mean {meant[name]!r}?")
            elif not claim.site.default and not name.endswith(SENT_FRAMES):
                yield Problem(*place, "another node must publish it", level=NOTE)


# The forms of values that are one name, and how many names a hint lists.
_ONE_NAME, _LISTED = frozenset(("whole", "own", "member", "collision")), 3


@rule("MB246", "undeclared-part", WARNING)
def undeclared_part(subject: Subject) -> Iterator[Problem]:
    """Report collisions and sensors that sensors, plugins and <ros2_control> name and nothing has."""
    is_part = not subject.robot.links and subject.document.root.tag == "robot"
    # An included model has names of its own.
    if not is_part and not uses_xacro(subject.document) and not subject.elements.every("include"):
        for found in (_of_contact_sensors, _of_plugins, _of_simulated_hardware):
            yield from lacking(subject, found(subject))


@memoized
def _collisions(subject: Subject) -> Mapping[str, Mapping[str, str]]:
    """Return by each link in the simulation its collisions' names, with the links that they are of."""
    if subject.document.root.tag == "robot":
        made = collisions(subject.document.root).items()
        return {left: {name: link for (link, _), name in it.items()} for left, it in made}
    found: dict[str, dict[str, str]] = {}
    for it in subject.elements.every("link"):
        names = {name_of(one): name_of(it) for one in it.iterchildren("collision")}
        found.setdefault(name_of(it), {}).update(names)
    return found


@memoized
def _simulated_sensors(subject: Subject) -> frozenset[str]:
    every = ((it, it.getparent()) for it in subject.elements.every("sensor"))
    own = (it for it, above in every if above is None or above.tag != "ros2_control")
    return frozenset(map(name_of, own))


def _of_contact_sensors(subject: Subject) -> Iterator[Problem]:
    hinted = iter(range(HINTED))
    by = "reference" if subject.document.root.tag == "robot" else "name"
    for sensor in (it for it in subject.elements.every("sensor") if it.get("type") == "contact"):
        above = sensor.getparent()
        link = "" if above is None else above.get(by, "")
        own = _collisions(subject).get(subject.robot.body.get(link, link))
        # Without a <collision> its name is the default, which nothing has.
        asked = {text_of(it): it for it in sensor.iterfind("contact/collision")} or {"": sensor}
        for name in asked if own is not None else ():
            if name not in (own or ()):
                what = f"the collision {name!r}, which its link lacks" if name else "no collision"
                message = f"contact sensor {name_of(sensor)!r} names {what}"
                hint = (
                    _collisions_of(link, own or {}, name) if next(hinted, None) is not None else ""
                )
                yield Problem(asked[name], message, "" if name else None, hint)


def _collisions_of(link: str, own: Mapping[str, str], value: str) -> str:
    """Return the hint with the collisions of the link that a value begins with, or of the sensor's."""
    name = value.rpartition("::")[2]
    begun = {it for it in own.values() if name.startswith(it)}
    meant = max(begun, key=len, default=link) if name else link
    names = [name] if name in own else [it for it, owner in own.items() if owner == meant] or [*own]
    written = " or ".join(map(repr, names[:_LISTED]))
    return f"write {written}" if names else "give its link a <collision>"


def _of_plugins(subject: Subject) -> Iterator[Problem]:
    guesses = Guesses()
    for claim in references(subject).doubtful:
        site, value = claim.site, claim.value.strip()
        if site.kinds not in (("sensor",), ("collision",)) or site.form not in _ONE_NAME:
            continue
        known: frozenset[str] = _simulated_sensors(subject)
        if site.kinds == ("collision",):
            known = frozenset().union(*_collisions(subject).values())
        name = value.replace("::", "/").rpartition("/")[2]
        if site.section.startswith("plugin") and name and not {value, name} & known:
            message = f"{where(claim)} names the {site.kinds[0]} {name!r}, which is not declared"
            yield Problem(claim.element, message, claim.attribute, guesses.hint(name, known))


def _of_simulated_hardware(subject: Subject) -> Iterator[Problem]:
    guesses = Guesses()
    for system, plugin, _ in simulated(subject):
        for it in system.iterchildren("sensor"):
            if (name := name_of(it)) not in _simulated_sensors(subject):
                message = f"{text_of(plugin)} has no sensor {name!r}: nothing is exported for it"
                hint = guesses.hint(name, _simulated_sensors(subject))
                # It may be one that the real robot alone has.
                advice = hint or "name it like Gazebo's sensor, or leave it out of the simulation"
                yield Problem(it, message, "name", advice, level="" if hint else NOTE)
