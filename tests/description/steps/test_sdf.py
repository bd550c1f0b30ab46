# SPDX-License-Identifier: Apache-2.0
"""Every real SDF is rewritten and verified, or refused for a true reason; libsdformat sees it alike."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial
from pathlib import Path
from typing import NamedTuple

import pytest
import refusal_reasons
from case_files import load_cases
from expected_names import (
    ROBOT,
    Options,
    bare,
    changed_slots,
    frame_spelled,
    is_insertion,
    parsed,
    spelled,
)
from lxml import etree
from paths import CORPUS, FIXTURES, fixture_text
from postfix_command import run
from real_robots import spread
from refusals import STOPPED, check_refusal

from multibot_rewrite import MultibotError, ProofError, rewrite, strip

HOME = CORPUS / "sdf"
REFUSALS = FIXTURES / "sdf_refusals.json"
LEAST_FILES, LEAST_REWRITTEN, LEAST_VALID = 150, 100, 0.5
FEW = 12
OPTIONS: tuple[dict[str, str], ...] = ({}, {"layout": "L2", "affix": "prefix"})
KINDS = ("link", "joint", "frame", "model")


@pytest.fixture(scope="session")
def models() -> dict[str, Path]:
    """Return the real SDF files beside the repository, by their relative path."""
    found = {str(path.relative_to(HOME)): path for path in sorted(HOME.rglob("*.sdf"))}
    if not found:
        pytest.skip(f"no corpus of real SDF files: looked for {HOME}/**/*.sdf")
    return found


# ---------------------------------------------------------------- names and references by themselves


class Place(NamedTuple):
    """A reference: the model it is looked up in (None: outside of all), and its text."""

    scope: etree._Element | None
    text: str


def model_above(element: etree._Element) -> etree._Element | None:
    """Return the model that an element stands in."""
    return next(element.iterancestors("model"), None)


def name_of(element: etree._Element) -> str:
    """Return the name of a link, joint, frame, model or include."""
    own = element.findtext("name") if element.tag == "include" else element.get("name")
    return (own or "").strip()


def inside(scope: etree._Element, name: str) -> etree._Element | None:
    """Return what a model holds under that name."""
    for kind in (*KINDS, "include"):
        for child in scope.iterchildren(kind):
            if name_of(child) == name:
                return child
    return None


def target(place: Place) -> etree._Element | None:
    """Return what a reference leads to: an element of this file, or the include it goes into."""
    found, rest = place.scope, place.text
    while rest and found is not None and found.tag == "model":
        # Before SDF 1.8 a link may be called a::b.
        whole = inside(found, rest)
        name, _, below = rest.partition("::")
        found, rest = (inside(found, name), below) if whole is None else (whole, "")
    dead_end = rest and found is not None and found.tag != "include"
    return None if dead_end or found is place.scope else found


def references(root: etree._Element) -> Iterator[Place]:
    """Every reference of a model, in document order."""
    for element in root.iter("*"):
        above = model_above(element)
        if element.tag == "model":
            yield Place(element, element.get("canonical_link", ""))
            yield Place(element, element.get("placement_frame", ""))
        parent = element.getparent()
        if element.tag == "pose" and parent is not None:
            outer = model_above(parent) if parent.tag == "model" else above
            yield Place(outer, element.get("relative_to", element.get("frame", "")))
        if element.tag == "frame":
            yield Place(above, element.get("attached_to", ""))
        if parent is not None and parent.tag == "joint" and element.tag in ("parent", "child"):
            yield Place(above, (element.text or "").strip())
        yield Place(above, element.get("expressed_in", ""))


def new_name(kind: str, name: str, options: Options) -> str:
    """Return a declared name as the options ask for."""
    if kind in ("link", "frame"):
        return frame_spelled(name, options, ROBOT)
    return spelled(name, "_", options, ROBOT)


def problems(data: bytes, output: bytes, options: Options) -> Iterator[str]:
    """Where the output is not the same model under the new names."""
    before, after = parsed(data), bare(output, ROBOT)
    number = {element: at for at, element in enumerate(before.iter("*"))}
    number |= {element: at for at, element in enumerate(after.iter("*"))}
    for old, new in zip(before.iter(*KINDS), after.iter(*KINDS), strict=True):
        wanted = new_name(str(old.tag), name_of(old), options)
        if is_declared(old) and name_of(new) != wanted:
            yield f"{old.tag} {name_of(old)!r} became {name_of(new)!r}"
    for was, now in zip(references(before), references(after), strict=True):
        if number.get(target(was)) != number.get(target(now)):  # type: ignore[arg-type]
            yield f"{was.text!r} became {now.text!r}, which leads elsewhere"
    for slot, text in changed_slots(data, output):
        if slot.tag != "collision" and not is_insertion(slot.value, text):
            yield f"{slot} became {text!r}"


def is_declared(element: etree._Element) -> bool:
    """Return whether it is where SDF has models, links, joints and frames, and not in a plugin."""
    parent = element.getparent()
    return bool(name_of(element)) and parent is not None and parent.tag in ("sdf", "model")


# ---------------------------------------------------------------- every real file


def outcome(data: bytes, options: Options) -> refusal_reasons.Outcome:
    """Rewrite one file and look at the result with other eyes."""
    try:
        output = rewrite(data, ROBOT, **options).data
    except ProofError as error:
        return refusal_reasons.Outcome("", str(error))
    except MultibotError as error:
        return refusal_reasons.Outcome(refusal_reasons.reason(error), "")
    wrong = [*problems(data, output, options)]
    if strip(output, ROBOT, **options) != data:
        wrong.append("strip does not give the input back")
    return refusal_reasons.Outcome("", "; ".join(wrong))


@pytest.mark.sample(2)
@pytest.mark.slow
@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_every_model_is_rewritten_or_refused(models: dict[str, Path], options: Options) -> None:
    found = {name: outcome(path.read_bytes(), options) for name, path in models.items()}
    wrong = [f"{name}: {it.problem}" for name, it in found.items() if it.problem]
    assert not wrong, f"{len(wrong)} of {len(models)} files:\n" + "\n".join(wrong[:20])
    assert {name: it.reason for name, it in found.items() if it.reason} == on_record()
    assert len(found) >= LEAST_FILES
    assert len(found) - len(on_record()) >= LEAST_REWRITTEN


def on_record() -> dict[str, str]:
    """Return the committed refusals."""
    table: dict[str, str] = json.loads(REFUSALS.read_text())
    return table


def test_every_refusal_is_true(models: dict[str, Path]) -> None:
    wrong = [
        f"{name}: {why}"
        for name, why in on_record().items()
        if not is_true(why, models[name].read_bytes())
    ]
    assert wrong == []


def is_true(why: str, data: bytes) -> bool:
    """Return whether the reason holds, by other means than the package's; False if unknown."""
    if found := re.fullmatch(r"MB109 world '(.*)' cannot be rewritten for one robot", why):
        worlds = parsed(data).findall("world")
        return found[1] in [world.get("name", "") for world in worlds]
    return why.startswith("MB105") and refusal_reasons.is_true(why, data)


@pytest.mark.parametrize(
    ("why", "data"),
    [
        ("MB109 world 'w' cannot be rewritten for one robot", "<sdf><model name='w'/></sdf>"),
        ("MB109 world 'w' cannot be rewritten for one robot", "<sdf><world name='v'/></sdf>"),
        ("MB105 xacro element <arg>", "<sdf><arg/></sdf>"),
        ("MB104 something else", "<sdf/>"),
    ],
)
def test_an_untrue_refusal_is_noticed(why: str, data: str) -> None:
    assert not is_true(why, data.encode())


# ---------------------------------------------------------------- the judges see a wrong name

NESTED = fixture_text("sdf_nested.sdf").encode()
WRONG = [
    pytest.param(b'attached_to="base/robot1"', b'attached_to="base"', id="not-renamed"),
    pytest.param(b">left_robot1::wheel/", b">right_robot1::wheel/", id="another-model"),
    pytest.param(b"<parent>mount/", b"<parent>hub/", id="another-frame"),
    pytest.param(b"::wheel/robot1<", b"::wheel_robot1<", id="another-kind"),
    pytest.param(b'canonical_link="base/', b'canonical_link="left_robot1::tyre/', id="canonical"),
]
DECLARED = [
    pytest.param(b"mount/robot1", b"mount/robot2", id="frame-of-another-robot"),
    pytest.param(b'<joint name="axle_', b'<joint name="axel_', id="joint"),
    pytest.param(b"rover_robot1", b"rover", id="model-not-renamed"),
]


# A name that is a link here and a joint there.
TWO_KINDS = fixture_text("sdf_two_kinds.sdf").encode()


def test_a_scope_decides_what_a_name_is_of() -> None:
    """Of a model that is not there nothing is known, and nothing is changed."""
    options = {"layout": "L2", "separators": {"link": "/", "joint": "_"}}
    made = etree.fromstring(rewrite(TWO_KINDS, "r1", **options).data)  # type: ignore[arg-type]
    found = {it.get("name"): it.get("attached_to") for it in made.iter("frame")}
    assert found == {
        "on_link/r1": "x/r1",
        "on_joint/r1": "x_r1",
        "on_a/r1": "a_r1::x/r1",
        "on_b/r1": "b_r1::x_r1",
        "on_none/r1": "c::x",
    }


FLAT = b"""<sdf version="1.7">
  <model name="rover">
    <link name="base"/>
    <link name="arm::base"/>
    <joint name="arm::j" type="fixed"><parent>base</parent><child>arm::base</child></joint>
  </model>
</sdf>
"""


def test_a_wrong_flattened_name_is_noticed() -> None:
    output = rewrite(FLAT, ROBOT).data
    right, wrong = b"<child>arm::base/robot1<", b"<child>base/robot1<"
    assert right in output
    assert [*problems(FLAT, output, {})] == []
    assert [*problems(FLAT, output.replace(right, wrong), {})] != []


@pytest.mark.parametrize(("old", "new"), [*WRONG, *DECLARED])
def test_a_wrong_name_is_noticed(old: bytes, new: bytes) -> None:
    output = rewrite(NESTED, ROBOT).data
    assert old in output
    assert [*problems(NESTED, output, {})] == []
    assert [*problems(NESTED, output.replace(old, new), {})] != []


# ---------------------------------------------------------------- libsdformat as a referee


class Graph(NamedTuple):
    """A graph that libsdformat prints: scoped names, and (from, to, label) of its edges."""

    nodes: frozenset[str]
    edges: frozenset[tuple[str, str, str]]


Tool = Callable[..., str]


@pytest.fixture(scope="session")
def sdf_tool(tmp_path_factory: pytest.TempPathFactory) -> Tool:
    """Return a function that runs ``gz sdf`` or ``ign sdf`` and returns its standard output."""
    path = tmp_path_factory.mktemp("sdf") / "nested.sdf"
    path.write_bytes(NESTED)
    for command in filter(None, map(shutil.which, ("gz", "ign"))):
        tool = partial(printed, command)
        if is_valid(tool, path):
            return tool
    pytest.skip("libsdformat is missing: apt install ignition-tools libsdformat-dev")


def printed(command: str, *arguments: str) -> str:
    """Return the standard output of one call."""
    run = [command, "sdf", *arguments]
    return subprocess.run(run, capture_output=True, text=True, check=False, timeout=60).stdout


def is_valid(tool: Tool, path: Path) -> bool:
    """Return whether libsdformat takes the file without an error."""
    return "Valid." in tool("-k", str(path))


def graph(tool: Tool, kind: str, path: Path) -> Graph:
    """Return the graph of that kind."""
    text = tool("-g", kind, str(path))
    names = dict(re.findall(r'^ *(\d+) \[label="(.*) \(\d+\)"\];', text, re.MULTILINE))
    edges = re.findall(r"^ *(\d+) -> (\d+) \[label=(.*)\];", text, re.MULTILINE)
    assert names and edges, text
    return Graph(
        frozenset(names.values()), frozenset((names[a], names[b], label) for a, b, label in edges)
    )


def scoped_names(data: bytes, options: Options) -> dict[str, str]:
    """Every scoped name of a model -> what it has to become."""
    found = {}
    for element in parsed(data).iter(*KINDS):
        path = [*reversed([*element.iterancestors("model")]), element]
        old = "::".join(name_of(step) for step in path)
        found[old] = "::".join(new_name(str(s.tag), name_of(s), options) for s in path)
        if element.tag == "model":
            found[f"{old}::__model__"] = f"{found[old]}::__model__"
    return found


def renamed(old: Graph, names: Mapping[str, str]) -> Graph:
    """Return the graph under the new names; what the model does not declare (``__root__``) stays."""

    def new(name: str) -> str:
        return names.get(name, name)

    return Graph(
        frozenset(map(new, old.nodes)), frozenset((new(a), new(b), c) for a, b, c in old.edges)
    )


def differences(tool: Tool, data: bytes, output: bytes, options: Options, home: Path) -> list[str]:
    """Where libsdformat does not see the same model under the new names."""
    before, after = home / "before.sdf", home / "after.sdf"
    before.write_bytes(data)
    after.write_bytes(output)
    if not is_valid(tool, after):
        return ["not valid any more"]
    names = scoped_names(data, options)
    wrong = []
    for kind in ("pose", "frame"):
        wanted, found = renamed(graph(tool, kind, before), names), graph(tool, kind, after)
        gaps = [*(wanted.nodes ^ found.nodes), *(wanted.edges ^ found.edges)]
        wrong += [f"{kind}: {gap}" for gap in gaps[:4]]
    return wrong


class Trial(NamedTuple):
    """A model and the options for it."""

    name: str
    data: bytes
    options: Options


def judge(tool: Tool, trials: list[Trial], home: Path) -> None:
    """No model differs, and enough of them were valid to mean something."""
    valid, wrong = 0, []
    for name, data, options in trials:
        (home / "before.sdf").write_bytes(data)
        if is_valid(tool, home / "before.sdf"):
            valid += 1
            output = rewrite(data, ROBOT, **options).data
            found = differences(tool, data, output, options, home)
            wrong += [f"{name} {options}: {found}"] if found else []
    assert not wrong, f"{len(wrong)} of {valid} models:\n" + "\n".join(wrong[:20])
    assert valid >= LEAST_VALID * len(trials), f"only {valid} of {len(trials)} are valid"


def trials(models: Mapping[str, Path], *options: Options) -> list[Trial]:
    """Return the models that are not refused."""
    names = [name for name in models if name not in on_record()]
    return [Trial(name, models[name].read_bytes(), each) for name in names for each in options]


@pytest.mark.slow
def test_libsdformat_sees_the_same(sdf_tool: Tool, models: dict[str, Path], tmp_path: Path) -> None:
    taken = {name: path for name, path in models.items() if name not in on_record()}
    few = trials(spread(taken, FEW), *OPTIONS)
    judge(sdf_tool, [Trial("nested", NESTED, OPTIONS[1]), *few[::12], *few[3::12]], tmp_path)


@pytest.mark.deep
@pytest.mark.parametrize("options", OPTIONS, ids=str)
def test_libsdformat_sees_the_same_in_many(
    sdf_tool: Tool, models: dict[str, Path], options: Options, tmp_path: Path
) -> None:
    """It is a process five times a model."""
    judge(sdf_tool, trials(models, options)[OPTIONS.index(options) :: 16], tmp_path)


@cache
def valid_cases() -> list[Trial]:
    """Return the case files of SDF that are models, with nothing but an affix to choose."""
    return [
        Trial(case.name, case.source, case.options)
        for case in load_cases()
        if case.expect == "changed" and case.source.count(b"<sdf ") and not case.finds
        if not case.options.keys() - {"affix"} and b"<include>" not in case.source
    ]


@pytest.mark.deep
def test_libsdformat_sees_the_same_in_the_cases(sdf_tool: Tool, tmp_path: Path) -> None:
    judge(sdf_tool, valid_cases()[::3], tmp_path)


@pytest.mark.slow
@pytest.mark.sample(3)
@pytest.mark.parametrize(("old", "new"), [WRONG[0], WRONG[1], DECLARED[0]])
def test_libsdformat_notices_a_wrong_name(
    sdf_tool: Tool, old: bytes, new: bytes, tmp_path: Path
) -> None:
    output = rewrite(NESTED, ROBOT).data
    assert old in output
    assert differences(sdf_tool, NESTED, output, {}, tmp_path) == []
    assert differences(sdf_tool, NESTED, output.replace(old, new), {}, tmp_path)


# ---------------------------------------------------------------- the command


@pytest.mark.more
def test_a_model_is_rewritten_and_stripped(tmp_path: Path) -> None:
    (tmp_path / "model.sdf").write_bytes(NESTED)
    assert run(tmp_path, "model.sdf", "r1", "r2", "-o", "{robot}/model.sdf").code == 0
    assert (tmp_path / "r2" / "model.sdf").read_bytes() == rewrite(NESTED, "r2").data
    assert run(tmp_path, "model.sdf", "r1", "r2", "-o", "{robot}.sdf").code == 0
    for robot in ("r1", "r2"):
        assert (tmp_path / f"{robot}.sdf").read_bytes() == rewrite(NESTED, robot).data
        back = run(tmp_path, f"{robot}.sdf", robot, "--undo")
        assert (back.code, back.out) == (0, NESTED)


@pytest.mark.more
def test_a_world_is_refused_with_a_way_out(tmp_path: Path) -> None:
    world = NESTED.replace(b'1.9">', b'1.9"><world name="w">').replace(b"</sdf>", b"</world></sdf>")
    (tmp_path / "w.sdf").write_bytes(world)
    done = run(tmp_path, "w.sdf", ROBOT, "-o", "out.urdf")
    check_refusal(
        tmp_path, done, STOPPED, ("w.sdf:1:20:", "MB109", "'w'", "model.sdf", "<include>")
    )
