# SPDX-License-Identifier: Apache-2.0
"""What Gazebo does not survive, and systems of one robot that send on one topic."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.rules.settings import Settings

INERTIA = '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
MASS = f'<inertial><mass value="1"/>{INERTIA}</inertial>'
TYPE = '<joint name="{0}{1}" type="{2}"><parent link="{0}"/><child link="{1}"/></joint>'


def found(inside: str, codes: tuple[str, ...], distro: str = "jazzy") -> list[tuple[str, str]]:
    """Code and level of what is found."""
    text = f'<robot name="r">{inside}</robot>'
    settings = Settings(select=codes, distro=distro)
    return [(it.code, it.level) for it in lint_data("r.urdf", text.encode(), settings)]


def chain(*types: str) -> str:
    """Links a, b, c and so on, each on a joint of one of these types below the one before."""
    names = "abcdef"[: len(types) + 1]
    links = "".join(f'<link name="{it}">{MASS}</link>' for it in names)
    pairs = zip(names, names[1:], types, strict=False)
    return links + "".join(TYPE.format(*it) for it in pairs)


def sensors(*links: str) -> str:
    return "".join(
        f'<gazebo reference="{it}"><sensor name="imu" type="imu"><topic>{it}</topic></sensor></gazebo>'
        for it in links
    )


KEPT = '<gazebo reference="{}"><{}>true</{}></gazebo>'


@pytest.mark.parametrize(
    ("robot", "levels"),
    [
        # sdformat Link.cc loadUniqueRepeated: "sensor with name[imu] already exists".
        (chain("fixed") + sensors("a", "b"), ["error"]),
        (chain("fixed", "fixed") + sensors("b", "c"), ["error"]),
        (chain("fixed", "fixed", "fixed") + sensors("a", "b", "d"), ["error", "error"]),
        (chain("fixed") + sensors("a", "a"), ["error"]),
        # Links that stay apart.
        (chain("continuous") + sensors("a", "b"), []),
        (chain("fixed", "continuous") + sensors("b", "c"), []),
        (chain("fixed") + sensors("a", "b") + KEPT.format("ab", *["preserveFixedJoint"] * 2), []),
        (
            chain("fixed")
            + sensors("a", "b")
            + KEPT.format("ab", *["disableFixedJointLumping"] * 2),
            [],
        ),
        # What Gazebo Classic does with it is not known for certain.
        (
            chain("fixed")
            + sensors("a", "b")
            + '<gazebo><plugin name="p" filename="libgazebo_ros_p3d.so"/></gazebo>',
            ["warning"],
        ),
    ],
)
def test_sensors_of_one_name_on_links_that_fixed_joints_merge(
    robot: str, levels: list[str]
) -> None:
    assert found(robot, ("MB201",)) == [("MB201", it) for it in levels]


BATTERY = (
    '<gazebo><plugin filename="gz-sim-linearbatteryplugin-system" '
    'name="gz::sim::systems::LinearBatteryPlugin">{}</plugin></gazebo>'
)
WHOLE = {"battery_name": "b", "capacity": "1", "voltage": "12"}


@pytest.mark.parametrize("left_out", ["", *WHOLE])
@pytest.mark.parametrize("distro", ["humble", "jazzy", "rolling"])
def test_a_battery_needs_what_its_server_ends_without(left_out: str, distro: str) -> None:
    """LinearBatteryPlugin.cc of 6.18.0: Configure returns (242, 297), PreUpdate goes on (505)."""
    inside = "".join(f"<{tag}>{it}</{tag}>" for tag, it in WHOLE.items() if tag != left_out)
    expected = [("MB115", "error")] if left_out else []
    assert found(chain() + BATTERY.format(inside), ("MB115",), distro) == expected


def test_the_build_refuses_both(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    inside = chain("fixed") + sensors("a", "b") + BATTERY.format("<battery_name>b</battery_name>")
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{inside}</robot>')
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text("simulator: gazebo\ndescription: r.urdf\nrobots: [{name: r1}]\n")
    assert main(["build", str(fleet), "-o", str(tmp_path / "out")]) == 1
    said = capsys.readouterr().err
    assert "error: MB201" in said and "error: MB115" in said and "nothing was written" in said
    fleet.write_text("simulator: none\ndescription: r.urdf\nrobots: [{name: r1}]\n")
    assert main(["build", str(fleet), "-o", str(tmp_path / "out")]) == 0


def system(file: str, name: str, inside: str = "") -> str:
    return (
        f'<gazebo><plugin filename="gz-sim-{file}-system" name="gz::sim::systems::{name}">'
        f"{inside}</plugin></gazebo>"
    )


DRIVE = system("diff-drive", "DiffDrive")
PUBLISHER = ("odometry-publisher", "OdometryPublisher")
POSES = system("pose-publisher", "PosePublisher")


@pytest.mark.parametrize(
    ("robot", "distro", "number"),
    [
        # DiffDrive.cc:363 and OdometryPublisher.cc:244 have /model/NAME/odometry by default.
        (DRIVE + system(*PUBLISHER), "jazzy", 1),
        (DRIVE + system(*PUBLISHER, "<odom_topic>truth</odom_topic>"), "jazzy", 0),
        # PosePublisher has /model/NAME/pose up to gz-sim8, /NAME/pose since.
        (POSES + system(*PUBLISHER), "humble", 1),
        (POSES + system(*PUBLISHER), "jazzy", 1),
        (POSES + system(*PUBLISHER), "kilted", 0),
        (POSES + system(*PUBLISHER, "<tf_topic>tf</tf_topic>"), "jazzy", 0),
        # MecanumDrive of Humble sends nothing.
        (system("mecanum-drive", "MecanumDrive") + system(*PUBLISHER), "humble", 0),
        (system("mecanum-drive", "MecanumDrive") + system(*PUBLISHER), "jazzy", 1),
        # Both listen.
        (DRIVE + system("velocity-control", "VelocityControl"), "jazzy", 0),
    ],
)
def test_two_systems_that_send_on_one_topic(robot: str, distro: str, number: int) -> None:
    assert found(chain() + robot, ("MB243",), distro) == [("MB243", "warning")] * number
