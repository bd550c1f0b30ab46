# SPDX-License-Identifier: Apache-2.0
"""Parts become one robot: the text by hand, what is refused, what two parts share, and back again."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree
from paths import fixture_text

from multibot_rewrite import InputError, Part, UsageError, join, split
from multibot_rewrite.cli.multibot import main
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.related_files.join import join_plain

ARM = fixture_text("join_arm.urdf")
HAND = """<!-- a hand: -- two - dashes --->
<robot name="hand"><link name="base"/><link name="finger"/>
<joint name="grip" type="fixed"><parent link="base"/><child link="finger"/></joint></robot>"""
HAND = HAND.replace("-- two - dashes --->", "two - dashes -->")
# By hand, from the page that describes the comments.
JOINED = fixture_text("join_joined.urdf")
BLOCK = '<gazebo><plugin filename="gz_ros2_control-system" name="c">{}</plugin></gazebo>'


def robot(inside: str, name: str = "r", head: str = "") -> str:
    return f'<robot name="{name}"{head}>{inside}</robot>'


def link(name: str, inside: str = "") -> str:
    return f'<link name="{name}">{inside}</link>'


def fixed(name: str, parent: str, child: str, inside: str = "", kind: str = "fixed") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{inside}{ends}</joint>'


def tree_of(data: bytes) -> etree._Element:
    return etree.fromstring(data, etree.XMLParser(remove_comments=True))


def names(data: bytes, tag: str) -> list[str | None]:
    return [it.get("name") for it in tree_of(data).iterchildren(tag)]


def joined(*inside: str, prefix: str = "p_", **more: object) -> bytes:
    """Return a base with one link and each text as a part on it."""
    first = Part(robot(link("base")), name="base")
    parts = [
        Part(robot(it), at="base", prefix=prefix and f"{prefix}{at}_", name=f"n{at}", **more)  # type: ignore[arg-type]
        for at, it in enumerate(inside)
    ]
    data = join([first, *parts]).data
    back = split(data)
    assert [back[f"n{at}"] for at in range(len(parts))] == [robot(it).encode() for it in inside]
    return data


def test_the_joined_text_is_the_parts_with_a_joint_between() -> None:
    parts = [Part(ARM, name="arm"), Part(HAND, "tool", (0, 0, 0.5, 0, 0, 1.5), "h_", "hand")]
    made = join(parts)
    assert made.text == JOINED
    assert (made.parts, made.notes, made.findings) == (("arm", "hand"), (), ())
    assert split(made.text) == {"arm": ARM.encode(), "hand": HAND.encode()}


def test_a_joined_description_is_the_first_part_of_another() -> None:
    once = join([Part(ARM, name="arm"), Part(HAND, "tool", prefix="h_")])
    twice = join([Part(once.data), Part(HAND, "h_finger", prefix="k_")])
    both = join([Part(ARM, name="arm"), *(Part(HAND, at, prefix=p) for at, p in _HANDS)])
    assert twice.data == both.data
    assert list(split(twice.data)) == ["arm", "h", "k"]
    with pytest.raises(UsageError, match="two parts are called 'h'"):
        join([Part(once.data), Part(HAND, "h_finger", prefix="k_", name="h")])
    with pytest.raises(InputError, match="it is joined itself; give its parts"):
        join([Part(ARM), Part(once.data, "tool")])


_HANDS = (("tool", "h_"), ("h_finger", "k_"))


def test_a_world_link_gives_way_to_the_link_that_the_part_is_on() -> None:
    origin = '<origin xyz="1 0 0" rpy="0 0 0"/>'
    inside = link("world") + link("foot") + fixed("stand", "world", "foot", origin)
    data = joined(inside, pose=(0, 0, 1, 0, 0, 1.5707963267948966))
    assert names(data, "link") == ["base", "p_0_foot"]
    stand = tree_of(data).find("joint")
    assert stand is not None and stand.get("name") == "p_0_stand"
    assert [it.attrib.get("link") for it in stand.iterchildren("parent", "child")] == [
        "base",
        "p_0_foot",
    ]
    where = stand.find("origin")
    assert where is not None
    found = [*map(float, f"{where.get('xyz')} {where.get('rpy')}".split())]
    assert found == pytest.approx([0, 1, 1, 0, 0, 1.5707963267948966], abs=1e-12)
    # Without a pose its own numbers stay as they are written.
    assert origin.encode() in joined(inside)


def test_two_arms_on_one_world() -> None:
    one = robot(link("world") + link("foot") + fixed("stand", "world", "foot"))
    parts = [Part(one, name="left"), Part(one, "world", (1, 0, 0, 0, 0, 0), "r_")]
    data = join(parts).data
    assert names(data, "link") == ["world", "foot", "r_foot"]
    assert tree_of(data).xpath("joint[2]/origin/@xyz") == ["1 0 0"]


GREY = '<material name="grey"><color rgba="{} 0.5 0.5 1"/></material>'
LOOKS = link("a", '<visual><material name="grey"/></visual>')


def test_a_material_of_two_parts_is_there_once_and_renamed_where_it_differs() -> None:
    same = joined(GREY.format("0.5") + LOOKS, GREY.format(".50") + LOOKS)
    assert names(same, "material") == ["grey"]
    other = joined(GREY.format("0.5") + LOOKS, GREY.format("0.6") + LOOKS)
    assert names(other, "material") == ["grey", "p_1_grey"]
    assert tree_of(other).xpath("//visual/material/@name") == ["grey", "p_1_grey"]
    odd = GREY.replace('"grey"', '"a &amp; b--c, %"') + LOOKS.replace('"grey"', '"a &amp; b--c, %"')
    odd = joined(odd.format("0.5"), odd.format("0.6"))
    assert names(odd, "material") == ["a & b--c, %", "p_1_a & b--c, %"]
    bare = joined('<material name="grey"/>' + link("a"), GREY.format("0.5") + LOOKS)
    assert names(bare, "material") == ["grey", "p_1_grey"]
    # A part without a prefix has a name.
    alone = joined(GREY.format("0.5") + link("b"), GREY.format("0.6") + LOOKS, prefix="")
    assert names(alone, "material") == ["grey", "n1_grey"]
    assert tree_of(alone).xpath("//visual/material/@name") == ["n1_grey"]


def test_a_controller_manager_is_there_once_with_the_files_of_both() -> None:
    first = BLOCK.format("<parameters>a.yaml</parameters>")
    second = BLOCK.format("<parameters>b.yaml</parameters><parameters>a.yaml</parameters>")
    data = joined(first + link("a"), second + link("a"))
    assert tree_of(data).xpath("//plugin/parameters/text()") == ["a.yaml", "b.yaml"]
    empty = joined(BLOCK.format("") + link("a"), second + link("a"))
    assert tree_of(empty).xpath("//plugin/parameters/text()") == ["b.yaml", "a.yaml"]


def test_controller_managers_of_two_simulators_both_stay_and_a_line_says_so() -> None:
    classic = BLOCK.format("").replace("gz_ros2_control-system", "libgazebo_ros2_control.so")
    first = Part(robot(link("base") + BLOCK.format("")))
    made = join([first, Part(robot(link("a") + classic), "base", prefix="p_", name="n")])
    assert tree_of(made.data).xpath("//plugin/@filename") == [
        "gz_ros2_control-system",
        "libgazebo_ros2_control.so",
    ]
    assert "makes a controller manager, and so does an earlier plugin" in made.notes[0]


def test_what_is_said_of_the_whole_robot_is_said_once_and_other_settings_are_told() -> None:
    state = '<gazebo><plugin filename="gz-sim-joint-state-publisher-system" name="j"/></gazebo>'
    data = joined(state + link("a"), f"{link('a')}<gazebo><!-- x -->{state[8:]}")
    assert len(tree_of(data).findall("gazebo")) == 1
    static = robot(link("a") + "\n<gazebo><static>true</static></gazebo>")
    made = join([Part(robot(link("base"))), Part(static, "base", prefix="p_")])
    assert made.notes == ("<text>:2: <static> now applies to the whole robot",)


def test_names_of_ros2_control_meet_and_take_the_prefix() -> None:
    control = (
        '<ros2_control name="hw" type="system"><hardware><plugin>x</plugin></hardware>'
        '<joint name="j"/><gpio name="io"/></ros2_control>'
    )
    inside = link("a") + link("b") + fixed("j", "a", "b") + control
    data = joined(inside, inside)
    assert names(data, "ros2_control") == ["p_0_hw", "p_1_hw"]
    assert tree_of(data).xpath("//gpio/@name") == ["p_0_io", "p_1_io"]
    with pytest.raises(InputError, match="ros2_control 'hw' is in <text>, too; give it a prefix"):
        others = inside.replace('"a"', '"c"').replace('"b"', '"d"').replace('"j"', '"k"')
        joined(inside, others, prefix="")


def test_topics_of_two_parts_are_told() -> None:
    camera = link("a") + (
        '<gazebo reference="a"><sensor name="s" type="camera"><topic>image</topic></sensor></gazebo>'
    )
    first = Part(robot(link("base")))
    parts = [Part(robot(camera), "base", prefix=it) for it in ("p_", "q_")]
    (note, *_) = join([first, *parts]).notes
    assert "p and q have the topic" in note
    assert "image" in note


def test_a_namespace_of_xml_goes_with_the_elements_that_use_it() -> None:
    head = ' xmlns:drake="http://drake.mit.edu"'
    part = robot(link("a", "<drake:x/>"), head=head)
    made = join([Part(robot(link("base"))), Part(part, "base", name="n")])
    assert b'<link xmlns:drake="http://drake.mit.edu" name="a">' in made.data
    assert split(made.data)["n"] == part.encode()


REFUSED = {
    "no link": (robot(""), "it has no link; give the file that has the robot"),
    "two roots": (robot(link("a") + link("b")), "2 of its links have no parent ('a' and 'b')"),
    "a joint to itself": (robot(link("a") + fixed("j", "a", "a")), "joins link 'a' to itself"),
    "a loop": (
        robot(link("a") + link("b") + fixed("j", "a", "b") + fixed("k", "b", "a")),
        "make a loop",
    ),
    "a child that is no link": (robot(link("a") + fixed("j", "a", "b")), "'b', which is no link"),
    "two parents": (
        robot(link("a") + link("b") + fixed("j", "a", "b") + fixed("k", "a", "b")),
        "link 'b' is the child of joints 'j' and 'k'",
    ),
    "two links of a name": (robot(link("a") + link("a")), "two links are called 'a'"),
    "an SDF": ('<sdf version="1.9"><model name="m"><link name="a"/></model></sdf>', "it is <sdf>"),
    "a xacro that is not expanded": (
        f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{link("${a}")}</robot>',
        "MB105",
    ),
    "no XML": ("<robot", "not well-formed"),
    "a world with shapes": (
        robot(link("world", "<visual/>") + link("a") + fixed("j", "world", "a")),
        "its link 'world' has shapes of its own",
    ),
    "a world alone": (robot(link("world")), "its link 'world' is all it has"),
    "a part that floats": (
        robot(link("world") + link("a") + fixed("j", "world", "a", kind="floating")),
        "joint 'j' is floating",
    ),
    "comments of a join in a part": (
        robot("<!-- multibot end x </robot> -->" + link("a")),
        "it is joined itself",
    ),
    "a joint called as the new one": (
        robot(link("a") + link("b") + fixed("n_mount", "a", "b")),
        "joint 'n_mount' is there already",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_part_that_cannot_be_joined_is_refused_in_one_line(case: str) -> None:
    text, wanted = REFUSED[case]
    with pytest.raises(InputError) as found:
        join([Part(robot(link("base"))), Part(text, "base", name="n")])
    assert wanted in str(found.value)
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("robot_file", "said"),
    [
        ('<xacro:include filename="part.xacro"/>', "give {}/arm.xacro, which includes it"),
        ('<xacro:include filename="middle.xacro"/>', "give {}/arm.xacro, which includes it"),
        ('<xacro:include filename="${1}art.xacro"/>', "give {}/arm.xacro, which includes it"),
        ('<xacro:include filename="${1}arts.xacro"/>', "give the file that has the robot"),
        ('<xacro:include filename="other/part.xacro"/>', "give the file that has the robot"),
    ],
)
def test_a_part_of_macros_says_which_file_includes_it(
    robot_file: str, said: str, tmp_path: Path
) -> None:
    head = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
    include = '<xacro:include filename="part.xacro"/>'
    middle = include if "middle" in robot_file else ""
    macro = '<xacro:macro name="m"/>'
    texts = {"part": macro, "middle": middle, "arm": robot_file, "one": link("a")}
    for name, text in texts.items():
        (tmp_path / f"{name}.xacro").write_text(f"{head}{text}</robot>")
    with pytest.raises(InputError) as found:
        join([Part(tmp_path / "one.xacro"), Part(tmp_path / "part.xacro", "a", prefix="p_")])
    wanted = f"it has no link; it defines macros; {said.format(tmp_path)}"
    assert str(found.value) == f"{tmp_path}/part.xacro (expanded): {wanted}"


# What a robot has once -> what it is called, and a part that has one.
SYSTEM = '<ros2_control name="{}" type="system"><hardware><plugin>a/B</plugin></hardware>{}'
OF_ONE = {
    "link": ("link", link("x") + fixed("on_{}", "{}", "x")),
    "joint": ("joint", link("y") + fixed("x", "{}", "y")),
    "transmission": ("transmission", '<transmission name="x"/>'),
    "hardware": ("ros2_control", SYSTEM.format("x", "</ros2_control>")),
    "gpio": ("gpio", SYSTEM.format("{}", '<gpio name="x"/></ros2_control>')),
    "sensor": ("sensor", SYSTEM.format("{}", '<sensor name="x"/></ros2_control>')),
}


@pytest.mark.parametrize("case", OF_ONE)
def test_what_a_robot_has_once_two_parts_may_not_both_have(case: str) -> None:
    word, inside = OF_ONE[case]
    first = robot(link("base") + inside.replace("{}", "base").replace('"y"', '"y1"'))
    other = robot(link("root") + inside.replace("{}", "root"))
    with pytest.raises(InputError) as found:
        join([Part(first, name="a"), Part(other, "base", name="b")])
    said = f"<text>: {word} 'x' is in <text>, too; give it a prefix (--prefix hand_)"
    assert str(found.value) == said
    assert b'name="b_x"' in join([Part(first, name="a"), Part(other, "base", prefix="b_")]).data


_TURNS = '<joint name="j{0}" type="{0}"><parent link="base"/><child link="{1}"/></joint>'
WHEELED = (
    '<robot name="w"><link name="base"/><link name="wheel"/><link name="mast"/>'
    f"{_TURNS.format('continuous', 'wheel')}{_TURNS.format('fixed', 'mast')}</robot>"
)
WRONG = {
    "one part": ([Part(ARM)], "one description alone"),
    "no link named": (
        [Part(ARM), Part(HAND, prefix="h_")],
        "name the link that it is fixed to with --at, as tool",
    ),
    "a link like none": (
        [Part(ARM), Part(HAND, "xyz", prefix="h_")],
        "no part before it has a link 'xyz'; name another one, as tool",
    ),
    "a root and what turns": (
        [Part(WHEELED), Part(HAND, prefix="h_")],
        "name the link that it is fixed to with --at, as mast, base",
    ),
    "a link that is not there": (
        [Part(ARM), Part(HAND, "tol", prefix="h_")],
        "has a link 'tol'; did you mean 'tool'?",
    ),
    "a first part on a link": ([Part(ARM, "x"), Part(HAND, "tool")], "it is the first part"),
    "a pose of five": ([Part(ARM), Part(HAND, "tool", (0,) * 5, "h_")], "six numbers"),
    "a pose without end": ([Part(ARM), Part(HAND, "tool", (float("inf"),) * 6, "h_")], "six"),
    "two of a name": (
        [Part(ARM), Part(HAND, "tool", prefix="h_"), Part(HAND, "tool", prefix="h")],
        "two parts are called 'h'",
    ),
    "a prefix of two words": ([Part(ARM), Part(HAND, "tool", prefix="a b")], "cannot start a name"),
    "no part": ([Part(ARM), "hand.urdf"], "write Part('arm.urdf')"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_call_is_told_in_one_line(case: str) -> None:
    parts, wanted = WRONG[case]
    with pytest.raises(UsageError) as found:
        join(parts)  # type: ignore[arg-type]
    assert wanted in str(found.value)
    assert "\n" not in str(found.value)


EDITED = {
    "the comment at the end": ("multibot end hand", "multibot endhand", "was edited by hand"),
    "what it is": ("multibot base arm", "multi base arm", "multibot join did not make it"),
    "a name without its prefix": ("h_finger", "finger", "h_"),
}


@pytest.mark.parametrize("case", EDITED)
def test_a_joined_text_that_was_edited_is_not_split(case: str) -> None:
    old, new, wanted = EDITED[case]
    with pytest.raises(InputError, match=wanted):
        split(JOINED.replace(old, new))


def test_the_command_joins_and_splits(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("arm.urdf").write_text(ARM)
    Path("hand.urdf").write_text(HAND)
    words = ["join", "arm.urdf", "hand.urdf", "--at", "tool", "--prefix", "h_"]
    assert main([*words, "--pose", "0 0 0.5 0 0 1.5", "-o", "out/r.urdf"]) == 0
    assert capsys.readouterr().err == "multibot: arm, h: joined; verified\n"
    assert Path("out/r.urdf").read_text() == JOINED.replace(" hand ", " h ").replace(
        "hand_mount", "h_mount"
    )
    Path("arm.urdf").write_bytes(Path("out/r.urdf").read_bytes())
    assert main(["join", "arm.urdf", "--undo", "-o", "."]) == 2
    assert "arm.urdf is a file that is read" in capsys.readouterr().err
    assert main(["join", "out/r.urdf", "--undo", "-o", "parts"]) == 0
    assert Path("parts/arm.urdf").read_text() == ARM
    assert Path("parts/h.urdf").read_text() == HAND


def test_arguments_go_to_the_xacro_before_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made = tmp_path / "x.urdf.xacro"
    made.write_text(
        '<robot name="x" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="n" default="a"/>'
        '<link name="$(arg n)"/></robot>'
    )
    words = ["join", str(made), "n:=one", str(made), "n:=two", str(made), "n:=three"]
    assert main([*words, "--at", "one", "--at", "two", "--prefix", "x", "--prefix", ""]) == 2
    assert "two parts are called 'x'" in capsys.readouterr().err
    assert main([*words, "--at", "one", "--at", "two", "--prefix", "y", "--prefix", "z"]) == 2
    assert "no part before it has a link 'two'" in capsys.readouterr().err
    assert main([*words, "--at", "one", "--at", "ytwo", "--prefix", "y", "--prefix", "z"]) == 0
    assert names(capsys.readouterr().out.encode(), "link") == ["one", "ytwo", "zthree"]


@pytest.mark.parametrize(
    ("words", "wanted"),
    [
        (["x:=1", "a.urdf"], "write it behind the xacro"),
        (
            ["a.urdf", "b.urdf", "--at", "x", "--at", "y"],
            "--at is given 2 times for 1 part after the first",
        ),
        (["a.urdf", "b.urdf", "--at", "x", "--pose", "1 2 x"], "write six numbers"),
        (["a.urdf", "b.urdf", "--undo", "-o", "out"], "--undo takes one file"),
        (["a.urdf", "--undo"], "name a folder for them with -o parts/"),
        (["a.urdf", "--undo", "-o", "out", "--at", "x"], "--at is for joining"),
        (["a.urdf", "b.urdf", "--at", "x"], "a.urdf: cannot be read"),
    ],
)
def test_a_wrong_command_is_told_in_one_line(
    words: list[str], wanted: str, capsys: pytest.CaptureFixture[str], here: Path
) -> None:
    assert main(["join", *words]) == 2
    said = capsys.readouterr().err
    assert wanted in said
    assert said.count("\n") == 1
    assert not list(here.iterdir())


def test_what_a_rewrite_refuses_is_one_line_too(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    made, base = tmp_path / "x.urdf", tmp_path / "base.urdf"
    made.write_text(robot(link("a") + "\n<x>${pi}</x>"))
    base.write_text(robot(link("base")))
    for first, second in ((base, made), (made, base)):
        words = ["join", str(first), str(second), "--at", "base", "--prefix", "x_"]
        assert main(words) == 2
        said = capsys.readouterr().err
        assert f"{made}:2:1: error: MB105" in said
        assert said.count("\n") == 1


def test_an_argument_that_no_xacro_has_is_told(tmp_path: Path) -> None:
    made = tmp_path / "x.urdf.xacro"
    made.write_text(robot(link("a"), head=' xmlns:xacro="http://www.ros.org/wiki/xacro"'))
    part = Part(made, "base", xacro_args={"typo": "1"})
    notes = join([Part(robot(link("base"))), part]).notes
    assert notes == (f"{made} (expanded): no file of the xacro has the argument typo",)


@pytest.mark.parametrize(
    ("files", "told"),
    [
        (("meshes/a.stl", "package://x/b.stl", "/abs/c.stl", ""), "'meshes/a.stl'"),
        (("b.stl", "a.stl", "c.stl"), "'b.stl'"),
        (("file:///a.stl", "/abs/c.stl"), ""),
    ],
)
def test_paths_that_lead_elsewhere_now_are_told(files: tuple[str, ...], told: str) -> None:
    shape = '<visual><geometry><mesh filename="{}"/></geometry></visual>'
    inside = link("a", "".join(map(shape.format, files)))
    made = join([Part(robot(link("base"))), Part(robot(inside), "base", name="n")])
    more = ", and 2 more" if files[0] == "b.stl" else ""
    what = (
        f"<text>: {told} is looked up from the folder of the file{more}; write package://NAME/..."
    )
    assert made.notes == ((what,) if told else ())


def test_a_picture_is_looked_up_from_there_too() -> None:
    colour = '<visual><material name="m"><texture filename="t.png"/></material></visual>'
    made = join([Part(robot(link("base"))), Part(robot(link("a", colour)), "base", name="n")])
    assert "'t.png' is looked up" in made.notes[0]


def test_a_plugin_that_is_not_known_takes_the_word_proved(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    inside = link("a") + '<gazebo><plugin filename="libmine.so" name="m"><x>a</x></plugin></gazebo>'
    made = join([Part(robot(link("base"))), Part(robot(inside), "base", prefix="p_")])
    assert made.not_verified == ("1 name not understood", "1 plugin not known")
    assert (
        join([Part(robot(link("base"))), Part(robot(inside), "base", name="n")]).not_verified == ()
    )
    for name, text in (("base", link("base")), ("part", inside)):
        (tmp_path / f"{name}.urdf").write_text(robot(text))
    words = [str(tmp_path / "base.urdf"), str(tmp_path / "part.urdf"), "--at", "base"]
    assert main(["join", *words, "--prefix", "p_"]) == 0
    said = capsys.readouterr().err.splitlines()
    assert (
        said[-1]
        == "multibot: base, p: joined, not verified: 1 name not understood, 1 plugin not known"
    )


def test_a_frame_that_its_own_author_lost_is_no_fault_of_the_join() -> None:
    inside = link("base") + (
        '<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">'
        "<frame_id>{model}/odom</frame_id></plugin></gazebo>"
    )
    made = join([Part(robot(inside)), Part(robot(link("a")), "base", name="n")])
    assert b"<frame_id>{model}/odom</frame_id>" in made.data


def test_two_materials_that_got_the_prefix_lose_it_again() -> None:
    def robot(name: str, link: str, red: str, blue: str) -> bytes:
        colours = "".join(
            f'<material name="{it}"><color rgba="{rgba}"/></material>'
            for it, rgba in (("red", red), ("blue", blue))
        )
        return f'<robot name="{name}">{colours}<link name="{link}"/></robot>'.encode()

    arm = robot("arm", "base", "1 0 0 1", "0 0 1 1")
    hand = robot("hand", "palm", "0.5 0 0 1", "0 0 0.5 1")
    made = join([Part(arm), Part(hand, "base", prefix="h_", name="hand")])
    assert all(f'<material name="h_{it}">'.encode() in made.data for it in ("red", "blue"))
    assert split(made.data)["hand"] == hand


def test_a_fleet_of_parts_tells_meshes_that_are_looked_up_beside_their_file(tmp_path: Path) -> None:
    arm = tmp_path / "arm.urdf"
    mesh = '<visual><geometry><mesh filename="m/a.stl"/></geometry></visual>'
    arm.write_text(f'<robot name="arm"><link name="base">{mesh}</link></robot>')
    parts = Part(str(arm)), Part(str(arm), at="base", prefix="left_")
    made = join_plain(parts, "fleet.yaml:1", builtin_tree((), "jazzy"), False)
    assert any("'m/a.stl' is looked up from the folder" in it for it in made.notes)
