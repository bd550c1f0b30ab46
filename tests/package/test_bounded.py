# SPDX-License-Identifier: Apache-2.0
"""What anybody may write is read within bounds of size, depth and expansion, by every reader."""

from __future__ import annotations

import ast
import json
import os
import re
from collections.abc import Callable
from pathlib import Path
from threading import Thread

import pytest
import yaml
from hypothesis import given, settings, strategies as st
from parsed import sources

from multibot_rewrite import knowledge
from multibot_rewrite.base import bounded
from multibot_rewrite.base.model import InputError, MultibotError
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.fleet.outputs.manifest import read_manifest
from multibot_rewrite.knowledge.node_sets import user_library
from multibot_rewrite.knowledge.parameters import load_known_nodes
from multibot_rewrite.knowledge.yaml_with_lines import read_yaml_with_lines
from multibot_rewrite.lint.config.baseline import read_baseline
from multibot_rewrite.related_files.yaml_text import read_yaml
from multibot_rewrite.system.json import from_json, from_json as from_json_plan, from_yaml

NODES = Path(knowledge.__file__).parent / "nodes"

Reader = Callable[[str], object]


def bomb(levels: int, width: int = 10) -> str:
    """Return lists of aliases of lists: ``width`` to the power of ``levels`` words in the end."""
    lines = [f"a0: &a0 [{', '.join('x' * width)}]"]
    for at in range(1, levels):
        lines.append(f"a{at}: &a{at} [{', '.join([f'*a{at - 1}'] * width)}]")
    return "\n".join(lines) + "\n"


YAML_FAULTS = {
    # libyaml 0.2.6 refuses it before we count: "exceeded maximum nesting depth".
    "flow lists": ("[" * 100_000, "nest"),
    "flow mappings": ("{a: " * 100_000, "nested deeper than 100 levels"),
    "ends in comments": ("[ # ]\n" * 101, "nested deeper than 100 levels"),
    "block lists": ("- " * 3_000 + "a", "nested deeper than 100 levels"),
    "complex keys": ("? " * 3_000 + "a", "nested deeper than 100 levels"),
    "block mappings": (
        "\n".join(f"{' ' * at}a:" for at in range(3_000)),
        "nested deeper than 100 levels",
    ),
    "lists at their keys": (
        "\n".join(f"{' ' * at}- a:" for at in range(0, 2_000, 2)),
        "nested deeper than 100 levels",
    ),
    "flow in quotes and comments": (
        "".join(f"# ]]]]]]\n['{']' * 9}',\n" for _ in range(101)),
        "nested deeper than 100 levels",
    ),
    "bomb": (bomb(9), "aliases stand for more than 100,000 values"),
    "recursive list": ("a: &a [*a]", "the alias is inside the value that it repeats"),
    "recursive key": ("a: &a\n  b:\n  - *a\n", "the alias is inside the value that it repeats"),
    "recursive merge": ("a: &a\n  <<: *a\n", "the alias is inside the value that it repeats"),
}
YAML_READERS: dict[str, Reader] = {
    "parameters, rviz, bridge, moveit, fleet": lambda text: read_yaml(text.encode(), "f"),
    "plan": lambda text: from_yaml(text.encode(), "f"),
    "nodes": lambda text: read_yaml_with_lines(text, "f"),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("fault", YAML_FAULTS)
@pytest.mark.parametrize("reader", YAML_READERS)
def test_every_yaml_reader_has_the_bounds(reader: str, fault: str) -> None:
    text, message = YAML_FAULTS[fault]
    with pytest.raises(MultibotError) as caught:
        YAML_READERS[reader](text)
    assert str(caught.value).startswith("f:") and message in str(caught.value)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 300


@pytest.mark.parametrize(
    ("name", "text", "least"),
    [
        ("MAX_REPEATED", "a: &a [x, x]\nb: [*a, *a]", 6),
        ("MAX_REPEATED", "a: &a x\nb: [*a, *a, *a]", 3),
        ("MAX_DEPTH", "a: {b: [c]}", 3),
    ],
)
def test_the_last_value_within_a_bound_is_allowed(
    monkeypatch: pytest.MonkeyPatch, name: str, text: str, least: int
) -> None:
    """A list that is repeated counts with its values."""
    monkeypatch.setattr(bounded, name, least)
    assert bounded.load_yaml(text, "f")
    monkeypatch.setattr(bounded, name, least - 1)
    with pytest.raises(InputError):
        bounded.load_yaml(text, "f")


@pytest.mark.parametrize("size", [8, 9])
def test_the_last_byte_within_the_bound_is_read(tmp_path: Path, size: int) -> None:
    file = tmp_path / "file"
    file.write_bytes(b"x" * size)
    if size == 8:
        assert bounded.read_bytes(str(file), 8) == b"x" * 8
        return
    with pytest.raises(OSError, match="over the limit of 8 bytes"):
        bounded.read_bytes(str(file), 8)


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "text",
    [
        pytest.param("[" * 100 + "]" * 100, id="at-the-limit"),
        pytest.param(bomb(4), id="few-aliases"),
        pytest.param("a: &a [1]\nb: *a\nc: &a [2]\nd: [*a]\n", id="an-anchor-again"),
        pytest.param("[a, [b]]\n" + "# [[[[ {{{{ & *\n" * 99, id="brackets-in-comments"),
        pytest.param("\n".join(f"- [[{at}]]" for at in range(999)), id="many-lists"),
        pytest.param(" " * 300 + "a: 1", id="far-right"),
        pytest.param("*x", id="unknown-anchor"),
    ],
)
def test_what_is_within_the_bounds_is_read_as_before(text: str) -> None:
    try:
        wanted = yaml.load(text, Loader=yaml.CSafeLoader)
    except yaml.MarkedYAMLError as error:
        with pytest.raises(InputError, match=f": {re.escape(str(error.problem))}; "):
            bounded.load_yaml(text, "f")
        return
    assert bounded.load_yaml(text, "f") == wanted


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: 1\nb: !own 2\n", "f:2:4: .*'!own'"),
        ("a: !!python/name:os.system x\n", "f:1:4: .*python/name"),
        ("a: =\n", "f:1:4: .*value"),
        ("a: *b\n", "f:1:4: .*undefined alias"),
        ("? [a]\n: 1\n", "f:1:3: .*unhashable key"),
        ("? {a: b}\n: 1\n", "f:1:3: .*unhashable key"),
        ("<<: 3\n", "f:1:5: .*expected a mapping"),
        ("!!set [a]\n", "f:1:1: .*expected a mapping"),
        ("a: !!binary 'a'\n", "f:1:4: .*base64"),
        ("a: !degrees x\n", "f:1:4: .*!degrees"),
        ("a: [b\n", "f:2:1: .*did not find"),
        ("a: [b", "f:1:6: .*did not find"),
        ("a: \0\n", "f: .*#x0000"),
        ("a: \ud800\n", "f: .*surrogates"),
    ],
)
def test_what_is_no_yaml_is_an_input_error_with_its_place(text: str, message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}.*; do this$"):
        bounded.load_yaml(text, "f", "do this")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        pytest.param("x: " + "9" * 5_000, "5,000 characters, over the limit of 100", id="digits"),
        pytest.param("x: 1" + ":1" * 50_000, "100,001 characters", id="base-60"),
        pytest.param("x: " + "1" * 5_000 + ".0", "5,002 characters", id="float"),
        pytest.param("x: 2001-13-45", "'2001-13-45' is not a value of the kind time", id="date"),
        pytest.param("x: !!int y", "'y' is not a value of the kind int", id="int"),
        pytest.param("x: !!bool y", "'y' is not a value of the kind bool", id="bool"),
        pytest.param("x: !!timestamp y", "'y' is not a value of the kind time", id="time"),
    ],
)
def test_a_value_that_python_cannot_hold_is_a_fault_with_its_line(text: str, message: str) -> None:
    with pytest.raises(InputError, match=r"^f:1:4: not valid YAML: ") as caught:
        from_yaml(text.encode(), "f")
    assert message in str(caught.value)


JSON_FAULTS = {
    "lists": ("[" * 100_000, "nested deeper than 100 levels"),
    "objects": ('{"a":' * 100_000, "nested deeper than 100 levels"),
    "behind strings": ('[["]]]]\\"]]]",' * 101, "nested deeper than 100 levels"),
    "digits": ("9" * 5_000, "5,000 characters, over the limit of 100"),
}


@pytest.mark.slow
@settings(deadline=None)
@given(
    st.recursive(
        st.text("ab[]{}\\\"'\n", max_size=9),
        lambda inner: st.lists(inner) | st.dictionaries(st.text('[]{}"\\', max_size=3), inner),
    )
)
def test_the_depth_of_json_is_that_of_its_lists_and_objects(value: object) -> None:
    def depth(it: object) -> int:
        if not isinstance(it, list | dict):
            return 0
        return 1 + max(map(depth, it.values() if isinstance(it, dict) else it), default=0)

    text = json.dumps(value)
    assert bounded._json_depth(text.encode()) == depth(value)


def _baseline(text: str) -> object:
    Path("f").write_text(text)
    return read_baseline("f")


JSON_READERS: dict[str, Reader] = {
    "plan": lambda text: from_json_plan(text.encode(), "f"),
    "snapshot": lambda text: from_json(text.encode(), "f"),
    "baseline": _baseline,
    "manifest": lambda text: read_manifest(text.encode(), "f"),
}


@pytest.mark.parametrize("fault", JSON_FAULTS)
@pytest.mark.parametrize("reader", JSON_READERS)
def test_every_json_reader_has_the_bounds(reader: str, fault: str, here: Path) -> None:
    text, message = JSON_FAULTS[fault]
    with pytest.raises(MultibotError) as caught:
        JSON_READERS[reader](text)
    assert str(caught.value).startswith("f:") and "\n" not in str(caught.value)
    # A manifest is the tool's own: what is wrong in it does not matter.
    assert message in str(caught.value) or reader == "manifest"


@pytest.mark.parametrize(
    "text", ['{"a":"[[[\\"[["}', "[[1], [2]]", "[" * 100 + "]" * 100, '"\\\\"']
)
def test_json_within_the_bounds_is_read_as_before(text: str) -> None:
    assert bounded.load_json(text) == json.loads(text)


READ_TEXT: dict[str, Reader] = {
    "description": read_file,
    "nodes": lambda path: user_library(path, NEWEST_LTS),
    "parameters": lambda path: load_known_nodes(path, NEWEST_LTS),
    "definitions": lambda path: load_definitions((path,), NEWEST_LTS),
    "baseline": read_baseline,
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("reader", READ_TEXT)
@pytest.mark.parametrize("file", ["/dev/zero", "large"])
def test_a_file_without_an_end_is_too_large(file: str, reader: str, tmp_path: Path) -> None:
    path = tmp_path / "large"
    path.touch()
    os.truncate(path, 2**40)
    given = file if file.startswith("/") else str(path)
    with pytest.raises(MultibotError) as caught:
        READ_TEXT[reader](given)
    assert "it is over the limit of 16,777,216 bytes" in str(caught.value)


def test_a_file_is_read_whole_whatever_size_it_says(tmp_path: Path) -> None:
    full = tmp_path / "full"
    reading, writing = os.pipe()  # of a shell's <(xacro ...)
    with os.fdopen(writing, "wb") as end:
        written = Thread(target=lambda: (end.write(b"x" * 200_000), end.close()))
        written.start()  # in pieces: more than a pipe holds, and its size is 0
        assert bounded.read_bytes(f"/dev/fd/{reading}") == b"x" * 200_000
        written.join()
    os.close(reading)
    full.write_bytes(b"x" * 10)
    assert bounded.read_bytes(str(full), 10) == b"x" * 10
    assert bounded.read_bytes("/proc/self/cmdline") == Path("/proc/self/cmdline").read_bytes()
    with pytest.raises(OSError, match="over the limit of 9 bytes"):
        bounded.read_bytes(str(full), 9)


def test_line_ends_are_those_of_unix(tmp_path: Path) -> None:
    (tmp_path / "text").write_bytes(b"\xef\xbb\xbfa\r\nb\rc\n")
    assert bounded.read_text(str(tmp_path / "text")) == "a\nb\nc\n"


def calls(tree: ast.Module) -> set[str]:
    called = (it.func for it in ast.walk(tree) if isinstance(it, ast.Call))
    return {ast.unparse(it) for it in called if isinstance(getattr(it, "value", None), ast.Name)}


@pytest.mark.slow
def test_the_parsers_are_called_in_one_place() -> None:
    parsers = {f"{module}.{name}" for module in ("yaml", "json") for name in ("load", "loads")}
    parsers |= {f"yaml.{name}" for name in ("compose", "parse", "safe_load", "load_all")}
    found = {path for path, tree in sources().items() if calls(tree) & parsers}
    # What these read is written by the tool: its schema, its data, messages between its processes.
    own = {"fleet/outputs/zenoh_configuration.py"}
    own |= {"fleet/file/fleet_data.py", "live/rehearsal.py", "producers/ros/request.py"}
    own |= {"producers/launch/records.py", "producers/ros/ask.py", "producers/ros/child.py"}
    own |= {"system/parameters.py"}
    own |= {"description/sources/child/frames.py", "description/sources/child/serve.py"}
    assert found == {"base/bounded.py", "live/stub_nodes.py", *own}


WORDS = (
    "a: [yes, No, TRUE, oN, ~, null, Null, 1.5, 2024-01-01, 0x1, 'true', \"\", y]\nb:\nc: !!str yes"
)


@pytest.mark.parametrize("text", [WORDS, *(it.read_text() for it in sorted(NODES.glob("*.yaml")))])
def test_a_text_of_the_package_is_read_as_any_other(text: str) -> None:
    assert read_yaml_with_lines(text, "a", own=True) == read_yaml_with_lines(text, "a")
