# SPDX-License-Identifier: Apache-2.0
"""Which files of folders are robots, and which are beside them: by their names and their texts."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from paths import CORPUS, FIXTURES

from multibot_rewrite import rewrite
from multibot_rewrite.base.model import InputError, UsageError
from multibot_rewrite.fleet.proposal import searching
from multibot_rewrite.fleet.proposal.searching import Found, search, without

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


def test_what_a_build_has_written_is_no_other_robot(tmp_path: Path) -> None:
    made = {"fleet__manifest_dot_json": "{}", "fleet__plan_dot_yaml": "robots: {}"}
    put(tmp_path, own_dot_urdf=ROBOT, fleet__robot1__own_dot_urdf=ROBOT, **made)
    # urdf-postfix alone leaves its mark, as a rewrite of the first robot shows.
    rover = str(FIXTURES / "robots" / "rover.urdf")
    put(tmp_path, out__robot1_dot_urdf=rewrite(rover, "robot1").text)
    assert search([str(tmp_path)]).descriptions == (str(tmp_path / "own.urdf"),)


def test_a_description_in_a_folder_that_is_named_is_there_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The folder as an absolute path, the description as a relative one."""
    put(tmp_path, package_dot_xml="<package><name>p</name></package>", urdf__a_dot_urdf=ROBOT,
        config__p_dot_yaml=PARAMS)  # fmt: skip
    monkeypatch.chdir(tmp_path)
    found = search([str(tmp_path), "urdf/a.urdf"])
    assert found.params == (str(tmp_path / "config" / "p.yaml"),)
    assert found.descriptions == ("urdf/a.urdf",)


def test_hidden_and_built_folders_are_left_out(tmp_path: Path) -> None:
    left = ("build", "install", "log", "node_modules", "test", "tests", "__pycache__", ".git")
    for folder in (*left, "urdf", "builds"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "r.urdf").write_text(ROBOT)
    found = search([str(tmp_path)]).descriptions
    assert found == (str(tmp_path / "builds" / "r.urdf"), str(tmp_path / "urdf" / "r.urdf"))


def test_a_description_that_is_named_goes_with_its_package(tmp_path: Path) -> None:
    put(tmp_path, package_dot_xml="<package><name>p</name></package>", urdf__a_dot_urdf=ROBOT,
        urdf__b_dot_urdf=ROBOT, config__p_dot_yaml=PARAMS)  # fmt: skip
    named = str(tmp_path / "urdf" / "a.urdf")
    found = search([named])
    assert found.descriptions == (named,)
    assert [Path(it).name for it in found.every] == ["a.urdf", "b.urdf"]
    assert [Path(it).name for it in found.params] == ["p.yaml"]
    other = without(found, found.params)
    assert other.params == () and other.every == found.every
    gone = str(tmp_path / "gone")
    with pytest.raises(UsageError) as caught:
        search([gone])
    assert str(caught.value) == (
        f"{gone}: there is no such file or folder; give a description or a folder"
    )


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


def test_a_file_that_includes_itself_is_one(tmp_path: Path) -> None:
    include = '<robot name="r"><xacro:include filename="a.xacro"/></robot>'
    put(tmp_path, a_dot_xacro=include)
    assert len(search([str(tmp_path)]).descriptions) == 1


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


def test_of_a_file_that_cannot_be_read_nothing_is_known(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"a\xff")
    assert searching.text_of(str(tmp_path / "a")) == "a\ufffd"
    assert searching.data_of_file(str(tmp_path / "gone")) == b""


@pytest.mark.parametrize("many", [2, 3])
def test_files_that_include_each_other_are_no_parts(many: int, tmp_path: Path) -> None:
    """A loop has no first file; whoever expands one of them gets the reason."""
    for at in range(many):
        include = f'<xacro:include filename="{(at + 1) % many}.xacro"/>'
        (tmp_path / f"{at}.xacro").write_text(f'<robot name="r">{include}</robot>')
    (tmp_path / "part.xacro").write_text(ROBOT)
    (tmp_path / "top.xacro").write_text(
        '<robot name="r"><xacro:include filename="part.xacro"/></robot>'
    )
    found = [Path(it).name for it in search([str(tmp_path)]).descriptions]
    assert found == [*(f"{at}.xacro" for at in range(many)), "top.xacro"]


def _refusal(path: str) -> str:
    """What a file is refused with that is named alone; empty for one that is taken."""
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
    monkeypatch.setattr(searching, "_files", lambda _: alone)
    paths = [str(it) for it in sorted(home.rglob("*")) if it.name.endswith(ENDS)]
    for path in paths[:: max(1, len(paths) // 300)]:
        alone[:] = [path]
        found = search([os.path.dirname(path)])
        refused = "" if path.endswith(".srdf") else _refusal(path)
        assert not (path in found.every and refused), path
        assert not (path in (*found.worlds, *found.launch) and not refused), path
        # A xacro of an SRDF can be named: what is in it is known only when it is expanded.
        assert path not in found.srdf or refused or path.endswith((".xacro", ".srdf")), path
