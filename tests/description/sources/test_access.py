# SPDX-License-Identifier: Apache-2.0
"""What an expansion may read and see: near its file, in packages, of ROS's variables."""

from __future__ import annotations

from pathlib import Path

import pytest

from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.access import (
    BOUNDED,
    TRUSTED,
    Access,
    NotAllowedError,
    Reach,
)
from multibot_rewrite.description.sources.expand import expand

XACRO = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
PART = XACRO.format('<link name="part"/>')


@pytest.fixture
def repository(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a repository of two packages; ROS is not sourced."""
    for variable in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(variable, raising=False)
    for package in ("arm", "tool"):
        (tmp_path / "repo" / package / "urdf").mkdir(parents=True)
        (tmp_path / "repo" / package / "package.xml").write_text(f"<name>{package}</name>")
        (tmp_path / "repo" / package / "urdf" / "part.xacro").write_text(PART)
    return tmp_path / "repo"


def including(file: Path, name: str, reach: Reach = BOUNDED) -> str:
    """Return the text, or the message, of a file that includes ``name``."""
    file.write_text(XACRO.format(f'<xacro:include filename="{name}"/>'))
    try:
        return expand(str(file), {}, reach=reach).decode()
    except InputError as error:
        return str(error)


def test_a_file_reads_its_package_and_not_the_next_one(repository: Path) -> None:
    file = repository / "arm" / "urdf" / "robot.xacro"
    (repository / "arm" / "more").mkdir()
    (repository / "arm" / "more" / "part.xacro").write_text(PART)
    assert "part" in including(file, "part.xacro")
    assert '<link name="part"/>' in including(file, "../more/part.xacro")
    assert "is outside of the folders" in including(file, "../../tool/urdf/part.xacro")


def test_a_repository_is_one(repository: Path) -> None:
    """Also a copy without ``.git``, which has what only the top of a repository has."""
    file = repository / "arm" / "urdf" / "robot.xacro"
    for mark in (".git", ".gitignore", ".github", ".gitmodules", "LICENSE", "README.md"):
        (repository / mark).mkdir()
        assert '<link name="part"/>' in including(file, "../../tool/urdf/part.xacro"), mark
        (repository / mark).rmdir()


@pytest.mark.parametrize("reach", [{"roots": True}, {"trust": True}])
def test_more_roots_and_trust_let_it_read_more(repository: Path, reach: dict[str, bool]) -> None:
    file = repository / "arm" / "urdf" / "robot.xacro"
    wider = Reach(roots=(str(repository / "tool"),)) if "roots" in reach else TRUSTED
    assert '<link name="part"/>' in including(file, "../../tool/urdf/part.xacro", wider)


def test_the_folder_of_a_file_that_is_in_no_package(tmp_path: Path) -> None:
    (tmp_path / "a" / "b").mkdir(parents=True)
    (tmp_path / "a" / "b" / "part.xacro").write_text(PART)
    (tmp_path / "part.xacro").write_text(PART)
    assert '<link name="part"/>' in including(tmp_path / "a" / "r.xacro", "b/part.xacro")
    assert "is outside of the folders" in including(tmp_path / "a" / "r.xacro", "../part.xacro")


@pytest.mark.sample(1)
@pytest.mark.parametrize("home", ["home", "home/user"])
def test_a_home_is_no_robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, home: str) -> None:
    """It may be a repository, and hold a robot: what is beside the robot is read, no more."""
    folder = tmp_path / home
    (folder / "letters").mkdir(parents=True)
    (folder / ".git").mkdir()
    for name in ("part.xacro", "letters/part.xacro"):
        (folder / name).write_text(PART)
    monkeypatch.setenv("HOME", str(tmp_path / "home" / "user"))
    assert '<link name="part"/>' in including(folder / "r.xacro", "part.xacro")
    assert "is outside of the folders" in including(folder / "r.xacro", "letters/part.xacro")
    (folder / "robot").mkdir()
    assert "is outside of the folders" in including(folder / "robot" / "r.xacro", "../part.xacro")


def test_who_works_above_a_file_reads_what_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But for a home, and for a file that is elsewhere."""
    file, other = tmp_path / "work/a/b.launch.py", tmp_path / "work/c.urdf"
    file.parent.mkdir(parents=True)
    other.write_text("text")
    monkeypatch.chdir(tmp_path / "work")
    assert Access(str(file), Reach(), None).read(str(other)) == b"text"
    monkeypatch.setenv("HOME", str(tmp_path / "work"))
    with pytest.raises(NotAllowedError):
        Access(str(file), Reach(), None).read(str(other))
    (tmp_path / "else").mkdir()
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.chdir(tmp_path / "else")
    with pytest.raises(NotAllowedError):
        Access(str(file), Reach(), None).read(str(other))


@pytest.mark.parametrize("hidden", [".part.xacro", ".config/part.xacro"])
def test_what_is_hidden_is_not_read(repository: Path, hidden: str) -> None:
    path = repository / "arm" / hidden
    path.parent.mkdir(exist_ok=True)
    path.write_text(PART)
    assert "is hidden" in including(repository / "arm" / "r.xacro", hidden)


def test_a_link_is_what_it_leads_to(repository: Path) -> None:
    file = repository / "arm" / "r.xacro"
    (repository / "arm" / "inner.xacro").symlink_to("urdf/part.xacro")
    (repository / "arm" / "outer.xacro").symlink_to("../tool/urdf/part.xacro")
    assert '<link name="part"/>' in including(file, "inner.xacro")
    assert "is outside of the folders" in including(file, "outer.xacro")


def test_a_link_to_the_file_itself_reads_where_both_are(tmp_path: Path, repository: Path) -> None:
    include = '<xacro:include filename="{}"/>'
    target = repository / "arm" / "urdf" / "r.xacro"
    target.write_text(XACRO.format(include.format("part.xacro")))
    (tmp_path / "linked").mkdir()
    (tmp_path / "linked" / "r.xacro").symlink_to(target)
    (tmp_path / "linked" / "part.xacro").symlink_to(repository / "arm" / "urdf" / "part.xacro")
    assert b'<link name="part"/>' in expand(str(tmp_path / "linked" / "r.xacro"), {})


def sourced(tmp_path: Path, repository: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Install the package tool as ``colcon build --symlink-install`` does."""
    prefix = tmp_path / "install" / "tool"
    share = prefix / "share" / "tool"
    share.mkdir(parents=True)
    (share / "part.xacro").symlink_to(repository / "tool" / "urdf" / "part.xacro")
    index = prefix / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "tool").write_text("")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/nowhere:{prefix}")


def test_a_sourced_workspace_is_read_through_its_links(
    tmp_path: Path, repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sourced(tmp_path, repository, monkeypatch)
    file = repository / "arm" / "r.xacro"
    assert '<link name="part"/>' in including(file, "$(find tool)/part.xacro")
    said = including(file, "$(find tool)/../../../../repo/tool/urdf/part.xacro")
    assert "is outside of the folders" in said


def test_a_package_of_the_same_repository_needs_no_sourced_ros(repository: Path) -> None:
    file = repository / "arm" / "r.xacro"
    assert '<link name="part"/>' in including(file, "$(find tool)/urdf/part.xacro")
    (repository / "tool" / "package.xml").unlink()
    assert "needs a sourced ROS 2" in including(file, "$(find tool)/urdf/part.xacro")


def test_the_repositories_of_a_workspace_are_beside_each_other(tmp_path: Path) -> None:
    file = tmp_path / "src" / "one" / "arm" / "r.xacro"
    part = tmp_path / "src" / "two" / "tool" / "part.xacro"
    for it, name in ((file, "arm"), (part, "tool")):
        it.parent.mkdir(parents=True)
        (it.parent.parent / ".git").mkdir()
        (it.parent / "package.xml").write_text(f"<package><name>{name}</name></package>")
        it.write_text(XACRO.format('<link name="part"/>'))
    assert '<link name="part"/>' in including(file, "$(find tool)/part.xacro")
    (tmp_path / "src").rename(tmp_path / "other")
    moved = tmp_path / "other" / "one" / "arm" / "r.xacro"
    assert "needs a sourced ROS 2" in including(moved, "$(find tool)/part.xacro")


def test_a_file_that_a_build_installs_elsewhere(repository: Path) -> None:
    """As ros2_control_demos: description/urdf is installed as urdf."""
    file, tool = repository / "arm" / "r.xacro", repository / "tool"
    (tool / "description").mkdir()
    (tool / "urdf").rename(tool / "description" / "urdf")
    for folder in ("one", "two"):
        (tool / folder / "urdf").mkdir(parents=True)
        (tool / folder / "urdf" / "twice.xacro").write_text(PART)
    assert '<link name="part"/>' in including(file, "$(find tool)/urdf/part.xacro")
    assert "No such file" in including(file, "$(find tool)/rdf/part.xacro")
    assert "No such file" in including(file, "$(find tool)/urdf/twice.xacro"), "which of both?"


def test_a_package_that_is_nowhere(
    tmp_path: Path, repository: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = repository / "arm" / "r.xacro"
    assert "needs a sourced ROS 2" in including(file, "$(find more)/part.xacro")
    sourced(tmp_path, repository, monkeypatch)
    assert "package 'more' is not found; source" in including(file, "$(find more)/part.xacro")


@pytest.mark.parametrize("name", ["..", ".", "", "a/b", "/etc", "../arm"])
def test_no_path_is_a_package(repository: Path, name: str) -> None:
    access = Access(str(repository / "arm" / "r.xacro"), Reach(), lambda _: "/")
    with pytest.raises(LookupError, match="is no name of a package"):
        access.package(name)


def test_patterns(repository: Path) -> None:
    access = Access(str(repository / "arm" / "r.xacro"), Reach(), None)
    arm = repository / "arm"
    (arm / "a1").mkdir()
    for name in ("a.xacro", ".a.xacro", "a1/b.xacro", "a1/c.yaml"):
        (arm / name).write_text("")
    assert access.matching(f"{arm}/*.xacro") == [f"{arm}/a.xacro"]
    assert access.matching(f"{arm}/a?/[bc].*") == [f"{arm}/a1/b.xacro", f"{arm}/a1/c.yaml"]
    assert access.matching(f"{arm}/none*/*") == []
    for outside in (f"{repository}/*", f"{arm}/*/../../tool/package.xml", "/*"):
        with pytest.raises(NotAllowedError, match="is outside of the folders"):
            access.matching(outside)


def test_a_pattern_is_bounded(repository: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("multibot_rewrite.description.sources.access.MOST_FILES", 30)
    loop = repository / "arm" / "loops"
    loop.mkdir()
    for name in "ab":
        (loop / name).symlink_to(".")
    access = Access(str(repository / "arm" / "r.xacro"), Reach(), None)
    with pytest.raises(NotAllowedError, match="more than 30 files"):
        access.matching(f"{loop}/" + "/".join("*" * 40))


VALUE = '<link name="$({})"/>'


# Of ROS, colcon, Gazebo and its forerunners, by their documentation.
OF_ROS = (
    "ROS_DISTRO", "ROS_PACKAGE_PATH", "RMW_IMPLEMENTATION", "AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH",
    "CMAKE_PREFIX_PATH", "TURTLEBOT3_MODEL", "GAZEBO_MODEL_PATH", "GAZEBO_PLUGIN_PATH",
    "GAZEBO_RESOURCE_PATH", "GZ_VERSION", "GZ_SIM_RESOURCE_PATH", "GZ_SIM_SYSTEM_PLUGIN_PATH",
    "IGN_GAZEBO_RESOURCE_PATH", "SDF_PATH",
)  # fmt: skip


def test_variables_of_ros_are_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    links = []
    for name in OF_ROS:
        monkeypatch.setenv(name, f"waffle_{name}")
        links.append(VALUE.format(f"optenv {name} no"))
    (tmp_path / "r.xacro").write_text(XACRO.format("".join(links)))
    made = expand(str(tmp_path / "r.xacro"), {}).decode()
    assert [name for name in OF_ROS if f'<link name="waffle_{name}"/>' not in made] == []


@pytest.mark.sample(1)
@pytest.mark.parametrize("call", ["env HUSKY_ARM", "optenv HUSKY_ARM none"])
def test_another_variable_is_refused_and_not_silently_its_default(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    monkeypatch.setenv("HUSKY_ARM", "ur5")
    file = tmp_path / "r.xacro"
    file.write_text(XACRO.format(VALUE.format(call)))
    with pytest.raises(InputError, match=r"'HUSKY_ARM' is set, .* --trust"):
        expand(str(file), {})
    assert b'<link name="ur5"/>' in expand(str(file), {}, reach=TRUSTED)
    monkeypatch.delenv("HUSKY_ARM")
    if "none" in call:
        assert b'<link name="none"/>' in expand(str(file), {})
    else:
        with pytest.raises(InputError, match="'HUSKY_ARM' is not set; set it"):
            expand(str(file), {})


@pytest.mark.parametrize("name", ["GZ_TRANSPORT_PASSWORD", "GITHUB_TOKEN", "HOME", "PATH"])
def test_no_password_is_among_the_variables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setenv(name, "x")
    with pytest.raises(NotAllowedError):
        Access(str(tmp_path / "r.xacro"), Reach(), None).variable(name)


def test_a_pattern_names_no_hidden_file_and_none_that_does_not_fit(repository: Path) -> None:
    folder = repository / "arm" / "urdf"
    for name in (".hidden.xacro", "other.txt"):
        (folder / name).write_text(PART)
    file = folder / "robot.xacro"
    file.write_text(PART)
    access = Access(str(file), BOUNDED, None)
    found = [Path(it).name for it in access.matching(str(folder / "*.xacro"))]
    assert found == ["part.xacro", "robot.xacro"]


def test_a_root_that_xacro_does_not_expand_is_named(tmp_path: Path) -> None:
    file = tmp_path / "part.xacro"
    file.write_text('<xacro:macro xmlns:xacro="http://www.ros.org/wiki/xacro" name="a"/>')
    with pytest.raises(InputError, match=r"<xacro:macro>, which xacro does not expand"):
        expand(str(file), {})
