# SPDX-License-Identifier: Apache-2.0
"""The public calls as a caller meets them: typed options, wrong arguments, copies, docstrings."""

from __future__ import annotations

import inspect
import io
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from lxml import etree
from paths import ROOT
from public_calls import FLEET, PARAMS, ROVER, SMALL

import multibot_rewrite
from multibot_rewrite import (
    LoadedFleet,
    UsageError,
    explain,
    load_fleet,
    rewrite,
    rewrite_all,
    strip,
)
from multibot_rewrite.base import naming
from multibot_rewrite.base.arguments import checked
from multibot_rewrite.base.naming import Policy, make_naming
from multibot_rewrite.fleet.robots.node_names import NodeNames

CALLS = (rewrite, rewrite_all, explain, strip)


@pytest.fixture
def fleet(tmp_path: Path) -> LoadedFleet:
    (tmp_path / "rover.urdf").write_bytes(ROVER.read_bytes())
    (tmp_path / "params.yaml").write_text(PARAMS)
    (tmp_path / "fleet.yaml").write_text(FLEET)
    return load_fleet(tmp_path / "fleet.yaml")


# ---------------------------------------------------------------- options


@pytest.mark.parametrize("call", CALLS)
def test_the_naming_options_are_the_same_everywhere(call: Callable[..., object]) -> None:
    wanted = inspect.signature(make_naming).parameters
    found = inspect.signature(call).parameters
    assert tuple(wanted) == tuple(Policy.__annotations__)
    for name, parameter in wanted.items():
        own = found[name]
        types = [
            eval(it, vars(naming)) if isinstance(it, str) else it
            for it in (own.annotation, parameter.annotation)
        ]
        assert types[0] == types[1]
        assert own.default == parameter.default
        assert own.kind is inspect.Parameter.KEYWORD_ONLY


def test_one_robot_and_many_take_the_same_options() -> None:
    one, many = (dict(inspect.signature(it).parameters) for it in (rewrite, rewrite_all))
    del one["robot"], many["robots"]
    assert one == many


@pytest.mark.parametrize("call", [*CALLS, load_fleet])
def test_no_call_takes_options_that_it_does_not_list(call: Callable[..., object]) -> None:
    kinds = {it.kind for it in inspect.signature(call).parameters.values()}
    assert inspect.Parameter.VAR_KEYWORD not in kinds


RIGHT = """\
from pathlib import Path
from multibot_rewrite import explain, load_fleet, rewrite, rewrite_all, strip
text: str = rewrite("r.urdf", "r1", layout="both", separators={"link": "_"}, topics=None).text
names = [it.robot for it in rewrite_all(b"<robot/>", {"r1", "r2"}, definitions=["a"], again=True)]
data: bytes = strip(Path("r.urdf"), "r1", affix="prefix", shared_frames=("map",))
reason: str = explain("r.urdf", 3, groups="rename")[0].reason
start: dict[str, object] = load_fleet("f.yaml").robot("r1").node("amcl", "p.yaml")
"""
WRONG = {
    'rewrite("r.urdf", "r1", layuot="both")': "layuot",
    'rewrite_all("r.urdf", ["r1"], afix="both")': "afix",
    'strip("r.urdf", "r1", layuot="both")': "layuot",
    'explain("r.urdf", 3, vocabulery=[])': "vocabulery",
    'load_fleet("f.yaml", robot="r1")': "robot",
    'rewrite("r.urdf", "r1", layout=3)': "int",
    'rewrite("r.urdf", ["r1"])': "list",
    'rewrite_all("r.urdf", None)': "None",
    'explain("r.urdf", "3")': "str",
}


@pytest.mark.deep
def test_mypy_sees_every_option(tmp_path: Path) -> None:
    """With a program of a caller: right calls are right, and each wrong one is one error."""
    program = tmp_path / "caller.py"
    lines = RIGHT.splitlines()
    program.write_text("\n".join([*lines, *WRONG]) + "\n")
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", program]
    found = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    errors = dict(re.findall(r"caller\.py:(\d+): error: (.*)", found))
    assert sorted(map(int, errors)) == [len(lines) + 1 + at for at in range(len(WRONG))], found
    for word, message in zip(WRONG.values(), errors.values(), strict=True):
        assert f'"{word}' in message, found


# ---------------------------------------------------------------- wrong arguments


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rewrite(SMALL, "r1", layuot="L1"), "'layuot'; did you mean 'layout'?"),
        (lambda: rewrite_all(SMALL, ["r1"], seperators={}), "did you mean 'separators'?"),
        (lambda: strip(SMALL, "r1", defintions=[]), "did you mean 'definitions'?"),
        (lambda: explain(SMALL, 1, afix="prefix"), "'afix'; did you mean 'affix'?"),
        (lambda: load_fleet(pathh="x"), "has no argument 'pathh'; did you mean 'path'?"),
        (lambda: load_fleet("x", zzz=1), "has no argument 'zzz'; it takes path"),
        (load_fleet, "missing a required argument: 'path'; it takes path"),
        (lambda: load_fleet("a", "b"), "too many positional arguments; it takes path"),
        (lambda: rewrite(SMALL, "r1", robot="r2"), "multiple values for argument 'robot'"),
    ],
)
def test_a_wrong_name_is_one_line(call: Callable[[], object], message: str) -> None:
    with pytest.raises(UsageError) as caught:
        call()
    assert re.match(r"(rewrite|rewrite_all|strip|explain|load_fleet)\(\)", str(caught.value))
    assert message in str(caught.value)


TEXTS = ("layout", "affix", "topics", "groups", "file")
NAMES = ("shared_frames", "shared_topics", "definitions")
MAPS = ("separators", "xacro_args")
NO_TEXT = (3, b"both", Path("both"), ["both"], True)
NO_NAMES = ("map", b"map", None, 3, ["map", 3], Path("map"))
NO_MAP = ("a:=b", ["a"], 3, {"link": None}, {3: "_"}, {"link": True})
SOME: Mapping[str, tuple[object, ...]] = {
    **dict.fromkeys(TEXTS, NO_TEXT),
    **dict.fromkeys(NAMES, NO_NAMES),
    **dict.fromkeys(MAPS, NO_MAP),
    "again": (1, None, "yes"),
    "urdf": (3, ["r.urdf"], True),
}


@pytest.mark.parametrize("call", CALLS)
def test_every_option_of_a_wrong_type_is_named(call: Callable[..., Any]) -> None:
    first: dict[str, tuple[object, ...]] = {"explain": (SMALL, 1), "rewrite_all": (SMALL, ["r1"])}
    options = [it for it in inspect.signature(call).parameters if it in SOME]
    assert len(options) >= 10
    for option in options:
        for value in SOME[option]:
            with pytest.raises(UsageError) as caught:
                call(*first.get(call.__name__, (SMALL, "r1")), **{option: value})
            assert f"{call.__name__}(): " in str(caught.value)
            assert option in str(caught.value)
            assert "; write " in str(caught.value)


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize(
    "source", [None, 3, ["r.urdf"], bytearray(b"<robot/>"), True, "", io.StringIO()]
)
def test_a_wrong_source_is_named(call: Callable[..., Any], source: object) -> None:
    second: dict[str, object] = {"explain": 1, "rewrite_all": ["r1"]}
    with pytest.raises(UsageError, match=r"\(\): source is .*; write a path, XML text or bytes"):
        call(source, second.get(call.__name__, "r1"))


@pytest.mark.parametrize("read", [etree, ElementTree], ids=["lxml", "python"])
def test_what_is_open_or_parsed_is_a_source(read: Any, tmp_path: Path) -> None:
    text = rewrite(SMALL, "r1").text
    (tmp_path / "small.urdf").write_text(SMALL)
    with open(tmp_path / "small.urdf") as file, open(tmp_path / "small.urdf", "rb") as binary:
        for source in (file, binary, io.StringIO(SMALL), io.BytesIO(SMALL.encode())):
            assert rewrite(source, "r1").text == text
    root = read.fromstring(SMALL)
    for source in (root, read.ElementTree(root)):
        assert rewrite(source, "r1").text == rewrite(read.tostring(root), "r1").text


@pytest.mark.parametrize("call", [rewrite, strip])
@pytest.mark.parametrize("robot", [None, 3, b"r1", ["r1"], Path("r1")])
def test_a_wrong_robot_is_named(call: Callable[..., Any], robot: object) -> None:
    with pytest.raises(UsageError, match=r"\(\): robot is .*; write "):
        call(SMALL, robot)


@pytest.mark.parametrize(
    ("robots", "message"),
    [
        ("robot1", "robots is a str; write ['robot1']"),
        ("robot1 robot2", "robots is a str; write ['robot1', 'robot2']"),
        ("robot1,robot2", "robots is a str; write ['robot1', 'robot2']"),
        (None, "robots is None; write a list of str"),
        (3, "robots is an int; write a list of str"),
        (b"r1", "robots is a bytes; write a list of str"),
        (Path("r1"), "robots is a PosixPath; write a list of str"),
        (["r1", None], "robots[1] is None; write a str"),
        (["r1", Path("r2")], "robots[1] is a PosixPath; write a str"),
        ([1], "robots[0] is an int; write '1'"),
    ],
)
def test_wrong_robots_are_named(robots: Any, message: str) -> None:
    with pytest.raises(UsageError) as caught:
        rewrite_all(SMALL, robots)
    assert str(caught.value) == f"rewrite_all(): {message}"


def test_an_argument_of_xacro_is_text() -> None:
    with pytest.raises(UsageError, match=r"xacro_args\['sim'\] is a bool; write 'true'"):
        rewrite("r.urdf.xacro", "r1", xacro_args={"sim": True})  # type: ignore[dict-item]


@pytest.mark.parametrize("line", [None, "3", 3.0, True])
def test_a_wrong_line_is_named(line: Any) -> None:
    with pytest.raises(UsageError, match=r"explain\(\): line is .*; write an int"):
        explain(SMALL, line)


@pytest.mark.parametrize("path", [None, 3, b"fleet.yaml", ["fleet.yaml"]])
def test_a_wrong_fleet_is_named(path: Any) -> None:
    with pytest.raises(UsageError, match=r"load_fleet\(\): path is .*; write a path"):
        load_fleet(path)


@pytest.mark.slow
@pytest.mark.parametrize(
    "ask",
    [
        lambda fleet, it: fleet.robot(it),
        lambda fleet, it: fleet.text(it),
        lambda fleet, it: fleet.parameters(it),
        lambda fleet, it: fleet.robots[0].frame(it),
        lambda fleet, it: fleet.robots[0].joint(it),
        lambda fleet, it: fleet.robots[0].topic(it),
        lambda fleet, it: fleet.robots[0].text(it),
        lambda fleet, it: fleet.robots[0].node(it),
        lambda fleet, it: fleet.robots[0].node("amcl", "params.yaml", it),
        lambda fleet, it: fleet.robots[0].params("params.yaml", it),
        lambda fleet, it: fleet.robots[0].start_parameters(it),
        lambda fleet, it: fleet.robots[0].table.for_node(it),
        lambda fleet, it: fleet.robots[0].table.full_name(it),
    ],
)
def test_a_wrong_argument_of_a_method_is_named(
    ask: Callable[[LoadedFleet, object], object], fleet: LoadedFleet
) -> None:
    for value in (None, 3, ["amcl"], b"amcl"):
        with pytest.raises(UsageError, match=r"^(Loaded|NodeNames)\w*\.\w+\(\): [\w\[\]]+ is "):
            ask(fleet, value)


def test_a_new_type_of_argument_needs_a_check() -> None:
    def call(size: complex) -> None:
        """No public call has such an argument."""

    with pytest.raises(KeyError, match="complex"):
        checked(call)


# ---------------------------------------------------------------- any iterable of robots


def generated() -> Iterator[str]:
    yield "r1"
    yield "r2"


@pytest.mark.parametrize(
    "robots",
    [
        ["r1", "r2"],
        ("r1", "r2"),
        generated(),
        {"r1": 1, "r2": 2},
        {"r1": 1, "r2": 2}.keys(),
        map(str, ["r1", "r2"]),
    ],
    ids=["list", "tuple", "generator", "dict", "keys", "map"],
)
def test_robots_come_in_any_iterable(robots: Any) -> None:
    assert [it.robot for it in rewrite_all(SMALL, robots)] == ["r1", "r2"]


def test_robots_may_be_a_set() -> None:
    found = {it.robot: it.text for it in rewrite_all(SMALL, {"r1", "r2"})}
    assert found == {it: rewrite(SMALL, it).text for it in ("r1", "r2")}


def test_options_come_in_any_iterable() -> None:
    text = rewrite(SMALL, "r1", shared_frames=(it for it in ["base"]), definitions=iter(())).text
    assert text == rewrite(SMALL, "r1", shared_frames=["base"]).text != SMALL


# ---------------------------------------------------------------- docstrings


PROPERTIES = (property, cached_property)


def public() -> Iterator[tuple[str, object]]:
    """Every function that is offered, and every method and property of what they return."""
    for name in (*multibot_rewrite.__all__, "NodeNames"):
        it = NodeNames if name == "NodeNames" else getattr(multibot_rewrite, name)
        if not isinstance(it, type):
            yield name, it
            continue
        for word, member in vars(it).items():
            if not word.startswith("_") and (callable(member) or isinstance(member, PROPERTIES)):
                yield f"{name}.{word}", member


PUBLIC = dict(public())


def test_the_public_names_are_found() -> None:
    known = {"rewrite", "load_fleet", "Rewrite.changes", "LoadedRobot.node", "LoadedFleet.made"}
    assert known <= PUBLIC.keys()
    assert len(PUBLIC) > 30


@pytest.mark.parametrize("name", PUBLIC)
def test_every_docstring_names_its_errors(name: str) -> None:
    text = inspect.getdoc(PUBLIC[name]) or ""
    found = re.search(r"[Rr]aises\s+(as|nothing|\w*Error|\w*Refused|InputError)", text)
    assert found, f"{name} does not say what it raises: {text!r}"


def test_errors_that_docstrings_name_exist() -> None:
    named = {
        word
        for it in PUBLIC.values()
        for word in re.findall(r"\b\w+(?:Error|Refused)\b", it.__doc__ or "")
    }
    assert {"InputError", "UsageError", "RewriteRefused"} <= named <= set(multibot_rewrite.__all__)


def test_nothing_of_the_library_trusts_a_xacro_by_itself() -> None:
    trusted = {call.__name__: inspect.signature(call).parameters.get("trust") for call in CALLS}
    assert {name: it.default for name, it in trusted.items() if it} == {
        name: False for name, it in trusted.items() if it
    }
    assert trusted["explain"] is not None
