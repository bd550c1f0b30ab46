# SPDX-License-Identifier: Apache-2.0
"""Words for robots in names and values: a build puts them in itself, so that a source has none."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping

from lxml.etree import _Element

from multibot_rewrite.base.conventions import PARTS, USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.findings.rule import rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.companions.engine import GRAPH
from multibot_rewrite.companions.kinds import EVERY, RVIZ
from multibot_rewrite.companions.named_file import NamedFile
from multibot_rewrite.companions.sites import GZ_TOPIC, Site
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.twice import BETWEEN
from multibot_rewrite.knowledge.parameter_entries import RUN_TIME
from multibot_rewrite.rules.declaration import OF_TWO
from multibot_rewrite.rules.places import remark

# Only where such letters begin, or a line of dashes would be looked at from each of them.
_TOKEN = lazy_compile(r"(?<![A-Za-z0-9_~/.-])[A-Za-z0-9_~/.-]*[A-Za-z0-9_]")
_BETWEEN = "".join(BETWEEN)
# Values that are not names, such as URLs, substitutions and files.
_NOT_A_NAME = lazy_compile(
    r"://|\$\(|\$\{|\.(?:yaml|rviz|urdf|xml|stl|dae|obj|world|sdf|pgm|png|so)\b"
)


@rule("MB863", "robot-in-name-beside", ERROR, formats=EVERY, options=OF_TWO)
def robot_in_name(file: NamedFile) -> Iterator[Finding]:
    """The first name that holds one of the robots."""
    if not file.robots:
        return
    known = declared_names(file.declared)
    named = ((it, _in_site(file, it, known)) for it in file.names)
    others = ((it, in_value(it.text, file.robots - file.own, known)) for it in file.others)
    found = [(it, *said) for it, said in (*named, *others) if said]
    for site, name, robot in sorted(found, key=lambda it: (it[0].line, it[0].column))[:1]:
        yield remark(site, *of_one_robot(name, robot), WARNING if file.kind == RVIZ else "")


def in_description(
    root: _Element, words: Collection[str], declared: Mapping[str, Collection[str]]
) -> Iterator[Problem]:
    """The first value of a description that is for another robot."""
    known = declared_names(declared)
    for element in root.iter("*") if words else ():
        for attribute, text in (*element.items(), ("", (element.text or "").strip())):
            found = in_value(str(text), words, known)
            if found:
                message, hint = of_one_robot(*found)
                yield Problem(element, message, str(attribute), hint, (), robot_in_name.code)
                return


def declared_names(declared: Mapping[str, Collection[str]]) -> frozenset[str]:
    """Every name that a description declares, and the frames of nearly every robot."""
    return frozenset((*USUAL_FRAMES, *(it for names in declared.values() for it in names)))


def _in_site(file: NamedFile, site: Site, declared: frozenset[str]) -> tuple[str, str] | None:
    """The name of a site, and the robot in it."""
    # In a topic of gz the model is the robot, whatever it is called; a planning group has any name; a
    # prefix is told itself.
    if site.kind in (GZ_TOPIC, "group", *RUN_TIME):
        return None
    # A robot may be called as a frame or topic is; what its description declares is judged there.
    name = f"/{site.text.strip('/')}/"
    if site.kind != "namespace" and name.strip("/") in file.robots | declared:
        return None
    if file.kind == RVIZ and name.count("/") < 3:
        return None
    robot = next((it for it in sorted(file.robots) if f"/{it}/" in name and _tells(it, name)), "")
    if not robot and site.kind not in GRAPH:
        robot = _glued(site.text, file.robots, declared)
    return (site.text, robot) if robot else None


def in_value(text: str, words: Collection[str], declared: frozenset[str]) -> tuple[str, str] | None:
    """The first name in a value of unknown use that is a robot's, and that robot."""
    if not any(it in text for it in words) or _NOT_A_NAME.search(text):
        return None
    for token in _TOKEN.findall(text):
        robot = _at_an_end(token, words) or _glued(token, words, declared)
        if robot:
            return token, robot
    return None


def _at_an_end(token: str, words: Iterable[str]) -> str:
    """The robot that a name begins or ends with, or that is its model; empty for none."""
    name = token.strip("/")
    told = (it for it in sorted(words) if _tells(it, name))
    ends = ((f"{it}/", f"/{it}", f"model/{it}/") for it in told)
    for start, end, model in ends:
        if name.startswith(start) or name.endswith(end) or model in f"{name}/":
            return end[1:]
    return ""


def _tells(word: str, name: str) -> bool:
    """Does a robot's word that is a segment of a name tell of the robot? A word for parts of any robot
    does where it is there twice: camera/image is a topic of every camera."""
    return word not in PARTS or f"/{word}/{word}/" in f"/{name.strip('/')}/"


def _glued(token: str, words: Iterable[str], declared: frozenset[str]) -> str:
    """The robot that a declared name has before or behind it, as in robot1_odom; empty for none."""
    name = token.strip("/")
    if name in declared:
        return ""
    return next((it for it in sorted(words) if not declared.isdisjoint(_without(name, it))), "")


def _without(name: str, word: str) -> Iterator[str]:
    """A name without a robot's word in front, and without it behind, however often it is there."""
    front = back = name
    while front.startswith(word):
        front = front.removeprefix(word).lstrip(_BETWEEN)
        yield front
    while back.endswith(word):
        back = back.removesuffix(word).rstrip(_BETWEEN)
        yield back


def of_one_robot(name: str, robot: str) -> tuple[str, str]:
    """Message and hint; raises nothing."""
    message = f"{name} includes the robot name {robot}, so the file is for that robot only"
    return message, "remove the robot name from every name; the build adds it for each robot"
