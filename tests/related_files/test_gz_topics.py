# SPDX-License-Identifier: Apache-2.0
"""Topics of Gazebo as the rewritten description and the spawned model have them."""

from __future__ import annotations

import pytest
from made_params import L2, L4, setting

from multibot_rewrite.related_files.bridge import MODEL_SLOT, gz_topic
from multibot_rewrite.related_files.context import NAMESPACE_SLOT as SPACE, TAG_SLOT as TAG

CLOUD = "gz.msgs.PointCloudPacked"


@pytest.mark.parametrize(
    ("policy", "name", "gz_type", "new"),
    [
        (L4, "/lidar/points", CLOUD, f"/lidar/{SPACE}/points"),
        (L4, "/a/lidar/points", CLOUD, f"/a/lidar/{SPACE}/points"),
        (L4, "/lidar/points", "gz.msgs.Image", f"/lidar/points/{SPACE}"),
        (L4, "/lidar/cloud", CLOUD, f"/lidar/cloud/{SPACE}"),
        (L4, "points", CLOUD, f"points/{SPACE}"),
        (L2, "/lidar/points", CLOUD, f"/{SPACE}/lidar/points"),
        (L2, "scan", "", f"{SPACE}/scan"),
        # Of the whole simulation.
        (L2, "/clock", "", "/clock"),
        (L2, "/stats", "", "/stats"),
        (L2, "/world/w/pose", "", "/world/w/pose"),
        (L2, "/worlds", "", f"/{SPACE}/worlds"),
        # Below a model; what the description does not declare stays.
        (L2, "/model/rover/odom", "", f"/model/{MODEL_SLOT}/odom"),
        (L2, "/model/rover", "", f"/model/{MODEL_SLOT}"),
        (L2, "model/rover/tf", "", f"model/{MODEL_SLOT}/tf"),
        (L2, "/model/rover/joint/elbow/cmd", "", f"/model/{MODEL_SLOT}/joint/{TAG}_elbow/cmd"),
        (L4, "/model/rover/joint/other/cmd", "", f"/model/{MODEL_SLOT}/joint/other/cmd"),
        (
            L4, "/world/w/model/rover/link/laser/sensor/imu_sensor/imu", "",
            f"/world/w/model/{MODEL_SLOT}/link/laser/{TAG}/sensor/imu_sensor_{TAG}/imu",
        ),
        # A launch file fills it in.
        (L2, "${name}/scan", "", "${name}/scan"),
        (L2, "/model/rover/${x}", "", "/model/rover/${x}"),
    ],
)  # fmt: skip
def test_a_topic_of_the_simulator(
    policy: tuple[str, str], name: str, gz_type: str, new: str
) -> None:
    assert gz_topic(setting(policy), name, gz_type) == new


@pytest.mark.parametrize("ending", ["image", "depth_image", "camera_info", "points"])
def test_a_sensor_sends_below_the_topic_that_the_description_gives(ending: str) -> None:
    """gz-sensors RgbdCameraSensor.cc puts each behind the sensor's topic."""
    context = setting(L4)
    context = context._replace(names=context.names._replace(given=frozenset({"eye", "eye/image"})))
    new = {"image": f"/eye/image/{SPACE}"}.get(ending, f"/eye/{SPACE}/{ending}")
    assert gz_topic(context, f"/eye/{ending}") == new


def test_points_are_below_a_topic_of_a_model_that_the_description_gives() -> None:
    """gz-sensors GpuLidarSensor.cc adds /points to the topic, whatever words that has."""
    context = setting(L2)
    given = frozenset({"model/rover/lidar"})
    context = context._replace(names=context.names._replace(given=given))
    named = gz_topic(context, "/model/rover/lidar")
    assert MODEL_SLOT not in named
    assert gz_topic(context, "/model/rover/lidar/points") == f"{named}/points"


@pytest.mark.parametrize("topic", ["/clock", "/stats", "clock"])
def test_topics_of_the_simulator_are_so_whatever_robots_share(topic: str) -> None:
    assert gz_topic(setting(L2, shared_topics=()), topic) == topic
