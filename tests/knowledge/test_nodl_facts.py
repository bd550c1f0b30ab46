# SPDX-License-Identifier: Apache-2.0
"""NoDL documents in their places, and what the facts of nodes become by them."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.knowledge.node_sets import built_in, user_library
from multibot_rewrite.knowledge.nodl.document import Parameter
from multibot_rewrite.knowledge.nodl.lookup import (
    INDEX,
    NONE,
    Identity,
    NodeKnowledge,
    _frames,
    find_interfaces,
    load,
    nodes_of,
)
from multibot_rewrite.knowledge.records import Endpoint, FrameParameter, NodeFacts, SentTransform
from multibot_rewrite.system.records import PUBLISHES, SUBSCRIBES

QOS = "qos: {history: KEEP_ALL, reliability: RELIABLE}"
STRING = f"type: std_msgs/msg/String, {QOS}"


def document(*publishers: str, include: str = "", more: str = "") -> str:
    ends = "".join(f"  - {{name: {name}, {STRING}}}\n" for name in publishers)
    included = f"include: [{{ref: '{include}'}}]\n" if include else ""
    return f"nodl_version: 2\n{included}{more}" + (f"publishers:\n{ends}" if ends else "")


def written(folder: Path, name: str, text: str) -> str:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return str(path)


def installed(prefix: Path, key: str, text: str) -> str:
    return written(prefix / INDEX, key, text)


def node_of(node_set: str, *paths: str) -> NodeFacts:
    (node,) = nodes_of(NodeKnowledge(built_in(NEWEST_LTS), find_interfaces(paths)), node_set)
    return node


def ends(node: NodeFacts, role: str = PUBLISHES) -> dict[str, Endpoint]:
    return {end.name: end for end in node.endpoints if end.role == role}


# ---------------------------------------------------------------- where documents are


def test_an_installed_document_is_found_by_package_and_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "overlay", tmp_path / "underlay"
    installed(first, "nav2_amcl__amcl", document("brand_new"))
    installed(second, "nav2_amcl__amcl", document("hidden_by_the_overlay"))
    installed(second, "other_package__map_server", document("not_of_nav2"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{first}:{second}:{tmp_path / 'missing'}")
    amcl = node_of("amcl")
    assert amcl.interface == str(first / INDEX / "nav2_amcl__amcl")
    assert "brand_new" in ends(amcl)
    assert "hidden_by_the_overlay" not in ends(amcl)
    assert node_of("map_server").interface == ""
    assert node_of("amcl", "none").interface == ""


def test_a_given_document_is_above_an_installed_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed(tmp_path, "nav2_amcl__amcl", document("installed"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    given = written(tmp_path / "given", "nav2_amcl__amcl.nodl.yaml", document("given"))
    assert node_of("amcl", str(tmp_path / "given")).interface == given
    assert node_of("amcl", given).interface == given


def test_the_place_of_a_file_says_which_node_it_is_for(tmp_path: Path) -> None:
    written(tmp_path, "src/acme/package.xml", "<package><name>acme_arm</name></package>")
    written(tmp_path, "src/acme/nodl/gripper.nodl.json", '{"nodl_version": 2}')
    written(tmp_path, "src/nav2_amcl__amcl.nodl.yml", document())
    written(tmp_path, "src/plain.nodl.yaml", document())
    written(tmp_path, "src/local_costmap/local_costmap.nodl.yaml", document())
    written(tmp_path, "src/no_interface.yaml", "a: b\n")
    written(tmp_path, "src/.git/hidden.nodl.yaml", document())
    assert set(find_interfaces([str(tmp_path / "src")]).given) == {
        Identity("acme_arm", "gripper"),
        Identity("nav2_amcl", "amcl"),
        Identity("", "plain"),
        Identity("", "local_costmap/local_costmap"),
    }


def test_a_folder_where_packages_are_installed_is_read_as_such(tmp_path: Path) -> None:
    installed(tmp_path, "acme__gripper", document("grip"))
    assert set(ends(node_of("acme/gripper", str(tmp_path)))) == {"grip"}


def test_two_documents_of_a_node_are_refused(tmp_path: Path) -> None:
    written(tmp_path, "a/acme__gripper.nodl.yaml", document())
    written(tmp_path, "b/acme__gripper.nodl.yaml", document())
    with pytest.raises(UsageError, match=r"two interfaces of acme/gripper: .*a/.* and .*b/.*"):
        find_interfaces([str(tmp_path)])


@pytest.mark.parametrize("name", ["missing", "empty"])
def test_a_path_without_documents_is_refused(name: str, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    with pytest.raises(UsageError, match=name):
        find_interfaces([str(tmp_path / name)])


def test_what_is_not_run_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    installed(tmp_path, "nav2_map_server__map_server", "not: [nodl")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert node_of("amcl").interface == ""
    with pytest.raises(UsageError, match="map_server:"):
        node_of("map_server")


# ---------------------------------------------------------------- includes


def test_included_documents_are_part_of_the_node(tmp_path: Path) -> None:
    written(tmp_path, "acme__base.nodl.yaml", document("/status"))
    written(tmp_path, "common/rest.nodl.yaml", document("rest", include="nodl://acme/base"))
    path = written(
        tmp_path, "acme__arm.nodl.yaml", document("own", include="local://common/rest.nodl.yaml")
    )
    names = [end.name for end in load(path, find_interfaces([str(tmp_path)])).endpoints]
    assert names == ["own", "rest", "/status"]


@pytest.mark.parametrize(
    ("include", "word"),
    [
        ("nodl://acme/nobody", "nodl://acme/nobody is not installed"),
        ("nodl://acme", "is not nodl://PACKAGE/NAME"),
        ("https://example.com/a", "is not nodl://PACKAGE/NAME"),
        ("local://nobody.yaml", "does not exist"),
        ("local://a.nodl.yaml", "included twice"),
    ],
)
def test_an_include_that_leads_nowhere_or_round_is_refused(
    include: str, word: str, tmp_path: Path
) -> None:
    path = written(tmp_path, "a.nodl.yaml", document(include=include))
    with pytest.raises(UsageError) as caught:
        load(path, NONE)
    assert str(caught.value).startswith(f"{path}:2: ")
    assert word in str(caught.value)


def test_a_name_of_two_documents_is_refused(tmp_path: Path) -> None:
    written(tmp_path, "b.nodl.yaml", document("same"))
    path = written(tmp_path, "a.nodl.yaml", document("same", include="local://b.nodl.yaml"))
    with pytest.raises(
        UsageError, match=r"b\.nodl\.yaml: publishes topic same is in .*a\.nodl\.yaml"
    ):
        load(path, NONE)


def test_a_parameter_of_two_documents_is_refused(tmp_path: Path) -> None:
    rate = "parameters: {rate: {type: double, default_value: 1.0}}\n"
    other = written(tmp_path, "b.nodl.yaml", document(more=rate))
    path = written(tmp_path, "a.nodl.yaml", document(include="local://b.nodl.yaml", more=rate))
    with pytest.raises(UsageError) as caught:
        load(path, NONE)
    assert str(caught.value) == f"{other}: parameter rate is in {path} too, which includes it"


# ---------------------------------------------------------------- what a node becomes


def amcl_as(tmp_path: Path, text: str) -> NodeFacts:
    return node_of("amcl", written(tmp_path, "nav2_amcl__amcl.nodl.yaml", text))


def test_a_document_is_above_the_tables(tmp_path: Path) -> None:
    text = (
        "nodl_version: 2\nsubscriptions:\n"
        f"  - {{name: /scan, type: acme_msgs/msg/Scan, {QOS}}}\n"
        "service_servers: [{name: /amcl/get_state, type: lifecycle_msgs/srv/GetState}]\n"
    )
    (before,) = nodes_of(NodeKnowledge(built_in(NEWEST_LTS), NONE), "amcl")
    amcl = amcl_as(tmp_path, text)
    scan = ends(amcl, SUBSCRIBES)["/scan"]
    assert (scan.type, scan.when) == ("acme_msgs/msg/Scan", "")
    assert scan.parameter == ends(before, SUBSCRIBES)["scan"].parameter
    assert "scan" not in ends(amcl, SUBSCRIBES)
    # A document of a running node has private names in full.
    assert ends(amcl, "serves")["~/get_state"].when == ""
    assert "/amcl/get_state" not in ends(amcl, "serves")


def test_rosout_parameters_and_clock_are_left_out(tmp_path: Path) -> None:
    text = document("/rosout", "/parameter_events", "mine") + (
        f"subscriptions: [{{name: /clock, type: rosgraph_msgs/msg/Clock, {QOS}}}]\n"
        "service_servers:\n"
        "  - {name: /driver/get_parameters, type: rcl_interfaces/srv/GetParameters}\n"
        "  - {name: ~/get_type_description, type: type_description_interfaces/srv/GetTypeDescription}\n"
    )
    node = node_of("driver", written(tmp_path, "driver.nodl.yaml", text))
    assert [end.name for end in node.endpoints] == ["mine"]


def test_an_image_and_its_transports_are_one_and_tf_may_be_a_helpers(tmp_path: Path) -> None:
    image, packed = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"
    text = (
        "nodl_version: 2\npublishers:\n"
        f"  - {{name: image, type: {image}, {QOS}}}\n"
        f"  - {{name: image/compressed, type: {packed}, {QOS}}}\n"
        f"  - {{name: map/compressed, type: {packed}, {QOS}}}\n"
        f"  - {{name: eye/left/image, type: {image}, {QOS}}}\n"
        f"  - {{name: eye/left/image/theora, type: {packed}, {QOS}}}\n"
        f"subscriptions:\n  - {{name: /tf, type: tf2_msgs/msg/TFMessage, {QOS}}}\n"
        f"  - {{name: /tf_static, type: {image}, {QOS}}}\n"
        f"  - {{name: other/tf, type: tf2_msgs/msg/TFMessage, {QOS}}}\n"
    )
    node = node_of("lens", written(tmp_path, "lens.nodl.yaml", text))
    assert {name: end.transport for name, end in ends(node).items()} == {
        "image": True,
        "map/compressed": False,
        "eye/left/image": True,
    }
    assert [name for name, end in ends(node, SUBSCRIBES).items() if end.helper] == ["/tf"]
    assert not any(end.helper for end in ends(node).values())


def test_frames_are_the_defaults_of_parameters(tmp_path: Path) -> None:
    more = (
        "parameters:\n"
        "  odom_frame_id: {type: string, default_value: odometry}\n"
        "  new.frame: {type: string, default_value: tool}\n"
        "  frame_rate: {type: double, default_value: 30.0}\n"
        "  frame_id: {type: string}\n"
    )
    amcl = {it.parameter: it.default for it in amcl_as(tmp_path, document(more=more)).frames}
    assert amcl["odom_frame_id"] == "odometry"
    assert amcl["base_frame_id"] == "base_footprint"
    assert "new.frame" not in amcl
    node = node_of("mine", written(tmp_path / "b", "mine.nodl.yaml", document(more=more)))
    assert [tuple(it)[:2] for it in node.frames] == [
        ("odom_frame_id", "odometry"),
        ("new.frame", "tool"),
    ]


def test_a_node_of_a_node_set_keeps_the_node_sets_changes(tmp_path: Path) -> None:
    text = document("/cmd_vel", "local_plan").replace("std_msgs/msg/String", "acme/msg/Velocity")
    path = written(tmp_path, "nav2_controller__controller_server.nodl.yaml", text)
    found = {
        it.name: it
        for it in nodes_of(
            NodeKnowledge(built_in(NEWEST_LTS), find_interfaces([path])), "navigation"
        )
    }
    velocity = ends(found["controller_server"])["/cmd_vel"]
    assert (velocity.remapped, velocity.type) == ("cmd_vel_nav", "acme/msg/Velocity")


def test_a_document_is_found_by_the_usual_name_of_a_node_that_a_node_set_renames(
    tmp_path: Path,
) -> None:
    path = written(
        tmp_path, "nav2_lifecycle_manager__lifecycle_manager.nodl.yaml", document("beat")
    )
    found = {
        it.name: it
        for it in nodes_of(
            NodeKnowledge(built_in(NEWEST_LTS), find_interfaces([path])), "localization"
        )
    }
    assert found["lifecycle_manager_localization"].interface == path


def test_a_document_may_have_the_name_of_the_executable(tmp_path: Path) -> None:
    # robot_localization and slam_toolbox, CMakeLists.txt: add_executable.
    path = written(tmp_path, "robot_localization__ekf_node.nodl.yaml", document("new"))
    assert node_of("ekf_filter_node", path).interface == path
    path = written(tmp_path, "slam_toolbox__sync_slam_toolbox_node.nodl.yaml", document("new"))
    assert node_of("slam_toolbox", path).interface == path


def test_a_node_of_the_users_own_file_stays_and_names_its_document_otherwise(
    tmp_path: Path,
) -> None:
    mine = "nodes:\n  amcl: {package: nav2_amcl, publishes: {mine: std_msgs/msg/String}}\n"
    nodes = written(tmp_path, "mine.yaml", mine)
    library = user_library(nodes, NEWEST_LTS)
    path = written(tmp_path, "nav2_amcl__amcl.nodl.yaml", document("theirs"))
    interfaces = find_interfaces([path])
    (own,) = nodes_of(NodeKnowledge(library, interfaces, frozenset({"amcl"})), "amcl")
    (theirs,) = nodes_of(NodeKnowledge(library, interfaces), "amcl")
    assert (list(ends(own)), list(ends(theirs))) == (["mine"], ["theirs", "mine"])


def test_a_document_alone_is_a_node_set_by_its_name(tmp_path: Path) -> None:
    written(tmp_path, "acme__gripper.nodl.yaml", document("grip"))
    assert node_of("gripper", str(tmp_path)).package == "acme"
    written(tmp_path, "other__gripper.nodl.yaml", document("grip"))
    with pytest.raises(UsageError, match="acme/gripper or other/gripper"):
        node_of("gripper", str(tmp_path))
    assert node_of("other/gripper", str(tmp_path)).package == "other"
    with pytest.raises(UsageError, match="node set 'griper' is not known"):
        node_of("griper", str(tmp_path))


@pytest.mark.parametrize(
    ("known", "frames"),
    [
        (NodeFacts("a", "p", ()), [("base_frame", "body"), ("tool_frame", "tool")]),
        # What the library names is all of it.
        (
            NodeFacts("a", "p", (), frames=(FrameParameter("base_frame", "base"),)),
            [("base_frame", "body")],
        ),
        (NodeFacts("a", "p", (), sends=(SentTransform("base_frame", "tool_frame"),)), []),
    ],
)
def test_which_frames_are_taken_of_a_document(
    known: NodeFacts, frames: list[tuple[str, str]]
) -> None:
    given = (Parameter("base_frame", "string", "body"), Parameter("tool_frame", "string", "tool"))
    assert [
        tuple(it)[:2] for it in _frames(known, (*given, Parameter("x", "string", "y")))
    ] == frames
