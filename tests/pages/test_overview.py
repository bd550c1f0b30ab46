# SPDX-License-Identifier: Apache-2.0
"""The picture of the fleet: boxes in rows, arrows between them."""

from __future__ import annotations

import re

from page_calls import CROSS_TALK, LEAK, OK, Crossing

from multibot_rewrite.pages.overview import Tile, overview

R1, R2 = Tile("r1", "r1", "2 nodes", "#g0", "good"), Tile("r2", "r2", "1 error", "#g1", "bad")
TALK = Crossing("r2", "", "r1", CROSS_TALK, ("subscribes /r1/scan",))
MARKER = (
    '<marker id="{0}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7"'
    ' orient="auto"><path class="{0}" d="M0 0L8 4L0 8z"/></marker>'
)
TIPS = f"<defs>{MARKER.format('tip')}{MARKER.format('tip-bad')}</defs>"


def tiles(count: int) -> list[Tile]:
    return [Tile(f"r{at}", f"r{at}", "", "#", "good") for at in range(count)]


def corners(drawing: str) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in re.findall(r'<rect x="(.*?)" y="(.*?)"', drawing)]


def test_two_robots_a_tool_and_a_name_of_no_robot() -> None:
    crossings = [
        TALK,
        Crossing("r1", "", "", LEAK, ("publishes /x", "subscribes /y")),
        Crossing("", "/tool", "r1", OK, ("publishes /r1/cmd",)),
    ]
    assert overview([R1, R2], crossings, ["/tool"]) == (
        '<svg class="overview few" viewBox="0 0 1180 278" role="group" aria-label="the fleet">'
        f"{TIPS}"
        '<path class="reach calm" d="M307 176C307 139 283 139 283 102" marker-end="url(#tip)">'
        "<title>/tool: as planned\npublishes /r1/cmd</title></path>"
        '<path class="reach bad" d="M897 44C897 18 283 18 283 44" marker-end="url(#tip-bad)">'
        "<title>r2: cross-talk: a robot&#x27;s node uses another robot&#x27;s name\n"
        "subscribes /r1/scan</title></path>"
        '<path class="reach bad" d="M307 102C307 139 873 139 873 176" marker-end="url(#tip-bad)">'
        "<title>r1: leak: a robot&#x27;s node uses a name of no robot\n"
        "publishes /x\nsubscribes /y</title></path>"
        '<a href="#g0"><g class="tile good"><rect x="180" y="44" width="230" height="58" rx="7"/>'
        '<text class="title" x="295" y="69.52">r1</text>'
        '<text class="note" x="295" y="90.4">2 nodes</text><title>r1\n2 nodes</title></g></a>'
        '<a href="#g1"><g class="tile bad"><rect x="770" y="44" width="230" height="58" rx="7"/>'
        '<text class="title" x="885" y="69.52">r2</text>'
        '<text class="note" x="885" y="90.4">1 error</text><title>r2\n1 error</title></g></a>'
        '<a href="#shared"><g class="tile shared">'
        '<rect x="180" y="176" width="230" height="58" rx="7"/>'
        '<text class="title" x="295" y="201.52">/tool</text>'
        '<text class="note" x="295" y="222.4">of no robot</text>'
        "<title>/tool\nof no robot</title></g></a>"
        '<a href="#shared"><g class="tile bad">'
        '<rect x="770" y="176" width="230" height="58" rx="7"/>'
        '<text class="title" x="885" y="201.52">names of no robot</text>'
        '<text class="note" x="885" y="222.4">/x, /y</text>'
        "<title>names of no robot\n/x, /y</title></g></a>"
        '<text class="reach-note" x="590" y="28.5">/r1/scan</text></svg>'
    )


def test_two_directions_bend_differently() -> None:
    drawing = overview([R1, R2], [TALK._replace(source="r1", target="r2")], [])
    assert 'd="M307 44C307 -2 873 -2 873 44"' in drawing
    assert '<text class="reach-note" x="590" y="13.5">/r1/scan</text>' in drawing
    assert 'viewBox="0 0 1180 146"' in drawing


def test_several_names_are_counted_and_a_long_one_is_cut() -> None:
    two = TALK._replace(names=("subscribes /a", "calls /b"))
    assert '<text class="reach-note" x="590" y="28.5">2 names</text>' in overview(
        [R1, R2], [two], []
    )
    long = TALK._replace(names=(f"calls {'x' * 41}",))
    assert f">{'x' * 19}…{'x' * 20}</text>" in overview([R1, R2], [long], [])


def test_a_label_between_two_rows_is_in_their_middle() -> None:
    drawing = overview(tiles(7), [TALK._replace(source="r0", target="r6")], [])
    assert '<text class="reach-note" x="98.3333" y="128">/r1/scan</text>' in drawing


def test_more_than_twelve_arrows_have_no_labels() -> None:
    assert overview([R1, R2], [TALK] * 12, []).count("reach-note") == 12
    assert overview([R1, R2], [TALK] * 13, []).count("reach-note") == 0


def test_more_than_eight_other_nodes_are_one_box() -> None:
    names = [f"/n{at}" for at in range(9)]
    reach = Crossing("", "/n3", "r1", OK, ("calls /r1/s",))
    assert overview([R1], [reach], names[:8]).count("<rect") == 9
    drawing = overview([R1], [reach], names)
    assert drawing.count("<rect") == 2
    assert ">9 other nodes</text>" in drawing and '<g class="tile shared">' in drawing
    assert 'href="#shared"' in drawing and "<title>9 other nodes\nof no robot</title>" in drawing


def test_rows_are_as_wide_as_the_fleet_is_large() -> None:
    """Four in a row of wide boxes, then six of smaller ones, then ten."""
    assert corners(overview(tiles(1), [], [])) == [(475, 44)]
    assert corners(overview(tiles(4), [], []))[3] == (917.5, 44)
    assert 'class="overview few"' in overview(tiles(4), [], [])
    five = overview(tiles(5), [], [])
    assert 'width="160" height="54"' in five and 'class="overview"' in five
    assert corners(five)[:2] == [(38, 44), (274, 44)]
    seven = corners(overview(tiles(7), [], []))
    assert seven[6] == (seven[0][0], 44 + 54 + 60)
    assert 'width="160" height="54"' in overview(tiles(30), [], [])
    many = overview(tiles(31), [], [])
    assert 'width="106" height="40"' in many
    assert corners(many)[10] == (6, 44 + 40 + 40)
    assert overview([], [], []).startswith('<svg class="overview few" viewBox="0 0 1180 44"')


def test_a_title_is_cut_to_its_box() -> None:
    (drawing,) = [overview([R1._replace(title="y" * 30, note="z" * 30)], [], [])]
    assert (
        f">{'y' * 14}…{'y' * 14}</text>" in drawing and f">{'z' * 14}…{'z' * 14}</text>" in drawing
    )
