# SPDX-License-Identifier: Apache-2.0
"""What Gazebo reads below ``<gazebo>`` against the specification of SDF: one pass, every fault.

Sources: ``sdf.schema``; parser_urdf.cc of sdformat (ParseSDFExtension, InsertSDFExtensionLink and
the like): a ``<gazebo>`` with the name of a link is put into that link, one with the name of a
joint into that joint, one without a name into the model; some tags are taken out and mean something
else.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from math import radians, tau

from lxml.etree import _Element

from multibot_rewrite.base.conventions import ROWS
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING
from multibot_rewrite.base.nearest import MISTYPED, nearest, slip_of
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.description.checks.links_and_joints import Robot
from multibot_rewrite.description.checks.problem import Problem, fault
from multibot_rewrite.description.rewriters.text import text_of
from multibot_rewrite.rules.schema import versions
from multibot_rewrite.rules.schema.described import WORDS, SdfPart, SdfRow, chunks, described
from multibot_rewrite.rules.schema.sdf_values import QUATERNION, TURN, misread, number_in
from multibot_rewrite.rules.schema.sections import is_own, shortened

# What the converter takes out of the block of a joint; the others are for links, and static for
# neither.
OF_JOINTS = frozenset(ROWS["of joints"][0][0])
OF_BOTH = frozenset({"disableFixedJointLumping", "preserveFixedJoint", "dampingFactor"})
OF_MODELS = frozenset({"static", "canonicalBody"})
# Merged into the shapes that the link has already, or a name in the old style.
_MERGED = ("visual", "collision", "material")
# What gz-sensors reads of a <sensor> although SDF does not have it: gz-sensors8_8.2.2
# src/Sensor.cc:188, and ignition-sensors6 for the second.
READ_BESIDES = frozenset({"gz_frame_id", "ignition_frame_id"})
# Angles that SDF has no range for.
ANGLES = frozenset({"min_angle", "max_angle"})
# What Gazebo Classic takes besides: gazebo-classic gazebo/rendering/Camera.cc, GetOgrePixelFormat.
OGRE_FORMATS = frozenset({"FLOAT32", "FLOAT16"})
Version = tuple[int, ...]
# How bad is for Gazebo Classic what its successor refuses.
_MILD = {"range": NOTE, "value": WARNING, "word": WARNING}
# What the last release with Gazebo Classic reads.
CLASSIC = (1, 9)


def version_of_release(release: str) -> Version:
    """Return the version of SDF that Gazebo reads in a release."""
    found = versions.read_version(versions.reader_of(release, versions.SDFORMAT).reads)
    assert found
    return tuple(found)


def block_faults(blocks: Sequence[_Element], robot: Robot, release: str) -> tuple[Problem, ...]:
    """Return every fault in these ``<gazebo>`` elements."""
    version, taken = version_of_release(release), described("urdf")
    assert taken
    found = tuple(it for block in blocks for it in _block_faults(block, robot, version, taken))
    return _by_reader(found, blocks[0].getroottree().getroot(), release)


def model_faults(root: _Element, release: str) -> tuple[Problem, ...]:
    """Return every fault in the models and worlds of an ``<sdf>``."""
    version = version_of_release(release)
    tops = root.iterchildren("model", "world")
    found = tuple(it for top in tops for it in _element_faults(top, str(top.tag), version))
    return _by_reader(found, root, release)


def _by_reader(found: tuple[Problem, ...], root: _Element, release: str) -> tuple[Problem, ...]:
    """Return faults at the reader's level: libsdformat 9 has no ranges, and reads part of a vector."""
    if not any(it.code in _MILD for it in found) or not versions.may_be_classics(root, release):
        return found
    return tuple(it._replace(level=_MILD.get(it.code, it.level)) for it in found)


def _block_faults(
    block: _Element, robot: Robot, version: Version, taken: SdfPart
) -> Iterator[Problem]:
    name = block.get("reference", "")
    if name and name not in robot.link and name not in robot.joint:
        return  # MB202 reports it
    home = "model" if not name else "link" if name in robot.link else "joint"
    for child in block.iterchildren("*"):
        tag = str(child.tag)
        if tag in taken.rows:
            yield from _converter_faults(child, taken.rows[tag][0], home)
        elif tag not in _MERGED:
            known = described(home)
            assert known
            yield from _child_faults(child, home, known, version, taken.rows)


def _converter_faults(child: _Element, row: SdfRow, home: str) -> Iterator[Problem]:
    """Yield the fault of a tag that the converter itself reads."""
    at = "value" if child.get("value") else ""
    text = child.get("value") or text_of(child)
    if not text or "$" in text:
        return
    belongs = _parents_of(row.name)
    if home not in belongs:
        message = f"<{row.name}> in the <gazebo> of a {home} has no effect"
        hint = f"name a {' or '.join(belongs)} with reference=, where it is read"
        yield fault("misplaced", child, None, message, hint)
    elif wrong := misread(row.type, text):
        level = ERROR if row.type == "double" and wrong.fails else WARNING
        message = f"{row.name} {shortened(text)!r} {wrong.problem}"
        yield fault("value", child, at, message, "", level)


def _parents_of(tag: str) -> tuple[str, ...]:
    """Return the elements of SDF into which the converter puts a tag of ``<gazebo>``."""
    if tag in OF_MODELS:
        return ("model", "link", "joint")
    if tag in OF_BOTH:
        return ("link", "joint")
    return ("joint",) if tag in OF_JOINTS else ("link",)


def _child_faults(
    child: _Element, home: str, known: SdfPart, version: Version, also: Mapping[str, object]
) -> Iterator[Problem]:
    """Yield faults of a child of an element with section ``known``; ``also`` are further tags."""
    tag = str(child.tag)
    rows = known.rows.get(tag)
    if rows is None:
        if is_own(tag):
            yield from _unknown_child(child, known, home, also)
        return
    row = _of_version(rows, version)
    if row.first > version:
        message = f"<{tag}> in <{home}> is of SDF {'.'.join(map(str, row.first))}"
        hint = f"leave it out: Gazebo of this release reads up to SDF {'.'.join(map(str, version))}"
        yield fault("later", child, None, message, hint)
        return
    yield from _value_faults(child, "", row, text_of(child), known, version)
    # The converter of sdformat leaves out what an older SDF had here, such as the <frame> of a sensor.
    if row.section and (row.last or version) >= version:
        yield from _element_faults(child, row.section, version)


def _element_faults(element: _Element, section: str, version: Version) -> Iterator[Problem]:
    """Yield faults in attributes and children of an element that has a section."""
    known = described(section)
    if known is None:
        return
    for key, text in zip(map(str, element.keys()), map(str, element.values()), strict=True):
        rows = known.rows.get(f"@{key}")
        if rows is not None:
            row = _of_version(rows, version)
            yield from _value_faults(element, key, row, text, known, version)
        elif is_own(key):
            free = [it[1:] for it in known.rows if it[0] == "@" and it[1:] not in element.attrib]
            if near := nearest(key, free):
                message = f"Gazebo reads no attribute {key!r} of <{element.tag}>"
                yield fault("misspelt", element, key, message, f"did you mean {near!r}?")
    # Attributes without which sdformat refuses the model; those of plugins depend on the release.
    for name in known.needed:
        if name[0] == "@" and not element.get(name[1:], "").strip():
            row = _of_version(known.rows[name], version)
            if row.required and row.first <= version and element.tag != "plugin":
                yield fault("missing", element, None, f"<{element.tag}> has no {name[1:]!r}")
    if "*" in known.rows or not len(element):
        return
    for child in element.iterchildren("*"):
        yield from _child_faults(child, str(element.tag), known, version, {})


def _of_version(rows: tuple[SdfRow, ...], version: Version) -> SdfRow:
    """Return the row of a version, or one of an older version, or the first later one."""
    if len(rows) == 1:
        return rows[0]
    older = [it for it in rows if it.first <= version]
    return older[-1] if older else rows[0]


def _value_faults(
    element: _Element, at: str, row: SdfRow, text: str, known: SdfPart, version: Version
) -> Iterator[Problem]:
    """Yield what is wrong with a value: of the attribute ``at``, or the text."""
    text = text.strip()
    if not text or "$" in text:
        return
    if row.type == "string":
        yield from _unknown_word(element, at, f"{known.name}/{row.name}", text, version)
        return
    turned = row.type == "pose" and element.get("rotation_format") == QUATERNION
    if wrong := misread(QUATERNION if turned else row.type, text):
        level = ERROR if wrong.fails else WARNING
        yield fault(
            "value",
            element,
            at,
            f"{_place_and_value(element, at, text)} {wrong.problem}",
            "",
            level,
        )
    elif row.low is not None or row.high is not None:
        yield from _range_faults(element, at, row, text)
    elif row.type == "pose" or row.name in ANGLES:
        yield from _degree_faults(element, at, row, text)


def _place_and_value(element: _Element, at: str, text: str) -> str:
    """Return how a message names a value."""
    return f"{_element_in_words(element, at)} {shortened(text)!r}"


def _element_in_words(element: _Element, at: str) -> str:
    return f"{element.tag}@{at}" if at else f"<{element.tag}>"


def _degree_faults(element: _Element, at: str, row: SdfRow, text: str) -> Iterator[Problem]:
    """Yield a fault for an angle of more than a turn, unless it is in degrees or a quaternion."""
    if element.get("degrees", "").lower() in ("true", "1") or element.get("rotation_format"):
        return
    angles = [number_in(it) or 0.0 for it in (text.split()[3:] if row.type == "pose" else [text])]
    worst = max(angles, key=abs, default=0.0)
    if abs(worst) > TURN:
        message = f"{_place_and_value(element, at, text)} is more than a turn: it is in radians"
        yield fault("degrees", element, at, message, f"{worst:g} degrees are {radians(worst):.4g}")


def _range_faults(element: _Element, at: str, row: SdfRow, text: str) -> Iterator[Problem]:
    value = number_in(text)
    if value is None:
        return
    if row.low is not None and value < row.low:
        message = f"is below {row.low:.10g}, the least that SDF allows"
        yield fault("range", element, at, f"{_place_and_value(element, at, text)} {message}")
    elif row.high is not None and value > row.high:
        message = f"is above {row.high:.10g}, the most that SDF allows"
        # The hint for an angle that was written in degrees.
        is_angle = ("fov" in row.name or "angle" in row.name) and value > tau
        hint = f"{value:g} degrees are {radians(value):.4g} radians" if is_angle else ""
        yield fault("range", element, at, f"{_place_and_value(element, at, text)} {message}", hint)


def _unknown_word(
    element: _Element, at: str, name: str, text: str, version: Version
) -> Iterator[Problem]:
    """Yield a fault for a word that the library does not know."""
    known, row = words(name), described(f"{WORDS} {name}")
    folded = row is not None and "folded" in row.words
    if not known or text in known or (folded and text.lower() in known):
        return
    if text in OGRE_FORMATS and _is_for_classic(element):
        return
    near = nearest(text, known)
    if not near and version <= CLASSIC and name == "sensor/@type":
        return  # Gazebo Classic lets plugins add types of sensors
    hint = f"did you mean {near!r}?" if near else f"SDF knows {shorten(sorted(known))}"
    message = f"{_element_in_words(element, at)} is {shortened(text)!r}, which SDF does not know"
    yield fault("word", element, at, message, hint)


def _is_for_classic(element: _Element) -> bool:
    """Return whether the sensor of a value has a plugin of Gazebo Classic."""
    sensor = next(element.iterancestors("sensor"), None)
    plugins = sensor.iterchildren("plugin") if sensor is not None else ()
    return any("gazebo_ros_" in it.get("filename", "") for it in plugins)


@lru_cache
def words(name: str) -> tuple[str, ...]:
    """Return the words that the library knows for ``sensor/@type``; empty where it takes any."""
    found = described(f"{WORDS} {name}")
    return tuple(found.rows) if found else ()


def _unknown_child(
    child: _Element, known: SdfPart, home: str, also: Mapping[str, object]
) -> Iterator[Problem]:
    tag = str(child.tag)
    if tag in READ_BESIDES:
        return
    free = [it for it in (*known.rows, *also) if it[0] not in "@*"]
    parent, near = child.getparent(), slip_of(tag, free) or nearest(tag, free, MISTYPED)
    if parent is not None and near and parent.find(near) is not None:
        near = ""  # that one is there already
    message = f"Gazebo reads no <{tag}> in <{home}>"
    if near:
        yield fault("misspelt", child, None, message, f"did you mean <{near}>?")
    else:
        homes = [it for it in _parents_in_sdf(tag) if it != home] or _siblings_with(child, known)
        hint = f"move it into <{'> or <'.join(homes)}>" if homes else ""
        yield fault("misplaced" if homes else "not-read", child, None, message, hint)


def _siblings_with(child: _Element, known: SdfPart) -> tuple[str, ...]:
    """Return the sibling elements that have such a child."""
    parent, found = child.getparent(), []
    for it in parent.iterchildren("*") if parent is not None else ():
        inner = [described(row.section) for row in known.rows.get(str(it.tag), ()) if row.section]
        if any(one is not None and child.tag in one.rows for one in inner):
            found.append(str(it.tag))
    return tuple(found)


@lru_cache
def _parents_in_sdf(tag: str) -> tuple[str, ...]:
    """Return the elements of SDF that have such a child, if there are few."""
    found = {
        part.partition("]")[0].rpartition(".")[2].partition("_shape")[0]
        for part in chunks().values()
        if f"\n{tag} " in part and not part.startswith((WORDS, "urdf"))
    }
    return tuple(sorted(found)) if 0 < len(found) <= 3 else ()
