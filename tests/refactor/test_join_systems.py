# SPDX-License-Identifier: Apache-2.0
"""One ros2_control for parts of one hardware: what it becomes, by hand; the parts come out again."""

from __future__ import annotations

from pathlib import Path
from types import FunctionType

import pytest
from lxml import etree

from multibot_rewrite import InputError, Joined, Part, ProofError, join
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.joining import blocks

SYSTEM = """\
  <ros2_control name="driver" type="system">
    <hardware><plugin>mock_components/GenericSystem</plugin>PARAM</hardware>
    <!-- its own -->
    <joint name="turn"><command_interface name="position"/></joint>
    <sensor name="wrist"><state_interface name="force.z"/></sensor>
  </ros2_control>
"""
ARM = f"""\
<?xml version="1.0"?>
<robot name="arm">
  <link name="base"/>
  <link name="tool"/>
  <joint name="turn" type="continuous">
    <parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
  </joint>
{SYSTEM}</robot>
"""
TABLE = '<robot name="cell"><link name="table"/></robot>\n'
OTHER = ARM.replace("PARAM", '<param name="ip">10.0.0.2</param>')
ONE = ARM.replace("PARAM", "")


def two(second: str = ONE, one_system: bool = True, first: str = ONE) -> Joined:
    at = {"at": "table", "one_system": one_system}
    parts = [Part(first, prefix="l_", **at), Part(second, prefix="r_", **at)]  # type: ignore[arg-type]
    return join([Part(TABLE), *parts])


def driven(made: Joined) -> dict[str, list[tuple[str, str]]]:
    """Return what each system drives."""
    found = etree.fromstring(made.data).iterchildren("ros2_control")
    return {
        it.get("name", ""): [(str(one.tag), one.get("name", "")) for one in it.iterchildren("*")][
            1:
        ]
        for it in found
    }


LEFT = [("joint", "l_turn"), ("sensor", "l_wrist")]
RIGHT = [("joint", "r_turn"), ("sensor", "r_wrist")]


def test_one_id_twice_on_one_hardware_is_refused_or_told() -> None:
    numbered = ONE.replace('name="turn"><c', 'name="turn"><param name="ID">1</param><c')
    with pytest.raises(InputError, match=r"'r_turn' and 'l_turn' have one ID=1 on one hardware"):
        two(numbered, first=numbered)
    assert "have one ID=1" in " ".join(two(numbered, False, numbered).notes)
    other = numbered.replace(">1<", ">2<")
    assert "have one ID" not in " ".join(two(other, False, numbered).notes)
    assert driven(two(other, first=numbered)) == {"l_driver": [*LEFT, *RIGHT]}


def test_parts_of_one_hardware_have_one_system() -> None:
    assert driven(two()) == {"l_driver": [*LEFT, *RIGHT]}


def test_without_it_each_part_has_its_own() -> None:
    assert driven(two(one_system=False)) == {"l_driver": LEFT, "r_driver": RIGHT}


@pytest.mark.parametrize(
    "second",
    [
        OTHER,
        ONE.replace('type="system"', 'type="sensor"'),
        ONE.replace("mock_components/GenericSystem", "gz_ros2_control/GazeboSimSystem"),
    ],
)
def test_other_hardware_stays_and_is_told(second: str) -> None:
    made = two(second)
    assert driven(made) == {"l_driver": LEFT, "r_driver": RIGHT}
    assert any("ros2_control 'r_driver' stays" in it for it in made.notes)


def test_the_proof_sees_a_joint_that_is_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    def one_lost(system: etree._Element) -> list[etree._Element]:
        return [it for it in system.iterchildren("*") if it.tag != "hardware"][:1]

    wrong = {**vars(blocks), "driven": one_lost}
    faulty = FunctionType(blocks.one_system.__code__, wrong)
    monkeypatch.setattr("multibot_rewrite.description.joining.join.one_system", faulty)
    with pytest.raises(ProofError, match="<ros2_control> 'r_driver' is changed"):
        two()


def test_a_list_of_parts_has_the_key(tmp_path: Path) -> None:
    (tmp_path / "arm.urdf").write_text(ONE)
    second = "{description: arm.urdf, prefix: r_, at: {parent: tool}, one_system: true}"
    listed = tmp_path / "robot.urdf.join"
    listed.write_text(f"join: [{{description: arm.urdf}}, {second}]\n")
    assert main(["join", str(listed), "-o", str(tmp_path / "robot.urdf"), "-q"]) == 0
    assert etree.parse(tmp_path / "robot.urdf").xpath("count(ros2_control)") == 1
