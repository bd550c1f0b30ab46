# SPDX-License-Identifier: Apache-2.0
"""A whole package takes a prefix: launch files hand it on, an SRDF follows, what is left is listed."""

from __future__ import annotations

from pathlib import Path

import pytest
from paths import fixture_text, write_files

from multibot_rewrite import adopt
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.sources.expand import expand
from multibot_rewrite.producers.launch.door import missing
from multibot_rewrite.refactor.launches import fillable
from multibot_rewrite.refactor.named_elsewhere import named_elsewhere, root_sections

SPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
ROBOT = f'<robot name="r" {SPACE}>\n  <link name="base"/>\n  <link name="arm"/>\n{{}}</robot>\n'
JOINT = '  <joint name="j" type="fixed"><parent link="base"/><child link="arm"/></joint>\n'
LAUNCH = fixture_text("adopt_package_launch.txt")
XML = """\
<launch>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description" value="$(command 'xacro $(dirname)/../urdf/r.urdf.xacro')"/>
  </node>
</launch>
"""
# The description is read when the file is loaded, so the argument is not known there.
EARLY = LAUNCH.replace(
    'text = Command(["xacro ", PATH])',
    'text = open(PATH).read()\n    unused = Command(["xacro ", "r.urdf.xacro"])',
)


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """Return a package with one description."""
    for folder in ("urdf", "launch", "src", "config"):
        (tmp_path / "r" / folder).mkdir(parents=True)
    (tmp_path / "r/package.xml").write_text("<package><name>r</name></package>")
    (tmp_path / "r/urdf/r.urdf.xacro").write_text(ROBOT.format(JOINT))
    return tmp_path / "r"


NEEDS_LAUNCH = pytest.mark.skipif(bool(missing()), reason="launch reads XML alone")
FILES = [
    pytest.param("a.launch.py", LAUNCH, marks=pytest.mark.more),
    pytest.param("a.launch.xml", XML, marks=(NEEDS_LAUNCH, pytest.mark.more)),
]


@pytest.mark.parametrize(("name", "text"), FILES)
def test_a_launch_file_is_read_with_the_argument(package: Path, name: str, text: str) -> None:
    path = package / "launch" / name
    path.write_text(text)
    # The world is no name of the robot: the launch file is verified with it.
    robot = package / "urdf/r.urdf.xacro"
    robot.write_text(robot.read_text().replace("  <link", '  <link name="world"/>\n  <link', 1))
    made = adopt(str(package), trust=True)
    assert made.launches == (str(path),)
    assert not [it for it in made.left if it.place.startswith(str(path))]
    assert b"prefix" in made.after[str(path)]
    assert made.before[str(path)] == text.encode()


YAML = (
    "# kept\nfollow:\n  ros__parameters:\n    joints: [j]  # the arm\n    frame: {frame_id: base}\n"
)
FILLED = YAML.replace("[j]", "[$(var prefix)j]").replace(": base", ": $(var prefix)base")
MANAGER = """\
        Node(
            package="controller_manager",
            executable="ros2_control_node",
            parameters=[PARAMETERS],
        ),
"""
GIVEN = 'os.path.join(os.path.dirname(__file__), "..", "config", "c.yaml")'


def with_parameters(package: Path, item: str, more: str = "") -> str:
    (package / "config/c.yaml").write_text(YAML)
    node = MANAGER.replace("PARAMETERS", item)
    text = LAUNCH.replace("    return", f"{more}    return").replace("    ])", f"{node}    ])")
    (package / "launch/a.launch.py").write_text(text)
    return text


@pytest.mark.more
@pytest.mark.parametrize(
    ("item", "more"), [(GIVEN, ""), ("given", f"    given = {GIVEN}\n")], ids=["there", "by a name"]
)
def test_a_parameter_file_is_filled_in(package: Path, item: str, more: str) -> None:
    """UR's driver has it so: ParameterFile(..., allow_substs=True)."""
    with_parameters(package, item, more)
    made = adopt(str(package), trust=True)
    assert made.after[str(package / "config/c.yaml")].decode() == FILLED
    launch = made.after[str(package / "launch/a.launch.py")].decode()
    assert f"parameters=[ParameterFile({item}, allow_substs=True)]" in launch
    assert "from launch_ros.parameter_descriptions import ParameterFile\n" in launch
    assert made.launches == (str(package / "launch/a.launch.py"),)


@pytest.mark.more
@pytest.mark.parametrize(
    "why", ["named in the xacro, too", "named twice in the launch file", "opened as well"]
)
def test_a_parameter_file_that_others_read_stays(package: Path, why: str) -> None:
    more = ""
    if why == "named in the xacro, too":
        plugin = '<plugin name="p" filename="x"><parameters>c.yaml</parameters></plugin>'
        text = ROBOT.format(f"{JOINT}<gazebo>{plugin}</gazebo>")
        (package / "urdf/r.urdf.xacro").write_text(text)
    elif why == "named twice in the launch file":
        more = '    print("config/c.yaml")\n'
    with_parameters(package, "given", f"    given = {GIVEN}\n{more}")
    if why == "opened as well":
        path = package / "launch/a.launch.py"
        path.write_text(
            path.read_text().replace("    return", "    open(given).close()\n    return")
        )
    made = adopt(str(package), trust=True)
    assert str(package / "config/c.yaml") not in made.after
    assert b"ParameterFile" not in made.after[str(package / "launch/a.launch.py")]
    assert any("c.yaml:4" in it.place for it in made.left)


def test_one_parameter_file_of_a_name_is_filled_in_where_nothing_is(tmp_path: Path) -> None:
    robot = ROBOT.format(JOINT).encode()
    files = {
        "a/c.yaml": YAML,
        "b/d.yaml": f"\ufeff{YAML}",
        "b/c.yaml": YAML,
        "a/e.yaml": "a: [",
        "f.yaml": FILLED,
    }
    write_files(tmp_path, files)

    def filled(urdfs: list[bytes], names: set[str]) -> dict[str, tuple[str, str, str]]:
        paths = [str(tmp_path / it) for it in files]
        found = fillable(paths, urdfs, names, "prefix", "try_")
        return {name: (it.path, it.after.decode(), it.tried.decode()) for name, it in found.items()}

    after = f"\ufeff{YAML}".replace("[j]", "[$(var prefix)j]")
    tried = f"\ufeff{YAML}".replace("[j]", "[try_j]")
    assert filled([robot], {"j"}) == {"d.yaml": (f"{tmp_path}/b/d.yaml", after, tried)}
    assert filled([robot], {"j", "base"})["d.yaml"][1] == f"\ufeff{FILLED}"
    assert filled([robot], {"arm"}) == filled([], {"j"}) == {}


@pytest.mark.more
def test_a_parameter_file_of_a_node_that_does_not_run_stays(package: Path) -> None:
    """Nothing proves what it is then; the argument is handed on all the same."""
    with_parameters(package, GIVEN)
    path = package / "launch/a.launch.py"
    text = path.read_text().replace(
        'executable="ros2_control_node",',
        'executable="ros2_control_node",\n            condition=IfCondition("false"),',
    )
    path.write_text(f"from launch.conditions import IfCondition\n{text}")
    made = adopt(str(package), trust=True)
    assert str(package / "config/c.yaml") not in made.after
    assert made.launches == (str(path),)
    assert b"ParameterFile" not in made.after[str(path)]


PLUGIN = (
    '<gazebo><plugin name="p" filename="libgazebo_ros_control.so"><robotNamespace>/demo'
    "</robotNamespace></plugin></gazebo>\n"
)


@pytest.mark.more
@pytest.mark.parametrize("own", [True, False])
def test_a_launch_file_puts_the_description_into_the_namespace_or_keeps_its_own(
    package: Path, own: bool
) -> None:
    (package / "urdf/r.urdf.xacro").write_text(ROBOT.format(JOINT + PLUGIN))
    path = package / "launch/a.launch.py"
    path.write_text(LAUNCH.replace("executable=", 'namespace="x", executable=') if own else LAUNCH)
    made = adopt(str(package), trust=True)
    assert (made.namespace, made.launches) == ("namespace", (str(path),))
    assert (b'" namespace:=", LaunchConfiguration("namespace")' in made.after[str(path)]) != own
    told = [it.why for it in made.left if it.place.startswith(str(path))]
    assert told == ["it has a namespace; give that to its xacro by hand"] * own


def test_sections_of_parameters_are_told_where_there_is_a_namespace(package: Path) -> None:
    (package / "config/c.yaml").write_text(MANAGED.format("drive", "x"))
    assert adopt(str(package)).left == ()
    (package / "urdf/r.urdf.xacro").write_text(ROBOT.format(JOINT + PLUGIN))
    (told,) = adopt(str(package)).left
    assert (told.place, told.why) == (
        f"{package}/config/c.yaml:2",
        "'controller_manager' matches no node in a namespace; write /**/controller_manager",
    )


@pytest.mark.more
def test_one_that_does_not_hand_it_on_is_left_as_it_was(package: Path) -> None:
    path = package / "launch/a.launch.py"
    path.write_text(EARLY)
    made = adopt(str(package), trust=True)
    assert made.launches == ()
    assert str(path) not in made.after
    (why,) = [it.why for it in made.left if it.place == str(path)]
    assert why.startswith("it does not hand prefix on")


@pytest.mark.more
def test_one_that_cannot_be_read_at_all_gets_it_and_is_not_proved(package: Path) -> None:
    path = package / "launch/a.launch.py"
    path.write_text(f"raise RuntimeError(1)\n{LAUNCH}")
    made = adopt(str(package), trust=True)
    assert (str(path) in made.after, made.launches) == (True, ())
    assert any("not verified" in it.why for it in made.left if it.place == str(path))


def test_a_launch_file_is_proved_behind_fences(package: Path) -> None:
    """What it does besides is refused, and it is not verified; ``trust`` lets it."""
    path, made = package / "launch/a.launch.py", package / "made"
    path.write_text(f"open({str(made)!r}, 'w')\n{LAUNCH}")
    found = adopt(str(package))
    assert str(path) in found.after and not made.exists()
    (why,) = [it.why for it in found.left if it.place == str(path)]
    assert "not verified" in why and "--trust" in why
    assert str(path) in adopt(str(package), trust=True).launches and made.exists()


def test_a_plain_srdf_becomes_a_xacro_beside_it(package: Path) -> None:
    srdf = package / "config/r.srdf"
    srdf.write_text(
        '<robot name="r"><group name="g"><joint name="j"/></group>'
        '<disable_collisions link1="base" link2="arm" reason="Adjacent"/></robot>'
    )
    write_files(package, {"launch/b.launch.py": "a = ('config/r.srdf', 'r.srdf.bak', 'or.srdf')\n"})
    write_files(package, {".setup_assistant": "srdf:\n  relative_path: config/r.srdf\n"})
    made = adopt(str(package))
    text = made.after[f"{srdf}.xacro"].decode()
    assert '<group name="g"><joint name="${prefix}j"/>' in text
    assert 'link1="${prefix}base" link2="${prefix}arm"' in text
    assert str(srdf) not in made.after
    why = "names 'config/r.srdf', which has no prefix; expand the .xacro next to it in its place"
    assert [(it.place.removeprefix(f"{package}/"), it.why) for it in made.left] == [
        (".setup_assistant:2", f"it {why}"), ("launch/b.launch.py:1", f"the launch file {why}")
    ]  # fmt: skip
    Path(f"{srdf}.xacro").write_text(text)
    assert b'link1="base"' in expand(f"{srdf}.xacro", {})


def test_names_in_code_and_data_are_listed_with_their_lines(package: Path) -> None:
    files = {
        "src/a.cpp": '// base\nauto frame = "base";\nauto other = "base_of_all";\n',
        "src/b.py": "x = 1\n\nframe = 'arm'\n",
        "config/c.yaml": "a:\n  ros__parameters: {joints: [j], frame: /base, own: based}\n",
    }
    write_files(package, files)
    made = adopt(str(package))
    assert [(it.place.removeprefix(f"{package}/"), it.why) for it in made.left] == [
        ("config/c.yaml:2", "it names 'j', which a prefix does not reach"),
        ("src/a.cpp:2", "its code names 'base', which a prefix does not reach"),
        ("src/b.py:3", "its code names 'arm', which a prefix does not reach"),
    ]


MANAGED = """\
# of the manager
controller_manager:
  ros__parameters:
    update_rate: 100
    {}: {{type: a/B}}
{}:
  ros__parameters: {{k: 1}}
"""


@pytest.mark.parametrize(
    ("texts", "said"),
    [
        ([MANAGED.format("drive", "drive")], ["p0.yaml:2 controller_manager 1 section more"]),
        ([MANAGED.format("drive", "amcl")], ["p0.yaml:2 controller_manager"]),
        (
            ["amcl:\n  ros__parameters: {}\n", MANAGED.format("amcl", "x")],
            ["p0.yaml:1 amcl", "p1.yaml:2 controller_manager"],
        ),
        (
            [MANAGED.format("amcl", "amcl").replace("type", "rate")],
            ["p0.yaml:2 controller_manager"],
        ),
        (["amcl:\n  ros__parameters: {}\n"], []),
        (["robot_state_publisher:\n  ros__parameters: {}\n"], ["p0.yaml:1 robot_state_publisher"]),
        (["controller_manager:\n  ros__parameters: [\n"], ["p0.yaml:1 controller_manager"]),
        (["- 1\n", "controller_manager: 1\n", "controller_manager: {ros__parameters: 1}\n"], []),
    ],
)
def test_sections_of_nodes_that_get_the_namespace_are_told(
    tmp_path: Path, texts: list[str], said: list[str]
) -> None:
    for at, text in enumerate(texts):
        (tmp_path / f"p{at}.yaml").write_text(text)
    found = list(root_sections([str(tmp_path / f"p{at}.yaml") for at in range(len(texts))]))
    names = [(it.place.rpartition("/")[2], it.why.rpartition("/")[2]) for it in found]
    more = [" 1 section more" if "1 section more" in it.why else "" for it in found]
    assert [f"{at} {name}{one}" for (at, name), one in zip(names, more, strict=True)] == said


@pytest.mark.parametrize("folder", ["build", "install", "log", "node_modules", ".git", "src/build"])
def test_what_a_build_made_is_not_searched(package: Path, folder: str) -> None:
    (package / folder).mkdir()
    (package / folder / "a.py").write_text("x = 'arm'\n")
    (package / "src" / "no_build.py").write_text("x = 'arm'\n")
    found = [it.place for it in named_elsewhere(str(package), ["arm"], ())]
    assert found == [f"{package}/src/no_build.py:1"]


@pytest.mark.parametrize("lines", [20, 23])
def test_of_many_lines_of_a_file_twenty_are_listed(package: Path, lines: int) -> None:
    (package / "src/a.py").write_text("x = 'arm'\n" * lines)
    *listed, last = [it.why for it in named_elsewhere(str(package), ["arm"], ())]
    listed += [last] if lines == 20 else []
    assert {*listed} == {"its code names 'arm', which a prefix does not reach"}
    assert len(listed) == 20
    assert lines == 20 or last == "its code names such names in other lines, too: 21, 22, 23"


@pytest.mark.parametrize("name", ["prefix", "tf_prefix"])
def test_a_description_that_takes_one_stays(
    package: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    own = f'<xacro:arg name="{name}" default=""/>'
    text = ROBOT.replace('name="base"', f'name="$(arg {name})base"')
    text = text.replace('name="arm"', f'name="$(arg {name})arm"').replace("<link", f"{own}<link", 1)
    text = text.format("")
    (package / "urdf/r.urdf.xacro").write_text(text)
    made = adopt(str(package))
    assert made.already == {str(package / "urdf/r.urdf.xacro"): name}
    assert made.after == {}
    assert main(["adopt", str(package)]) == 0
    assert f"it has such an argument already: {name}" in capsys.readouterr().err


def test_an_argument_with_the_name_of_the_robot_is_one(package: Path) -> None:
    own = '<xacro:arg name="robot_name" default="lbr"/>'
    text = ROBOT.format(JOINT).replace("<link", f"{own}<link", 1)
    for it in ("base", "arm", "j"):
        text = text.replace(f'"{it}"', f'"$(arg robot_name)_{it}"')
    (package / "urdf/r.urdf.xacro").write_text(text)
    assert list(adopt(str(package)).already.values()) == ["robot_name"]


def test_an_argument_for_something_else_is_none(package: Path) -> None:
    own = '<xacro:arg name="prefix" default=""/><xacro:property name="p" value="$(arg prefix)"/>\n'
    mesh = '<visual><geometry><mesh filename="${p}a.stl"/></geometry></visual>'
    text = ROBOT.replace('"base"/>', f'"base">{mesh}</link>').replace("  <link", f"{own}  <link", 1)
    (package / "urdf/r.urdf.xacro").write_text(text.replace("{}", JOINT))
    made = adopt(str(package))
    assert (made.argument, dict(made.already)) == ("robot_prefix", {})


def test_one_that_takes_it_and_one_that_does_not(package: Path) -> None:
    own = '<xacro:arg name="prefix" default=""/><link name="$(arg prefix)only"/>'
    (package / "urdf/other.urdf.xacro").write_text(f'<robot name="o" {SPACE}>{own}</robot>')
    made = adopt(str(package))
    assert list(made.already) == [str(package / "urdf/other.urdf.xacro")]
    assert made.verified == (str(package / "urdf/r.urdf.xacro"),)


def test_an_srdf_that_takes_one_stays_and_its_urdf_gets_the_same(package: Path) -> None:
    own = '<xacro:arg name="prefix" default=""/><group name="g"><link name="$(arg prefix)base"/>'
    srdf = package / "config/r.srdf.xacro"
    srdf.write_text(f'<robot name="r" {SPACE}>{own}</group></robot>')
    made = adopt(str(package))
    assert (made.argument, dict(made.already)) == ("prefix", {str(srdf): "prefix"})
    assert made.verified == (str(package / "urdf/r.urdf.xacro"),)
