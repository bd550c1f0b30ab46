# SPDX-License-Identifier: Apache-2.0
"""The robots at the head of the page: each with all that concerns it, equal ones as one card."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence

from multibot_rewrite.base.findings.rule import Rule
from multibot_rewrite.base.findings.selection import said_of
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.wording import plural
from multibot_rewrite.live.watching import Verdict, verdict_words
from multibot_rewrite.pages.page_sections import PageSection, concerns_of, look_of, summarize
from multibot_rewrite.pages.scene import FindingRow, Scene
from multibot_rewrite.pages.states import MISSING
from multibot_rewrite.pages.svg import safe

# More robots or findings of a card are folded.
MOST_ROBOTS, MOST_ROWS = 8, 5


class _Card(NamedTuple):
    """Robots of which the same is true; ``rows`` are the numbers of the findings."""

    sections: Sequence[PageSection]
    rows: tuple[int, ...]


def robot_cards(
    scene: Scene, sections: Sequence[PageSection], rules: Mapping[str, Rule]
) -> Iterator[str]:
    """The robots with findings first, then those without; what is of no robot is last."""
    cards = sorted(_cards(scene, sections), key=lambda card: not card.rows)
    order = {robot: at for at, robot in enumerate(scene.robots)}
    yield '<div class="cards" role="list" aria-label="robots">\n'
    yield from (_html(card, scene, order, rules) for card in cards)
    yield "</div>\n"


def _cards(scene: Scene, sections: Iterable[PageSection]) -> Iterator[_Card]:
    rows = concerns_of(scene)
    same: dict[tuple[tuple[int, ...], bool], list[PageSection]] = {}
    for section in sections:
        robot = section.group.robot
        own = rows.get(robot, ())
        if robot or own:
            same.setdefault((own, not robot), []).append(section)
    return (_Card(members, own) for (own, _), members in same.items())


def _html(card: _Card, scene: Scene, order: Mapping[str, int], rules: Mapping[str, Rule]) -> str:
    numbers = " ".join(str(order.get(it.group.robot, -1)) for it in card.sections)
    links = [
        f'<a href="#{it.id}">{safe(it.group.robot or "shared, or of no robot")}</a>'
        for it in card.sections
    ]
    first = card.sections[0].group.robot
    lines = [f"<li>{_line(at, scene.rows[at], rules, first)}</li>" for at in card.rows]
    return (
        f'<div class="card {look_of(card.sections[0])}" role="listitem" data-robot="{numbers}">'
        f"<h3>{_folded(links, MOST_ROBOTS, 'robot', ', ')}</h3><p>{safe(_state(card, scene))}</p>"
        f"{_list(lines)}</div>\n"
    )


def _state(card: _Card, scene: Scene) -> str:
    levels = Counter(scene.rows[at].finding.level for at in card.rows)
    sure = scene.outcome.planned and scene.outcome.verdict != Verdict.INCONCLUSIVE
    robots = {it.group.robot for it in card.sections}
    own = tuple(it for it in scene.coverage.robots if it.robot in robots)
    planned = verdict_words(Verdict.PLANNED, (), scene.coverage._replace(robots=own), sure)
    state = summarize(levels) or ("notes only" if card.rows else planned)
    nodes = sum(
        node.robot == section.group.robot and not node.is_robot and node.state != MISSING
        for section in card.sections
        for node in section.group.nodes
    )
    each = " each" if len(card.sections) > 1 and card.rows else ""
    many = f"{len(card.sections)} robots, " if len(card.sections) > 1 else ""
    return f"{many}{state}{each}; {plural(nodes, 'node')} running"


def _line(at: int, row: FindingRow, rules: Mapping[str, Rule], robot: str) -> str:
    """A finding in a few words, as it is of the robot, with a link to it."""
    it = row.finding
    about = said_of(next(iter(it.names), it.node), it, robot)
    words = rules[it.code].name.replace("-", " ") if it.code in rules else it.code
    message = said_of(it.message, it, robot)
    return (
        f'<a class="brief {safe(it.level)}" href="#finding-{at}" title="{safe(message)}">'
        f"<b>{safe(words)}</b> <code>{safe(about)}</code></a>"
    )


def _list(lines: Sequence[str]) -> str:
    if not lines:
        return ""
    shown = f"<ul>{''.join(lines[:MOST_ROWS])}</ul>"
    if len(lines) <= MOST_ROWS:
        return shown
    more = f"<summary>{len(lines) - MOST_ROWS} more</summary><ul>{''.join(lines[MOST_ROWS:])}</ul>"
    return f"{shown}<details>{more}</details>"


def _folded(parts: Sequence[str], most: int, what: str, joint: str) -> str:
    if len(parts) <= most:
        return joint.join(parts)
    more = f"<summary>{plural(len(parts) - most, f'more {what}')}</summary>"
    return f"{joint.join(parts[:most])} <details>{more}{joint.join(parts[most:])}</details>"
