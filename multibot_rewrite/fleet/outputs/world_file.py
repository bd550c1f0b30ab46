# SPDX-License-Identifier: Apache-2.0
"""``world.sdf``: the user's world without its robot, or an empty one that runs sensors.

What names that robot names those of the fleet, which the launch file spawns. Gazebo's own
empty.sdf has physics, user commands, the scene and contacts; a lidar, a camera or an IMU sends
nothing in it. Source: gz-sim gz-sim8 examples/worlds/empty.sdf, sensors_demo.sdf, and the names
in src/systems (ign-gazebo6 of Humble calls the libraries ignition-gazebo-...). A block of a
plugin that names it (``<wind_obj>`` of VRX, ``<performer>`` of gz-sim) is there for each robot;
a parameter of the plugin itself can name one robot only, and names the first. Sources: gz-sim
examples/worlds/levels.sdf; osrf/vrx vrx_gz/src/USVWind.cc, ScoringPlugin.cc."""

import os
import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from lxml.etree import _Element

from multibot_rewrite.base.bounded import own_text
from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding, declare
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import Edit, InputError
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.description.rewriters.text import text_at, text_of
from multibot_rewrite.description.rewriters.tree import library_key
from multibot_rewrite.description.sources.included_models import model_file
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.world_systems import needed_systems
from multibot_rewrite.description.steps.apply import Spans, cut
from multibot_rewrite.description.steps.document import Document, read_document, tag_end, text_slot
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import FilesAndFindings, OutputFile
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot
from multibot_rewrite.fleet.robots.simulators import is_simulated, systems_of
from multibot_rewrite.knowledge.worlds import DEFAULTS, SENT_BY, SENT_BY_ANY, SYSTEMS
from multibot_rewrite.related_files.names.rename_map import is_declared, spell

_SCOPE = "::"
_BELOW_MODEL = r"((?:^|/)model/){}(?=/|$)"
WORLD_ROBOT = declare("MF846", "robot-of-the-world", NOTE, formats=("fleet",))


class _Kind(NamedTuple):
    """Robots of one description, what that is called in the world, and its files."""

    robots: Sequence[RewrittenRobot]
    names: frozenset[str]
    files: frozenset[str]


class _Text(NamedTuple):
    """The world as it is read, where its elements are, and the places of the fleet file."""

    document: Document
    spans: Spans
    file: str
    line: int


def own_world(
    path: str, robots: Sequence[RewrittenRobot], systems: str, file: str, line: int
) -> tuple[bytes, list[Finding]]:
    """Return the world with these robots and ``systems``, and findings; raises InputError."""
    document = read_document(read_file(path), path)
    world = document.root.find("world")
    if world is None:
        raise InputError(f"{path}:1: there is no <world> in it; simulator_world takes an SDF world")
    it = _Text(document, Spans(document), file, line)
    at = tag_end(document.source, it.spans.start_of(world))
    edits = [Edit(at, at, b"\n" + systems.rstrip("\n").encode(), None)] if systems else []
    edits += _own_paths(it)
    findings: list[Finding] = []
    for kind in _robots_by_description(robots):
        gone = [one for one in world.iterchildren("include", "model") if _is_robot(one, kind, path)]
        names = kind.names | {name for one in gone if (name := _model_name(one))}
        for one in gone:
            edits.append(Edit(*it.spans.of(one), b"", None))
            findings.append(
                _world_finding(it, one, f"the world's {_model_name(one)!r} is left out", NOTE)
            )
        inside = {below for one in gone for below in one.iter()}
        for plugin in world.iter("plugin"):
            if plugin not in inside:
                for edit in _plugin_edits(it, plugin, kind._replace(names=names)):
                    (edits if isinstance(edit, Edit) else findings).append(edit)  # type: ignore[arg-type]
    # In order, without those inside of another one.
    apart: list[Edit] = []
    for edit in sorted(edits, key=lambda one: (one.start, -one.end)):
        if not apart or edit.start >= apart[-1].end:
            apart.append(edit)
    return b"".join(cut(document.source, apart)), findings


def world_topics(path: str) -> dict[str, str]:
    """Return the gz topics of a user's world, or of Gazebo's empty one, with types; empty: unknown."""
    root = read_document(read_file(path), path).root if path else None
    world = root.find("world") if root is not None else None
    if root is None or world is None:
        return _world_topics("empty", DEFAULTS)
    plugins = [library_key(it.get("filename") or "") for it in world.iterchildren("plugin")]
    systems = [it.removeprefix("gz-sim-").removesuffix("-system") for it in plugins]
    told = {f"/{it}": "" for it in _topics_in(world)}
    return told | _world_topics(world.get("name", ""), systems or DEFAULTS)


def _topics_in(element: _Element) -> set[str]:
    texts = (text_of(it) for it in element.iter("*") if str(it.tag).endswith("topic"))
    named = {*texts, *(it.get("topic", "") for it in element.iter("*"))}
    return {it.lstrip("/") for it in named} - {""}


def names_of_world(path: str, robots: Sequence[RewrittenRobot]) -> frozenset[str]:
    """Return the models in a user's world that are no robots, and the gz topics that it names."""
    root = read_document(read_file(path), path).root if path else None
    world = root.find("world") if root is not None else None
    kinds = [*_robots_by_description(robots)]
    found: set[str] = set()
    for one in world.iterchildren("*") if world is not None else ():
        if any(_is_robot(one, kind, path) for kind in kinds):
            continue
        found |= _topics_in(one)
        if one.tag in ("include", "model"):
            found.add(_model_name(one))
    return frozenset(found)


def _is_robot(one: _Element, kind: _Kind, path: str) -> bool:
    """Return whether a model in the world at ``path`` is a robot of this kind, by name or file."""
    uri = text_at(one, "uri")
    found = model_file(uri, os.path.dirname(os.path.abspath(path))) if uri else ""
    is_of_file = bool(found) and os.path.realpath(found) in kind.files
    return is_of_file or _model_name(one) in kind.names


def _world_topics(world: str, systems: Sequence[str]) -> dict[str, str]:
    own = (SENT_BY_ANY, *(SENT_BY.get(it, {}) for it in systems))
    return {
        f"/world/{world}/{name}": f"gz.msgs.{type_}" for it in own for name, type_ in it.items()
    }


def _robots_by_description(robots: Sequence[RewrittenRobot]) -> Iterator[_Kind]:
    found = lists_by_key((it.spec.simulated or it.spec.description, it) for it in robots)
    for alike in found.values():
        root = alike[0].member.source.root
        model = root if root.tag == "robot" else next(root.iter("model"), root)
        spec = alike[0].spec
        files = (os.path.realpath(one) for one in (spec.description, spec.simulated) if one)
        # What stands before all links, as in wamv/base_link, is the name that its launch spawns it by.
        links = [it.get("name", "") for it in root.iter("link") if it.get("name")]
        prefixes = {it.partition("/")[0] if "/" in it else "" for it in links}
        names = {model.get("name", ""), *(prefixes if len(prefixes) == 1 else ())} - {""}
        yield _Kind(alike, frozenset(names), frozenset(files))


def _model_name(one: _Element) -> str:
    return one.get("name") or text_at(one, "name") or text_at(one, "uri").rpartition("/")[2]


def _plugin_edits(it: _Text, plugin: _Element, kind: _Kind) -> Iterator[Edit | Finding]:
    """Yield the edits that give each robot its own values in a plugin of the world; or a finding."""
    for block in (one for one in plugin.iterchildren("*") if len(one)):
        texts_in = (text_of(one) for one in block.iter("*") if not len(one))
        if not any(_new_value(text, kind.robots[0], kind.names, False) for text in texts_in):
            continue
        start, end = it.spans.of(block)
        texts = [_block_for(it, block, kind, robot) for robot in kind.robots]
        yield Edit(start, end, b"\n".join(texts), None)
    leaves = [one for one in plugin.iterchildren("*") if not len(one)]
    named = [one for one in leaves if _new_value(text_of(one), kind.robots[0], kind.names, False)]
    for one in leaves:
        new = _new_value(text_of(one), kind.robots[0], kind.names, bool(named))
        slot = text_slot(it.document.source, it.spans.start_of(one), text_of(one)) if new else None
        if slot:
            yield Edit(*slot, new.encode(), None)
    if named and len(kind.robots) > 1:
        who = plugin.get("name") or plugin.get("filename") or "plugin"
        first = kind.robots[0].spec.name
        message = f"{who} of the world names one robot in <{named[0].tag}>: now {first} alone"
        yield _world_finding(it, named[0], message, WARNING)


def _block_for(it: _Text, block: _Element, kind: _Kind, robot: RewrittenRobot) -> bytes:
    """Return the block for one robot; its own name, if it has one, becomes the robot's."""
    source = it.document.source
    start, end = it.spans.of(block)
    edits = []
    for one in block.iter("*"):
        text = text_of(one) if not len(one) else ""
        new = _new_value(text, robot, kind.names, True)
        slot = text_slot(source, it.spans.start_of(one), text) if new else None
        edits += [Edit(slot[0] - start, slot[1] - start, new.encode(), None)] if slot else []
    own = re.compile(rb"""\bname\s*=\s*["']([^"'<]*)""").search(
        source, start, tag_end(source, start)
    )
    if own and robot is not kind.robots[0]:
        at = own.end(1) - start
        edits.append(Edit(at, at, f"_{robot.spec.name}".encode(), None))
    return b"".join(cut(source[start:end], sorted(edits)))


def _new_value(value: str, robot: RewrittenRobot, names: frozenset[str], tied: bool) -> str:
    """Return what a value becomes for a robot; empty if it does not name the robot."""
    # In what is ``tied`` to the robot, links and joints become its own.
    model, scope, rest = value.partition(_SCOPE)
    if value in names:
        return robot.spec.model
    if scope and model in names:
        return _SCOPE.join((robot.spec.model, *(_new_part(it, robot) for it in rest.split(_SCOPE))))
    made = value
    for name in names:
        made = re.sub(_BELOW_MODEL.format(re.escape(name)), rf"\g<1>{robot.spec.model}", made)
    if made == value and tied:
        made = _new_part(value, robot)
    return made if made != value else ""


def _new_part(value: str, robot: RewrittenRobot) -> str:
    """Return the robot's name of a link, joint or sensor; any other text as it is."""
    for kind in ("link", "joint", "sensor"):
        if is_declared(robot.names, kind, value):
            return spell(robot.names, kind, value)
    return value


def _own_paths(it: _Text) -> Iterator[Edit]:
    """Yield edits that make relative paths absolute: the copy of the world is in another folder."""
    folder = os.path.dirname(os.path.abspath(it.document.file))
    for one in it.document.root.iter("uri", "filename"):
        text = text_of(one)
        path = os.path.join(folder, text)
        if text and "://" not in text and os.path.exists(path):
            slot = text_slot(it.document.source, it.spans.start_of(one), text)
            if slot:
                yield Edit(*slot, f"file://{path}".encode(), None)


def _world_finding(it: _Text, one: _Element, message: str, level: str) -> Finding:
    place = f"{it.document.file}:{one.sourceline}"
    hint = f"{place}; robots are spawned by the launch file" if level == NOTE else f"see {place}"
    return WORLD_ROBOT.finding(message, hint, level=level, file=it.file, line=it.line)


FILE = "world.sdf"
# The release whose Gazebo has libraries of the old name.
OLD_NAMES = "humble"
_ALWAYS = {
    "physics": "Physics",
    "user-commands": "UserCommands",
    "scene-broadcaster": "SceneBroadcaster",
    "contact": "Contact",
}


def world_file(plan: FleetPlan) -> FilesAndFindings:
    """Yield the user's world for the robots, or an empty one if a sensor needs it."""
    # Raises InputError for a file that is no world.
    kind = "ignition-gazebo" if has_release(OLD_NAMES, plan.file.distro) else "gz-sim"
    robots = [it for it in plan.robots if is_simulated(it) and not it.is_classic]
    usual = {library: _system_xml(kind, library, name) for library, name in _ALWAYS.items()}
    ours = _sensor_systems(robots, kind)
    given = plan.file.simulator_world
    if given:
        simulated = [it for it in plan.robots if is_simulated(it)]
        models = [(it.spec.model, it.member.inventory.document.root) for it in simulated]
        spawning = {it: usual[it] for it, _ in needed_systems(models) if it in usual}
        world = read_document(read_file(given), given).root.find("world")
        plugins = world.iterchildren("plugin") if world is not None else ()
        there = [it.get("filename") or "" for it in plugins]
        lacking = {
            library: text
            for library, text in (spawning | ours).items()
            if not any(f"-{library}-system" in it for it in there)
        }
        if not there:
            # To a world that names none those are added that Gazebo gives it.
            lacking = usual | ours if ours else {}
        systems = "".join(lacking.values())
        data, findings = own_world(given, simulated, systems, *plan.file.world_place)
        yield OutputFile(FILE, data, (given,))
        yield from findings
    elif ours:
        systems = "".join({**usual, **ours}.values())
        place = own_text(__file__, "place_on_earth.sdf") if "navsat" in ours else ""
        empty = own_text(__file__, "empty_world.sdf").format(systems=systems, place=place)
        yield OutputFile(FILE, empty.encode())


def _sensor_systems(robots: Sequence[RewrittenRobot], kind: str) -> dict[str, str]:
    """Return the XML of the systems that sensors and files of these robots need, by library.

    ``kind`` is what plugins are called after: gz-sim or ignition-gazebo."""
    roots = [it.member.inventory.document.root for it in robots]
    types = {sensor.get("type", "") for root in roots for sensor in root.iter("sensor")}
    needed = dict(sorted(SYSTEMS[it] for it in types & SYSTEMS.keys()))
    found = systems_of(robots).items()
    theirs = {
        library.removeprefix("gz-sim-").removesuffix("-system"): f"    {text}\n"
        for library, text in found
    }
    return {**{it: _system_xml(kind, it, name) for it, name in needed.items()}, **theirs}


def _system_xml(kind: str, library: str, name: str) -> str:
    head = f'    <plugin filename="{kind}-{library}-system" name="gz::sim::systems::{name}"'
    if name != "Sensors":
        return f"{head}/>\n"
    return f"{head}>\n      <render_engine>ogre2</render_engine>\n    </plugin>\n"
