# SPDX-License-Identifier: Apache-2.0
"""Ports of simulated robots: the numbers that the autopilots of the second and third instance take.

Expected: ArduPilot libraries/AP_HAL_SITL/SITL_cmdline.cpp raises its ports by 10 for each instance
(``-I``), PX4-Autopilot launch/multi_uav_mavros_sitl.launch has ``14560 + id`` for udp and
``4560 + id`` for tcp, gazebo_mavlink_interface.cpp takes 14560 and 4560 where the model says nothing.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest
from fleet_folder import planned_fleet
from lxml import etree

from multibot_rewrite import rewrite, rewrite_all, strip
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError
from multibot_rewrite.checks.build import make_outputs

ARDUPILOT = '<plugin name="a" filename="ArduPilotPlugin"><fdm_port_in>9002</fdm_port_in></plugin>'
MAVLINK = '<plugin name="m" filename="libgazebo_mavlink_interface.so">{}</plugin>'
MODEL = '<sdf version="1.6"><model name="drone"><link name="base"/>{}</model></sdf>'


def _built(
    folder: Path, plugins: dict[str, str], distro: str = "jazzy"
) -> tuple[list[str], list[Finding]]:
    """Return the texts of the robots' models, and what is said."""
    for name, plugin in plugins.items():
        (folder / f"{name}.sdf").write_text(MODEL.format(plugin))
    robots = "".join(f"  - {{name: {it}, description: {it}.sdf}}\n" for it in plugins)
    (folder / "fleet.yaml").write_text(
        f"layout: both\ndistro: {distro}\nsimulator: gazebo\nrobots:\n{robots}"
    )
    plan = planned_fleet(folder / "fleet.yaml")
    made = make_outputs(plan, str(folder / "out"))
    texts = {it.path: it.text for it in made.files}
    said = [*made.findings, *plan.fleet.table.problems]
    return [texts[f"{name}/{name}.sdf"] for name in plugins], said


def _ports(texts: list[str], tag: str) -> list[str | None]:
    return [etree.fromstring(it.encode()).findtext(f".//plugin/{tag}") for it in texts]


@pytest.mark.parametrize(("tcp", "tag", "first"), [("0", "udp", 14560), ("1", "tcp", 4560)])
def test_a_port_that_the_model_leaves_to_its_default(
    tmp_path: Path, tcp: str, tag: str, first: int
) -> None:
    plugin = MAVLINK.format(f"<use_tcp>{tcp}</use_tcp>")
    texts, _ = _built(tmp_path, {"a": plugin, "b": plugin}, "humble")
    assert _ports(texts, f"mavlink_{tag}_port") == [None, str(first + 1)]


HARDWARE = (
    '<robot name="r"><link name="base"/><ros2_control name="c" type="system"><hardware>'
    "<plugin>{}</plugin>{}</hardware></ros2_control></robot>"
)
KUKA_PORT = '<param name="client_port">59152</param>'
UNITREE, KUKA = "hardware_unitree_sdk2/HardwareUnitree", "kuka_rsi_driver::KukaRSIHardwareInterface"
OF_LO = '<param name="network_interface">lo</param><param name="domain">7</param>'
OF_WIRE = '<param name="network_interface">eth0</param>'


@pytest.mark.parametrize(
    ("text", "path", "numbers"),
    [
        (MODEL.format(ARDUPILOT), ".//fdm_port_in", ["9002", "9012", "9022"]),
        (HARDWARE.format(UNITREE, ""), ".//param[@name='domain']", [None, "2", "3"]),
        (HARDWARE.format(UNITREE, OF_LO), ".//param[@name='domain']", ["7", "8", "9"]),
        (HARDWARE.format(UNITREE, OF_WIRE), ".//param[@name='domain']", None),
        # PX4's mavlink_interface.cpp opens the serial port in place of the others.
        (
            MODEL.format(MAVLINK.format("<serialEnabled>1</serialEnabled>")),
            ".//mavlink_udp_port",
            None,
        ),
        (
            HARDWARE.format(KUKA, KUKA_PORT),
            ".//param[@name='client_port']",
            ["59152", "59153", "59154"],
        ),
    ],
)
def test_robots_that_are_rewritten_together_have_numbers_of_their_own(
    text: str, path: str, numbers: list[str | None] | None
) -> None:
    """quadruped_ros2_control HardwareUnitree.h: lo and domain 1 where nothing is written.
    An interface of a computer is no number: nobody can raise it."""
    one = rewrite(text, "a", distro="jazzy")
    three = [*rewrite_all(text, ["a", "b", "c"], distro="jazzy")]
    assert len({it.findings for it in three}) == 1
    found = [etree.fromstring(it.data).findtext(path) for it in three]
    assert found == (numbers or [None] * 3)
    assert [it.data for it in three[:1]] == [one.data] and one.not_verified
    assert bool(three[2].not_verified) == (numbers is None)
    assert ("MF845" in {it.code for it in three[0].findings}) == bool(numbers)
    met = [it.hint for it in one.findings if it.code == "MB412"]
    assert all(("in one call" in it) == bool(numbers) for it in met) and met
    assert [strip(it.data, it.robot, distro="jazzy") for it in three] == [text.encode()] * 3
    listed = [[one.new for one in it.changes if one.kind == "port"] for it in three]
    assert listed == [[], *([it] for it in numbers[1:])] if numbers else not any(listed)


def test_a_number_is_taken_back_only_as_it_was_written(tmp_path: Path) -> None:
    """A port that is written where another one's default is put, without a blank."""
    own, text = tmp_path / "own.vocab", HARDWARE.format("a/B", "")
    paths = (f"address+1:hardware/param[@name={it}]=59152" for it in ("client_port", "other"))
    own.write_text(f"[hardware a/B]\nopens: {' '.join(paths)}\n")
    text = text.replace("<hardware>", f"<hardware>{KUKA_PORT}")
    two = [*rewrite_all(text, ["a", "b"], distro="jazzy", definitions=[str(own)])]
    back = partial(strip, robot="b", distro="jazzy", definitions=[str(own)])
    assert back(two[1].data) == text.encode()
    for old, new in (("59153<", "59152<"), ("from 59152 -->", "from 59152 --> ")):
        assert old.encode() in two[1].data
        with pytest.raises(InputError, match="edited by hand"):
            back(two[1].data.replace(old.encode(), new.encode()))


def test_what_is_no_number_is_not_said_to_get_one() -> None:
    text = MODEL.format(ARDUPILOT.replace("9002", "udp"))
    *_, last = rewrite_all(text, ["a", "b"], distro="jazzy")
    (hint,) = (it.hint for it in last.findings if it.code == "MB412")
    assert "in one call" not in hint


def test_two_mavros_of_one_system_are_joined_by_topics_of_their_own(tmp_path: Path) -> None:
    """mavros_node.cpp: router and UAS meet in /uas1, whatever the namespace of their process."""
    (tmp_path / "p.yaml").write_text("mavros_node: {ros__parameters: {tgt_system: 1}}\n")
    (tmp_path / "d.urdf").write_text('<robot name="d"><link name="base_link"/></robot>')
    robots = "".join(f"  - {{name: uav{it}, description: d.urdf}}\n" for it in (1, 2))
    text = f"layout: both\ndistro: jazzy\nrobots:\n{robots}related_files: {{params: p.yaml}}\n"
    (tmp_path / "fleet.yaml").write_text(text)
    plan = planned_fleet(tmp_path / "fleet.yaml")
    files = {it.path: it.text for it in make_outputs(plan, "out").files}
    for end in ("source", "sink"):
        rule = f"[/uas1/mavlink_{end}, uas1/mavlink_{end}]"
        assert files["remappings.yaml"].count(rule) == 2
