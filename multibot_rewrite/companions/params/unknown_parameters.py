"""Parameters that are not known: guessed to hold names, or with a name of the description in them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from multibot_rewrite.companions.names.by_kind import is_plain
from multibot_rewrite.companions.names.rename_map import is_declared
from multibot_rewrite.companions.params.name_sites import NameSite, SectionNames
from multibot_rewrite.companions.params.sections import ParamSection
from multibot_rewrite.companions.params.values import ParamsJob, renamed
from multibot_rewrite.companions.yaml_text import found_at
from multibot_rewrite.findings.finding import WARNING, Finding
from multibot_rewrite.findings.rule import declare

UNKNOWN_NODE = declare(
    "MF114",
    "names-guessed",
    WARNING,
    what="A node is not known, so the parameters that hold names are guessed from their own names.",
    why="A wrong guess adds the robot's name to something else, and what is not guessed keeps the name "
    "of one robot: then two robots use the same topic or frame.",
    fix="Describe the node's parameters in a file, and name that file under parameters: in the fleet "
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
    guessed = [site.key for site in names.sites if site.param is None and _is_taken(job, site)]
    if guessed:
        words = ", ".join(dict.fromkeys(key.value for key in guessed))
        message = (
            f"node {section.path} is not known; parameters that hold names are guessed: {words}"
        )
        hint = "describe the node in a file under parameters:"
        yield found_at(job.document, guessed[0], UNKNOWN_NODE, message, hint)


def _is_taken(job: ParamsJob, site: NameSite) -> bool:
    """Does the guess change the value?"""
    return site.kind in ("topic", "service") or renamed(job.context, site) != site.value


UNKNOWN_PARAMETER = declare(
    "MF123",
    "name-in-unknown-parameter",
    WARNING,
    what="A parameter that is not known to hold names has the name of a link, joint, frame or topic "
    "of the robot, or an interface of its hardware, as its value or in its key.",
    why="It stays as it is. If it is a name, the node looks for a frame or joint that no longer has "
    "that name, or two robots use the same topic.",
    fix="If it is a name, describe the parameter in a file, and name that file under parameters: in "
    "the fleet file.",
    bad="""\
mast_driver:
  ros__parameters:
    mounted_on: lidar_link
""",
    good="""\
mast_driver:
  ros__parameters:
    frame_id: lidar_link
""",
    line=3,
    formats=("params",),
)


def unclaimed_names(job: ParamsJob, pages: Sequence[SectionNames]) -> Iterator[Finding]:
    """Names of the description at parameters that are not known to hold names."""
    claimed = {it.value: it.kind for names in pages for it in names.sites if _is_robots(job, it)}
    declared = {
        name: kind
        for kind in ("link", "joint")
        for name in job.context.names.declared.get(kind, ())
    }
    either = {**claimed, **declared}
    for names in pages:
        found = [(it, either[it.value]) for it in names.unclaimed if it.value in either]
        found += [(it, declared[it.value]) for it in names.keys if it.value in declared]
        found += [(it, "interface") for it in names.unclaimed if _is_interface(job, it.value)]
        for scalar, kind in found:
            article = "an" if kind == "interface" else "a"
            message = (
                f"{scalar.value!r} is {article} {kind} of the robot, but the parameter is not known"
            )
            hint = "if it is a name, describe the parameter in a file under parameters:"
            yield found_at(job.document, scalar, UNKNOWN_PARAMETER, message, hint)


def _is_interface(job: ParamsJob, value: str) -> bool:
    """Is it ``elbow/position``? ``imu/data`` is more likely a topic than an interface of a sensor,
    ``imu/orientation.x`` can be no topic."""
    *chain, interface = value.split("/")
    kinds = ("joint", "gpio", "sensor") if "." in interface else ("joint", "gpio")
    names = job.context.names
    return interface != "" and any(is_declared(names, kind, it) for kind in kinds for it in chain)


def _is_robots(job: ParamsJob, site: NameSite) -> bool:
    """A frame or absolute topic that changes for a robot; relative topics are common words."""
    if site.kind == "frame":
        return site.at < 0 and renamed(job.context, site) != site.value
    return site.kind == "topic" and site.value.startswith("/") and is_plain(site.value)
