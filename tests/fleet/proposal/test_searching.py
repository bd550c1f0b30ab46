# SPDX-License-Identifier: Apache-2.0
"""Which files of folders are robots, and which are beside them: by their names and their texts."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from paths import CORPUS, FIXTURES

from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.cli import urdf_postfix
from multibot_rewrite.proposal import searching
from multibot_rewrite.proposal.searching import Found, search

ROBOT = '<robot name="r"/>'
PARAMS = "a:\n  ros__parameters: {b: 1}\n"
KINDS = [
    ("r.urdf", ROBOT, "descriptions"), ("r.urdf", "<other/>", ""),
    ("r.xacro", ROBOT, "descriptions"), ("r.xacro", "<robot xmlns:a='b'/>", ""),
    ("r.srdf.xacro", ROBOT, "srdf"), ("r.xacro", '<robot name="r"><group name="g"/></robot>', "srdf"),
    ("r.sdf", "<sdf><model/></sdf>", "descriptions"),
    ("r.model", "<sdf><model/></sdf>", "descriptions"),
    ("r.model", "ply", ""), ("r.sdf", "<sdf><world/></sdf>", "worlds"),
    ("w.world", "<sdf><world/></sdf>", "worlds"), ("r.sdf", "<sdf/>", ""),
    ("r.sdf", "<sdf><model><static> true </static></model></sdf>", ""),
    ("r.sdf", "<sdf><model><static>1</static></model></sdf>", ""),
    ("r.sdf", "<sdf><model><static>false</static></model></sdf>", "descriptions"),
    ("r.srdf", "", "srdf"), ("v.rviz", "", "rviz"), ("p.yaml", PARAMS, "params"),
    ("p.yml", PARAMS, "params"),
    *(
        (f"b{at}.yaml", text, "bridge")
        for at, text in enumerate(("- ros_topic_name: a", "-  gz_topic_name : a", "-\n  topic_name: a"))
    ),
    *(
        (f"{it}.yaml", "a: 1", "moveit")
        for it in (
            "kinematics", "joint_limits", "ompl_planning", "moveit_controllers", "sensors_3d",
            "moveit_servo",
        )
    ),
    ("other.yaml", "a: 1", ""), ("t.xml", "<root><BehaviorTree/></root>", "behavior_trees"),
    ("t.xml", "<root/>", ""), ("a.launch.py", "", "launch"), ("a_launch.yaml", PARAMS, "launch"),
    ("a.launch.xml", "", "launch"), ("launch.py", "", ""), ("a.txt", ROBOT, ""),
    ("launch/up.py", "def generate_launch_description():", "launch"), ("launch/up.py", "", ""),
    ("launch/up.xml", "<launch/>", "launch"), ("up.py", "def generate_launch_description():", ""),
    # A bridge is a list: a file of knowledge with the same word is none that is wrong.
    ("r.yaml", "# rows\n---\n- topic_name: a\n", "bridge"), ("r.yaml", "[{topic_name: a}]\n", ""),
    ("r.yaml", "nodes:\n  - topic_name: a\n", ""), ("r.yaml", "", ""),
]  # fmt: skip


def test_a_description_in_no_package_has_no_files_of_packages(tmp_path: Path) -> None:
    """A folder that is named has them."""
    for name in ("r.urdf", "p.yaml", "other/v.rviz", "other/launch/a.launch.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(ROBOT if name == "r.urdf" else PARAMS)
    (tmp_path / "other" / "package.xml").write_text("<package><name>other</name></package>")
    own, every = search([str(tmp_path / "r.urdf")]), search([str(tmp_path)])
    assert (own.rviz, own.launch, own.params) == ((), (), (str(tmp_path / "p.yaml"),))
    assert every.rviz and every.launch and every.params == own.params


@pytest.mark.parametrize(("name", "text", "kind"), KINDS, ids=[f"{a}-{c}" for a, _, c in KINDS])
def test_a_file_is_for_one_thing(name: str, text: str, kind: str, tmp_path: Path) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text(text)
    found = search([str(tmp_path)])
    path = str(tmp_path / name)
    kinds = {it for it in Found._fields if path in getattr(found, it) and it != "every"}
    assert kinds == ({kind} if kind else set())
    assert found.every == found.descriptions and found.folders == (str(tmp_path),)


def put(folder: Path, **files: str) -> None:
    for name, text in files.items():
        path = folder / name.replace("__", "/").replace("_dot_", ".")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


CART = """\
<robot name="cart"><link name="base_link"/><link name="laser"/><joint name="j" type="fixed">
<parent link="base_link"/><child link="laser"/></joint></robot>
"""
NAV2 = (
    "amcl:\n  ros__parameters: {odom_frame_id: odom, base_frame_id: base_link, scan_topic: scan}\n"
)


@pytest.mark.parametrize("layout", ["postfix", "frames-per-robot"])
def test_what_urdf_postfix_wrote_beside_its_source_is_none(layout: str, tmp_path: Path) -> None:
    put(tmp_path, cart_dot_urdf=CART, nav2_dot_yaml=NAV2)
    urdf, nav2 = (str(tmp_path / it) for it in ("cart.urdf", "nav2.yaml"))
    named = ("robot1", "--layout", layout, "-q", "-o")
    assert urdf_postfix.main([urdf, *named, str(tmp_path / "a_cart.urdf")]) == 0
    assert urdf_postfix.main([nav2, *named, str(tmp_path / "z.yaml"), "--urdf", urdf]) == 0
    found = search([str(tmp_path)])
    assert (found.every, found.params) == ((urdf,), (nav2,))
    # One that is named is meant.
    assert str(tmp_path / "z.yaml") in search([urdf, str(tmp_path / "z.yaml")]).params


def test_a_variant_of_a_file_is_not_taken_for_a_robots_copy(tmp_path: Path) -> None:
    """It has another name at one link, or as its own; a frame of it is called otherwise."""
    texts = [CART, CART.replace('"cart"', '"cart_two"'), CART.replace("laser", "laser_two")]
    texts += [CART.replace('"b', '"b1').replace('"l', '"l1')]
    put(tmp_path, **{f"cart{at}_dot_urdf": text for at, text in enumerate(texts)})
    put(tmp_path, a_dot_yaml=NAV2, b_dot_yaml=NAV2.replace("base_link", "base_link_two"))
    found = search([str(tmp_path)])
    assert (len(found.every), len(found.params)) == (4, 2)


@pytest.mark.parametrize(
    ("included", "left"),
    [
        ("part.xacro", False), ("./part.xacro", False), ("sub/part.xacro", True), ("other.xacro", True),
        ("$(find p)/urdf/part.xacro", False), ("$(find-pkg-share p)/urdf/part.xacro", False),
        ("$(find q)/urdf/part.xacro", True), ("${dir}/part.xacro", False), ("/a/part.xacro", False),
    ],
)  # fmt: skip
def test_what_another_file_includes_is_no_robot(included: str, left: bool, tmp_path: Path) -> None:
    include = f'<robot name="r" xmlns:xacro="x"><xacro:include filename="{included}"/></robot>'
    put(tmp_path, package_dot_xml="<package><name>p</name></package>", urdf__part_dot_xacro=ROBOT,
        urdf__all_dot_xacro=include)  # fmt: skip
    found = [Path(it).name for it in search([str(tmp_path)]).descriptions]
    assert found == (["all.xacro", "part.xacro"] if left else ["all.xacro"])


def test_a_folder_with_too_many_files_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    put(tmp_path, a_dot_urdf=ROBOT, b_dot_txt="")
    monkeypatch.setattr(searching, "MOST_FILES", 2)
    assert len(search([str(tmp_path)]).descriptions) == 1
    monkeypatch.setattr(searching, "MOST_FILES", 1)
    with pytest.raises(
        UsageError, match=r"it has more than 1 files; name the folder of one package"
    ):
        search([str(tmp_path)])


def _refusal(path: str) -> str:
    """Return what a file is refused with that is named alone; empty for one that is taken."""
    try:
        taken = search([path]).descriptions
    except InputError as error:
        return str(error)
    assert taken == (os.path.normpath(path),)
    return ""


ENDS = (".urdf", ".sdf", ".model", ".world", ".xacro", ".srdf")


@pytest.mark.more
@pytest.mark.parametrize(
    "home", [FIXTURES, CORPUS / "sdf", CORPUS / "srdf", CORPUS / "urdf"], ids=lambda it: it.name
)
def test_a_named_file_and_its_folder_have_one_answer(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a folder takes for a description is taken by its name, and what it takes for something else
    is refused by its name."""
    # Each is alone in its folder: no other file includes it.
    alone: list[str] = []
    monkeypatch.setattr(searching, "home_of", os.path.dirname)
    monkeypatch.setattr(searching, "_candidates", lambda *_: alone)
    paths = [str(it) for it in sorted(home.rglob("*")) if it.name.endswith(ENDS)]
    for path in paths[:: max(1, len(paths) // 300)]:
        alone[:] = [path]
        found = search([os.path.dirname(path)])
        refused = "" if path.endswith(".srdf") else _refusal(path)
        assert not (path in found.every and refused), path
        assert not (path in (*found.worlds, *found.launch) and not refused), path
        # A xacro of an SRDF can be named: what is in it is known only when it is expanded.
        assert path not in found.srdf or refused or path.endswith((".xacro", ".srdf")), path
