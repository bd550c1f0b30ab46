# SPDX-License-Identifier: Apache-2.0
"""A tree that one thread is making is whole for every other: the second comes in at each line.

Chance would need many runs for that; here a trace stops the first thread where the second one comes.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from threading import Thread
from types import FrameType
from typing import Any

import pytest
from description_calls import NEWEST_LTS, Definitions, Template, library, make_naming
from paths import fixture_text

from multibot_rewrite import DefinitionsError
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.rewriters import tree as trees
from multibot_rewrite.description.rewriters.tree import Tree

FILES = (trees.__file__, library.__file__)
# The plugin definitions of a rover: a section in a section, a block, a chosen plugin, a keep.
TEXT = fixture_text("interleaved_text.txt")
ROBOT = b"""\
<robot name="r"><link name="a"/><link name="b"/>
<joint name="j"><parent link="a"/><child link="b"/></joint>
<gazebo reference="a"><plugin name="n" filename="libdrive.so">
<frame>a</frame><wheel side="left">j</wheel><label>a</label></plugin></gazebo></robot>
"""
RENAMED = b"""\
<robot name="r_r1"><link name="a/r1"/><link name="b/r1"/>
<joint name="j_r1"><parent link="a/r1"/><child link="b/r1"/></joint>
<gazebo reference="a/r1"><plugin name="n_r1" filename="libdrive.so">
<frame>a/r1</frame><wheel side="left">j_r1</wheel><label>a</label></plugin></gazebo></robot>
"""
Spot = tuple[str, int]


def cold() -> Tree:
    """Return a tree that nothing has asked for anything yet."""
    return Tree(Definitions({"test.vocab": TEXT}, NEWEST_LTS))


def prepared(tree: Tree) -> Template:
    template = pipeline.prepare(ROBOT, "robot.urdf", make_naming(), tree)
    assert template.findings == []
    return template


def rendered(template: Template) -> bytes:
    return next(pipeline.render(template, ["r1"]))


def rewritten(tree: Tree) -> bytes:
    return rendered(prepared(tree))


def stopping(spot: Spot, turn: int, then: Callable[[], None]) -> Callable[..., Any]:
    """Return a trace that calls ``then`` when a line runs for the given time."""
    seen: Counter[Spot] = Counter()

    def trace(frame: FrameType, event: str, _: object) -> Any:
        here = frame.f_code.co_filename, frame.f_lineno
        if event == "line" and here == spot:
            seen[here] += 1
            if seen[here] == turn:
                then()
        return trace if frame.f_code.co_filename in FILES else None

    return trace


def traced(trace: Callable[..., Any], work: Callable[[], bytes]) -> bytes:
    before = sys.gettrace()
    sys.settrace(trace)
    try:
        return work()
    finally:
        sys.settrace(before)


def lines_run() -> Counter[Spot]:
    """How often each line of the tree and the plugin definitions runs in a cold rewrite."""
    found: Counter[Spot] = Counter()

    def trace(frame: FrameType, event: str, _: object) -> Any:
        if frame.f_code.co_filename not in FILES:
            return None
        found[frame.f_code.co_filename, frame.f_lineno] += event == "line"
        return trace

    tree = cold()
    traced(trace, lambda: rewritten(tree))
    return +found


def both(spot: Spot, turn: int) -> list[bytes]:
    """Return what two threads make of a cold tree: the second reads its description while the
    first is at that line, and proves its text when the first is done."""
    tree = cold()
    read: list[Template] = []

    def second() -> None:
        thread = Thread(target=lambda: read.append(prepared(tree)))
        thread.start()
        thread.join()

    first = traced(stopping(spot, turn, second), lambda: rewritten(tree))
    return [first, *map(rendered, read)]


def missed(turns: Callable[[int], range], every: int = 1) -> list[tuple[str, int]]:
    """Return the lines at which two threads do not both make the right text."""
    return [
        (Path(spot[0]).stem, spot[1])
        for spot, times in [*lines_run().items()][::every]
        for turn in turns(times)
        if both(spot, turn) != [RENAMED, RENAMED]
    ]


def test_many_lines_are_looked_at() -> None:
    files = Counter(file for file, _ in lines_run())
    assert min(files[file] for file in FILES) > 20


@pytest.mark.slow
def test_another_thread_comes_when_a_line_first_runs() -> None:
    """Three lines are one step of the work: one of them is asked."""
    assert missed(lambda _: range(1, 2), every=3) == []


@pytest.mark.deep
def test_another_thread_comes_whenever_a_line_runs() -> None:
    assert missed(lambda times: range(1, times + 1)) == []


BROKEN = TEXT.replace("child@link uses link", "child@link loves link")


def test_a_mistake_in_the_definitions_is_raised_again() -> None:
    """What could not be made whole is not there: it is no section without rows for the next."""
    tree = Tree(Definitions({"test.vocab": BROKEN}, NEWEST_LTS))
    for _ in range(2):
        with pytest.raises(DefinitionsError, match=r"test\.vocab:13"):
            rewritten(tree)
