"""What is open in a robot: something is needed, and nothing of the robot gives it."""

from __future__ import annotations

from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.system.records import Place


class Gap(NamedTuple):
    """``node`` needs ``name`` (of a ``kind``: interface, topic, service, frame), and nothing has it.

    ``key`` is the same before and after a rewrite. ``place`` is where it is needed, ``near`` what may
    be meant, and where that is; places are None where no file says it. ``at`` is where the node is
    declared that needs it.
    """

    kind: str
    name: str
    node: str
    key: tuple[str, ...]
    place: Place | None = None
    near: str = ""
    near_place: Place | None = None
    at: Place | None = None
