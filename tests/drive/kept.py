# SPDX-License-Identifier: Apache-2.0
"""What sdformat leaves of a description, as Gazebo loads it: links, joints, sensors, plugins.

``sdf -p`` says it where it is installed and not older than 12.7; else it is read here by the rules of
``src/parser_urdf.cc`` (CreateSDF, ReduceFixedJoints), which a deep test holds against the program.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

from lxml import etree

# Until then what a massless link that is lumped carries was left out, too, and a milligram was no mass.
WHOLE = (12, 7)
NEARLY = 1e-6
YES = ("true", "yes", "1")


class Kept(NamedTuple):
    """What is in the simulator; a sensor with the link or joint that it is on."""

    links: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    sensors: tuple[tuple[str, etree._Element], ...] = ()
    plugins: tuple[etree._Element, ...] = ()


def kept(root: etree._Element) -> Kept:
    """Return what Gazebo has of a description, URDF or SDF."""
    if root.tag == "sdf":
        return of_sdf(root)
    program = sdf_program()
    said = printed(program, root) if program and version(program) >= WHOLE else None
    return of_urdf(root) if said is None else said


@cache
def sdf_program() -> str:
    return next((it for it in ("gz", "ign") if shutil.which(it)), "")


@cache
def version(program: str) -> tuple[int, int]:
    """Return the version of sdformat that a program has."""
    done = subprocess.run(
        [program, "sdf", "--versions"], capture_output=True, text=True, timeout=30, check=False
    )
    found = re.search(r"^(\d+)\.(\d+)", done.stdout, re.MULTILINE)
    return (int(found[1]), int(found[2])) if found else (0, 0)


def printed(program: str, root: etree._Element) -> Kept | None:
    """Return what ``sdf -p`` makes of a URDF; nothing where it says nothing."""
    with tempfile.NamedTemporaryFile(suffix=".urdf") as file:
        file.write(etree.tostring(root))
        file.flush()
        command = [program, "sdf", "-p", file.name]
        done = subprocess.run(command, capture_output=True, timeout=60, check=False)
    start = done.stdout.find(b"<sdf")
    # A plugin may have elements whose prefix is declared nowhere.
    parser = etree.XMLParser(recover=True)
    return None if start < 0 else of_sdf(etree.fromstring(done.stdout[start:], parser))


def of_sdf(root: etree._Element) -> Kept:
    model = root.find(".//model")
    if model is None:
        return Kept()
    parts = [it for each in model.iter("model") for it in each]
    places = [it for it in parts if it.tag in ("link", "joint")]
    return Kept(
        tuple(it.get("name", "") for it in parts if it.tag == "link"),
        tuple(it.get("name", "") for it in parts if it.tag == "joint"),
        tuple((it.get("name", ""), each) for it in places for each in it.iterfind("sensor")),
        tuple(it for it in parts if it.tag == "plugin"),
    )


class Joint(NamedTuple):
    """A joint of a URDF, and whether its child becomes a part of its parent."""

    name: str
    parent: str
    child: str
    lumped: bool


def of_urdf(root: etree._Element, old: bool = False) -> Kept:
    """Return the rules of sdformat; ``old`` are those before 12.7."""
    joints = list(joints_of(root))
    body = bodies(root, joints)
    masses = {it.get("name", ""): mass_of(it) for it in root.iterfind("link")}
    links, made, none = [], [], NEARLY if old else 0.0
    queue = [it for it in body if it not in {joint.child for joint in joints}][:1]
    while queue:
        name = queue.pop()
        # Of two that have the same child urdfdom keeps the last by name.
        own = max((it for it in joints if it.child == name), default=None)
        lumped = own is not None and own.lumped
        if name != "world" and (old or not lumped) and weight(name, masses, joints) <= none:
            continue
        if name != "world" and not lumped:
            links.append(name)
            made += [own.name] if own else []
        queue += [it.child for it in joints if it.parent == name]
    sensors = tuple(sensors_of(root, body, {*links, *made}))
    added = [it for block in root.iterfind("gazebo") if not block.get("reference") for it in block]
    links += [it.get("name", "") for it in added if it.tag == "link"]
    made += [it.get("name", "") for it in added if it.tag == "joint"]
    plugins = [it for block in root.iterfind("gazebo") for it in plugins_of(block)]
    return Kept(tuple(links), tuple(made), sensors, tuple(plugins))


def joints_of(root: etree._Element) -> Iterator[Joint]:
    whole = {
        block.get("reference")
        for block in root.iterfind("gazebo")
        for tag in ("preserveFixedJoint", "disableFixedJointLumping")
        if any(said(it) in YES for it in block.iterfind(tag))
    }
    for it in root.iterfind("joint"):
        parent, child = it.find("parent"), it.find("child")
        if parent is not None and child is not None:
            name, above = it.get("name", ""), parent.get("link", "")
            lumped = it.get("type") == "fixed" and name not in whole and above != "world"
            yield Joint(name, above, child.get("link", ""), lumped)


def said(element: etree._Element) -> str:
    """``GetKeyValueAsString``: the attribute ``value``, or the text."""
    return (element.get("value") or element.text or "").strip().lower()


def bodies(root: etree._Element, joints: list[Joint]) -> dict[str, str]:
    """Each link with the one that it becomes a part of."""
    above = {it.child: it.parent for it in joints if it.lumped}
    found = {}
    for it in root.iterfind("link"):
        name, seen = it.get("name", ""), set()
        while name in above and name not in seen:
            seen.add(name)
            name = above[name]
        found[it.get("name", "")] = name
    return found


def mass_of(link: etree._Element) -> float:
    mass = link.find("inertial/mass")
    try:
        return 0.0 if mass is None else float(mass.get("value", "0"))
    except ValueError:
        return 0.0


def weight(name: str, masses: dict[str, float], joints: list[Joint]) -> float:
    """Return the mass of a link with all that is lumped into it."""
    parts = [it.child for it in joints if it.parent == name and it.lumped]
    return masses.get(name, 0.0) + sum(weight(it, masses, joints) for it in parts)


def sensors_of(
    root: etree._Element, body: dict[str, str], there: set[str]
) -> Iterator[tuple[str, etree._Element]]:
    """Yield the sensors of blocks whose link or joint is there."""
    for block in root.iterfind("gazebo"):
        place = block.get("reference", "")
        place = body.get(place, place)
        if place in there:
            yield from ((place, it) for it in block.iterfind("sensor"))


def plugins_of(block: etree._Element) -> list[etree._Element]:
    """Return the model's plugins: those of blocks without a reference."""
    return [] if block.get("reference") else block.findall("plugin")
