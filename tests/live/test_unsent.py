# SPDX-License-Identifier: Apache-2.0
"""Ends that nothing gives, where the code of their nodes is known, asked of small systems."""

from __future__ import annotations

import pytest
from graph_calls import ALONE, Index, absences, index

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.rules.system.unsent import open_ends
from multibot_rewrite.system.records import MAY, RUNS, End, Place, Sure, System

IMU, SCAN = "sensor_msgs/msg/Imu", "sensor_msgs/msg/LaserScan"
HERE = Place("bridge.yaml", 4)


def end(
    node: str, role: str, name: str, type_: str = IMU, kind: str = "topic", sure: Sure = RUNS
) -> End:
    own = (kind, role, name, type_, "", f"/{node}", None, "", name.rpartition("/")[2])
    return End(*own, sure=sure, place=HERE)


READS = end("ekf", "subscribes", "/r/imu/data")


def seen(*ends: End) -> Index:
    return index(System(ends=ends), ALONE)


def told(*ends: End) -> list[Finding]:
    return absences(seen(READS, *ends))


def meant(*ends: End) -> list[str]:
    """The names that are meant by what is open, empty where none is known."""
    return [it.names[1] if it.code == "MG303" else "" for it in told(*ends)]


def test_what_nothing_sends_is_a_note() -> None:
    (found,) = told()
    assert (found.code, found.level, found.names) == ("MG316", "note", ("/r/imu/data",))


def test_another_reader_or_another_kind_closes_nothing() -> None:
    assert meant(end("other", "subscribes", "/r/imu/data")) == [""]
    assert meant(end("bridge", "serves", "/r/imu/data", kind="service")) == [""]


def test_a_client_needs_its_server() -> None:
    calls = end("lifecycle", "calls", "/r/load_map", "nav2_msgs/srv/LoadMap", "service")
    assert [it.name for it in open_ends(seen(calls))] == ["/r/load_map"]
    assert open_ends(seen(calls, calls._replace(node="/map_server", role="serves"))) == []


def test_an_action_sends_its_status() -> None:
    status = end("bt", "subscribes", "/r/go/_action/status", "action_msgs/msg/GoalStatusArray")
    served = end("driver", "serves", "/r/go", "nav2_msgs/action/NavigateToPose", "action")
    assert open_ends(seen(status, served)) == []


def test_the_only_topic_of_its_type_is_meant_and_where_it_is() -> None:
    other = end("bridge", "publishes", "/r/other_name")._replace(place=Place("b.yaml", 7))
    (found,) = told(other)
    assert found.names == ("/r/imu/data", "/r/other_name")
    assert (found.file, found.line) == HERE[:2]
    assert "see b.yaml:7" in found.hint


@pytest.mark.parametrize(
    "sent",
    [
        end("bridge", "publishes", "/r/gyro", SCAN),
        end("bridge", "publishes", "/r/gyro", ""),
        end("ekf", "publishes", "/r/gyro"),
        end("bridge", "serves", "/r/gyro", kind="service"),
    ],
    ids=["another type", "no type", "its own", "a service"],
)
def test_what_is_not_meant(sent: End) -> None:
    assert meant(sent) == [""]


def test_of_several_the_one_with_the_same_last_word_is_meant() -> None:
    sent = [end("bridge", "publishes", it) for it in ("/r/imu_raw/dat", "/r/gyro_front/data")]
    assert meant(*sent) == ["/r/gyro_front/data"]


def test_of_several_with_that_word_the_one_most_like_it_is_meant() -> None:
    sent = [end("bridge", "publishes", it) for it in ("/r/gyroscope/data", "/r/imu0/data")]
    assert meant(*sent) == ["/r/imu0/data"]


def test_what_people_send_is_open_for_nobody() -> None:
    command = end("drive", "subscribes", "/r/cmd_vel")
    remapped = command._replace(name="/r/drive_input")
    assert open_ends(seen(command, remapped)) == []
    assert open_ends(seen(remapped._replace(code_name="input"))) != []


def test_an_end_on_a_condition_or_of_unknown_code_needs_nothing() -> None:
    assert open_ends(seen(READS._replace(sure=MAY))) == []
    assert open_ends(seen(READS._replace(code_name=""))) == []
