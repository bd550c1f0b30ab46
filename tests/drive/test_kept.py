# SPDX-License-Identifier: Apache-2.0
"""What the drive test says that sdformat keeps is what sdformat keeps."""

from __future__ import annotations

import shutil
from collections import defaultdict
from pathlib import Path
from typing import Any

import kept
import pytest
import xacro
from lxml import etree
from paths import ROOT
from real_robots import corpus_files

INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
MASS = f'<inertial><mass value="1"/>{INERTIA}</inertial>'
SENSOR = '<gazebo reference="{0}"><sensor name="eye" type="camera"/></gazebo>'


def link(name: str, mass: str = MASS) -> str:
    return f'<link name="{name}">{mass}</link>'


def joint(parent: str, child: str, kind: str = "continuous") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/><axis xyz="0 0 1"/>'
    return f'<joint name="{parent}_{child}" type="{kind}">{ends}</joint>'


def read(*parts: str) -> kept.Kept:
    return kept.of_urdf(etree.fromstring(f'<robot name="r">{"".join(parts)}</robot>'))


def test_a_link_without_mass_takes_what_is_below_it_away() -> None:
    found = read(link("a"), link("b", ""), link("c"), joint("a", "b"), joint("b", "c"))
    assert (found.links, found.joints) == (("a",), ())


def test_a_robot_without_mass_has_no_link() -> None:
    found = read(link("a", ""), link("b", ""), joint("a", "b"), SENSOR.format("b"))
    assert (found.links, found.joints, found.sensors) == ((), (), ())


def test_a_fixed_link_becomes_a_part_of_its_parent_with_its_sensor() -> None:
    found = read(link("a", ""), link("b"), joint("a", "b", "fixed"), SENSOR.format("b"))
    assert (found.links, found.joints) == (("a",), ())
    assert [where for where, _ in found.sensors] == ["a"]


def test_a_joint_that_is_preserved_needs_mass_on_both_sides() -> None:
    whole = '<gazebo reference="a_b"><preserveFixedJoint>true</preserveFixedJoint></gazebo>'
    assert read(link("a"), link("b"), joint("a", "b", "fixed"), whole).joints == ("a_b",)
    lost = read(link("a"), link("b", ""), joint("a", "b", "fixed"), whole)
    assert (lost.links, lost.joints) == (("a",), ())


def test_a_mount_without_mass_keeps_what_turns_on_it() -> None:
    parts = (link("a"), link("mount", ""), link("pan"), joint("a", "mount", "fixed"))
    found = read(*parts, joint("mount", "pan"))
    assert (found.links, found.joints) == (("a", "pan"), ("mount_pan",))


def test_what_is_on_the_world_is_fixed_to_it() -> None:
    found = read('<link name="world"/>', link("a"), joint("world", "a", "fixed"))
    assert (found.links, found.joints) == (("a",), ("world_a",))


@pytest.mark.parametrize(
    "file", sorted((ROOT / "examples").rglob("*.urdf*")), ids=lambda it: it.name
)
def test_the_examples_stay_whole_in_gazebo(file: Path) -> None:
    """Each joint that can turn is there, and each wheel has something that touches the ground."""
    root = etree.fromstring(xacro.process_file(str(file)).toxml())
    turning = {it.get("name") for it in root.iter("joint") if it.get("type") not in ("fixed", None)}
    found = kept.of_urdf(root)
    assert turning <= set(found.joints)
    assert root.find("link/visual") is not None
    wheels = [it for it in root.iter("link") if "wheel" in it.get("name")]
    assert all(it.find("collision") is not None for it in wheels)


def said(found: kept.Kept) -> list[Any]:
    sensors = [(where, it.get("name"), it.get("type")) for where, it in found.sensors]
    plugins = [it.get("filename") or "" for it in found.plugins]
    return [sorted(found.links), sorted(found.joints), sorted(map(str, sensors)), sorted(plugins)]


def of_each_repository() -> list[Path]:
    """Of each the three largest descriptions; all of sdformat, which are its own tests."""
    found: dict[str, list[Path]] = defaultdict(list)
    for name, path in corpus_files().items():
        found[name.partition("/")[0]].append(path)
    largest = {it: sorted(own, key=lambda at: at.stat().st_size) for it, own in found.items()}
    return sorted(at for it, own in largest.items() for at in own[0 if "sdformat" in it else -3 :])


@pytest.mark.deep
@pytest.mark.skipif(
    not any(map(shutil.which, ("gz", "ign"))),
    reason="the referee is sdformat: apt install ignition-tools libsdformat-dev",
)
@pytest.mark.parametrize("file", of_each_repository(), ids=str)
def test_sdformat_keeps_the_same(file: Path) -> None:
    try:
        root = etree.parse(str(file)).getroot()
    except etree.XMLSyntaxError:
        pytest.skip("no XML")
    if root.tag != "robot":
        pytest.skip("no URDF")
    program = kept.sdf_program()
    found = kept.printed(program, root)
    if found is None:
        pytest.skip("sdformat refuses it")
    assert said(kept.of_urdf(root, kept.version(program) < kept.WHOLE)) == said(found)
