# SPDX-License-Identifier: Apache-2.0
"""Random robots, and random ways to write each of them down."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import NamedTuple
from xml.sax.saxutils import escape

from expected_names import BARE_LAYOUTS
from hypothesis import strategies as st

LAYOUTS = (*BARE_LAYOUTS, "L2", "frames-per-robot", "L3", "both", "L4", "postfix")
SEPARATORS = {"link": "/ _ __ - .", "joint": "/ _ __ - .", "topic": "/ _"}

TRICKY = (
    "base_link", "x", "x_robot1", "x/robot1", "robot1/x", "robot1_x", "/x", "x/", "world", "map",
    "odom", "arm", "arm_left", "arm_left_b", "left_b", "joint_1", "joint_10", "joint_1_b", "a b",
    "a.b", "a-b", "a&b", "it's", 'say "x"', "a>b", "a::b", "robot1", "ärm", "ось", "腕", "name", "1",
)  # fmt: skip
FAMILY = (
    "x",
    "/x",
    "x/",
    "x_robot1",
    "x/robot1",
    "robot1/x",
    "/robot1/x",
    "world",
    "/world",
    "/",
    "//",
)
names = st.sampled_from(TRICKY) | (
    st.text("ab1_-./ é", min_size=1, max_size=5).map(str.strip).filter(bool)
)
robot_names = st.sampled_from(("robot1", "r", "b", "left_b", "_b", "b_left", "robot_10", "link"))


class Element(NamedTuple):
    """An element to write; ``body`` is text or children."""

    tag: str
    attributes: tuple[tuple[str, str], ...]
    body: str | tuple[Element, ...] = ()


class Style(NamedTuple):
    """How a robot is written down."""

    seed: int
    newline: str
    indent: str
    prolog: str
    comments: bool
    escapes: bool


styles = st.builds(
    Style,
    st.integers(0, 9999),
    st.sampled_from(("\n", "\r\n", "")),
    st.sampled_from(("", "  ", "\t")),
    st.sampled_from(("", "<?xml version='1.0'?>\n", '<?xml version="1.0" encoding="utf-8"?>\r\n')),
    st.booleans(),
    st.sampled_from((False, False, False, True)),
)


class Robot(NamedTuple):
    """A random robot: its text and what is needed to judge refusals."""

    text: bytes
    style: Style


@st.composite
def random_robots(draw: st.DrawFn, extras: bool = True) -> Robot:
    """Return a random tree of links with all that may hang on it."""
    pool = draw(st.sampled_from((names, names, st.sampled_from(FAMILY))))
    links = draw(st.lists(pool, min_size=1, max_size=7, unique=True))
    joints = draw(st.lists(pool, min_size=len(links) - 1, max_size=len(links) - 1, unique=True))
    body = [element("link", {"name": name}, _geometry(name)) for name in links]
    for at, name in enumerate(joints):
        body.append(_joint(draw, name, links[draw(st.integers(0, at))], links[at + 1], joints))
    if extras:
        body += draw(st.lists(_extras(links, joints), max_size=4))
    body = draw(st.permutations(body))
    style = draw(styles)
    root = element("robot", {"name": draw(names)}, tuple(body))
    return Robot(write(root, style), style)


def element(
    tag: str, attributes: Mapping[str, str] | None = None, body: str | tuple[Element, ...] = ()
) -> Element:
    """Return an element from plain words."""
    return Element(tag, tuple((attributes or {}).items()), body)


def _geometry(name: str) -> tuple[Element, ...]:
    """Return a visual whose mesh path holds the link's name: it must stay."""
    mesh = element("mesh", {"filename": f"package://meshes/{name}.stl"})
    return (element("visual", {}, (element("geometry", {}, (mesh,)),)),)


def _joint(draw: st.DrawFn, name: str, parent: str, child: str, joints: list[str]) -> Element:
    kind = draw(st.sampled_from(("fixed", "continuous")))
    body = [element("parent", {"link": parent}), element("child", {"link": child})]
    if draw(st.booleans()):
        body.append(element("mimic", {"joint": draw(st.sampled_from(joints) | names)}))
    return element("joint", {"name": name, "type": kind}, tuple(body))


def _extras(links: list[str], joints: list[str]) -> st.SearchStrategy[Element]:
    """Whatever else stands below a root; references may lead nowhere, or have stray slashes."""
    stray = st.sampled_from(links).flatmap(lambda name: st.sampled_from((f"/{name}", f"{name}/")))
    link = st.sampled_from(links) | names | stray
    joint = st.sampled_from(joints or ["none"]) | names
    reference = (link | joint).map(lambda name: {"reference": name})
    block = st.tuples(plugins(link, joint))
    return (
        st.builds(element, st.just("gazebo"), reference, st.just((element("mu1", {}, "0.2"),)))
        | st.builds(element, st.just("gazebo"), st.just({}), block)
        | st.builds(_transmission, joint)
        | st.builds(_control, joint)
        | st.builds(lambda name: element("note", {"link": name}, name), link)
    )


def _transmission(joint: str) -> Element:
    body = (element("joint", {"name": joint}), element("actuator", {"name": "motor"}))
    return element("transmission", {"name": "drive"}, body)


def _control(joint: str) -> Element:
    plugin = element("plugin", {}, "mock_components/GenericSystem")
    interface = element("state_interface", {"name": "position"})
    body = (element("hardware", {}, (plugin,)), element("joint", {"name": joint}, (interface,)))
    return element("ros2_control", {"name": "arm", "type": "system"}, body)


def plugins(
    link: st.SearchStrategy[str], joint: st.SearchStrategy[str]
) -> st.SearchStrategy[Element]:
    """Return a plugin of each family, with a few of its parameters."""
    ros = st.sampled_from(ROS_BLOCKS)
    return st.one_of(
        st.builds(_diff_drive, joint, st.none() | link, st.none() | link, ros),
        st.builds(_laser, link),
        st.builds(_gz_drive, joint, link),
        st.builds(_unknown, link),
    )


ROS_BLOCKS = (
    None,
    (),
    (element("namespace", {}, "/demo"),),
    (element("remapping", {}, "cmd_vel:=demo/cmd_vel"), element("remapping", {}, " odom:=/odom ")),
    (element("argument", {}, "--ros-args"), element("remapping", {}, "/tf:=tf")),
)


def _diff_drive(
    joint: str, base: str | None, odom: str | None, ros: tuple[Element, ...] | None
) -> Element:
    body = [element("left_joint", {}, joint), element("right_joint", {}, f" {joint} ")]
    body += [element("robot_base_frame", {}, base)] if base else []
    body += [element("odometry_frame", {}, odom)] if odom else []
    body += [] if ros is None else [element("ros", {}, ros)]
    return _plugin("drive", "libgazebo_ros_diff_drive.so", body)


def _laser(link: str) -> Element:
    body = [element("topicName", {}, "/scan"), element("frameName", {}, link)]
    return _plugin("laser", "libgazebo_ros_laser.so", body)


def _gz_drive(joint: str, link: str) -> Element:
    body = [element("left_joint", {}, joint), element("child_frame_id", {}, link)]
    return _plugin("gz::sim::systems::DiffDrive", "gz-sim-diff-drive-system", body)


def _unknown(link: str) -> Element:
    return _plugin(link, "libnobody_knows.so", [element("frame", {}, link)])


def _plugin(name: str, filename: str, body: Sequence[Element]) -> Element:
    return element("plugin", {"name": name, "filename": filename}, tuple(body))


# Text of these, and no other, may be renamed beyond the references above.
PARAMETERS = {
    "left_joint", "right_joint", "robot_base_frame", "odometry_frame", "child_frame_id",
    "frameName", "topicName", "namespace", "remapping",
}  # fmt: skip

# ---------------------------------------------------------------- writing them down


def write(root: Element, style: Style) -> bytes:
    """Return the robot as text; every choice of spelling comes from the style's seed."""
    text = _written(root, style, random.Random(style.seed), 0)
    return f"{style.prolog}{text}{style.newline}".encode()


def _written(item: Element, style: Style, chance: random.Random, depth: int) -> str:
    head = item.tag + "".join(_attribute(pair, style, chance) for pair in item.attributes)
    head += chance.choice(("", "", " ", "\n  "))
    if not item.body:
        return f"<{head}/>" if chance.random() < 0.7 else f"<{head}></{item.tag}>"
    if isinstance(item.body, str):
        return f"<{head}>{_text(item.body, style, chance)}</{item.tag}>"
    lead = style.newline + style.indent * (depth + 1)
    inner = "".join(
        lead + _comment(child, style, chance) + _written(child, style, chance, depth + 1)
        for child in item.body
    )
    return f"<{head}>{inner}{style.newline}{style.indent * depth}</{item.tag}>"


def _attribute(pair: tuple[str, str], style: Style, chance: random.Random) -> str:
    quote = chance.choice("\"'")
    gap, equals = chance.choice((" ", "\n    ", "\t")), chance.choice(("=", "=", " = "))
    value = _escaped(pair[1], style, chance).replace(quote, "&quot;" if quote == '"' else "&apos;")
    return f"{gap}{pair[0]}{equals}{quote}{value}{quote}"


def _text(value: str, style: Style, chance: random.Random) -> str:
    pad = chance.choice(("", "", " ", "\n   "))
    return f"{pad}{_escaped(value, style, chance)}{pad}"


def _escaped(value: str, style: Style, chance: random.Random) -> str:
    text = escape(value) if chance.random() < 0.5 else escape(value).replace("&gt;", ">")
    if style.escapes and chance.random() < 0.3:
        return f"&#{ord(value[0])};{escape(value[1:])}"
    return text


def _comment(item: Element, style: Style, chance: random.Random) -> str:
    if not style.comments or chance.random() < 0.6:
        return ""
    return chance.choice(COMMENTS)


COMMENTS = (
    '<!-- <link name="x"/> -->',
    "<!-->-->",
    "<!-- don't <joint \"-->",
    "<?keep <link name='x'/>?>",
    "<![CDATA[ <link> ]]>",
)
