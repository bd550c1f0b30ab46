# SPDX-License-Identifier: Apache-2.0
"""An SRDF beside its URDF: every link and joint is spelled as there, and nothing else changes."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from expected_names import ROBOT, Options, Slot, changed_slots, frame_spelled, spelled
from lxml import etree
from paths import CORPUS, ROBOTS
from postfix_command import contents, run
from refusals import STOPPED, UNUSABLE, check_refusal, xacro

from multibot_rewrite import Finding, MultibotError, Rewrite, rewrite, rewrite_all, strip

HOME = CORPUS / "srdf"
LEAST_FILES, LEAST_COVERED = 100, 70
# Every fourth file with other options, all of them with -m deep.
SOME = 4
OPTIONS: tuple[dict[str, str], ...] = (
    {"layout": "L2", "affix": "prefix", "groups": "rename"},
    {"layout": "L1"},
    {"groups": "rename"},
)
ARM = ROBOTS / "two_finger_arm.urdf"
SHARED = ("world", "map")
# Where an SRDF names what; from srdfdom's model.cpp.
USES = {
    "robot@name": "model",
    "robot/group/link@name": "link",
    "robot/group/joint@name": "joint",
    "robot/group/passive_joint@name": "joint",
    "robot/group/chain@base_link": "link",
    "robot/group/chain@tip_link": "link",
    "robot/group/group@name": "group",
    "robot/group_state@group": "group",
    "robot/group_state/joint@name": "joint",
    "robot/end_effector@group": "group",
    "robot/end_effector@parent_link": "link",
    "robot/end_effector@parent_group": "group",
    "robot/virtual_joint@parent_frame": "frame",
    "robot/virtual_joint@child_link": "link",
    "robot/passive_joint@name": "joint",
    "robot/disable_collisions@link1": "link",
    "robot/disable_collisions@link2": "link",
    "robot/enable_collisions@link1": "link",
    "robot/enable_collisions@link2": "link",
    "robot/disable_default_collisions@link": "link",
    "robot/joint_property@joint_name": "joint",
    "robot/link_sphere_approximation@link": "link",
}
DECLARES = {
    "robot/group@name": "group",
    "robot/end_effector@name": "group",
    "robot/virtual_joint@name": "joint",
}
Names = dict[tuple[str, str], str]


class Pair(NamedTuple):
    """An SRDF and the URDF it is tested with; ``covered`` where that declares all it names."""

    srdf: bytes
    urdf: Path
    covered: bool


class Value(NamedTuple):
    """A name in an SRDF: whether it is declared there, its kind, and where it stands."""

    declares: bool
    kind: str
    slot: Slot
    line: int


# ---------------------------------------------------------------- what an SRDF names


def values(root: etree._Element) -> Iterator[Value]:
    """Every name of an SRDF, in document order."""
    for element in root.iter("*"):
        path = "/".join(
            [*reversed([str(e.tag) for e in element.iterancestors()]), str(element.tag)]
        )
        for attribute, value in element.attrib.items():
            place = f"{path}@{attribute}"
            kind = DECLARES.get(place) or USES.get(place)
            if kind and str(value).strip():
                slot = Slot(str(element.tag), str(attribute), " ".join(str(value).split()))
                yield Value(place in DECLARES, kind, slot, int(element.sourceline or 0))


def declared_by(urdf: bytes, rewritten: bytes) -> Names:
    """Kind and name of what a URDF declares -> the name it has once rewritten."""
    pairs = zip(_declarations(urdf), _declarations(rewritten), strict=True)
    return {old: new for old, (_, new) in pairs}


def _declarations(urdf: bytes) -> list[tuple[str, str]]:
    root = etree.fromstring(urdf)
    found = [("model", root.get("name", "").strip())]
    found += [(str(e.tag), e.get("name", "").strip()) for e in root.iterchildren("link", "joint")]
    return found


def new_names(srdf: etree._Element, urdf: Names, options: Options) -> Names:
    """Return the names of the URDF and those the SRDF itself declares."""
    names = dict(urdf)
    for value in values(srdf):
        if value.declares:
            stays = value.kind == "group" and options.get("groups") != "rename"
            name = value.slot.value
            new = name if stays else spelled(name, "_", options, ROBOT)
            names.setdefault((value.kind, name), new)
    return names


def expected(
    data: bytes, urdf: Names, options: Options
) -> tuple[list[tuple[Slot, str]], Counter[str]]:
    """Return the slots that change, and how often each name is reported for not being declared."""
    root = etree.fromstring(data)
    names = new_names(root, urdf, options)
    changes, missing = [], Counter[str]()
    for _, kind, slot, line in values(root):
        name = slot.value
        new = names.get((kind, name), name)
        if kind == "frame":
            new = names.get(("link", name), frame_spelled(name, options, ROBOT))
        elif (kind, name) not in names and name not in SHARED:
            missing[f"{name}@{line}"] += 1
        if new != name:
            changes.append((slot, new))
    return changes, missing


def reported(findings: tuple[Finding, ...]) -> Counter[str]:
    """Return the names that a rewrite reports as declared nowhere, with their lines."""
    texts = [(re.findall(r"names the [a-z ]+ '(.*)', which", f.message), f) for f in findings]
    return Counter(f"{names[0]}@{f.line}" for names, f in texts if names)


def without_values(data: bytes) -> bytes:
    """Return the text with every quoted value emptied."""
    return re.sub(rb"\"[^\"]*\"|'[^']*'", b"''", re.sub(rb"<!--.*?-->", b"", data, flags=re.DOTALL))


def comments(data: bytes) -> list[bytes]:
    """Return the comments of a text."""
    return re.findall(rb"<!--.*?-->", data, re.DOTALL)


def problems(pair: Pair, options: Options) -> Iterator[str]:
    """Whatever is wrong with one SRDF and its URDF, rewritten."""
    urdf = pair.urdf.read_bytes()
    both = rewrite(urdf, ROBOT, **options).data
    result = rewrite(pair.srdf, ROBOT, urdf=pair.urdf, **options)
    yield from wrong_in(result, pair.srdf, declared_by(urdf, both), options)
    if strip(result.data, ROBOT, urdf=both, **options) != pair.srdf:
        yield "strip does not give the input back"


def wrong_in(result: Rewrite, data: bytes, urdf: Names, options: Options) -> Iterator[str]:
    """Where a result is not the SRDF under the URDF's new names."""
    changes, missing = expected(data, urdf, options)
    found, told = changed_slots(data, result.data), reported(result.findings)
    if found != changes:
        yield f"changed otherwise: {sorted(set(found) ^ set(changes))[:4]}"
    if told != missing:
        yield f"reported otherwise: {told - missing}, {missing - told}"
    if without_values(data) != without_values(result.data):
        yield "more than values changed"
    if comments(data) != comments(result.data):
        yield "a comment changed"


# ---------------------------------------------------------------- real files


@pytest.fixture(scope="session")
def pairs(corpus: dict[str, Path]) -> dict[str, Pair]:
    """Every real SRDF with the real URDF that declares most of what it names."""
    files = sorted(HOME.rglob("*.srdf"))
    if not files:
        pytest.skip(f"no corpus of real SRDF files: looked for {HOME}/**/*.srdf")
    known = {path: set(_declarations(data)) for path, data in readable(corpus)}
    return {str(path.relative_to(HOME)): paired(path.read_bytes(), known) for path in files}


def readable(corpus: dict[str, Path]) -> Iterator[tuple[Path, bytes]]:
    """Yield the URDFs that are well-formed and need no xacro."""
    for path in corpus.values():
        data = path.read_bytes()
        try:
            etree.fromstring(data)
        except etree.XMLSyntaxError:
            continue
        if b"xacro:" not in data and b"${" not in data and b"$(" not in data:
            yield path, data


def paired(data: bytes, known: dict[Path, set[tuple[str, str]]]) -> Pair:
    """Return the SRDF with the URDF that declares most of it, and of those the smallest."""
    used = {
        (value.kind, value.slot.value)
        for value in values(etree.fromstring(data))
        if value.kind in ("link", "joint") and not value.declares
    }
    best = max(known, key=lambda path: (len(known[path] & used), -len(known[path])))
    return Pair(data, best, bool(used) and used <= known[best])


def judge(pairs: dict[str, Pair], options: Options) -> None:
    """No SRDF comes out wrong."""
    found = {name: [*problems(pair, options)] for name, pair in pairs.items()}
    wrong = [f"{name}: {it}" for name, it in found.items() if it]
    assert not wrong, f"{len(wrong)} of {len(pairs)} files:\n" + "\n".join(wrong[:20])


@pytest.mark.slow
@pytest.mark.parametrize(
    "part", [0, *(pytest.param(it, marks=pytest.mark.deep) for it in (1, 2, 3))]
)
def test_every_srdf_follows_its_urdf(pairs: dict[str, Pair], part: int) -> None:
    judge(dict([*pairs.items()][part::4]), {})
    assert len(pairs) >= LEAST_FILES
    assert sum(pair.covered for pair in pairs.values()) >= LEAST_COVERED


@pytest.mark.sample(3)
@pytest.mark.slow
@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_some_with_options(pairs: dict[str, Pair], options: Options) -> None:
    judge(dict([*pairs.items()][::SOME]), options)


# ---------------------------------------------------------------- the judge sees a wrong name

SRDF = b"""<?xml version="1.0"?>
<robot name="two_finger_arm">
  <group name="arm"><chain base_link="base_link" tip_link="wrist"/></group>
  <group name="hand"><joint name="wrist"/></group>
  <virtual_joint name="ground" type="fixed" parent_frame="world" child_link="table"/>
  <disable_collisions link1="wrist" link2="nothing" reason="wrist"/>
</robot>
"""
ARM_NAMES = declared_by(ARM.read_bytes(), rewrite(ARM, ROBOT).data)


def test_a_small_one_is_right() -> None:
    assert [*problems(Pair(SRDF, ARM, True), {})] == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b'name="wrist_robot1"', b'name="wrist/robot1"'),
        (b'tip_link="wrist/robot1"', b'tip_link="wrist"'),
        (b'reason="wrist"', b'reason="wrist/robot1"'),
        (b'name="ground_robot1"', b'name="ground"'),
        (b"<group name=", b"<group  name="),
        (b"<chain", b"<!-- --><chain"),
    ],
)
def test_a_wrong_output_is_noticed(old: bytes, new: bytes) -> None:
    output = rewrite(SRDF, ROBOT, urdf=ARM)
    assert old in output.data
    assert [*wrong_in(output._replace(data=output.data.replace(old, new, 1)), SRDF, ARM_NAMES, {})]


def test_a_name_not_reported_is_noticed() -> None:
    silent = rewrite(SRDF, ROBOT, urdf=ARM)._replace(findings=())
    (problem,) = wrong_in(silent, SRDF, ARM_NAMES, {})
    assert "reported otherwise" in problem


# ---------------------------------------------------------------- strip


def test_strip_needs_the_rewritten_urdf() -> None:
    urdf = rewrite(ARM, ROBOT).data
    srdf = rewrite(SRDF, ROBOT, urdf=ARM).data
    assert strip(srdf, ROBOT, urdf=urdf) == SRDF
    with pytest.raises(
        MultibotError, match=r"MB107 .* of the URDF does not have the name of robot1"
    ):
        strip(srdf, ROBOT, urdf=ARM)
    with pytest.raises(MultibotError, match="--urdf"):
        strip(srdf, ROBOT)


def test_an_srdf_that_says_nothing_is_one() -> None:
    empty = '<robot name="two_finger_arm">\n</robot>'
    new = '<robot name="two_finger_arm_robot1">\n</robot>'
    assert rewrite(empty, ROBOT, urdf=ARM).text == new
    urdf = rewrite(ARM, ROBOT).data
    assert strip(new, ROBOT, urdf=urdf) == empty.encode()


def test_two_robots_share_one_urdf() -> None:
    first, second = rewrite_all(SRDF, ["robot1", "robot2"], urdf=ARM)
    assert first.data.replace(b"robot1", b"robot2") == second.data


# ---------------------------------------------------------------- the command


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with an arm's URDF and SRDF."""
    (tmp_path / "arm.urdf").write_bytes(ARM.read_bytes())
    (tmp_path / "arm.srdf").write_bytes(SRDF)
    return tmp_path


MACRO = """
  <xacro:arg name="tip" default="wrist"/>
  <link name="base_link"/><link name="$(arg tip)"/>
  <joint name="wrist" type="fixed"><parent link="base_link"/><child link="$(arg tip)"/></joint>"""


@pytest.mark.more
def test_an_srdf_is_rewritten_and_stripped(folder: Path) -> None:
    done = run(folder, "arm.srdf", ROBOT, "--urdf", "arm.urdf", "-o", "out.srdf")
    assert done.code == 0
    assert "MB807" in done.err
    assert (folder / "out.srdf").read_bytes() == rewrite(SRDF, ROBOT, urdf=ARM).data
    assert run(folder, "arm.urdf", ROBOT, "-o", "out.urdf").code == 0
    back = run(folder, "out.srdf", ROBOT, "--undo", "--urdf", "out.urdf")
    assert (back.code, back.out) == (0, SRDF)


@pytest.mark.more
def test_several_robots_get_a_file_each(folder: Path) -> None:
    words = ("arm.srdf", "r1", "r2", "--urdf", "arm.urdf", "--separator", "group=_")
    assert run(folder, *words, "-o", "{robot}.srdf").code == 0
    for robot in ("r1", "r2"):
        wanted = rewrite(SRDF, robot, urdf=ARM, groups="rename").data
        assert (folder / f"{robot}.srdf").read_bytes() == wanted
    assert run(folder, *words).code == UNUSABLE


@pytest.mark.more
def test_the_urdf_may_be_xacro(folder: Path) -> None:
    (folder / "arm.urdf.xacro").write_text(xacro(MACRO))
    words = ("arm.srdf", ROBOT, "--urdf", "arm.urdf.xacro")
    plain, other = run(folder, *words), run(folder, *words, "tip:=nothing")
    assert b'tip_link="wrist/robot1"' in plain.out
    assert b'link2="nothing"' in plain.out
    assert b'tip_link="wrist"' in other.out
    assert b'link2="nothing/robot1"' in other.out


@pytest.mark.more
def test_an_srdf_may_be_xacro_beside_a_plain_urdf(folder: Path) -> None:
    group = (
        '<xacro:arg name="end" default="wrist"/><group name="a"><link name="$(arg end)"/></group>'
    )
    (folder / "arm.srdf.xacro").write_text(xacro(group))
    done = run(folder, "arm.srdf.xacro", ROBOT, "--urdf", "arm.urdf", "end:=table")
    assert b'<link name="table/robot1"/>' in done.out


BROKEN = '<robot name="two_finger_arm"><link name="a">'
LEFT = '<robot name="two_finger_arm"><link name="${a}"/></robot>'
SDF = '<sdf version="1.9"><model name="m"><link name="a"/></model></sdf>'
# Words of the call, the exit code, and what the one line has to say.
BAD = {
    "no-urdf": (("arm.srdf",), UNUSABLE, ("arm.srdf", "--urdf")),
    "strip-without-urdf": (("arm.srdf", "--undo"), UNUSABLE, ("arm.srdf", "--urdf")),
    "urdf-with-urdf": (("arm.urdf", "--urdf", "arm.urdf"), UNUSABLE, ("arm.urdf", "only an SRDF")),
    "sdf-with-urdf": (("arm.sdf", "--urdf", "arm.urdf"), UNUSABLE, ("arm.sdf", "only an SRDF")),
    "missing": (("arm.srdf", "--urdf", "no.urdf"), UNUSABLE, ("no.urdf", "is not there")),
    "folder": (("arm.srdf", "--urdf", "."), UNUSABLE, (".", "directory")),
    "broken": (("arm.srdf", "--urdf", "broken.urdf"), UNUSABLE, ("broken.urdf:1:", "well-formed")),
    "srdf-as-urdf": (("arm.srdf", "--urdf", "arm.srdf"), UNUSABLE, ("arm.srdf", "--urdf")),
    "xacro-left": (("arm.srdf", "--urdf", "left.urdf"), STOPPED, ("left.urdf:1:", "MB105")),
    "arguments-without-xacro": (
        ("arm.srdf", "--urdf", "arm.urdf", "tip:=a"),
        UNUSABLE,
        ("xacro", "arm.srdf"),
    ),
    "groups": (
        ("arm.srdf", "--urdf", "arm.urdf", "--separator", "group=renmae"),
        UNUSABLE,
        ("group='renmae'", "use one of / _"),
    ),
}


@pytest.mark.more
@pytest.mark.sample(4)
@pytest.mark.parametrize("name", BAD)
def test_what_cannot_work_is_one_line(folder: Path, name: str) -> None:
    words, code, wanted = BAD[name]
    (folder / "arm.sdf").write_text(SDF)
    (folder / "broken.urdf").write_text(BROKEN)
    (folder / "left.urdf").write_text(LEFT)
    before = contents(folder)
    done = run(folder, words[0], ROBOT, *words[1:], "-o", "out.urdf")
    check_refusal(folder, done, code, wanted)
    assert contents(folder) == before
