# SPDX-License-Identifier: Apache-2.0
"""Launch files of packages that are there as sources: where their files are, what includes read."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from multibot_rewrite.producers.launch import commands
from multibot_rewrite.producers.launch.failures import failure
from multibot_rewrite.producers.launch.includes import not_among, unread
from multibot_rewrite.producers.launch.kept_paths import GONE, lasting, real_paths
from multibot_rewrite.producers.launch.source_packages import link_share

CMAKE = """\
install(DIRECTORY config/ DESTINATION share/${PROJECT_NAME}/params)
install(DIRECTORY assets/models DESTINATION "share/${PROJECT_NAME}")
install(FILES top.yaml DESTINATION share/${PROJECT_NAME}/launch)
install(DIRECTORY include/ DESTINATION include)
"""


def write(folder: Path, *files: str) -> Path:
    for it in files:
        (folder / it).parent.mkdir(parents=True, exist_ok=True)
        (folder / it).write_text("")
    return folder


def test_a_share_folder_is_as_cmake_installs_it(tmp_path: Path) -> None:
    files = ("config/nav.yaml", "assets/models/a.sdf", "top.yaml", "launch/b.launch.py")
    source = write(tmp_path / "src", *files)
    (source / "CMakeLists.txt").write_text(CMAKE)
    link_share("mine", str(source), str(tmp_path / "share"))
    wanted = {
        "params/nav.yaml": "config/nav.yaml",
        "models/a.sdf": "assets/models/a.sdf",
        "launch/top.yaml": "top.yaml",
        # What stands in the sources is found where it stands, too.
        "launch/b.launch.py": "launch/b.launch.py",
        "config/nav.yaml": "config/nav.yaml",
    }
    found = {it: os.path.realpath(tmp_path / "share" / it) for it in wanted}
    assert found == {it: str(source / own) for it, own in wanted.items()}
    assert not (source / "launch" / "top.yaml").exists()


def test_folders_that_are_installed_under_one_name_are_one(tmp_path: Path) -> None:
    files = ("bringup/launch/b.launch.py", "description/launch/d.launch.py", "launch/own.launch.py")
    source = write(tmp_path / "src", *files)
    rules = "install(DIRECTORY description/launch bringup/launch DESTINATION share/mine)\n"
    (source / "CMakeLists.txt").write_text(rules)
    link_share("mine", str(source), str(tmp_path / "share"))
    names = ["b.launch.py", "d.launch.py", "own.launch.py"]
    assert sorted(os.listdir(tmp_path / "share/launch")) == names
    assert os.listdir(source / "launch") == ["own.launch.py"]
    assert os.listdir(source / "description/launch") == ["d.launch.py"]


def test_a_share_folder_of_a_package_in_python(tmp_path: Path) -> None:
    source = write(tmp_path / "src", "setup.py", "mine/assets/a.sdf", "mine/__init__.py")
    link_share("mine", str(source), str(tmp_path / "share"))
    assert (tmp_path / "share/assets/a.sdf").is_file() and (tmp_path / "share/setup.py").is_file()
    assert not (source / "assets").exists()


SETUP = """\
import os
from glob import glob
from setuptools import setup
package_name = 'mine'
share = f'share/{package_name}'
setup(name=package_name, data_files=[
    (os.path.join('share', package_name), glob('launch/*.launch.py')),
    (share + '/params', glob(os.path.join('config', '*.yaml')) + ['top.yaml']),
    ('share/other', glob('config/*')), (share, glob('../*')), [share, len(share)], (1, [None]),
])
"""


def test_a_share_folder_is_as_data_files_say(tmp_path: Path) -> None:
    files = ("config/nav.yaml", "top.yaml", "launch/b.launch.py", "launch/c.txt", "../beside.txt")
    source = write(tmp_path / "src", *files)
    (source / "setup.py").write_text(SETUP + "a = 'x'\n" + "a = a + a\n" * 99)
    link_share("mine", str(source), str(tmp_path / "share"))
    there = {it.name for it in (tmp_path / "share").iterdir()}
    assert there == {"b.launch.py", "config", "launch", "params", "setup.py", "top.yaml"}
    params = {it.name: os.path.realpath(it) for it in (tmp_path / "share/params").iterdir()}
    own = {"nav.yaml": "config/nav.yaml", "top.yaml": "top.yaml"}
    assert params == {name: str(source / path) for name, path in own.items()}


PYTHON = 'DeclareLaunchArgument("map"), DeclareLaunchArgument(name="start_x", default_value="0")'


@pytest.mark.parametrize(
    ("text", "given", "found"),
    [
        (PYTHON, ["map", "start_x"], []),
        (PYTHON, ["strat_x"], [("strat_x", "start_x")]),
        (PYTHON, ["start_x", "strat_x"], [("strat_x", "")]),
        (PYTHON, ["rviz"], [("rviz", "")]),
        (f'{PYTHON}; LaunchConfiguration("rviz")', ["rviz"], []),
        (f"{PYTHON}; LaunchConfiguration(robot + '_x')", ["rviz"], []),
        (f"{PYTHON}; IncludeLaunchDescription(other)", ["rviz"], []),
        (f"{PYTHON}; IncludeLaunchDescription(other)", ["strat_x"], [("strat_x", "start_x")]),
        ("LaunchDescription([])", ["rviz"], []),
        ('<launch><arg name="start_x"/></launch>', ["strat_x"], [("strat_x", "start_x")]),
        ("launch:\n- arg: {name: start_x}\n", ["strat_x"], [("strat_x", "start_x")]),
    ],
)
def test_arguments_that_the_other_file_does_not_read(
    text: str, given: list[str], found: list[tuple[str, str]], tmp_path: Path
) -> None:
    (tmp_path / "child").write_text(text)
    assert list(unread(str(tmp_path / "child"), given)) == found


def test_arguments_that_differ_in_their_number() -> None:
    assert list(not_among(["robot3_x"], ["robot1_x", "robot2_x"])) == []


def test_a_file_that_the_launch_makes_is_kept_as_a_text(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = tmp_path / "made"
    made.mkdir()
    (made / "r.sdf").write_text("<sdf/>")
    monkeypatch.setattr("tempfile.tempdir", str(made))
    file, text = str(made / "r.sdf"), ["-string", "<sdf/>"]
    assert list(lasting(["-file", file, "-name", "r", "/tf/"])) == [*text, "-name", "r", "/tf/"]
    assert list(lasting(["-x", f"--file={file}", file])) == ["-x", *text, file]


def test_paths_of_the_reader_become_those_that_stay(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a package with install rules the share folder is one of links."""
    top = tmp_path / "multibot_launch_x"
    share, source = top / "0/sources/share", tmp_path / "ws" / "acme"
    write(source, "worlds/a.world")
    write(source, "package.xml")
    write(tmp_path / "other" / "plain", "package.xml")
    (share / "acme").mkdir(parents=True)
    (share / "ament_index").mkdir()
    (share / "plain").symlink_to(tmp_path / "other" / "plain")
    (share / "acme/package.xml").symlink_to(source / "package.xml")
    (share / "acme/maps").symlink_to(source / "worlds")
    (top / "1").mkdir()
    (top / "1/sources").symlink_to(top / "0/sources")
    monkeypatch.setattr("tempfile.tempdir", str(top / "1"))
    there = f"{top}/1/sources/share"
    assert real_paths(f"{there}/acme/maps/a.world") == f"{source}/worlds/a.world"
    assert real_paths(f"<m file='{top}/0/sources/share/plain/x.stl'/> '{there}/acme'") == (
        f"<m file='{tmp_path}/other/plain/x.stl'/> '{source}'"
    )
    assert {*real_paths(there).split(":")} == {f"{tmp_path}/ws", f"{tmp_path}/other"}
    assert real_paths(f"{top}/1/not_installed/share/n2/a/b.yaml") == "$(find-pkg-share n2)/a/b.yaml"
    assert real_paths(f"{top}/1/tmpa.yaml:{top}/1/sources/lib") == (
        f"{GONE}/tmpa.yaml:{GONE}/sources/lib"
    )


def raised(text: str) -> BaseException:
    try:
        exec(text)
    except BaseException as error:
        return error
    raise AssertionError(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            "import os; os.environ['NOT_SET_HERE']",
            "the environment variable NOT_SET_HERE is not set",
        ),
        ("raise SystemExit(2)", "it ends itself (sys.exit(2)); give it the arguments"),
        (
            "open('/nowhere/a.yaml')",
            "FileNotFoundError: [Errno 2] No such file or directory: '/now",
        ),
        (
            "import subprocess; subprocess.run(['no_such_program'])",
            "it starts the program 'no_such",
        ),
    ],
)
def test_why_a_launch_file_cannot_be_read(text: str, said: str) -> None:
    assert failure(raised(text)).startswith(said)


def test_a_path_of_a_variable_that_is_not_set() -> None:
    try:
        os.path.join(os.getenv("NOT_SET_HERE"), "a")  # type: ignore[arg-type]
    except TypeError as error:
        assert failure(error).startswith("the environment variable NOT_SET_HERE is not set here")


def test_the_output_of_a_program_that_reads_is_known_without_it(tmp_path: Path) -> None:
    """Of xacro with one file and its arguments; options are not its files."""
    first, second = tmp_path / "a.txt", tmp_path / "b.txt"
    first.write_bytes(b"a\xff")
    second.write_text("b")
    assert commands.output_of(f"/bin/cat {first} {second}").text == "a\ufffdb"
    assert commands.output_of(f"other {first}") == commands.Output("")
    asked = (
        commands.output_of(f"ros2 param get /x {it}").text for it in ("y", "robot_description")
    )
    assert [bool(it) for it in asked] == [False, True]
    robot = tmp_path / "r.xacro"
    robot.write_text(
        '<robot name="$(arg n)" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n"'
        ' default="d"/></robot>'
    )
    assert 'name="x:=y"' in commands.output_of(f"xacro -v {robot} n:=x:=y").text
    assert commands.output_of(f"xacro {robot} {robot}").text == ""
    lost = commands.output_of(f"cat {tmp_path}/gone")
    assert lost.text == ""
    assert lost.fault.startswith(f"the output of 'cat {tmp_path}/gone' is not known: ")


def test_a_launch_file_starts_no_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What one prints is known where it only reads; it has ended well in every way to ask for it."""
    monkeypatch.setattr(subprocess, "Popen", subprocess.Popen)
    monkeypatch.setattr(os, "system", os.system)
    lines: list[str] = []
    lost = commands.start_nothing(lines)
    made, file = tmp_path / "made", tmp_path / "a"
    file.write_text("b")
    assert subprocess.check_output(["cat", file], text=True) == "b"
    assert subprocess.run(f"cat {file}", shell=True, check=True).stdout == b"b" and not lost
    assert os.popen(f"touch {made}").read() == "" and os.system(f"touch {made}") == 0
    assert subprocess.check_call(["touch", str(made)]) == subprocess.Popen(["touch", made]).wait()
    assert subprocess.getoutput(b"touch it") == ""
    assert not made.exists()
    assert lost == [f"it starts 'touch {made}' itself, which is not started here",
                    "it starts 'touch it' itself, which is not started here"]  # fmt: skip
    assert [subprocess.run(["cat", "/no/such"], check=False).stdout for _ in range(2)] == [b"", b""]
    assert len(lost) == 3 and lines[:2] == [f"cat {file}"] * 2
