"""Two robots that were given one device: its address, number or calibration, a port of its driver."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from importlib.resources import files

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.findings.finding import NOTE, WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.fleet.robots.rewritten_robots import RewrittenRobot, at_robot

ADDRESS, CALIBRATION, COMPUTER, NOWHERE = "address", "calibration", "computer", "nowhere"
# Of hardware that is not there.
_MOCKS = ("mock_components/", "fake_components/")
_ADVICE = {
    ADDRESS: "one device has one driver: give each robot its own",
    CALIBRATION: "each device has its own: name the file that was measured with this one",
    COMPUTER: "the second driver on a computer cannot open them: give each robot its own",
}

_ARM = """\
<robot name="arm">
  <link name="base"/>
  <ros2_control name="arm" type="system">
    <hardware>
      <plugin>franka_hardware/FrankaHardwareInterface</plugin>
      <param name="robot_ip">{}</param>
    </hardware>
  </ros2_control>
</robot>
"""
SAME_DEVICE = declare(
    "MF833",
    "robots-with-one-device",
    WARNING,
    what="The hardware of two robots has the same address, serial number, calibration or port. For "
    "ports of the computer it is a note: robots may have computers of their own.",
    why="Both drivers command one arm, or the second one is refused. With another arm's calibration "
    "the tool is millimetres from where tf has it.",
    fix="Give each robot its own, by its `arguments` in the fleet file.",
    bad="""\
robots:
  - {name: left, description: arm.urdf}
  - {name: right, description: arm.urdf}
""",
    good="""\
robots:
  - {name: left, description: arm.urdf}
  - {name: right, description: other.urdf}
""",
    line=3,
    formats=("fleet",),
    beside={"arm.urdf": _ARM.format("172.16.0.2"), "other.urdf": _ARM.format("172.16.0.3")},
)


class Device(NamedTuple):
    """What a hardware component is given: the kind, the parameter and its value."""

    kind: str
    param: str
    value: str


def one_device(robots: Sequence[RewrittenRobot]) -> Iterator[Finding]:
    """What two robots were both given, at the second one; those of simulators have no devices."""
    first: dict[Device, RewrittenRobot] = {}
    for robot in robots:
        met: dict[tuple[str, str], list[Device]] = {}
        for it in () if robot.spec.simulator == "gazebo" else devices(robot):
            other = first.setdefault(it, robot)
            if other is not robot:
                met.setdefault((it.kind, other.spec.name), []).append(it)
        for (kind, name), found in met.items():
            given = ", ".join(f"{it.param} {it.value}" for it in found)
            what = f"robot {robot.spec.name!r} has the same hardware as {name!r}: {given}"
            level = NOTE if kind == COMPUTER else WARNING
            yield at_robot(SAME_DEVICE, robot, what, _ADVICE[kind], level)


def devices(robot: RewrittenRobot) -> Iterator[Device]:
    """The devices of a robot's description; none of a component whose address is nowhere."""
    known = _known()
    for hardware in robot.member.inventory.document.root.iterfind("ros2_control/hardware"):
        if (hardware.findtext("plugin") or "").strip().startswith(_MOCKS):
            continue
        params = {it.get("name", ""): (it.text or "").strip() for it in hardware.iterfind("param")}
        found = [Device(kind, name, it) for name, it in params.items() if (kind := known.get(name))]
        if any(it.kind == ADDRESS and it.value in _nowhere() for it in found):
            continue
        yield from (it for it in dict.fromkeys(found) if it.value not in _nowhere())


def _known() -> Mapping[str, str]:
    kinds = (ADDRESS, CALIBRATION, COMPUTER)
    return {name: kind for kind in kinds for name in _data()[kind]}


def _nowhere() -> Sequence[str]:
    return _data()[NOWHERE]


@lru_cache
def _data() -> Mapping[str, list[str]]:
    text = (
        files("multibot_rewrite.producers.evidence")
        .joinpath("devices.yaml")
        .read_text(encoding="utf-8")
    )
    data: Mapping[str, list[str]] = load_yaml(text)
    return data
