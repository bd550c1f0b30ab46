# SPDX-License-Identifier: Apache-2.0
"""Plugin definitions of installed packages: found, used, undone; a broken package is refused."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from case_files import read_case
from description_calls import NEWEST_LTS, builtin_tree, load_definitions
from paths import FIXTURES

from multibot_rewrite import DefinitionsError, rewrite, strip
from multibot_rewrite.description.rewriters.installed import (
    advice,
    definitions_files,
    installed,
)
from tools.pages.plugins import pages

ACME = FIXTURES / "third_party" / "acme_robots"
CASE = read_case("acme", (ACME / "cases" / "acme_winch.case").read_bytes())
COMMAND = (sys.executable, "-m", "multibot_rewrite.cli.urdf_postfix")
PIP = (sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--quiet")
OFFLINE = ("--no-deps", "--no-index", "--no-build-isolation")
SECTION = "[plugin {name}]\nopens: nothing\nmy_frame uses link frame\n"
ROBOT = (
    '<robot name="a"><link name="base"/><gazebo><plugin name="p" filename="lib{name}.so">'
    "<my_frame>base</my_frame></plugin></gazebo></robot>"
)
Make = Callable[..., Path]


@pytest.fixture(scope="module")
def acme(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder that pip installed the third-party package into."""
    source = tmp_path_factory.mktemp("source") / "acme"
    shutil.copytree(ACME, source)
    # Reading its plugin definitions must not run its code.
    (source / "acme_robots" / "__init__.py").write_text("raise ImportError\n")
    target = tmp_path_factory.mktemp("target")
    words = [*PIP, *OFFLINE, "--no-compile", "--target", str(target), str(source)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return target


@pytest.fixture
def broken(acme: Path, tmp_path: Path) -> Path:
    """Return a copy of what pip installed, to break."""
    return shutil.copytree(acme, tmp_path / "site")


@pytest.fixture
def make(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Make]:
    """Lay down a distribution with one package of one definition file, first on sys.path."""
    caches = (installed, load_definitions, builtin_tree)

    def distribution(
        name: str,
        text: str,
        *,
        value: str = "",
        version: str = "1.0",
        site: str = "",
        end: str = "",
    ) -> Path:
        home = tmp_path / (site or name)
        package = home / name.replace("-", "_")
        package.mkdir(parents=True)
        (package / "__init__.py").write_text("raise ImportError\n")
        (package / "it.vocab").write_text(text, encoding="utf-8")
        folder = home / f"{package.name}-{version}{end or '.dist-info'}"
        folder.mkdir()
        about = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        (folder / ("PKG-INFO" if end else "METADATA")).write_text(about)
        points = f"[multibot_rewrite.plugin_definitions]\nit = {value or package.name}\n"
        (folder / "entry_points.txt").write_text(points)
        monkeypatch.syspath_prepend(str(home))
        for cache in caches:
            cache.cache_clear()
        return home

    yield distribution
    for cache in caches:
        cache.cache_clear()


def run(site: Path, *words: str, stdin: bytes = b"") -> subprocess.CompletedProcess[bytes]:
    """Run the command where ``site`` is on Python's path; standard input is the robot."""
    env = {**os.environ, "PYTHONPATH": os.pathsep.join([str(site), *_path()])}
    return subprocess.run(
        [*COMMAND, "-", *words, "--verbose"],
        input=stdin,
        env=env,
        cwd=site,
        capture_output=True,
        check=False,
    )


def _path() -> list[str]:
    return [os.environ["PYTHONPATH"]] if os.environ.get("PYTHONPATH") else []


def complaint() -> str:
    """Return what every call says now; always one line."""
    with pytest.raises(DefinitionsError) as caught:
        rewrite('<robot name="a"><link name="none of it is needed"/></robot>', "r1")
    assert "\n" not in str(caught.value)
    return str(caught.value)


def my_frame(name: str) -> str:
    """Where the plugin of that name ends up with its frame."""
    text = rewrite(ROBOT.format(name=name), "r1").text
    return text.partition("<my_frame>")[2].partition("<")[0]


# What pip installs is used by the command.


@pytest.mark.slow
def test_what_is_installed_is_known_renamed_and_undone(acme: Path) -> None:
    without = run(acme.parent, "robot1", stdin=CASE.source)
    assert without.stderr.count(b"MB902") == 2
    rewritten = run(acme, "robot1", stdin=CASE.source)
    assert (rewritten.returncode, rewritten.stdout) == (0, CASE.output), rewritten.stderr
    # The port is written in the description: all robots have it, and that is all there is to say.
    assert re.findall(rb"warning: (\w+)", rewritten.stderr) == [b"MB412"]
    stripped = run(acme, "robot1", "--undo", stdin=rewritten.stdout)
    assert (stripped.returncode, stripped.stdout) == (0, CASE.source)


def _write(site: Path, text: str) -> None:
    (site / "acme_robots" / "acme.vocab").write_text(text, encoding="utf-8")


def _bad_grammar(site: Path) -> None:
    _write(site, "[plugin acme_winch]\nrope uses lnik\n")


def _no_file(site: Path) -> None:
    (site / "acme_robots" / "acme.vocab").unlink()


def _clash(site: Path) -> None:
    _write(site, "[plugin gazebo_ros_diff_drive]\n\nodometry_frame keep mine\n")


def _missing_package(site: Path) -> None:
    shutil.rmtree(site / "acme_robots")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("break_it", "words"),
    [
        pytest.param(_bad_grammar, "/acme.vocab:2: unknown kind 'lnik', use one of", id="grammar"),
        pytest.param(_no_file, "entry point acme = acme_robots: no *.vocab file in", id="no-file"),
        pytest.param(_clash, "/acme.vocab:3: odometry_frame is in cl", id="clash"),
        pytest.param(_missing_package, "there is no package 'acme_robots'", id="no-package"),
    ],
)
def test_a_broken_package_stops_the_command(
    broken: Path, break_it: Callable[[Path], None], words: str
) -> None:
    break_it(broken)
    done = run(broken, "robot1", stdin=b'<robot name="a"><link name="l"/></robot>')
    said = done.stderr.decode()
    assert (done.returncode, done.stdout, said.count("\n")) == (2, b"", 1), said
    assert said.startswith("urdf-postfix: acme-robots 1.0: ")
    assert words in said
    assert said.endswith("; correct and reinstall it, or: pip uninstall acme-robots\n")


# The rest in this process, with distributions laid down by hand.


@pytest.mark.slow
@pytest.mark.parametrize("end", [".dist-info", ".egg-info"])
def test_every_library_call_uses_it(make: Make, end: str) -> None:
    assert my_frame("aa") == "base"
    make("aa", SECTION.format(name="aa"), end=end)
    rewritten = rewrite(ROBOT.format(name="aa"), "r1")
    assert "<my_frame>base/r1</my_frame>" in rewritten.text
    assert rewritten.findings == ()
    assert strip(rewritten.data, "r1").decode() == ROBOT.format(name="aa")


def test_files_come_by_distribution_whatever_the_path(make: Make) -> None:
    for name in ("b-b", "Aa", "c"):
        make(name, SECTION.format(name=name))
    found = installed()
    assert [file.distribution for file in found] == ["Aa", "b-b", "c"]
    assert found[1].name == f"b-b 1.0: {found[1].path}"
    assert found[1].path.endswith(os.path.join("b-b", "b_b", "it.vocab"))
    said = advice(f"{found[1].name}:3: wrong")
    assert said == "; correct and reinstall it, or: pip uninstall b-b"
    assert advice("mine.vocab:3: wrong") == ""


def test_every_definitions_file_right_in_a_package_is_read(make: Make) -> None:
    home = make("aa", "", end=".egg-info")
    for name in ("b.vocab", "a.vocab", "readme.txt"):
        (home / "aa" / name).write_text("")
    (home / "aa" / "below").mkdir()
    (home / "aa" / "below" / "c.vocab").write_text("")
    files = definitions_files("aa")
    assert [os.path.basename(it) for it in files] == ["a.vocab", "b.vocab", "it.vocab"]
    assert [os.path.basename(it) for it in definitions_files("aa.below")] == ["c.vocab"]
    assert [it.path for it in installed()] == files


@pytest.mark.slow
def test_a_package_below_another_is_not_imported(make: Make) -> None:
    home = make("aa", SECTION.format(name="outer"), value="aa.vocab")
    (home / "aa" / "vocab").mkdir()
    (home / "aa" / "vocab" / "it.vocab").write_text(SECTION.format(name="inner"))
    assert (my_frame("inner"), my_frame("outer")) == ("base/r1", "base")
    assert "aa" not in sys.modules


@pytest.mark.slow
def test_the_first_of_a_distribution_that_is_there_twice_counts(make: Make) -> None:
    make("a-a", SECTION.format(name="old"), version="1.0", site="second")
    make("a-a", SECTION.format(name="new"), version="2.0", site="first")
    assert [file.version for file in installed()] == ["2.0"]
    assert (my_frame("new"), my_frame("old")) == ("base/r1", "base")


def test_a_newer_one_without_definitions_hides_an_older_one(make: Make) -> None:
    make("aa", SECTION.format(name="old"), version="1.0", site="second")
    home = make("aa", "", version="2.0", site="first")
    (home / "aa-2.0.dist-info" / "entry_points.txt").unlink()
    installed.cache_clear()
    assert installed() == ()


@pytest.mark.slow
def test_two_entry_points_for_one_package_read_it_once(make: Make) -> None:
    home = make("aa", SECTION.format(name="aa"))
    with (home / "aa-1.0.dist-info" / "entry_points.txt").open("a") as file:
        file.write("again = aa\n")
    assert my_frame("aa") == "base/r1"


@pytest.mark.slow
def test_a_file_that_is_installed_and_named_too_is_read_once(make: Make) -> None:
    path = str(make("aa", SECTION.format(name="aa")) / "aa" / "it.vocab")
    text = rewrite(ROBOT.format(name="aa"), "r1", definitions=[path]).text
    assert "<my_frame>base/r1</my_frame>" in text


@pytest.mark.slow
def test_the_page_of_what_is_built_in_holds_nothing_else(make: Make) -> None:
    before = pages()
    make("aa", SECTION.format(name="aa"))
    assert pages() == before


WRONG_POINTS = pytest.mark.parametrize(
    ("value", "words"),
    [
        pytest.param("nowhere", "there is no package 'nowhere'", id="missing"),
        pytest.param("aa.nowhere", "there is no package 'aa.nowhere'", id="missing-below"),
        pytest.param("nowhere.aa", "there is no package 'nowhere.aa'", id="missing-above"),
        pytest.param("this", "there is no package 'this'", id="module"),
        pytest.param("aa:it", "'aa:it' is no package's name", id="attribute"),
        pytest.param("../aa", "'../aa' is no package's name", id="path"),
        pytest.param("importlib", "no *.vocab file in ", id="package-of-others"),
        pytest.param("aa\nodd", "entry_points.txt cannot be read", id="no-entry-points"),
    ],
)


@pytest.mark.slow
@WRONG_POINTS
def test_every_call_refuses_a_wrong_entry_point(make: Make, value: str, words: str) -> None:
    make("aa", SECTION.format(name="aa"), value=value)
    assert words in complaint()


@pytest.mark.more
@WRONG_POINTS
def test_a_wrong_entry_point_is_refused(make: Make, value: str, words: str) -> None:
    make("aa", SECTION.format(name="aa"), value=value)
    with pytest.raises(DefinitionsError) as caught:
        installed()
    message = str(caught.value)
    assert message.startswith("aa 1.0: ")
    assert words in message
    assert message.endswith("pip uninstall aa")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        pytest.param("hello\n", 1, "move this below the first [section]", id="text-first"),
        pytest.param("[gadget a]\n", 1, "TYPE one of", id="type"),
        pytest.param("[plugin a]\n@x[ uses link\n", 2, "bad path", id="path"),
        pytest.param("[plugin a]\nwith: nope\n", 1, "there is no [block nope]", id="block"),
        pytest.param("[element a]\nat: robbot\n", 1, "there is no [element robbot]", id="at"),
        pytest.param("[element x.link]\nat: robot\n", 1, "has a section or sites", id="tag"),
        pytest.param("[element link]\nat: robot\n@name keep it\n", 3, "already; re", id="element"),
        pytest.param(
            "[plugin mine gazebo_ros_diff_drive]\nleft_joint keep it\n",
            2,
            "already; remove",
            id="alias",
        ),
        pytest.param(
            "[plugin gazebo_ros_diff_drive]\nros/namespace keep it\n",
            2,
            "already; remove",
            id="of-a-block",
        ),
        pytest.param(
            "[element plugin]\nat: gazebo\nselect: sensor\n", 1, "select: is 'plugin'", id="setting"
        ),
    ],
)
def test_a_wrong_file_is_refused_though_nothing_needs_it(
    make: Make, text: str, line: int, words: str
) -> None:
    path = make("aa", text) / "aa" / "it.vocab"
    message = complaint()
    assert message.startswith(f"aa 1.0: {path}:{line}: ")
    assert words in message
    assert message.endswith("; correct and reinstall it, or: pip uninstall aa")


@pytest.mark.slow
def test_a_file_that_is_not_utf8_is_refused(make: Make) -> None:
    path = make("aa", "") / "aa" / "it.vocab"
    path.write_bytes(b"# sp\xe4t\n")
    assert complaint().startswith(f"aa 1.0: {path}: cannot be read: it is not UTF-8")


@pytest.mark.slow
def test_two_packages_that_say_different_things_are_refused(make: Make) -> None:
    one = make("aa", SECTION.format(name="both")) / "aa" / "it.vocab"
    two = make("bb", SECTION.format(name="both").replace("link", "joint")) / "bb" / "it.vocab"
    message = complaint()
    assert message.startswith(f"bb 1.0: {two}:3: my_frame is in aa 1.0: {one}")
    assert message.endswith("pip uninstall bb")


@pytest.mark.slow
def test_a_mistake_of_the_user_is_not_blamed_on_a_package(make: Make, tmp_path: Path) -> None:
    make("aa", SECTION.format(name="aa"))
    mine = tmp_path / "mine.vocab"
    mine.write_text(SECTION.format(name="aa"))
    with pytest.raises(DefinitionsError) as caught:
        rewrite(ROBOT.format(name="aa"), "r1", definitions=[str(mine)])
    assert str(caught.value).startswith(f"{mine}:3: my_frame is in aa 1.0: ")
    assert "uninstall" not in str(caught.value)


@pytest.mark.slow
def test_a_user_file_called_like_a_built_in_one_hides_nothing(here: Path) -> None:
    (here / "hardware.vocab").write_text(SECTION.format(name="aa"))
    builtin = list(load_definitions((), NEWEST_LTS, packages=False).names("hardware"))
    definitions = load_definitions(("hardware.vocab",), NEWEST_LTS, packages=False)
    assert list(definitions.names("hardware")) == builtin
    assert [found.file for found in definitions.find("plugin", "aa")] == ["./hardware.vocab"]


@pytest.mark.slow
def test_one_user_file_costs_no_parsing_of_the_rest(tmp_path: Path) -> None:
    mine = tmp_path / "mine.vocab"
    mine.write_text(SECTION.format(name="gazebo_ros_p3d") + "[block ros]\nextra uses link\n")
    definitions = load_definitions((str(mine),), NEWEST_LTS, packages=False)
    parsed = {section.name for found in definitions._found.values() for section in found}
    assert {"plugin gazebo_ros_p3d (ROS 2)", "block ros"} <= parsed
    assert len(parsed) < 6


@pytest.mark.slow
def test_where_nothing_is_installed_the_machinery_stays_out() -> None:
    code = (
        "import sys, multibot_rewrite as m;"
        "m.rewrite('<robot name=\"r\"><link name=\"l\"/></robot>', 'r1');"
        "print({'importlib.metadata', 'importlib.resources'} & set(sys.modules))"
    )
    words = [sys.executable, "-c", code]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


# A topic that one system of gz-sim makes of names and another one is told as a text is one topic.

ROV = """<sdf version="1.9"><model name="rov"><link name="hull"/><link name="prop"/>
<joint name="fin" type="revolute"><parent>hull</parent><child>prop</child></joint>
<plugin filename="gz-sim-thruster-system" name="gz::sim::systems::Thruster">
{space}<joint_name>fin</joint_name></plugin>
<plugin filename="ArduPilotPlugin" name="ArduPilotPlugin"><control channel="0">
<jointName>fin</jointName><cmd_topic>{told}</cmd_topic></control></plugin></model></sdf>"""


@pytest.mark.parametrize(
    ("told", "new"),
    [
        # The model's, though a system has a word of the same text.
        ("/model/rov/odometry", "/model/rov_robot1/odometry"),
        (
            "/world/sea/model/rov/link/hull/sensor/sonar/scan",
            "/world/sea/model/rov_robot1/link/hull/robot1/sensor/sonar/scan",
        ),
        # Made of nothing that is named here.
        ("/model/ship/joint/fin/cmd_thrust", "/model/ship/joint/fin/cmd_thrust/robot1"),
        ("/gimbal/cmd_roll", "/gimbal/cmd_roll/robot1"),
        ("/model/rover/odometry", "/model/rover/odometry/robot1"),
    ],
)
def test_names_in_other_topics(told: str, new: str) -> None:
    source = ROV.format(space="<namespace>rov</namespace>", told=told)
    assert f"<cmd_topic>{new}</cmd_topic>" in rewrite(source, "robot1").data.decode()


def test_a_topic_below_the_namespace_of_a_system() -> None:
    """gz-sim src/systems/multicopter_motor_model: its topic is below the robotNamespace alone."""
    told = "/quad/command/motor_speed"
    source = ROV.format(space="<robotNamespace>quad</robotNamespace>", told=told)
    source = source.replace("gz-sim-thruster-system", "gz-sim-multicopter-motor-model-system")
    source = source.replace("Thruster", "MulticopterMotorModel").replace("joint_name", "jointName")
    new = "<cmd_topic>/quad_robot1/command/motor_speed</cmd_topic>"
    assert new in rewrite(source, "robot1").data.decode()
