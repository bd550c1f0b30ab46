"""What the page is made of: a part a robot, short names for all things, where a finding is seen."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Mapping
from typing import NamedTuple, TypeVar

from multibot_rewrite.graph.pictures.lighter import plain, troubled
from multibot_rewrite.graph.pictures.marks import Targets
from multibot_rewrite.graph.pictures.scene import Group, Scene
from multibot_rewrite.graph.pictures.svg import Ids
from multibot_rewrite.graph.pictures.text import counted
from multibot_rewrite.graph.rules.comparison import INCONCLUSIVE, GraphFinding
from multibot_rewrite.model import ERROR, WARNING

LEVELS = (ERROR, WARNING, INCONCLUSIVE)
# Of a larger fleet only the robots with something wrong are unfolded, and no more than MOST_OPEN.
SMALL_FLEET, MOST_OPEN = 3, 10
SHARED = "shared"
_Thing = TypeVar("_Thing", bound=Hashable)


class Part(NamedTuple):
    """A group on the page: whole and ``light``, how many findings of a level it has."""

    group: Group
    light: Group
    id: str
    levels: Mapping[str, int]
    wrong: bool
    open: bool


def make_ids(scene: Scene) -> Ids:
    """A short name for all that is drawn."""
    nodes = sorted({node.name for group in scene.groups for node in group.nodes})
    names = sorted({name.name for group in scene.groups for name in group.names})
    frames = dict.fromkeys((one.topic, row.frame) for one in scene.outlines for row in one.rows)
    ids = Ids(_numbered("n", nodes), _numbered("t", names), _numbered("f", frames), frozenset())
    wanted = {id_ for about in scene.targets for id_ in hits_of(about, ids)}
    return ids._replace(anchors=frozenset(wanted))


def _numbered(letter: str, things: Iterable[_Thing]) -> dict[_Thing, str]:
    return {thing: f"{letter}{at}" for at, thing in enumerate(things)}


def hits_of(about: Targets, ids: Ids) -> list[str]:
    """The short names of what a finding is about, as far as it is drawn."""
    found = (
        *(ids.names.get(name, "") for name in about.names),
        *(ids.nodes.get(node, "") for node in about.nodes),
        *(ids.frames.get(frame, "") for frame in about.frames),
    )
    return [id_ for id_ in found if id_]


def make_parts(scene: Scene) -> list[Part]:
    """One a robot, then the one of what is no robot's."""
    counts = Counter((finding.robot, finding.level) for finding in scene.findings)
    parts, room = [], MOST_OPEN
    for at, group in enumerate(scene.groups):
        id_ = f"g{at}" if group.robot else SHARED
        levels = {level: counts[group.robot, level] for level in LEVELS}
        wrong = bool(sum(levels.values())) or troubled(group)
        opened = len(scene.robots) <= SMALL_FLEET or (wrong and room > 0)
        room -= opened
        parts.append(Part(group, plain(group), id_, levels, wrong, opened))
    return parts


def drawn(part: Part, ids: Ids) -> set[str]:
    """What links can lead to in a part."""
    nodes = {ids.nodes[node.name] for node in part.light.nodes}
    return nodes | {ids.names[name.name] for name in part.light.names if not name.merged}


def link_to(
    finding: GraphFinding, hits: Iterable[str], there: Mapping[str, tuple[str, set[str]]]
) -> str:
    """Where a finding is to be seen: in its robot's part, else in another one.

    ``there`` has the id of each robot's part and what is drawn in it.
    """
    own = there.get(finding.robot) or there[""]
    for hit in hits:
        if hit.startswith("f"):
            return f"#tf-{hit}"
        for part, inside in (own, *there.values()):
            if hit in inside:
                return f"#{part}-{hit}"
    return f"#{own[0]}"


def summary(levels: Mapping[str, int]) -> str:
    """``2 errors, 1 warning``; empty where there is nothing."""
    words = (
        f"{levels[level]} {level}" if level == INCONCLUSIVE else counted(levels[level], level)
        for level in LEVELS
        if levels[level]
    )
    return ", ".join(words)
