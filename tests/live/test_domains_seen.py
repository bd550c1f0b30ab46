# SPDX-License-Identifier: Apache-2.0
"""A plan whose robots are in several ROS domains, held against what was seen in each."""

from __future__ import annotations

from pathlib import Path

import pytest
from plans import PlannedRobot, planned, planned_end

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.live.diagnose import diagnose, diagnose_domains
from multibot_rewrite.planning.domain_bridge import with_bridges
from multibot_rewrite.planning.plan import to_yaml
from multibot_rewrite.rules.check import check_domains
from multibot_rewrite.system.domains import by_domain, named, side_by_side, unnamed
from multibot_rewrite.system.json import to_json
from multibot_rewrite.system.records import (
    PUBLISHES,
    SUBSCRIBES,
    TOPIC,
    Caveat,
    Controller,
    Domain,
    Edge,
    End,
    Environment,
    Heard,
    Node,
    Parameter,
    Robot,
    System,
    Topic,
)

ODOM, MAP = "nav_msgs/msg/Odometry", "nav_msgs/msg/OccupancyGrid"
NUMBERS = {"": 10, "robot1": 11, "robot2": 12}


def plan() -> System:
    """Two robots that read the map of all, and whose odometry a monitor of all reads."""
    robots = [
        PlannedRobot(it, [f"/{it}/{node}" for node in ("drive", "lidar", "imu")], (), f"/{it}/tf")
        for it in ("robot1", "robot2")
    ]
    ends = [
        planned_end("/map_server", TOPIC, PUBLISHES, "/map", MAP, "/map"),
        *(
            end
            for it in ("robot1", "robot2")
            for end in (
                planned_end(f"/{it}/drive", TOPIC, PUBLISHES, f"/{it}/odom", ODOM, "odom"),
                planned_end(f"/{it}/drive", TOPIC, SUBSCRIBES, "/map", MAP, "/map"),
            )
        ),
    ]
    made = planned("both", robots, ("/map_server",), ("/map",), ("map",), tuple(ends))
    domains = tuple(Domain(*it) for it in NUMBERS.items())
    return with_bridges(made._replace(domains=domains), ["odom"])


def test_each_domain_has_its_part_of_a_plan() -> None:
    """Robot ``a`` is in the domain of all; what is open in the plan is in none."""
    nodes = {it: Node(f"{it}/n", robot=it.strip("/")) for it in ("/a", "/b", "")}
    ends = {
        it: End(TOPIC, PUBLISHES, f"{it}/odom", ODOM, "", node.name, None, "")
        for it, node in nodes.items()
    }
    edges = {it: Edge("c", "p", "", False, (node.name,)) for it, node in nodes.items()}
    both = Edge("c", "both", "", False, ("/a/n", "/b/n"))
    rates = {it: Parameter(node.name, "rate", "1") for it, node in nodes.items()}
    topics = {it: Topic(f"{it}/odom") for it in nodes}
    robots = {"/a": Robot("a", tf_topic="/a/tf"), "/b": Robot("b", tf_topic="/b/tf")}
    whole = System(
        nodes=tuple(nodes.values()), ends=tuple(ends.values()), edges=(*edges.values(), both),
        parameters=tuple(rates.values()), topics=tuple(topics.values()),
        robots=tuple(robots.values()), layout="both", gaps=(Finding("MG102", "error", "m"),),
        domains=(Domain("", 5), Domain("b", 7)),
    )  # fmt: skip
    here, there = by_domain(whole).values()
    assert list(by_domain(whole)) == [5, 7]
    assert by_domain(whole._replace(domains=(Domain("b", 7),))) == {0: here, 7: there}
    assert by_domain(whole._replace(domains=())) == {}
    assert here == System(
        nodes=(nodes["/a"], nodes[""]), ends=(ends["/a"], ends[""]), edges=(edges["/a"], edges[""]),
        parameters=(rates["/a"], rates[""]), topics=(topics["/a"], topics[""]),
        robots=(robots["/a"],), layout="both",
    )  # fmt: skip
    assert there == System(
        nodes=(nodes["/b"],), ends=(ends["/b"],), edges=(edges["/b"],), parameters=(rates["/b"],),
        topics=(topics["/b"],), robots=(robots["/b"],), layout="both",
    )  # fmt: skip


def test_views_of_several_domains_are_one_with_the_worst_of_each() -> None:
    def view(at: int, settled: str, seconds: float) -> System:
        name = f"/n{at}"
        return System(
            nodes=(Node(name),), ends=(End(TOPIC, PUBLISHES, name, "", "", name, None, ""),),
            edges=(Edge(name, "p", "/tf", False, (name,)),), heard=(Heard(name, "f"),),
            parameters=(Parameter(name, "p", "1"),), controllers=(Controller(name, "c", "active"),),
            environment=Environment(
                at, "SUBNET", (), "rmw", participants=at, settled=settled, seconds=seconds,
                caveats=(Caveat("c", True, f"m{at}"),),
            ),
        )  # fmt: skip

    first, second = view(3, "quiet", 2.0), view(4, "timeout", 1.0)
    assert side_by_side({3: first}) == first
    found = side_by_side({3: first, 4: second})
    assert found == System(
        *(one + other for one, other in zip(first[:3], second[:3], strict=True)),
        environment=Environment(
            3, "SUBNET", (), "rmw", participants=7, settled="timeout", seconds=2.0,
            caveats=(Caveat("c", True, "domain 3: m3"), Caveat("c", True, "domain 4: m4")),
        ),
        heard=first.heard + second.heard, parameters=first.parameters + second.parameters,
        controllers=first.controllers + second.controllers,
    )  # fmt: skip
    below = named(first, 3)
    assert below == first._replace(
        nodes=(Node("/domain_3/n3"),),
        ends=(End(TOPIC, PUBLISHES, "/domain_3/n3", "", "", "/domain_3/n3", None, ""),),
        edges=(Edge("/n3", "p", "/domain_3/tf", False, ("/domain_3/n3",)),),
        heard=(Heard("/domain_3/n3", "f"),), parameters=(Parameter("/domain_3/n3", "p", "1"),),
        controllers=(Controller("/domain_3/n3", "c", "active"),),
    )  # fmt: skip


def test_a_finding_speaks_of_what_runs_in_its_domain() -> None:
    told = Finding(
        "MG102", "error", "/domain_3/a/b lacks domain_4, domain_34", "start /domain_4/c",
        robot="domain_3", node="/domain_3/a", names=("/domain_3/x", "/y"),
    )  # fmt: skip
    assert unnamed(told) == Finding(
        "MG102", "error", "/a/b of domain 3 lacks domain 4, domain 34", "start /c of domain 4",
        robot="domain 3", node="/a", names=("/x", "/y"),
    )  # fmt: skip


def as_planned() -> dict[int, System]:
    """Return what is seen of each domain where all runs."""
    found = {}
    for number, part in by_domain(plan()).items():
        nodes = tuple(Node(it.name, f"p{at}") for at, it in enumerate(part.nodes))
        ends = tuple(it._replace(code_name="") for it in part.ends)
        around = Environment(domain=number, rmw="rmw_fastrtps_cpp")
        found[number] = System(nodes, ends, environment=around)
    return found


def without(seen: System, *nodes: str) -> System:
    return seen._replace(
        nodes=tuple(it for it in seen.nodes if it.name not in nodes),
        ends=tuple(it for it in seen.ends if it.node not in nodes),
    )


def found_in(seen: dict[int, System]) -> list[Finding]:
    return check_domains(plan(), seen)


def test_all_as_planned_is_quiet() -> None:
    assert found_in(as_planned()) == []


def test_a_robot_in_the_domain_of_another_is_told_once() -> None:
    seen = as_planned()
    moved = [it for it in seen[12].nodes if it.name.startswith("/robot2/")]
    ends = [it for it in seen[12].ends if it.node.startswith("/robot2/")]
    seen[12] = without(seen[12], *(it.name for it in moved))
    seen[11] = seen[11]._replace(nodes=(*seen[11].nodes, *moved), ends=(*seen[11].ends, *ends))
    about = [it for it in found_in(seen) if "robot2" in (it.robot, it.node.split("/")[1:2] or "")]
    hints = {it.hint for it in about if it.code in ("MG101", "MG109")}
    assert hints == {"it runs in domain 11: start it with ROS_DOMAIN_ID=12"}
    assert not [it for it in found_in(seen) if it.code == "MG108"]


def saved(folder: Path, seen: dict[int, System]) -> list[str]:
    words = []
    for number, view in seen.items():
        file = folder / f"{number}.json"
        file.write_bytes(to_json(view))
        words += ["--from", str(file)]
    return words


def test_saved_snapshots_are_told_apart_by_their_domains(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "plan.yaml").write_text(to_yaml(plan()))
    words = ["check", str(tmp_path / "plan.yaml")]
    seen = as_planned()
    assert main([*words, *saved(tmp_path, seen)]) == 0
    broken = {**seen, 11: without(seen[11], "/robot1/drive")}
    capsys.readouterr()
    assert main([*words, *saved(tmp_path, broken)]) == 1
    assert "in domain 11" in capsys.readouterr().out
    # One domain alone, and too few of them.
    one = saved(tmp_path, {12: broken[12]})
    assert main([*words, "--domain", "12", *one]) == 0
    assert main([*words, *one]) == 2
    assert "give one of each of 10, 11, 12" in capsys.readouterr().err
    assert main([*words, "--domain", "13"]) == 2
    assert "the plan has no node there; it has 10, 11, 12" in capsys.readouterr().err


SCAN, TWIST = "sensor_msgs/msg/LaserScan", "geometry_msgs/msg/Twist"


def running(number: int, space: str = "", left_out: str = "") -> System:
    """Return a whole robot, without plan: in its namespace, or without one."""
    ends = [
        End(TOPIC, role, f"{space}/{name}", type_, "", f"{space}/{node}", None, node)
        for node, role, name, type_ in (
            ("driver", PUBLISHES, "odom", ODOM),
            ("driver", SUBSCRIBES, "cmd_vel", TWIST),
            ("lidar", PUBLISHES, "scan", SCAN),
            ("safety", SUBSCRIBES, "scan", SCAN),
            ("planner", SUBSCRIBES, "odom", ODOM),
            ("planner", PUBLISHES, "cmd_vel", TWIST),
        )
        if node != left_out
    ]
    nodes = tuple(Node(it, it) for it in dict.fromkeys(it.node for it in ends))
    around = Environment(domain=number, rmw="rmw_fastrtps_cpp", participants=len(nodes))
    return System(nodes, tuple(ends), environment=around)


@pytest.mark.parametrize("spaces", [("", ""), ("/robot1", "/robot2")])
def test_without_a_plan_each_domain_is_judged_and_its_robot_held_against_the_others(
    spaces: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two robots with the same names in two domains, as they come from their makers, and two with
    names."""
    healthy = {at: running(at, it) for at, it in zip((11, 12), spaces, strict=True)}
    assert main(["check", *saved(tmp_path, healthy)]) == 0
    shown = capsys.readouterr().err
    assert "domain 11: " in shown and "; 0 findings: nothing wrong seen" in shown
    broken = {**healthy, 12: running(12, spaces[1], "lidar")}
    page = tmp_path / "page.html"
    words = ["check", *saved(tmp_path, broken), "--fail-on", "warning", "--report", str(page)]
    assert main(words) == 1
    (line,) = capsys.readouterr().out.splitlines()
    who, like = (it.strip("/") for it in spaces) if spaces[0] else ("domain 11", "domain 12")
    lidar = f"{spaces[0]}/lidar" if spaces[0] else "/lidar of domain 11"
    assert f"{like} has no lidar, as {who} has ({lidar})" in line
    assert page.read_text()
    first = tmp_path / "first"
    words = ["check", *saved(tmp_path, healthy), "--suggest", str(first)]
    assert (main(words), main(words)) == (0, 2)
    assert f"{first / 'domain11' / 'fleet.yaml'} is there already" in capsys.readouterr().err
    for at in healthy:
        one = ["--from", str(tmp_path / f"{at}.json")]
        assert main(["check", str(first / f"domain{at}" / "plan.yaml"), *one]) == 0
    assert main(["check", *one, "--suggest", str(tmp_path / "one")]) == 0
    assert (tmp_path / "one" / "plan.yaml").exists()


def test_what_a_robot_lacks_and_another_domain_has_is_told_with_it() -> None:
    """A lidar that was started with another ROS_DOMAIN_ID."""
    whole = running(12, "/robot2")
    lost = [it for it in whole.nodes if it.name != "/robot2/lidar"]
    stray = [it for it in whole.ends if it.node == "/robot2/lidar"]
    seen = {
        0: System((Node("/robot2/lidar", "l"),), tuple(stray), environment=Environment(domain=0)),
        11: running(11, "/robot1"),
        12: whole._replace(
            nodes=tuple(lost), ends=tuple(it for it in whole.ends if it not in stray)
        ),
    }
    found = diagnose_domains({it: diagnose(view) for it, view in seen.items()}).findings
    hints = {it.hint for it in found if "/robot2/scan" in it.names}
    assert hints == {"/robot2/lidar of domain 0 has it: start both in one domain, or bridge it"}
