# SPDX-License-Identifier: Apache-2.0
"""Names that ROS or tf2 refuses, placeholders, and robots' names, which a build puts in itself."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping

from lxml.etree import _Element

from multibot_rewrite.base.conventions import PARTS, USUAL_FRAMES
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, rule
from multibot_rewrite.base.lazy import IN_SUBSTITUTION, lazy_compile
from multibot_rewrite.base.rosnames import check_name_in_code, check_node_name
from multibot_rewrite.description.checks.problem import Problem
from multibot_rewrite.description.checks.twice import BETWEEN
from multibot_rewrite.knowledge.node_entries import RUN_TIME
from multibot_rewrite.related_files.engine import GRAPH
from multibot_rewrite.related_files.named_file import EVERY, MOVEIT, PARAMS, RVIZ, NamedFile
from multibot_rewrite.related_files.names.by_kind import SPELLERS, is_filled, is_plain
from multibot_rewrite.related_files.names.placeholders import is_robot
from multibot_rewrite.related_files.sites import GZ_TOPIC, SECTION, Site
from multibot_rewrite.rules.declaration import OF_TWO, remark
from multibot_rewrite.rules.subject import Robots

_IN_VALUE = re.compile(rf"<[^<>]*>|\$\({IN_SUBSTITUTION}\)|\$?\{{[^{{}}]*\}}|%\w+")
# Stand for whole names of nodes.
_ANY = ("*", "**")
# What RViz calls the frame that everything is shown in.
_FIXED = "<Fixed Frame>"


def invalid_names(file: NamedFile) -> Iterator[Finding]:
    """Report names in the graph, and those of sections, that ROS refuses."""
    for site in file.names:
        fault = _section_fault(site) if site.kind == SECTION else ""
        if site.kind in GRAPH and site.text and is_filled(site.text):
            found = check_name_in_code(site.text)
            fault = found.reason if found else ""
        if fault:
            what = "node" if site.kind == SECTION else site.kind
            message = f"{what} {site.text!r} is not a valid ROS name: {fault}"
            yield remark(site, message, "it stays as it is; correct it")


def _section_fault(site: Site) -> str:
    """Return what is wrong with a section's key or pattern; ``in_key``: it is below another key."""
    if _IN_VALUE.search(site.text) or "<" in site.text or "$" in site.text or "{" in site.text:
        return ""
    if site.in_key and site.text.startswith("/"):
        return "the slash it starts with makes two slashes in a row"
    names = (it for it in site.text.strip("/").split("/") if it not in _ANY)
    faults = ((it, check_node_name(it)) for it in names)
    return next((f"{it!r}: {fault.reason}" for it, fault in faults if fault), "")


@rule("MB876", "name-in-text-block", WARNING, formats=(PARAMS, MOVEIT))
def text_block(file: NamedFile) -> Iterator[Finding]:
    """Report each name that is written as a block of text."""
    for site in file.names:
        if site.slot.is_block and site.kind in (*GRAPH, *SPELLERS):
            name = site.text.strip()
            message = f"the name {name!r} is in a block of text, so it is not rewritten"
            level = "" if file.is_certain or site.text != name else NOTE
            yield remark(site, message, f"write it on one line: {name}", level)


def placeholders(file: NamedFile) -> Iterator[Finding]:
    """Yield the first placeholder of each name."""
    level = "" if file.is_certain else NOTE
    for site in file.names:
        if is_plain(site.text) or is_robot(site.text) or site.text == _FIXED:
            continue
        if found := _IN_VALUE.search(site.text):
            message = f"the placeholder {found[0]} stays; a launch file must replace it"
            hint = "if it stands for the robot's name, write the value without it"
            yield remark(site, message, hint, level)


def unfilled(file: NamedFile) -> Iterator[Finding]:
    """Yield each placeholder for the robot once, in a file that is checked with a description."""
    told: set[str] = set()
    for site in file.names if file.is_certain and file.memo.get(Robots) else ():
        found = _IN_VALUE.search(site.slot.value)
        if found and is_robot(found[0]) and found[0] not in {*told, site.text}:
            told.add(found[0])
            message = f"{site.slot.value!r} keeps {found[0]} where no launch file fills it in"
            yield remark(site, message, "fill it in, or leave it out", NOTE)


def slashes(file: NamedFile) -> Iterator[Finding]:
    """Report values with a slash that are known to be frames."""
    for site in _frame_names(file):
        if site.text.startswith("/") and is_plain(site.text) and not _is_spaced(site.text):
            name, level = f"frame {site.text!r}", NOTE if site.bare else ""
            message = f"{name} starts with a slash, which tf2 refuses"
            if site.bare:
                message = f"{name} is written without its slash, which the node takes off"
            yield remark(site, message, f"write {site.text.lstrip('/')}", level)


@rule("MB865", "frame-with-white-space", WARNING, formats=EVERY)
def frame_with_white_space(file: NamedFile) -> Iterator[Finding]:
    """Report values with white space that are known to be frames."""
    for site in _frame_names(file):
        if _is_spaced(site.text) and is_filled(site.text):
            message = (
                f"frame {site.text!r} has white space in it: it is another one, and not rewritten"
            )
            yield remark(site, message, f"write {'_'.join(site.text.split())}")


def _frame_names(file: NamedFile) -> Iterator[Site]:
    # A block of text has a line break at its end, which is told where it is rewritten.
    free = (it for it in file.names if not it.in_key and not it.text.endswith("\n"))
    yield from (it for it in free if it.kind == "frame" and it.is_sure and it.text)


def _is_spaced(text: str) -> bool:
    return text.split() != [text]


# Only where such letters begin, or a line of dashes would be looked at from each of them.
_TOKEN = lazy_compile(r"(?<![A-Za-z0-9_~/.-])[A-Za-z0-9_~/.-]*[A-Za-z0-9_]")
_BETWEEN = "".join(BETWEEN)
# Values that are not names, such as URLs, substitutions and files.
_NOT_A_NAME = lazy_compile(
    r"://|\$\(|\$\{|\.(?:yaml|rviz|urdf|xml|stl|dae|obj|world|sdf|pgm|png|so)\b"
)


@rule("MB863", "robot-in-name-beside", ERROR, formats=EVERY, options=OF_TWO)
def robot_in_name(file: NamedFile) -> Iterator[Finding]:
    """Yield the first name that contains the name of one of the robots."""
    if not file.robots:
        return
    known = declared_names(file.declared)
    named = ((it, _robot_at(file, it, known)) for it in file.names)
    others = ((it, in_value(it.text, file.robots - file.own, known)) for it in file.others)
    found = [(it, *said) for it, said in (*named, *others) if said]
    for site, name, robot in sorted(found, key=lambda it: (it[0].line, it[0].column))[:1]:
        yield remark(site, *of_one_robot(name, robot), WARNING if file.kind == RVIZ else "")


def in_description(
    root: _Element, words: Collection[str], declared: Mapping[str, Collection[str]]
) -> Iterator[Problem]:
    """Yield a problem for the first value of a description that is for another robot."""
    known = declared_names(declared)
    for element in root.iter("*") if words else ():
        for attribute, text in (*element.items(), ("", (element.text or "").strip())):
            if found := in_value(str(text), words, known):
                message, hint = of_one_robot(*found)
                yield Problem(element, message, str(attribute), hint, (), robot_in_name.code)
                return


def declared_names(declared: Mapping[str, Collection[str]]) -> frozenset[str]:
    """Return every name that a description declares, and the frames of nearly every robot."""
    return frozenset((*USUAL_FRAMES, *(it for names in declared.values() for it in names)))


def _robot_at(file: NamedFile, site: Site, declared: frozenset[str]) -> tuple[str, str] | None:
    """Return the name at a site and the robot in it; None for a name without a robot."""
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
    robot = next(
        (it for it in sorted(file.robots) if f"/{it}/" in name and _means_robot(it, name)), ""
    )
    if not robot and site.kind not in GRAPH:
        robot = _robot_in_declared(site.text, file.robots, declared)
    return (site.text, robot) if robot else None


def in_value(text: str, words: Collection[str], declared: frozenset[str]) -> tuple[str, str] | None:
    """Return the first name in a value of unknown use that is a robot's, and that robot, or None."""
    if not any(it in text for it in words) or _NOT_A_NAME.search(text):
        return None
    for token in _TOKEN.findall(text):
        robot = _robot_at_an_end(token, words) or _robot_in_declared(token, words, declared)
        if robot:
            return token, robot
    return None


def _robot_at_an_end(token: str, words: Iterable[str]) -> str:
    """Return the robot that a name begins or ends with, or that is its model; empty for none."""
    name = token.strip("/")
    told = (it for it in sorted(words) if _means_robot(it, name))
    ends = ((f"{it}/", f"/{it}", f"model/{it}/") for it in told)
    for start, end, model in ends:
        if name.startswith(start) or name.endswith(end) or model in f"{name}/":
            return end[1:]
    return ""


def _means_robot(word: str, name: str) -> bool:
    """Return whether a robot's name as a segment means the robot: ``camera`` only where it is twice."""
    return word not in PARTS or f"/{word}/{word}/" in f"/{name.strip('/')}/"


def _robot_in_declared(token: str, words: Iterable[str], declared: frozenset[str]) -> str:
    """Return the robot's name before or after a declared name, as in robot1_odom; empty for none."""
    name = token.strip("/")
    if name in declared:
        return ""
    return next(
        (it for it in sorted(words) if not declared.isdisjoint(_without_affixes(name, it))), ""
    )


def _without_affixes(name: str, word: str) -> Iterator[str]:
    """Yield a name without any robot's name in front, and without any behind."""
    front = back = name
    while front.startswith(word):
        front = front.removeprefix(word).lstrip(_BETWEEN)
        yield front
    while back.endswith(word):
        back = back.removesuffix(word).rstrip(_BETWEEN)
        yield back


def of_one_robot(name: str, robot: str) -> tuple[str, str]:
    """Return message and hint about a name with a robot's name in it."""
    message = f"{name} includes the robot name {robot}, so the file is for that robot only"
    return message, "remove the robot name from every name; the build adds it for each robot"
