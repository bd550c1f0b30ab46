# SPDX-License-Identifier: Apache-2.0
"""The sections of the page, the robots at its head, short ids, and the link of each finding."""

from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar

from multibot_rewrite.base.findings.finding import ERROR, INCONCLUSIVE, WARNING, Finding, Rule
from multibot_rewrite.base.findings.formats.plain import in_words
from multibot_rewrite.base.findings.selection import said_of
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.wording import plural
from multibot_rewrite.live.watching import Verdict, verdict_words
from multibot_rewrite.pages.scene import DrawnEdge, DrawnGroup, DrawnName, Scene
from multibot_rewrite.pages.states import FAULTY, MISSING, OK, Targets
from multibot_rewrite.pages.svg import Ids, safe
from multibot_rewrite.system.records import SERVES

LEVELS = (ERROR, WARNING, INCONCLUSIVE)
# In a larger fleet only faulty robots are unfolded, and no more than MOST_OPEN.
SMALL_FLEET, MOST_OPEN = 3, 10
# Of more robots only so many are drawn, those with findings first, and each finding once before that.
MOST_DRAWN = 30
SHARED = "shared"
_Key = TypeVar("_Key", bound=Hashable)
# So many services of a node without a client are drawn as one.
MERGE_FROM = 3


class PageSection(NamedTuple):
    """The section of a group; ``shown`` is the group without what every node has.

    ``levels`` counts by level the findings that concern its robot; a ``faulty`` section has such
    findings or faulty names.
    """

    group: DrawnGroup
    shown: DrawnGroup
    id: str
    levels: Mapping[str, int]
    faulty: bool
    open: bool
    drawn: bool = True


def make_ids(scene: Scene) -> Ids:
    """Return a short id for everything that is drawn."""
    nodes = sorted({node.name for group in scene.groups for node in group.nodes})
    names = sorted({name.name for group in scene.groups for name in group.names})
    frames = dict.fromkeys((one.topic, row.frame) for one in scene.trees for row in one.rows)
    ids = Ids(_numbered("n", nodes), _numbered("t", names), _numbered("f", frames), frozenset())
    wanted = {id_ for row in scene.rows for id_ in ids_of(row.targets, ids)}
    return ids._replace(anchors=frozenset(wanted))


def _numbered(letter: str, things: Iterable[_Key]) -> dict[_Key, str]:
    """Return a short id for each thing: the letter and its number."""
    return {thing: f"{letter}{at}" for at, thing in enumerate(things)}


def ids_of(about: Targets, ids: Ids) -> list[str]:
    """Return the ids of the nodes, names and frames of a finding, as far as they are drawn."""
    found = (
        *(ids.names.get(name, "") for name in about.names),
        *(ids.nodes.get(node, "") for node in about.nodes),
        *(ids.frames.get(frame, "") for frame in about.frames),
    )
    return [id_ for id_ in found if id_]


def make_sections(scene: Scene) -> list[PageSection]:
    """Return a section for each robot, the first of equal ones open, then one for no robot."""
    concerns = concerns_of(scene)
    met: set[tuple[int, ...]] = set()
    sections, left = [], MOST_OPEN
    for at, group in enumerate(scene.groups):
        id_ = f"g{at}" if group.robot else SHARED
        own = concerns.get(group.robot, ())
        counts = Counter(scene.rows[number].finding.level for number in own)
        levels = {level: counts[level] for level in LEVELS}
        faulty = bool(sum(levels.values())) or has_faults(group)
        opened = len(scene.robots) <= SMALL_FLEET or (
            faulty and left > 0 and not (own and own in met)
        )
        met.add(own)
        left -= opened
        shown = without_common(group)
        sections.append(PageSection(group, shown, id_, levels, faulty, opened))
    worst_first = sorted(sections[:-1], key=lambda it: (not it.open, not it.faulty))
    drawn = {it.id for it in worst_first[:MOST_DRAWN]} | {SHARED}
    return [it._replace(drawn=it.id in drawn) for it in sections]


def concerns_of(scene: Scene) -> dict[str, tuple[int, ...]]:
    """Return the numbers of the findings that concern each robot."""
    found = lists_by_key(
        (robot, at) for at, row in enumerate(scene.rows) for robot in row.robots or ("",)
    )
    return {robot: tuple(rows) for robot, rows in found.items()}


def css_class_of(section: PageSection) -> str:
    """Return the CSS class of a robot."""
    return "bad" if section.levels[ERROR] else "odd" if section.faulty else "good"


def ids_in(section: PageSection, ids: Ids) -> set[str]:
    """Return the ids that can be linked to in a section."""
    if not section.drawn:
        return set()
    nodes = {ids.nodes[node.name] for node in section.shown.nodes}
    return nodes | {ids.names[name.name] for name in section.shown.names if not name.merged}


def link_to(
    finding: Finding, targets: Iterable[str], sections: Mapping[str, tuple[str, set[str]]]
) -> str:
    """Return the link to a finding: in its robot's section, or in another one.

    ``targets`` are the ids of what it is about. ``sections`` has by robot the id of its section and
    the ids in it."""
    own = sections.get(finding.robot) or sections[""]
    for target in targets:
        if target.startswith("f"):
            return f"#tf-{target}"
        for section, inside in (own, *sections.values()):
            if target in inside:
                return f"#{section}-{target}"
    return f"#{own[0]}"


def summarize(levels: Mapping[str, int]) -> str:
    """Return the numbers of findings by level, in words."""
    return in_words({level: levels[level] for level in LEVELS})


def without_common(group: DrawnGroup) -> DrawnGroup:
    """Return a group without the endpoints that every node has, unless they are faulty."""
    missing = {node.name for node in group.nodes if node.state == MISSING}
    edges = [
        edge
        for edge in group.edges
        if not edge.common or (edge.state in FAULTY and edge.node not in missing)
    ]
    return _merge_unused_services(_with_edges(group, edges))


def only_common(group: DrawnGroup) -> DrawnGroup:
    """Return the part of a group that ``without_common`` drops."""
    shown = {(edge.kind, edge.name) for edge in without_common(group).edges}
    hidden = [edge for edge in group.edges if (edge.kind, edge.name) not in shown]
    nodes = {edge.node for edge in hidden}
    smaller = _with_edges(group, hidden)
    return smaller._replace(nodes=tuple(n for n in smaller.nodes if n.name in nodes))


def has_faults(group: DrawnGroup) -> bool:
    """Return whether anything in the group is missing or wrong."""
    states = {node.state for node in group.nodes} | {edge.state for edge in group.edges}
    return not states.isdisjoint(FAULTY)


def _with_edges(group: DrawnGroup, edges: Iterable[DrawnEdge]) -> DrawnGroup:
    """Return the group with only these edges; robots and tools without an edge are dropped."""
    kept = tuple(edges)
    nodes = {edge.node for edge in kept}
    names = {(edge.kind, edge.name) for edge in kept}
    return group._replace(
        nodes=tuple(n for n in group.nodes if n.name in nodes or not (n.is_robot or n.is_tool)),
        names=tuple(name for name in group.names if (name.kind, name.name) in names),
        edges=kept,
    )


def _merge_unused_services(group: DrawnGroup) -> DrawnGroup:
    """Return a group with one name for a node's services without a client, where there are several."""
    ends = lists_by_key(((edge.kind, edge.name), edge) for edge in group.edges)
    alone = (own[0] for own in ends.values() if len(own) == 1)
    unused = lists_by_key(
        ((it.node, it.kind), it) for it in alone if it.role == SERVES and it.state not in FAULTY
    )
    merged = {key: own for key, own in unused.items() if len(own) >= MERGE_FROM}
    dropped = {(edge.kind, edge.name) for own in merged.values() for edge in own}
    names = [name for name in group.names if (name.kind, name.name) not in dropped]
    edges = [edge for edge in group.edges if (edge.kind, edge.name) not in dropped]
    for (node, kind), own in merged.items():
        # A space cannot be in the name of a real endpoint.
        bundle = f"{node} {kind}"
        names.append(DrawnName(kind, bundle, group.robot, OK, (), tuple(edge.name for edge in own)))
        edges.append(own[0]._replace(name=bundle, state=OK))
    return group._replace(names=tuple(names), edges=tuple(edges))


# More robots or findings of a card are folded.
MOST_ROBOTS, MOST_ROWS = 8, 5


class _Card(NamedTuple):
    """Robots of which the same is true; ``rows`` are the numbers of the findings."""

    sections: Sequence[PageSection]
    rows: tuple[int, ...]


def robot_cards(
    scene: Scene, sections: Sequence[PageSection], rules: Mapping[str, Rule]
) -> Iterator[str]:
    """Yield the robots with findings first, then those without; the nodes of no robot come last."""
    rows = concerns_of(scene)
    own = ((rows.get(it.group.robot, ()), not it.group.robot, it) for it in sections)
    same = lists_by_key(
        ((numbers, shared), it) for numbers, shared, it in own if numbers or not shared
    )
    found = (_Card(members, numbers) for (numbers, _), members in same.items())
    cards = sorted(found, key=lambda card: not card.rows)
    order = {robot: at for at, robot in enumerate(scene.robots)}
    yield '<div class="cards" role="list" aria-label="robots">\n'
    yield from (_card_html(card, scene, order, rules) for card in cards)
    yield "</div>\n"


def _card_html(
    card: _Card, scene: Scene, order: Mapping[str, int], rules: Mapping[str, Rule]
) -> str:
    numbers = " ".join(str(order.get(it.group.robot, -1)) for it in card.sections)
    links = [
        f'<a href="#{it.id}">{safe(it.group.robot or "shared, or of no robot")}</a>'
        for it in card.sections
    ]
    head = ", ".join(links[:MOST_ROBOTS])
    if others := links[MOST_ROBOTS:]:
        more = f"<summary>{plural(len(others), 'more robot')}</summary>"
        head += f" <details>{more}{', '.join(others)}</details>"
    robot, lines = card.sections[0].group.robot, []
    for at in card.rows:
        # A finding in a few words, as it is of the robot, with a link to it.
        it = scene.rows[at].finding
        about = safe(said_of(next(iter(it.names), it.node), it, robot))
        words = safe(rules[it.code].name.replace("-", " ") if it.code in rules else it.code)
        message = safe(said_of(it.message, it, robot))
        lines.append(
            f'<li><a class="brief {safe(it.level)}" href="#finding-{at}" title="{message}">'
            f"<b>{words}</b> <code>{about}</code></a></li>"
        )
    listed = f"<ul>{''.join(lines[:MOST_ROWS])}</ul>" if lines else ""
    if rest := lines[MOST_ROWS:]:
        listed += f"<details><summary>{len(rest)} more</summary><ul>{''.join(rest)}</ul></details>"
    return (
        f'<div class="card {css_class_of(card.sections[0])}" role="listitem" data-robot="{numbers}">'
        f"<h3>{head}</h3><p>{safe(_card_state(card, scene))}</p>{listed}</div>\n"
    )


def _card_state(card: _Card, scene: Scene) -> str:
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
