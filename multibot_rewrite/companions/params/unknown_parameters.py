"""Parameters of nodes that are not known: guessed to hold names."""

from __future__ import annotations

from collections.abc import Iterator

from multibot_rewrite.base.findings.finding import WARNING, Finding
from multibot_rewrite.base.findings.rule import declare
from multibot_rewrite.companions.engine import GRAPH
from multibot_rewrite.companions.params.name_sites import SectionNames
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.params.values import ParamsJob, renamed
from multibot_rewrite.companions.sites import Site, found_in

UNKNOWN_NODE = declare(
    "MF114",
    "names-guessed",
    WARNING,
    what="A node is not known, so the parameters that hold names are guessed from their own names.",
    why="A wrong guess adds the robot's name to something else, and what is not guessed keeps the name "
    "of one robot: then two robots use the same topic or frame.",
    fix="Describe the node's parameters in a file, and name that file under nodes: in the fleet "
    "file.",
    bad="""\
mast_driver:
  ros__parameters:
    image_topic: /image
""",
    good="""\
amcl:
  ros__parameters:
    scan_topic: /scan
""",
    line=3,
    formats=("params",),
)


def guessed_names(job: ParamsJob, section: ParamSection, names: SectionNames) -> Iterator[Finding]:
    """Guesses that change the section of an unknown node, as one finding."""
    if section.node is not None or section.wild:
        return
    guessed = [it for it in names.sites if not it.is_sure and _is_taken(job, it)]
    if guessed:
        words = ", ".join(dict.fromkeys(it.key for it in guessed))
        message = (
            f"node {section.path} is not known; parameters that hold names are guessed: {words}"
        )
        hint = "describe the node in a file under nodes:"
        yield found_in(job.document.file, guessed[0].slot, UNKNOWN_NODE, message, hint)


def _is_taken(job: ParamsJob, site: Site) -> bool:
    """Does the guess change the value?"""
    return site.kind in GRAPH or renamed(job.context, site) != site.text
