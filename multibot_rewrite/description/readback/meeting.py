"""Where robots meet: names in the running system that two of them have and that are not shared."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.naming import Naming, is_keyword
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.description.readback.nodes import SERVICE, TOPIC
from multibot_rewrite.description.readback.reading import FRAME, Reading, RuntimeName


class Meeting(NamedTuple):
    """A name of ``robot`` that ``other`` has, too."""

    robot: str
    other: str
    name: RuntimeName


def same_for_all(reading: Reading, word: str, naming: Naming) -> Iterator[RuntimeName]:
    """The names without ``word``, which stands for the robot: every robot would have them.

    Each name once, at its first place.
    """
    seen: set[tuple[str, str]] = set()
    for it in _own(reading.names, naming):
        if word not in it.name and (it.kind, it.name) not in seen:
            seen.add((it.kind, it.name))
            yield it


def meetings(readings: Mapping[str, Reading], naming: Naming) -> Iterator[Meeting]:
    """The names that two of these robots have, each once."""
    first: dict[tuple[str, str], tuple[str, RuntimeName]] = {}
    seen: set[tuple[str, str]] = set()
    for robot, reading in readings.items():
        for it in _own(reading.names, naming):
            key = it.kind, it.name
            other, name = first.setdefault(key, (robot, it))
            if other != robot and key not in seen:
                seen.add(key)
                yield Meeting(other, robot, name)


def _own(names: Iterable[RuntimeName], naming: Naming) -> Iterator[RuntimeName]:
    """The names that each robot must have for itself."""
    for it in names:
        bare = it.name.strip("/")
        if it.kind == FRAME:
            # Where each robot has a tf topic of its own, frames may be the same.
            at_run_time = naming.layout.at_run_time and it.tag == "link"
            shared = at_run_time or not naming.layout.frames or bare in naming.shared_frames
        elif it.kind in (TOPIC, SERVICE):
            # __default_topic__ is no topic: the simulator makes one from the model's name.
            shared = bare in naming.shared_topics or is_keyword(bare)
        else:
            shared = False
        if not shared:
            yield it
