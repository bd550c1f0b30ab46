# SPDX-License-Identifier: Apache-2.0
"""Files of people, damaged in every way that an editor, a disk or a joker damages them.

A ``Place`` is a file that a command reads. ``damages`` makes the damaged ones, in a fixed order.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import random
import shutil
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import yaml
from fleet_folder import fleet_folder, mixed
from growing_files import message
from paths import FIXTURES, fixture_text

from multibot_rewrite.cli import urdf_lint, urdf_postfix
from multibot_rewrite.cli.multibot import main

GRAPHS = FIXTURES / "graphs"
LAUNCH_PY = fixture_text("damaged_launch_py.txt")
LAUNCH_XML = fixture_text("damaged_launch_xml.xml")
LAUNCH_YAML = fixture_text("damaged_launch_yaml.yaml")
LUA = fixture_text("damaged_lua.txt")
TREE = """\
<root BTCPP_format="4">
  <BehaviorTree ID="MainTree">
    <Sequence>
      <ComputePathToPose goal="{goal}" path="{path}" server_name="compute_path_to_pose"/>
      <FollowPath path="{path}" server_name="follow_path"/>
    </Sequence>
  </BehaviorTree>
</root>
"""
TOML = """\
select = ["MB2", "MB5"]
ignore = ["MB401"]
layout = "frames-per-robot"
robots = ["robot1", "robot2"]
"""
OTHER = """\
- name: dock
  frame_id: map
  pose: [1.0, 2.0, 0.0]
"""
NODES = (GRAPHS / "nodes.yaml").read_text()


class Place(NamedTuple):
    """A file, and the commands that read it."""

    file: str
    commands: tuple[tuple[str, ...], ...]


BUILD = ("multibot", "build", "fleet.yaml", "-o", "out", "--quiet")


def _related_file(file: str) -> Place:
    of_arm = file in ("limits.yaml", "arm.srdf")
    urdf = () if file == "tree.xml" else ("--urdf", "arm.urdf.xacro" if of_arm else "rover.urdf")
    own = ("urdf-postfix", file, "robot1", *urdf, "-o", "out")
    return Place(file, (BUILD, own, ("urdf-lint", file)))


PLACES = (
    Place(
        "fleet.yaml",
        (
            BUILD,
            ("multibot", "plan", "fleet.yaml", "-o", "out"),
            ("multibot", "check", "fleet.yaml", "--from", "graph.json", "-o", "out"),
        ),
    ),
    *map(
        _related_file,
        (
            "one_robot.rviz",
            "params.yaml",
            "bridge.yaml",
            "limits.yaml",
            "slam.lua",
            "tree.xml",
            "arm.srdf",
        ),
    ),
    Place(
        "arm.urdf.xacro",
        (
            BUILD,
            ("urdf-lint", "arm.urdf.xacro"),
            ("multibot", "init", "arm.urdf.xacro", "--yes", "-o", "out"),
        ),
    ),
    Place(
        "rover.urdf",
        (
            BUILD,
            ("urdf-lint", "rover.urdf"),
            ("multibot", "init", "rover.urdf", "--yes", "-o", "out"),
        ),
    ),
    *(
        Place(
            it,
            (("multibot", "check-launch", it, "-o", "out"), ("multibot", "plan", it, "-o", "out")),
        )
        for it in ("a.launch.py", "a.launch.xml", "a.launch.yaml")
    ),
    Place(
        "plan.yaml",
        (
            ("multibot", "check", "plan.yaml", "--from", "graph.json", "-o", "out"),
            ("multibot", "check-launch", "a.launch.py", "--plan", "plan.yaml", "-o", "out"),
        ),
    ),
    Place(
        "graph.json",
        (
            ("multibot", "check", "--from", "graph.json", "-o", "out"),
            ("multibot", "check", "plan.yaml", "--from", "graph.json", "-o", "out"),
            ("multibot", "snapshot", "--from", "graph.json", "-o", "out"),
        ),
    ),
    Place("message.yaml", (("multibot", "check", "--from", "message.yaml", "-o", "out"),)),
    Place(
        "nodes.yaml",
        (
            (
                "multibot",
                "plan",
                "rover.urdf",
                "robot1",
                "robot2",
                "--nodes",
                "nodes.yaml",
                "--node-set",
                "small",
                "-o",
                "out",
            ),
        ),
    ),
    Place(
        "urdf-lint.toml", (("urdf-lint", "rover.urdf", "--config", "urdf-lint.toml", "-o", "out"),)
    ),
)


def whole_folder(folder: Path) -> Path:
    """Return a folder in which each of the commands works."""
    fleet = mixed().replace(
        "related_files: {rviz: one_robot.rviz}",
        "related_files: {rviz: one_robot.rviz, lua: slam.lua, behavior_trees: [tree.xml]}",
    )
    fleet_folder(folder, fleet)
    for name, text in {
        "a.launch.py": LAUNCH_PY,
        "a.launch.xml": LAUNCH_XML,
        "a.launch.yaml": LAUNCH_YAML,
        "slam.lua": LUA,
        "tree.xml": TREE,
        "urdf-lint.toml": TOML,
        "nodes.yaml": NODES,
        "message.yaml": message(1),
    }.items():
        (folder / name).write_text(text)
    shutil.copy(GRAPHS / "plan.yaml", folder / "plan.yaml")
    shutil.copy(GRAPHS / "healthy.json", folder / "graph.json")
    return folder


# ---- damage

Bytes = Callable[[random.Random, bytes], bytes]


def _cut(chance: random.Random, data: bytes) -> bytes:
    return data[: chance.randrange(1, len(data))]


def _insert(*what: bytes) -> Bytes:
    def inserted(chance: random.Random, data: bytes) -> bytes:
        at = chance.randrange(len(data))
        return data[:at] + chance.choice(what) + data[at:]

    return inserted


def _line_twice(chance: random.Random, data: bytes) -> bytes:
    lines = data.splitlines(keepends=True)
    at = chance.randrange(len(lines))
    return b"".join((*lines[: at + 1], *lines[at:]))


def _line_gone(chance: random.Random, data: bytes) -> bytes:
    lines = data.splitlines(keepends=True)
    del lines[chance.randrange(len(lines))]
    return b"".join(lines)


def _swapped(chance: random.Random, data: bytes) -> bytes:
    lines = data.splitlines(keepends=True)
    chance.shuffle(lines)
    return b"".join(lines)


def _value(chance: random.Random, data: bytes) -> bytes:
    """Another text behind one colon or equals sign."""
    places = [at for at, it in enumerate(data) if it in b":="]
    if not places:
        return data
    at = chance.choice(places) + 1
    end = min(
        it
        for it in (data.find(b"\n", at), data.find(b",", at), data.find(b"}", at), len(data))
        if it >= 0
    )
    new = chance.choice(
        (
            b"",
            b" []",
            b" {}",
            b" 1",
            b" null",
            b" .nan",
            b" 1e999",
            b" -1",
            b" true",
            b' ""',
            b" '",
            b" [[]]",
            b" 2024-01-01",
            b" !!binary x",
            b" *a",
            b" &a",
            b" " + b"9" * 5000,
            b' "x"',
            b" 0x1F",
            b" ~",
            b" \xe9",
        )
    )
    return data[:at] + new + data[end:]


DEEP = 10_000
BY_CHANCE: Mapping[str, Bytes] = {
    "cut": _cut,
    "NUL": _insert(b"\0"),
    "latin-1": _insert("é".encode("latin-1")),
    "marks": _insert(b"\xef\xbb\xbf", b"\xff\xfe"),
    "signs": _insert(
        b"{",
        b"[",
        b"}",
        b"]",
        b"<",
        b">",
        b"&",
        b"*",
        b'"',
        b"'",
        b"#",
        b"\t",
        b"- ",
        b": ",
        b"---\n",
        b"${x}",
        b"$(x)",
        b"%",
        b"\x1b[31m",
        b"&x;",
        b"{robot}",
        b"\\",
    ),
    "a line twice": _line_twice,
    "a line gone": _line_gone,
    "lines in disorder": _swapped,
    "a value": _value,
}
ALWAYS_ALIKE: Mapping[str, Callable[[bytes], bytes]] = {
    "a mark in front": lambda data: b"\xef\xbb\xbf" + data,
    "two marks in front": lambda data: b"\xef\xbb\xbf\xef\xbb\xbf" + data,
    "CRLF": lambda data: data.replace(b"\n", b"\r\n"),
    "CR": lambda data: data.replace(b"\n", b"\r"),
    "UTF-16": lambda data: data.decode().encode("utf-16"),
    "empty": lambda _: b"",
    "blank": lambda _: b" \n\n",
    "a number": lambda _: b"3\n",
    "a list": lambda _: b"[]\n",
    "a mapping": lambda _: b"{}\n",
    "a word": lambda _: b"hello\n",
    "null": lambda _: b"null\n",
    "deep": lambda _: b"[" * DEEP + b"]" * DEEP,
    "deep elements": lambda _: b"<a>" * DEEP + b"</a>" * DEEP,
    "deep blocks": lambda _: b"".join(b" " * at + b"a:\n" for at in range(500)),
    "deep calls": lambda _: b"x = " + b"(" * DEEP + b")" * DEEP,
    "a circle": lambda data: b"a: &a [*a]\n" + data,
    "laughs": lambda data: (
        b"a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n"
        + b"".join(
            b"a%d: &a%d [%s]\n" % (at, at, b", ".join([b"*a%d" % (at - 1)] * 10))
            for at in range(1, 10)
        )
        + data
    ),
    "laughs in XML": lambda _: (
        b'<!DOCTYPE r [<!ENTITY l0 "ha">'
        + b"".join(b'<!ENTITY l%d "%s">' % (n, b"&l%d;" % (n - 1) * 10) for n in range(1, 10))
        + b"]>\n<launch>&l9;</launch>"
    ),
    "other text": lambda _: bytes(range(256)),
}
OTHER_VALUES: tuple[Any, ...] = (
    None,
    1,
    "",
    [],
    {},
    [[]],
    True,
    float("inf"),
    float("nan"),
    -1,
    10**30,
    "a b",
    "é",
    [1, "x"],
    {"a": {"b": []}},
    {1: 2},
    "../../x",
    "{robot}",
    "$(x)",
    "a" * 5000,
    [None],
    -0.0,
)


def paths_in(value: Any, way: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the way to each value."""
    yield way
    inner = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, below in inner:
        yield from paths_in(below, (*way, key))


def with_value(value: Any, way: tuple[Any, ...], new: Any) -> Any:
    """Return the same with another value at the end of a way."""
    if not way:
        return new
    key, *rest = way
    if isinstance(value, dict):
        return {k: with_value(v, tuple(rest), new) if k == key else v for k, v in value.items()}
    return [with_value(v, tuple(rest), new) if k == key else v for k, v in enumerate(value)]


def another_type(chance: random.Random, data: bytes) -> bytes:
    """Return a YAML or JSON text with a value of another kind somewhere."""
    value = yaml.load(data, Loader=yaml.CSafeLoader)
    way = chance.choice(list(paths_in(value)))
    new = with_value(value, way, chance.choice(OTHER_VALUES))
    text = (
        json.dumps(new)
        if data[:1] == b"{"
        else yaml.safe_dump(new, sort_keys=False, allow_unicode=True)
    )
    return text.encode()


STRUCTURED = (".yaml", ".json", ".rviz")


def as_nothing(path: Path) -> None:
    path.unlink()


def as_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def as_circle(path: Path) -> None:
    path.unlink()
    path.symlink_to(path.name)


def as_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def as_device(path: Path) -> None:
    path.unlink()
    path.symlink_to("/dev/zero")


INSTEAD = {
    "nothing": as_nothing,
    "a folder": as_folder,
    "a link to itself": as_circle,
    "a pipe": as_pipe,
    "no end": as_device,
}


def damages(place: Place, many: int) -> Iterator[tuple[str, Callable[[Path], object]]]:
    """Every damage of a file, each that chance has a part in so many times, by its name."""
    yield from INSTEAD.items()
    for name, change in ALWAYS_ALIKE.items():
        yield name, partial(_changed, change)
    kinds = {**BY_CHANCE}
    if place.file.endswith(STRUCTURED):
        kinds |= dict.fromkeys((f"another type {it}" for it in range(4)), another_type)
    for name, damage in kinds.items():
        for at in range(many):
            yield f"{name}, {at}", partial(_damaged, damage, f"{place.file} {name} {at}")


def _changed(change: Callable[[bytes], bytes], path: Path) -> None:
    path.write_bytes(change(path.read_bytes()))


def _damaged(damage: Bytes, seed: str, path: Path) -> None:
    path.write_bytes(damage(random.Random(seed), path.read_bytes()))


class Run(NamedTuple):
    """What a command left behind."""

    code: int
    out: str
    err: str


PROGRAMS = {"multibot": main, "urdf-postfix": urdf_postfix.main, "urdf-lint": urdf_lint.main}


def run(words: tuple[str, ...]) -> Run:
    """Run a command in this process."""
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in "oe")
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = PROGRAMS[words[0]]([*words[1:]])
    return Run(code, *(it.buffer.getvalue().decode() for it in (out, err)))  # type: ignore[attr-defined]


NOISE = ("Traceback", "Errno", "<class", "object at 0x", "XML_PARSE_HUGE", "fault of the tool")
# What Python says of a fault in a program, which a launch file is.
OF_PYTHON = ("KeyError", "TypeError", "AttributeError", "IndexError")
CODES = {0, 1, 2, 3}


def faults(done: Run, words: tuple[str, ...], file: str, folder: Path) -> list[str]:
    """Return what is wrong with how a command ended."""
    found = []
    if done.code not in CODES:
        found.append(f"exit code {done.code}")
    text = done.out + done.err
    noise = NOISE if ".launch." in file else (*NOISE, *OF_PYTHON)
    found += [f"says {it}" for it in noise if it in text]
    if done.code == 2:
        lines = done.err.splitlines()
        if len(lines) != 1:
            found.append(f"{len(lines)} lines")
        if (folder / "out").exists():
            found.append("left its output")
        if done.out:
            found.append("printed something")
        # Without its section the node set that was asked for is what is wrong.
        if file not in text and not (file == "nodes.yaml" and "node set 'small'" in text):
            found.append(f"does not name {file}")
        if lines and len(lines[0]) > 1100:
            found.append(f"a line of {len(lines[0])} characters")
    if (
        done.code in (1, 2)
        and not text.strip()
        and "--quiet" not in words
        and not (folder / "out").exists()
    ):
        found.append("says nothing")
    if any(ord(it) < 32 and it not in "\n\t" for it in text):
        found.append("control characters")
    if [it for it in folder.rglob("*") if ".tmp" in it.name]:
        found.append("left a temporary file")
    return found
