# SPDX-License-Identifier: Apache-2.0
"""What can be read of expressions and elements of launch files without running them; by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from multibot_rewrite.fleet.proposal.launch_text import UNKNOWN, Reading, launch_text

HEAD = """\
DeclareLaunchArgument('declared', '5')
DeclareLaunchArgument(name='named', default_value='six')
other = 'x'
twice = 1
twice = 2
"""
GIVEN = {"rate": "5", "flag": "true", "bad": "[", "number": 3, "empty": "", "unknown": UNKNOWN}
CHAIN = "".join(f"a{at} = a{at + 1}\n" for at in range(13)) + "a13 = 1\n"
VALUES: dict[str, Any] = {
    "1": 1, "-1.5": -1.5, "+1": UNKNOWN, "-True": UNKNOWN, "-'a'": UNKNOWN, "not 1": UNKNOWN,
    "'a' + 'b'": "ab", "'a' / 'b'": "a/b", "'a' * 'b'": UNKNOWN, "1 + 2": UNKNOWN, "'a' + 1": UNKNOWN,
    "[1, 'a', (True, 2)]": [1, "a", [True, 2]], "[1, f()]": UNKNOWN, "f()": UNKNOWN, "{}": UNKNOWN,
    "other": "x", "twice": UNKNOWN, "nobody": UNKNOWN, "a2": 1, "a1": UNKNOWN,
    "os.path.join('a', 'b')": "a/b", "join('a', f())": UNKNOWN, "join()": UNKNOWN, "join(1)": UNKNOWN,
    "PathJoinSubstitution(['a', 'b'])": "a/b", "PathJoinSubstitution(substitutions=['a'])": "a",
    "PathJoinSubstitution(other)": UNKNOWN,
    "PathJoinSubstitution(['a', ['b', '.c']])": "a/b.c", "PathJoinSubstitution(['a', []])": UNKNOWN,
    "PathJoinSubstitution(['a', ['b', f()]])": UNKNOWN, "PathSubstitution('a') / 'b'": "a/b",
    "PathSubstitution(path=FindPackageShare('own')) / 'a' / ['b', '.c']": "own/a/b.c",
    "FindPackageShare('own') / 'a'": "own/a", "'a' / ['b', f()]": UNKNOWN, "'a' / []": UNKNOWN,
    "['a'] + ['b']": UNKNOWN, "'a' + ['b']": UNKNOWN, "'a' / 5": UNKNOWN,
    "LaunchConfiguration('rate')": 5, "LaunchConfiguration(variable_name='flag')": True,
    "LaunchConfiguration('bad')": "[", "LaunchConfiguration('number')": 3,
    "LaunchConfiguration('empty')": "", "LaunchConfiguration('unknown')": UNKNOWN,
    "LaunchConfiguration('declared')": 5, "LaunchConfiguration('named')": "six",
    "LaunchConfiguration('nobody')": UNKNOWN, "LaunchConfiguration(other)": UNKNOWN,
    "get_package_share_directory('own')": "own", "FindPackageShare(package='own')": "own",
    "get_package_share_path('own')": "own", "FindPackageShare('no_such')": UNKNOWN,
    "FindPackageShare(5)": UNKNOWN,
    "ParameterFile('p')": "p", "ParameterFile(param_file='p')": "p",
    "RewrittenYaml(root_key='r', source_file='p')": "p", "ParameterValue(value='p')": "p",
    "TextSubstitution(text='p')": "p", "PythonLaunchDescriptionSource('p')": "p", "str('p')": "p",
    "Path('p')": "p", "AnyLaunchDescriptionSource('p')": "p", "ReplaceString(source_file='p')": "p",
}  # fmt: skip


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Has a package."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "package.xml").write_text("<package><name>own</name></package>")
    return tmp_path


@pytest.mark.parametrize("expression", VALUES)
def test_the_value_of_an_expression(expression: str, folder: Path) -> None:
    """UNKNOWN where it is not plain; names lead to others a dozen times."""
    path = folder / "own" / "a.launch.py"
    path.write_text(f"{HEAD}{CHAIN}here = {expression}\nprint(here)\n")
    text = launch_text(str(path))
    found = Reading(text, GIVEN).value(text.assigned["here"])
    assert (found, type(found)) == (VALUES[expression], type(VALUES[expression]))


@pytest.mark.parametrize(
    ("expression", "path"),
    [("'a'", "a"), ("['a', 'b']", "ab"), ("['a', 1]", ""), ("5", ""), ("f()", "")],
)
def test_the_pieces_of_a_path_follow_each_other(expression: str, path: str, folder: Path) -> None:
    file = folder / "a.launch.py"
    file.write_text(f"here = {expression}\nprint(here)\n")
    text = launch_text(str(file))
    assert Reading(text, {}).path(text.assigned["here"]) == path
    assert Reading(text, {}).path(None) == ""


def test_what_is_assigned_and_never_read_is_not_started(folder: Path) -> None:
    file = folder / "a.launch.py"
    nodes = "one = Node(name='one')\ntwo = Node(name='two')\nthree.a = Node(name='three')\n"
    file.write_text(f"{nodes}LaunchDescription([two, LifecycleNode(name='four')])\n")
    assert {"two", "three", "four"} == {
        it.keywords[0].value.value for it in launch_text(str(file)).nodes
    }  # type: ignore[attr-defined]
    file.with_suffix(".yaml").write_text("a: [")
    assert launch_text(str(file.with_suffix(".yaml"))).nodes == ()


ELEMENTS = """\
<launch>
  <arg name="declared" default="d.yaml"/>
  <arg name="bare"/>
  <arg name="sometimes" default="s.yaml" if="$(var x)"/>
  <let name="set" value="l.yaml"/>
  <{tag} exec="e">{inside}</{tag}>
</launch>
"""
FROM = {
    "a.yaml": "a.yaml", "$(dirname)/a.yaml": "HERE/a.yaml",
    "$(find-pkg-share own)/a.yaml": "own/a.yaml",
    "$(var given)": "g.yaml", "$(var declared)": "d.yaml", "$(var set)": "l.yaml", "$(var bare)": "",
    "$(var sometimes)": "", "$(env A)": "", "b/$(var given)": "b/g.yaml", "$(var  given )": "g.yaml",
}  # fmt: skip


@pytest.mark.parametrize("tag", ["node", "lifecycle_node", "composable_node"])
@pytest.mark.parametrize("said", FROM)
def test_files_in_xml(said: str, tag: str, folder: Path) -> None:
    path = folder / "own" / "a.launch.xml"
    path.write_text(ELEMENTS.format(tag=tag, inside=f'<param from="{said}"/>'))
    text = launch_text(str(path))
    (node,) = text.nodes
    wanted = FROM[said].replace("HERE", str(path.parent))
    (given,) = (it.value for it in node.keywords if it.arg == "parameters")
    assert Reading(text, {"given": "g.yaml"}).path(given.elts[0]) == wanted  # type: ignore[attr-defined]
