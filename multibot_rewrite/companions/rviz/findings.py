"""All findings about the rewrite of an RViz config for robots."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.companions.rviz.display_checks import display_findings
from multibot_rewrite.companions.rviz.display_groups import Robots, leaves
from multibot_rewrite.companions.rviz.read_config import RvizConfig
from multibot_rewrite.companions.rviz.window_checks import window_findings


def config_findings(
    config: RvizConfig, robots: Robots, world: str, together: bool
) -> Iterator[Finding]:
    """The findings, each once, in the order of the file.

    ``together``: one window shows all ``robots``, in the frame ``world``.
    """
    found = [*window_findings(config, robots, world, together)]
    for one in leaves(config.displays):
        found += display_findings(config, one, robots, together)
    yield from sorted(dict.fromkeys(found), key=lambda it: (it.line, it.column, it.code))
