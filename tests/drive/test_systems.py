# SPDX-License-Identifier: Apache-2.0
"""What the drive test says that systems of gz-sim open, each as its source has it."""

from __future__ import annotations

import gazebo
import pytest
import simulator
from kept import Kept
from lxml import etree


def opened(text: str) -> set[tuple[str, str]]:
    """Return the role and topic of each end of a plugin or sensor of model m."""
    element = etree.fromstring(text)
    of = gazebo.of_sensor if element.tag == "sensor" else gazebo.of_plugin
    return {(it.role, it.topic) for it in of(element, "m", "w", "l")}


def plugin(name: str, inside: str = "") -> str:
    return f'<plugin filename="{name}">{inside}</plugin>'


def joint(name: str) -> str:
    return f"<joint_name>{name}</joint_name>"


SENSOR = "/world/w/model/m/link/l/sensor/s"
# Thruster.cc, MulticopterVelocityControl.cc, MulticopterMotorModel.cc, JointController.cc,
# Hydrodynamics.cc, Contact.cc, ForceTorque.cc
OPENED = {
    "a thruster of a namespace": (
        plugin("gz-sim-thruster-system", f"{joint('j')}<namespace>n</namespace>"),
        {("hears", "/model/n/joint/j/cmd_thrust"), ("sends", "/model/n/joint/j/ang_vel")},
    ),
    "a thruster without one, by its speed": (
        plugin("gz-sim-thruster-system", f"{joint('j')}<use_angvel_cmd>true</use_angvel_cmd>"),
        {("hears", "/model/m/joint/j/cmd_vel"), ("sends", "/model/m/joint/j/force")},
    ),
    "a thruster with a topic": (
        plugin("gz-sim-thruster-system", f"{joint('j')}<topic>t</topic>"),
        {("hears", "/m/t"), ("sends", "/m/t/ang_vel")},
    ),
    "a multicopter": (
        plugin("gz-sim-multicopter-control-system", "<robotNamespace>x3</robotNamespace>"),
        {("hears", "/x3/cmd_vel"), ("hears", "/x3/enable")},
    ),
    "its motor without a namespace": (
        plugin("gz-sim-multicopter-motor-model-system"),
        {("hears", "/m/command/motor_speed")},
    ),
    "a joint below its model": (
        plugin("libignition-gazebo-joint-controller-system.so", "<sub_topic>a/b</sub_topic>"),
        {("hears", "/model/m/a/b")},
    ),
    "a joint": (
        plugin("gz-sim-joint-controller-system", joint("j")),
        {("hears", "/model/m/joint/j/cmd_vel")},
    ),
    "water": (plugin("gz-sim-hydrodynamics-system"), set()),
    "a contact": (
        '<sensor name="s" type="contact"><contact><topic>touch</topic></contact></sensor>',
        {("sends", "/touch")},
    ),
    "a wrench": ('<sensor name="s" type="force_torque"/>', {("sends", f"{SENSOR}/forcetorque")}),
}
CONTROL = "<control channel='{0}'><type>COMMAND</type><cmd_topic>{1}</cmd_topic></control>"


@pytest.mark.parametrize("name", OPENED)
def test_a_system_opens_what_its_source_says(name: str) -> None:
    text, wanted = OPENED[name]
    assert opened(text) == wanted


def diver(robot: str, topic: str, port: str = "") -> simulator.Model:
    """Return a robot with one thruster, and an autopilot that sends on a topic."""
    given = f"<fdm_port_in>{port}</fdm_port_in>" if port else ""
    texts = (
        plugin("ArduPilotPlugin", given + CONTROL.format(0, topic)),
        plugin("gz-sim-thruster-system", joint("j")),
    )
    plugins = tuple(etree.fromstring(it) for it in texts)
    return simulator.Model(robot, robot, etree.Element("sdf"), Kept(("l",), ("j",), (), plugins))


def test_an_autopilot_is_heard_by_a_system_of_its_robot() -> None:
    there = simulator.World("w")
    fine = diver("r", "/model/r/joint/j/cmd_thrust")
    assert list(simulator.unheard(fine, there)) == []
    ((robot, what, why),) = simulator.unheard(diver("r", "/model/rov/joint/j/cmd_thrust"), there)
    assert (robot, what) == ("r", "drives")
    assert "/model/rov/joint/j/cmd_thrust" in why


@pytest.mark.parametrize(("first", "second"), [("9002", "9002"), ("", ""), ("", "9002")])
def test_two_autopilots_have_two_ports(first: str, second: str) -> None:
    ((robot, what, why),) = simulator.one_port([diver("a", "t", first), diver("b", "t", second)])
    assert (robot, what, why) == ("b", "starts", "a has its port 9002, too")


def test_ports_of_two_autopilots_are_no_fault() -> None:
    assert list(simulator.one_port([diver("a", "t", "9002"), diver("b", "t", "9012")])) == []
