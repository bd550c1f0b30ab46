# SPDX-License-Identifier: Apache-2.0
"""The descriptions and files of a launch file -> what stops the robots that run with them.

That is every error, and what Gazebo leaves out of a robot that runs in it. Where a description is only
sent, nothing counts that only a simulator reads. The build and check-launch ask for it. A finding in a
text that has no file of its own is at its place in the launch file."""

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

import yaml

from multibot_rewrite.base.bounded import load_yaml
from multibot_rewrite.base.conventions import CLOCK
from multibot_rewrite.base.findings.finding import ERROR, NOTE, WARNING, Finding, Rule, locate
from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.releases import ROS_2
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.steps.document import Document, read_document
from multibot_rewrite.lint.beside import context_of
from multibot_rewrite.lint.check import lint_data
from multibot_rewrite.planning.bridged_topics import DIRECTIONS
from multibot_rewrite.planning.records import Run
from multibot_rewrite.producers.ends import BRIDGE_FILE
from multibot_rewrite.producers.launch.bridges import expands, is_bridge, rows_in_arguments
from multibot_rewrite.producers.launch.launched import InSimulator, Launched, file_of
from multibot_rewrite.producers.launch.records import LaunchedNode
from multibot_rewrite.related_files.formats import read_named
from multibot_rewrite.related_files.named_file import BRIDGE, PARAMS, kind_of
from multibot_rewrite.rules.files import bridges
from multibot_rewrite.rules.files.judge import judged
from multibot_rewrite.rules.files.plugin_names import without_input
from multibot_rewrite.rules.settings import LEFT_OUT, Settings
from multibot_rewrite.system.records import NOWHERE, Place

# What has no effect in this simulator and this ROS, a joint that is not found there, and two senders.
_NO_EFFECT = ("MB163", "MB211", "MB243")
# Names, inertias and systems that only a simulator refuses.
_OF_SIMULATOR = ("MB160", "MB305", "MB306", "MB606", "MB624")
# A robot without a shape runs, and whether its file is there depends on the machine.
_SHAPES = ("MB701", "MB703")


def may_stop(rule: Rule) -> bool:
    """Return whether a finding of the rule can stop a robot."""
    return rule.level == ERROR or rule.code in (*LEFT_OUT, *_NO_EFFECT)


def in_use(found: Iterable[Finding], document: Document, simulated: bool) -> Iterator[Finding]:
    """Yield the findings that count for a robot with this document, with their level there."""
    for it in found:
        level = _level_in_simulator(it) if simulated else _level_if_sent(it, document)
        if level:
            yield it._replace(level=level)


def is_of_simulator(it: Finding, document: Document) -> bool:
    """Return whether a finding is no error if the description is only sent."""
    return _level_if_sent(it, document) != ERROR


def _level_in_simulator(it: Finding) -> str:
    """Return the level of a finding about a robot in a simulator; "" if it does not count."""
    if it.level == ERROR:
        return WARNING if it.code in _SHAPES else ERROR
    return WARNING if it.level == WARNING and it.code in (*LEFT_OUT, *_NO_EFFECT) else ""


def _level_if_sent(it: Finding, document: Document) -> str:
    """Return the level of a finding about a description that is only sent; "" if it does not count."""
    if it.level != ERROR or it.code in LEFT_OUT or _is_below_gazebo(it, document):
        return ""
    return WARNING if it.code in (*_SHAPES, *_OF_SIMULATOR) else ERROR


def _is_below_gazebo(it: Finding, document: Document) -> bool:
    starts = zip(document.elements, document.starts, strict=True)
    tops = ((top, at) for top, at in starts if top.getparent() is document.root)
    before = [top for top, at in tops if locate(document.source, at)[0] <= it.line]
    return bool(before) and before[-1].tag == "gazebo"


# What is wrong as soon as a second model has it, too.
_AGAIN = "MB416"
# Names that the node has not, and values of another type.
_OF_VALUES = ("MB110", "MB111", "MB120")
_FOR_ALL = "/**:"
# A description is no parameter to look into.
_TEXT = re.compile(r"<\?xml|<robot|<sdf")


def named_findings(launched: Launched) -> list[Finding]:
    """Return what is wrong with the files that a launch file names, each once."""
    every = (
        _in_descriptions,
        _loaded_again,
        _in_parameters,
        _in_values,
        bridge_findings,
    )
    unread = {it.place for it in launched.graph.notes}
    nodes = (it for it in launched.nodes if it.place not in unread)
    # Reported once for all nodes, not in each file.
    lacking = [*without_input(nodes, launched.release)]
    said = {(it.code, it.hint) for it in lacking}
    found = (it for findings in every for it in findings(launched))
    return [*dict.fromkeys(it for it in found if (it.code, it.hint) not in said), *lacking]


def _in_descriptions(launched: Launched) -> Iterator[Finding]:
    """Yield what stops the robots of the descriptions in a launch file."""
    for it in launched.models.found:
        file, data = file_of(launched.graph, it.text), it.text.encode()
        settings = Settings(distro=launched.release, ros=ROS_2, simulated=it.spawned)
        # Descriptions of its package are found from a name beside the launch file.
        beside = os.path.join(os.path.dirname(it.place.file), "robot.urdf")
        found = lint_data(file or beside, data, settings, may_stop)
        if found:
            told = in_use(found, read_document(data, file), it.spawned)
            yield from (one if file else _at_launch(one, it.place) for one in told)


def _loaded_again(launched: Launched) -> Iterator[Finding]:
    """Report systems of the world in the descriptions of two models or more."""
    settings = Settings(select=(_AGAIN,), distro=launched.release, ros=ROS_2, simulated=True)
    found: list[list[Finding]] = []
    for it in (one for one in launched.models.found if one.spawned):
        file = file_of(launched.graph, it.text)
        told = lint_data(file or "robot.urdf", it.text.encode(), settings)
        found += [[one if file else _at_launch(one, it.place) for one in told]] if told else []
    if len(found) > 1:
        yield from (one for own in found for one in own)


def _at_launch(it: Finding, place: Place) -> Finding:
    """Return a finding about a text without a file of its own, at its place in the launch file."""
    message = f"in the description (line {it.line}): {it.message}"
    return it._replace(message=message, file=place.file, line=place.line, column=1)


def _in_parameters(launched: Launched) -> Iterator[Finding]:
    """Yield errors and warnings in parameter files that exist as files."""
    texts = {
        it.file: it.text
        for node in launched.graph.nodes
        for it in node.parameters
        if it.file and it.file == it.source
    }
    settings = Settings(distro=launched.release, ros=ROS_2)
    for file, text in texts.items():
        if kind_of(text.encode()) == PARAMS:
            found = lint_data(file, text.encode(), settings)
            yield from (it for it in found if it.level != NOTE)


def _in_values(launched: Launched) -> Iterator[Finding]:
    """Yield what is wrong with the parameters that a launch file gives a node itself, at the node."""
    settings = Settings(select=_OF_VALUES, distro=launched.release, ros=ROS_2)
    nodes = {(it.place, it.namespace, it.program): it for it in launched.nodes if it.has_fact}
    for it in launched.graph.nodes:
        running = nodes.get((it.place, it.namespace, f"{it.package}/{it.executable}"))
        given = _own_parameters(it) if running else {}
        if running and given:
            text = yaml.safe_dump({running.full_name: {"ros__parameters": given}}, sort_keys=False)
            beside = os.path.join(os.path.dirname(it.place.file), "launch.yaml")
            for one in lint_data(beside, text.encode(), settings):
                level = WARNING if one.level == NOTE else one.level
                yield one._replace(level=level, file=it.place.file, line=it.place.line, column=1)


def _own_parameters(it: LaunchedNode) -> dict[str, object]:
    """Return the parameters that a launch file gives a node itself, without descriptions."""
    found: dict[str, object] = {}
    for text in (one.text for one in it.parameters if not one.file):
        if text.startswith(_FOR_ALL) and not _TEXT.search(text):
            found |= load_yaml(text, it.place.file)[_FOR_ALL.rstrip(":")]["ros__parameters"]
    return found


# That of every world, beside /world/NAME/clock (gz-sim 8 src/SimulationRunner.cc).
_CLOCK = bridges.GzTopic("gz.msgs.Clock", DIRECTIONS["in"])


class _BridgeText(NamedTuple):
    """The rows of a bridge: of a file, or of its arguments, which are at a place."""

    file: str
    text: str
    expanded: bool
    place: Place


def bridge_findings(launched: Launched) -> Iterator[Finding]:
    """Yield what is wrong with the rows of bridges, with all models that the launch file spawns."""
    models = launched.simulated
    known = _simulator_topics(models) if models and not launched.models.lost else {}
    for told in dict.fromkeys(it for node in launched.nodes for it in _bridge_texts(node)):
        # Names below the namespace of a bridge are not those of the file.
        mine = {} if told.expanded else known
        for it in _bridge_text_findings(told, launched.release, mine):
            # The description is the one that is spawned: the row does not work. What is not known may
            # send what one that stands in the launch file reads.
            at = told.place
            sure = bool(mine) and (at == NOWHERE or launched.whole)
            one = it._replace(level=ERROR) if sure or it.code != bridges.no_gz_topic.code else it
            yield one if at == NOWHERE else one._replace(file=at.file, line=at.line, column=1)


def _bridge_texts(it: Run) -> Iterator[_BridgeText]:
    given = it.values.get("config_file") if is_bridge(it) else None
    if given and os.path.isfile(str(given.value)):
        path = os.path.realpath(str(given.value))
        yield _BridgeText(path, read_file(path).decode("utf-8", "replace"), expands(it), NOWHERE)
    if text := rows_in_arguments(it):
        yield _BridgeText(BRIDGE_FILE, text, expands(it), it.place)


def _bridge_text_findings(
    told: _BridgeText, release: str, known: Mapping[str, bridges.GzTopic]
) -> Iterable[Finding]:
    context = context_of({}, Settings(distro=release))
    try:
        file = read_named(BRIDGE, told.text.encode(), told.file, context)
    except InputError:
        return ()
    file = file._replace(memo={bridges.GzTopics: bridges.GzTopics(known)} if known else {})
    return judged(file, (bridges.no_gz_topic, bridges.not_converted, bridges.bridge_row))


def _simulator_topics(models: Iterable[InSimulator]) -> dict[str, bridges.GzTopic]:
    found = (it for model in models for it in model.topics)
    own = {f"/{it.gz.lstrip('/')}": bridges.GzTopic(it.gz_type, it.direction) for it in found}
    return {CLOCK: _CLOCK, **own}
