# SPDX-License-Identifier: Apache-2.0
"""Every case file, byte by byte, and what must hold for any rewrite whatever the case."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import cast

import pytest
from case_files import Case, CaseError, all_cases, load_cases
from lxml import etree

from multibot_rewrite import Rewrite, RewriteRefused, rewrite, strip
from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, Finding
from multibot_rewrite.base.model import SiteRow
from multibot_rewrite.base.naming import POSTFIX, Policy, make_naming
from multibot_rewrite.base.releases import NEWEST_LTS
from multibot_rewrite.description import pipeline
from multibot_rewrite.description.checks.meeting import SAME_TEXT
from multibot_rewrite.description.library import rewrite_all
from multibot_rewrite.description.readback.meeting import LOOKUP, SHARED_CODES
from multibot_rewrite.description.rewriters.forms import IN_FRONT, Declared
from multibot_rewrite.description.rewriters.plugin_definitions import (
    PluginDefinition,
    load_definitions,
)
from multibot_rewrite.description.rewriters.tree import builtin_tree
from multibot_rewrite.description.steps.apply import fill
from multibot_rewrite.description.steps.collect import declarations

ROBOTS = ("robot1", "robot2")
CASES = all_cases()
BY_NAME = {case.name: case for case in CASES}
REWRITTEN = [case for case in CASES if case.expect != "refused"]
CHANGED = [case for case in CASES if case.expect == "changed"]
REFUSED = [case for case in CASES if case.expect == "refused"]
# An element that holds others and no name of its own has nothing to show.
REWRITERS = [
    rewriter
    for rewriter in load_definitions((), NEWEST_LTS).sections(
        "element", "plugin", "hardware", "sensor"
    )
    if rewriter.type != "element" or any(site.role != "keep" for site in rewriter.sites)
]
BLOCKS = load_definitions((), NEWEST_LTS).sections("block")
LEAST_CASES = 1050
LEAST_REFEREED = 980
# Not a word of rewrite's naming policy.
# gz-sim's odometry, whose frames are below the name of the model where the file does not say them.
FRAMES_LEFT_OUT = re.compile(
    rb"gz-sim-(?:diff-drive|mecanum-drive|ackermann-steering|tracked-vehicle|odometry-publisher)-system"
)
NO_POLICY = ("again", "file", "urdf", "distro")
# Rows of the plugin definitions, by section and path, at which no case renames anything.
UNEXERCISED: set[tuple[str, str]] = set()
# A plugin's parameter may be called <joint> or <link> too.
NAMELESS = {("model", ""), ("link", ""), ("joint", "")}
# A row of the plugin definitions: its section, path and line.
Row = tuple[str, str, int]


def run(case: Case, source: bytes | None = None) -> Rewrite:
    """Return the rewrite of the case's input, or of another ``source``, for the first robot."""
    return _run(case.name, case.source if source is None else source)


@cache
def _run(name: str, source: bytes) -> Rewrite:
    return rewrite(source, ROBOTS[0], **BY_NAME[name].options)


def policy(case: Case) -> Policy:
    """Return the options of the case that say how names are made."""
    return cast(Policy, {key: it for key, it in case.options.items() if key not in NO_POLICY})


def release(case: Case) -> str:
    """Return the release that the case is about; empty where it is none."""
    return str(case.options.get("distro", ""))


def beside(case: Case) -> dict[str, bytes]:
    """Return the rewritten URDF that a case's rewritten SRDF belongs to, as an option of ``strip``."""
    options = dict(case.options)
    urdf = options.pop("urdf", None)
    return {} if urdf is None else {"urdf": rewrite(urdf, ROBOTS[0], **options).data}


def outside(case: Case) -> Declared:
    """Return what the URDF beside an SRDF declares."""
    urdf = case.options.get("urdf")
    return {} if urdf is None else declarations(urdf.read_bytes(), "", builtin_tree((), NEWEST_LTS))


def places(findings: tuple[Finding, ...]) -> list[str]:
    """Return findings the way case files write them."""
    return sorted(f"{finding.code}@{finding.line}" for finding in findings)


# ---------------------------------------------------------------- each case


def test_no_case_was_lost() -> None:
    assert len(CASES) >= LEAST_CASES


def the_output_is_byte_exact(case: Case) -> None:
    result = run(case)
    assert result.data == case.output
    # What stays the same, or holds a placeholder, is shared by all robots: see description/readback.
    stays = case.expect == "same" or b"{robot}" in case.source
    skipped = (SHARED_CODES - {LOOKUP}) | {SAME_TEXT} if stays else frozenset()
    found = tuple(it for it in result.findings if it.code not in skipped)
    assert places(found) == sorted(case.finds)


@pytest.mark.parametrize("case", REFUSED, ids=lambda case: case.name)
def test_refused_with_that_code(case: Case) -> None:
    with pytest.raises(RewriteRefused) as caught:
        run(case)
    errors = {finding.code for finding in caught.value.findings if finding.level == ERROR}
    assert errors == {case.refusal}


def nothing_renamed_is_the_input(case: Case) -> None:
    naming = make_naming(**policy(case))._replace(separators={}, topics=POSTFIX)
    tree = builtin_tree((), release(case) or NEWEST_LTS)
    if FRAMES_LEFT_OUT.search(case.source):
        return  # each robot's frames are written in every layout, or tf would not have them
    template = pipeline.prepare(case.source, case.name, naming, tree, outside(case))
    assert fill(template.pieces, ROBOTS[0]) == case.source
    assert list(pipeline.render(template, ROBOTS, again=True)) == [case.source] * len(ROBOTS)


def strip_gives_the_input_back(case: Case) -> None:
    stripped = strip(
        run(case).data, ROBOTS[0], **policy(case), distro=release(case), **beside(case)
    )
    assert stripped == case.source


def two_robots_are_disjoint(case: Case) -> None:
    results = list(rewrite_all(case.source, ROBOTS, **case.options))
    first, second = (result.data for result in results)
    old = declared(case.source)
    assert (declared(first) - old).isdisjoint(declared(second) - old)
    # MF845: each robot has a port, or domain, of its own.
    is_numbered = any(it.code == "MF845" for result in results for it in result.findings)
    if not is_numbered and not any(robot.encode() in case.source for robot in ROBOTS):
        assert first.replace(b"robot1", b"robot2") == second


def declared(data: bytes) -> set[tuple[str, str]]:
    """Tag and name of every model, link and joint, nested or not."""
    found = etree.fromstring(data).iter("model", "link", "joint")
    return {(str(element.tag), element.get("name", "")) for element in found} - NAMELESS


def line_ends_stay_crlf(case: Case) -> None:
    assert run(case, crlf(case.source)).data == crlf(case.output)


def crlf(data: bytes) -> bytes:
    """Return the text with every line end written as Windows does."""
    return data.replace(b"\r\n", b"\n").replace(b"\n", b"\r\n")


def only_lines_with_edits_change(case: Case) -> None:
    result = run(case)
    plan = result.template.plan
    if plan.insertions:
        return  # they have lines of their own
    pairs = zip(case.source.split(b"\n"), result.data.split(b"\n"), strict=True)
    changed = {number for number, (old, new) in enumerate(pairs) if old != new}
    assert changed == {case.source.count(b"\n", 0, edit.start) for edit in plan.edits}


# ---------------------------------------------------------------- another reader


def yourdfpy_sees_the_same(case: Case) -> None:
    before = sizes(case.source) if is_urdf(case) else None
    assert before is None or sizes(run(case).data) == before


def is_urdf(case: Case) -> bool:
    """Is the input what yourdfpy reads? An SRDF is a ``<robot>`` too, an SDF it takes for empty."""
    return "urdf" not in case.options and etree.fromstring(case.source).tag == "robot"


@pytest.mark.slow
def test_yourdfpy_refereed_enough_cases() -> None:
    refereed = [case for case in REWRITTEN if is_urdf(case) and sizes(case.source) is not None]
    assert len(refereed) >= LEAST_REFEREED


@cache
def sizes(data: bytes) -> tuple[int, int] | None:
    """How many links and joints yourdfpy sees; None where it cannot load the description."""
    import yourdfpy  # takes a second

    scenes = dict.fromkeys(("build_scene_graph", "build_collision_scene_graph"), False)
    try:
        robot = yourdfpy.URDF.load(io.BytesIO(data), load_meshes=False, **scenes)
    except Exception:  # whatever it may stumble over
        return None
    return len(robot.robot.links), len(robot.robot.joints)


def the_named_rewriter_is_at_work(case: Case) -> None:
    _, claims, hosts, *_ = run(case).template.inventory
    served = {host.node.section.name for host in hosts if host.node.section is not None}
    assert case.rewriter in served | {claim.site.section for claim in claims}


# What is asked of each case while one works on it, and what else must hold for any rewrite.
FIRST = (the_output_is_byte_exact, the_named_rewriter_is_at_work)
LAWS = (
    nothing_renamed_is_the_input,
    strip_gives_the_input_back,
    two_robots_are_disjoint,
    line_ends_stay_crlf,
    only_lines_with_edits_change,
    yourdfpy_sees_the_same,
)
every = pytest.mark.parametrize("case", REWRITTEN, ids=lambda case: case.name)


@pytest.mark.sample(1)
@every
def test_case(case: Case) -> None:
    assert faults(FIRST, case) == []


@pytest.mark.slow
@every
def test_the_laws_hold(case: Case) -> None:
    assert faults(LAWS, case) == []


def faults(checks: Iterable[Callable[[Case], None]], case: Case) -> list[str]:
    """Return what each check finds wrong; thousands of cases make one test a check too dear."""
    return [f"{check.__name__}: {problem}" for check in checks if (problem := fault(check, case))]


def fault(check: Callable[[Case], None], case: Case) -> str:
    """Return what a check finds wrong; empty for nothing."""
    try:
        check(case)
    except AssertionError as error:
        return str(error) or "failed"
    return ""


# ---------------------------------------------------------------- what the cases cover


@pytest.mark.slow
def test_every_rewriter_has_a_changed_and_a_same_case() -> None:
    lacking = {rewriter.name: wanted(rewriter) - outcomes(rewriter) for rewriter in REWRITERS}
    assert {name: left for name, left in lacking.items() if left} == {}


def wanted(rewriter: PluginDefinition) -> set[str]:
    if not rewriter.sites:  # what it opens is for the second reading
        return set()
    renames = any(site.role != "keep" for site in rewriter.sites)
    return {"changed", "same"} if renames else {"same"}


def outcomes(rewriter: PluginDefinition) -> set[str]:
    return {case.expect for case in CASES if case.rewriter == rewriter.name}


@pytest.mark.slow
def test_every_default_and_hard_wired_topic_is_inserted() -> None:
    inserting = [rewriter for rewriter in REWRITERS if rewriter.inserts]
    lacking = {
        it.name: {default for default in literals(it) if not is_among(default, inserted(it))}
        for it in inserting
    }
    assert {name: left for name, left in lacking.items() if left} == {}


def is_among(default: str, defaults: set[str]) -> bool:
    """Is it there, with some name of the description in its slots? The model's stays a slot."""
    pattern = re.sub(r"\\{(?!model)\w+\\}", "[^/]+", re.escape(default))
    return any(re.fullmatch(pattern, it) for it in defaults)


def inserted(rewriter: PluginDefinition) -> set[str]:
    cases = [case for case in REWRITTEN if case.rewriter == rewriter.name]
    return {item.old for case in cases for item in run(case).template.plan.insertions}


def literals(rewriter: PluginDefinition) -> set[str]:
    """Return what the consumer falls back to or hard-wires, but for private topics, frames of
    the world, and what stands in front of names: no postfix reaches that, and it is reported
    (MB422)."""
    said = (it for it in rewriter.sites if it.form not in IN_FRONT)
    stated = {site.default.rpartition("?")[2] for site in said} - {*WORLD_FRAMES}
    defaults = {default for default in stated if "/../" not in default}
    # Where rules stand: not in a plugin of ROS 1, nor in what has no <ros>.
    takes_rules = rewriter.ros != "1" and any("remapping" in it.path for it in rewriter.sites)
    wired = rewriter.topics if takes_rules else ()
    return defaults - {"", "/"} | {topic for topic in wired if topic[0] != "~"}


@pytest.mark.slow
def test_every_row_of_the_definitions_renames_something() -> None:
    touched = {row for case in CHANGED for row in touched_rows(case)}
    wanted = {place(site): site for rewriter in REWRITERS + BLOCKS for site in rows(rewriter)}
    left = {(site.section, site.path) for row, site in wanted.items() if row not in touched}
    assert left == UNEXERCISED


def rows(rewriter: PluginDefinition) -> list[SiteRow]:
    """Return the rows of its own section at which something may be renamed."""
    own = f"{rewriter.type} {rewriter.names[0]}"
    return [site for site in rewriter.sites if site.role != "keep" and site.section == own]


def touched_rows(case: Case) -> Iterator[Row]:
    """Yield the rows at which the case renames a value."""
    _, plan, *_ = template = run(case).template
    for claim, spelling in zip(template.inventory.claims, plan.renames.values, strict=True):
        if spelling:
            yield place(claim.site)
    for claim, _ in plan.collisions:
        yield place(claim.site)


def place(site: SiteRow) -> Row:
    """Where the plugin definitions has this site; two flavours of a plugin share section and path."""
    return site.section, site.path, site.line


# ---------------------------------------------------------------- the loader

HEAD = b"about: a test\nrewriter: element robot\n"
SAME = HEAD + b"expect: same\n----\n<robot/>\n"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        pytest.param(b"colour: red\n" + SAME, "'colour: red' is unknown", id="header"),
        pytest.param(b"about: it\n" + SAME, "there twice", id="header-twice"),
        pytest.param(SAME.partition(b"\n")[2], "header about is missing", id="no-about"),
        pytest.param(HEAD + b"expect: same\n----\n", "same needs", id="no-input"),
        pytest.param(SAME.replace(b"same", b"changed"), "input, output", id="no-output"),
        pytest.param(SAME + b"----\n<robot/>\n", "same needs", id="same-with-output"),
        pytest.param(HEAD + b"expect: refused\n----\n<robot/>\n", "refused CODE", id="no-code"),
        pytest.param(
            SAME.replace(b"same", b"changed") + b"----\n<robot/>\n",
            "the output equals the input",
            id="nothing-changed",
        ),
        pytest.param(b"options: layout\n" + SAME, "'layout' is not key=value", id="option"),
        pytest.param(b"options: urdf=no.urdf\n" + SAME, "there is no .*no.urdf", id="urdf"),
    ],
)
def test_a_wrong_case_is_refused(tmp_path: Path, data: bytes, words: str) -> None:
    write(tmp_path / "odd" / "mine.case", data)
    with pytest.raises(CaseError, match=words) as caught:
        load_cases(tmp_path)
    assert "odd/mine" in str(caught.value)


@pytest.mark.parametrize("other", ["plain/mine.case", "odd/notes.txt"])
def test_a_wrong_folder_is_refused(tmp_path: Path, other: str) -> None:
    write(tmp_path / "odd" / "mine.case", SAME)
    assert [case.name for case in load_cases(tmp_path)] == ["odd/mine"]
    write(tmp_path / other, SAME)
    with pytest.raises(CaseError, match=r"there is a case odd/mine already|something else"):
        load_cases(tmp_path)


def write(path: Path, data: bytes) -> None:
    """Write a file, and make the folder that it is in."""
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(data)
