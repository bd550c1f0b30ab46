# SPDX-License-Identifier: Apache-2.0
"""Ends that nothing gives, where the code of their nodes is known, asked of small systems."""

from __future__ import annotations

import pytest
from graph_calls import ALONE, Index, absences, index

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.system.records import RUNS, End, Place, Sure, System

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
    """Return the names that are meant by what is open, empty where none is known."""
    return [it.names[1] if it.code == "MG303" else "" for it in told(*ends)]


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
