"""What the rules of descriptions find in those of a fleet's robots: what a simulator leaves out."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.fleet.robots.member import Member


def left_out(members: Iterable[Member], chosen: Iterable[Member] = ()) -> Iterator[Finding]:
    """What Gazebo leaves out of robots that have something for it, and of those that run in it, as
    their fleet file says (``chosen``): there it is an error. Each description once."""
    sure = {it.source.file: it.source for it in chosen}
    perhaps = {it.source.file: it.source for it in members if _is_for_gazebo(it)}
    simulated = perhaps | sure
    if not simulated:
        return
    # A fleet of real robots needs none of the lint.
    from multibot_rewrite.lint.check import lint_subject
    from multibot_rewrite.lint.files.subjects import make_subject
    from multibot_rewrite.rules.description.physics.mass import link_without_mass, no_inertia
    from multibot_rewrite.rules.settings import Settings

    weighed = Settings(select=(link_without_mass.code, no_inertia.code))
    for file, document in simulated.items():
        subject = make_subject(document, weighed._replace(simulated=file in sure))
        for it in lint_subject(subject):
            # It may be a real robot: nothing says that it runs in the simulator.
            yield it if file in sure or it.level != ERROR else it._replace(level=WARNING)


def _is_for_gazebo(member: Member) -> bool:
    blocks = member.inventory.document.root.iter("gazebo")
    return any(it.find(tag) is not None for it in blocks for tag in ("plugin", "sensor"))
