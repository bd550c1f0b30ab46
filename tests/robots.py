"""Robots to test with: random ones, real ones, and what a rewrite must make of them.

The expectation is computed here from the parsed text alone; nothing of it comes from the package.
"""

from __future__ import annotations

import importlib.metadata
import random
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple
from xml.sax.saxutils import escape

from hypothesis import strategies as st
from lxml import etree

REPO = Path(__file__).parents[1]
FIXTURES = REPO / "fixtures"
CORPUS = REPO.parent / "shared" / "corpus"
WHEELS = (
    "airo-models",
    "dexmate-urdf",
    "hello-robot-stretch-urdf",
    "hex-util-urdf",
    "icub-models",
    "robot-properties-fingers",
)
OPTIONAL_WHEELS = ("example-robot-data",)
ROBOT = "robot1"
BARE_LAYOUTS = ("L1", "tf-per-robot")
LAYOUTS = (*BARE_LAYOUTS, "L2", "frames-per-robot", "L3", "both", "L4", "postfix")
SEPARATORS = {"link": "/ _ __ - .", "joint": "/ _ __ - .", "topic": "/ _"}
Options = Mapping[str, object]

# ---------------------------------------------------------------- real files


def corpus_files() -> dict[str, Path]:
    """Every URDF of the corpus, by its path there; empty where there is none."""
    home = CORPUS / "urdf"
    return {str(path.relative_to(home)): path for path in sorted(home.rglob("*.urdf"))}


def wheel_files() -> dict[str, Path]:
    """Every URDF of the installed description wheels."""
    found: dict[str, Path] = {}
    for name in (*WHEELS, *OPTIONAL_WHEELS):
        found |= {f"{name}/{path.as_posix().lstrip('./')}": full for path, full in _urdfs(name)}
    return found


def _urdfs(name: str) -> Iterator[tuple[importlib.metadata.PackagePath, Path]]:
    try:
        wheel = importlib.metadata.distribution(name)
    except importlib.metadata.PackageNotFoundError:
        return
    for path in sorted(wheel.files or ()):
        if path.suffix == ".urdf":
            yield path, Path(str(wheel.locate_file(path))).resolve()


def spread(files: Mapping[str, Path], count: int) -> dict[str, Path]:
    """About ``count`` of the files, at equal distances."""
    step = max(1, len(files) // count)
    return dict(islice(list(files.items())[::step], count))


# ---------------------------------------------------------------- what a rewrite must make


class Names(NamedTuple):
    """Old name -> new name of the links and joints that stand directly below the root."""

    link: dict[str, str]
    joint: dict[str, str]


class Slot(NamedTuple):
    """One attribute or text; ``attribute`` is empty for text."""

    tag: str
    attribute: str
    value: str


def spelled(name: str, separator: str, options: Options, robot: str) -> str:
    """A declared link's or joint's name as the options ask for."""
    if options.get("layout") in BARE_LAYOUTS:
        return name
    if options.get("affix", "postfix") == "postfix":
        return f"{name}{separator}{robot}"
    slash = "/" if name.startswith("/") else ""
    return f"{slash}{robot}{separator}{name[len(slash) :]}"


def frame_spelled(name: str, options: Options, robot: str) -> str:
    """A frame's or link's name; shared ones stay, with or without slashes around."""
    shared = options.get("shared_frames", ("world", "map"))
    if name.strip("/") in {str(frame).strip("/") for frame in shared}:  # type: ignore[attr-defined]
        return name
    return spelled(name, _separator(options, "link", "/"), options, robot)


def _separator(options: Options, kind: str, default: str) -> str:
    given = options.get("separators") or {}
    return given.get(kind, default)  # type: ignore[attr-defined, no-any-return]


def new_names(root: etree._Element, options: Options, robot: str) -> Names:
    """What the links and joints of a description are called for a robot."""
    underscore = _separator(options, "joint", "_")
    return Names(
        {name: frame_spelled(name, options, robot) for name in _named(root, "link")},
        {name: spelled(name, underscore, options, robot) for name in _named(root, "joint")},
    )


def _named(root: etree._Element, tag: str) -> list[str]:
    """The names of the elements that have one."""
    found = [element.get("name", "").strip() for element in root.iterchildren(tag)]
    return [name for name in found if name]


REFERENCES = {
    "joint/parent@link": ("link",),
    "joint/child@link": ("link",),
    "joint/mimic@joint": ("joint",),
    "gazebo@reference": ("link", "joint"),
    "transmission/joint@name": ("joint",),
    "ros2_control/joint@name": ("joint",),
}


def references(root: etree._Element) -> list[tuple[tuple[str, ...], str]]:
    """(kinds, value) of every reference below the root whose place any reader agrees on."""
    found = []
    for place, kinds in REFERENCES.items():
        path, _, attribute = place.partition("@")
        values = [element.get(attribute, "").strip() for element in root.iterfind(path)]
        found += [(kinds, value) for value in values]
    return found


def graph_problems(source: bytes, output: bytes, options: Options, robot: str = ROBOT) -> list[str]:
    """Where the output is not the same robot under the new names."""
    before, after = etree.fromstring(source), bare(output, robot)
    names, now = new_names(before, options, robot), new_names(after, {"layout": "L1"}, robot)
    problems = []
    for kind in Names._fields:
        wanted = Counter(getattr(names, kind).values())
        if wanted != Counter(getattr(now, kind).keys()):
            problems.append(f"{kind}s: wanted {[*wanted]}, got {[*getattr(now, kind)]}")
    pairs = zip(references(before), references(after), strict=True)
    return problems + [
        f"{kinds} {old!r} -> {new!r}"
        for (kinds, old), (_, new) in pairs
        if not _same_target(kinds, old, new, names, now)
    ]


def _same_target(kinds: tuple[str, ...], old: str, new: str, names: Names, now: Names) -> bool:
    """A reference that resolved leads to the renamed thing; any other still leads nowhere."""
    for kind in kinds:
        if old in getattr(names, kind):
            return bool(new == getattr(names, kind)[old])
    return not any(new in getattr(now, kind) for kind in kinds)


def bare(output: bytes, robot: str) -> etree._Element:
    """The output's tree without what its markers say was inserted."""
    root = etree.fromstring(output)
    for comment in list(root.iter(etree.Comment)):
        words = (comment.text or "").partition(":")[0].split()
        if words[:2] == ["multibot", robot]:
            parent = comment.getparent()
            assert parent is not None
            inserted = list(comment.itersiblings("*"))[: int(words[2])]
            comment.tail = "".join(item.tail or "" for item in (comment, *inserted))
            for item in inserted:
                parent.remove(item)
    return root


def slots(root: etree._Element) -> list[Slot]:
    """Every attribute and text of a tree, in document order."""
    found = []
    for element in root.iter("*"):
        tag = str(element.tag)
        text = [element.text or "", *(child.tail or "" for child in element)]
        values = [*element.attrib.items(), ("", "".join(text))]
        found += [Slot(tag, str(key), " ".join(str(value).split())) for key, value in values]
    return found


def changed_slots(source: bytes, output: bytes, robot: str = ROBOT) -> list[tuple[Slot, str]]:
    """Each slot whose value differs, with the new value; the trees must be alike otherwise."""
    before, after = slots(etree.fromstring(source)), slots(bare(output, robot))
    assert [slot[:2] for slot in before] == [slot[:2] for slot in after]
    pairs = zip(before, after, strict=True)
    return [(old, new.value) for old, new in pairs if old.value != new.value]


def is_insertion(old: str, new: str, robot: str = ROBOT) -> bool:
    """Is the new value the old one with nothing but the robot's name and separators put in?"""
    gap = rf"(?:[/_.-]{{0,2}}{re.escape(robot)}[/_.-]{{0,2}})?"
    pattern = gap + "".join(re.escape(letter) + gap for letter in old)
    return new != old and re.fullmatch(pattern, new, re.DOTALL) is not None


# ---------------------------------------------------------------- random robots

TRICKY = (
    "base_link", "x", "x_robot1", "x/robot1", "robot1/x", "robot1_x", "/x", "x/", "world", "map",
    "odom", "arm", "arm_left", "arm_left_b", "left_b", "joint_1", "joint_10", "joint_1_b", "a b",
    "a.b", "a-b", "a&b", "it's", 'say "x"', "a>b", "a::b", "robot1", "ärm", "ось", "腕", "name", "1",
)  # fmt: skip
FAMILY = ("x", "/x", "x/", "x_robot1", "x/robot1", "robot1/x", "/robot1/x", "world", "/world")
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
    """A random tree of links with all that may hang on it."""
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
    """An element from plain words."""
    return Element(tag, tuple((attributes or {}).items()), body)


def _geometry(name: str) -> tuple[Element, ...]:
    """A visual whose mesh path holds the link's name: it must stay."""
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
    """A plugin of each family, with a few of its parameters."""
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
    """The robot as text; every choice of spelling comes from the style's seed."""
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
