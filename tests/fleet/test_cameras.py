# SPDX-License-Identifier: Apache-2.0
"""Nodes of images hear the one camera of their robot; else the build says that nothing sends.

Sources: ros-perception/image_pipeline humble 2a662bdb1, rolling 30b982af4 (since Jazzy) image_proc/src/
debayer.cpp, rectify.cpp, depth_image_proc/src/*.cpp; image_common camera_common.cpp getCameraInfoTopic.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import FIXTURES
from plans import ends_of

from multibot_rewrite.cli.multibot import main
from multibot_rewrite.planning.plan import read_plan

IMAGE, INFO = "sensor_msgs/msg/Image", "sensor_msgs/msg/CameraInfo"
CLASSIC = FIXTURES / "robots" / "rover.urdf"
WAITS = "warning: MF861"


def camera(topic: str, kind: str = "camera") -> str:
    inside = f"<topic>{topic}</topic><gz_frame_id>base_link</gz_frame_id><camera/>"
    return f'<sensor name="{topic[:3]}" type="{kind}">{inside}</sensor>'


def robot(folder: Path, *cameras: str) -> Path:
    """Return a description in gz-sim with these cameras."""
    file = folder / "robot.urdf"
    file.write_text(
        '<robot name="rover"><link name="base_link"><inertial><mass value="1"/><inertia ixx="0.1" '
        'iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        f'<gazebo reference="base_link">{"".join(cameras)}</gazebo></robot>'
    )
    return file


def built(
    folder: Path, release: str, layout: str, node_set: str, description: Path, more: str = ""
) -> Path:
    """Return the folder that is built for two robots, without an error."""
    fleet, out = folder / "fleet.yaml", folder / "out"
    fleet.write_text(
        f"distro: {release}\nlayout: {layout}\nsimulator: gazebo\nnode_sets: [{node_set}]\n"
        f"description: {description}\n{more}"
        "robots: [{name: robot1, pose: {y: 0.0}}, {name: robot2, pose: {y: 3.0}}]\n"
    )
    assert main(["build", str(fleet), "-o", str(out), "-q"]) == 0
    return out


def heard(out: Path, node: str, *types: str) -> set[str]:
    """Return the topics of these types that a node hears by the plan, whoever listens to it."""
    plan = read_plan((out / "plan.yaml").read_bytes(), "plan.yaml")
    found = (it for it in ends_of(plan, node) if it.role == "subscribes")
    return {it.name for it in found if it.type in types}


@pytest.mark.parametrize("release", ["humble", "jazzy", "lyrical"])
@pytest.mark.parametrize(
    ("layout", "nodes", "names"),
    [
        ("tf-per-robot", "/robot1/{}", ("/robot1/front/image_raw", "/robot1/front/camera_info")),
        ("postfix", "/{}_robot1", ("/front/image_raw/robot1", "/front/camera_info/robot1")),
    ],
)
def test_a_debayer_and_its_rectifiers_hear_the_camera(
    release: str, layout: str, nodes: str, names: tuple[str, str], tmp_path: Path
) -> None:
    """debayer.cpp: image_raw; rectify.cpp: the camera_info beside its image."""
    out = built(tmp_path, release, layout, "image_proc", robot(tmp_path, camera("front/image_raw")))
    image, info = names
    assert heard(out, nodes.format("debayer_node"), IMAGE) == {image}
    for it in ("rectify_mono_node", "rectify_color_node"):
        assert heard(out, nodes.format(it), INFO) == {info}
    # Since Jazzy the node asks for /image_mono/camera_info, made of /image_mono/robot1.
    asked = (
        "camera_info" if release == "humble" or layout != "postfix" else "image_mono/camera_info"
    )
    target = "f'front/camera_info/{name}'" if layout == "postfix" else "'front/camera_info'"
    assert f"('{asked}', {target})" in (out / "fleet.launch.py").read_text()


@pytest.mark.parametrize(
    ("space", "layout", "node", "camera"),
    [
        ("", "postfix", "/{}_robot2", "/front_robot2/"),
        ("demo", "postfix", "/{}_robot2", "/demo/front_robot2/"),
        ("demo", "both", "/robot2/{}", "/robot2/demo/front/"),
        ("demo", "tf-per-robot", "/robot2/{}", "/robot2/demo/front/"),
    ],
)
def test_the_topics_of_a_classic_camera_are_below_its_name(
    space: str, layout: str, node: str, camera: str, tmp_path: Path
) -> None:
    """gazebo_ros_camera.cpp: they are below its camera_name, in the namespace of its node."""
    name, file = "<camera_name>front</camera_name>", tmp_path / "rover.urdf"
    within = f"<ros><namespace>{space}</namespace></ros>" if space else ""
    file.write_text(CLASSIC.read_text().replace(name, f"{within}{name}"))
    out = built(tmp_path, "humble", layout, "image_proc", file)
    assert heard(out, node.format("debayer_node"), IMAGE) == {f"{camera}image_raw"}
    assert heard(out, node.format("rectify_mono_node"), INFO) == {f"{camera}camera_info"}


@pytest.mark.parametrize("release", ["humble", "lyrical"])
def test_depths_are_no_colours(release: str, tmp_path: Path) -> None:
    """gz-sensors RgbdCameraSensor.cc: <topic>/image and /depth_image, with one camera_info."""
    description = robot(tmp_path, camera("eye", "rgbd_camera"))
    node_set = "image_proc, PointCloudXyzNode, PointCloudXyzrgbNode"
    out = built(tmp_path, release, "tf-per-robot", node_set, description)
    assert heard(out, "/robot1/debayer_node", IMAGE) == {"/robot1/eye/image"}
    assert heard(out, "/robot1/PointCloudXyzNode", IMAGE) == {"/robot1/eye/depth_image"}
    assert heard(out, "/robot1/PointCloudXyzNode", INFO) == {"/robot1/eye/camera_info"}
    both = {"/robot1/eye/depth_image", "/robot1/eye/image"}
    assert heard(out, "/robot1/PointCloudXyzrgbNode", IMAGE) == both


@pytest.mark.parametrize("release", ["humble", "lyrical"])
@pytest.mark.parametrize(
    ("cameras", "has"),
    [
        ((), "its description has no camera"),
        (("front/image_raw", "rear/image_raw"), "send front/image_raw, rear/image_raw"),
    ],
    ids=["none", "two"],
)
def test_a_node_that_waits_for_ever_is_told(
    release: str,
    cameras: tuple[str, ...],
    has: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    description = robot(tmp_path, *map(camera, cameras))
    out = built(tmp_path, release, "tf-per-robot", "image_proc", description)
    every = capsys.readouterr().err
    (told,) = (it for it in every.splitlines() if WAITS in it)
    # What is made of the missing image is no other name of it.
    assert cameras or "MG303" not in every
    nodes = "debayer_node, rectify_mono_node, rectify_color_node"
    assert f"nothing sends image_raw, camera_info to {nodes} of 'robot1'" in told
    assert has in told
    assert heard(out, "/robot1/debayer_node", IMAGE) == {"/robot1/image_raw"}


def test_of_two_ends_none_is_surely_the_one_camera(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """register.cpp: the infos of a depth camera and of another one."""
    description = robot(tmp_path, camera("eye", "rgbd_camera"))
    out = built(tmp_path, "humble", "tf-per-robot", "RegisterNode", description)
    infos = {"/robot1/depth/camera_info", "/robot1/rgb/camera_info"}
    assert heard(out, "/robot1/RegisterNode", INFO) == infos
    assert WAITS in capsys.readouterr().err


@pytest.mark.parametrize("kind", ["thermal_camera", "depth_camera"])
def test_infos_beside_the_images_of_two_robots_are_one_error_with_its_remedy(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """ThermalCameraSensor.cc, DepthCameraSensor.cc: AdvertiseInfo asks a CameraSensor that was not
    loaded for <camera_info_topic>, and takes the place beside the image."""
    description = robot(tmp_path, camera("eye", kind))
    built(tmp_path, "jazzy", "postfix", "rviz", description, "topics: namespace\n")
    capsys.readouterr()
    fleet = tmp_path / "fleet.yaml"
    fleet.write_text(fleet.read_text().replace("topics: namespace\n", ""))
    assert main(["build", str(fleet), "-o", str(tmp_path / "out")]) == 1
    (told,) = (it for it in capsys.readouterr().err.splitlines() if " error: " in it)
    assert "robot.urdf" in told and "use topics: namespace" in told
