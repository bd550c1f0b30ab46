# SPDX-License-Identifier: Apache-2.0
"""One RViz config for all robots: shared displays once, and a group of displays for each robot."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.related_files.engine import splices_of
from multibot_rewrite.related_files.names.node_topics import robot_topic
from multibot_rewrite.related_files.rviz.read_config import (
    ABSOLUTE,
    COLOUR,
    DOCK,
    FLAT_COLOUR,
    FRAME,
    GROUP,
    PROCESS,
    SHARED,
    Colour,
    RvizConfig,
    RvizItem,
    RvizRobot,
    changed_values,
    is_name,
    robot_value,
    rviz_data,
    text_of,
    value,
)
from multibot_rewrite.related_files.yaml_text import (
    Block,
    Splice,
    YamlText,
    blocks,
    cut_out,
    end_of,
    inserted,
    is_block,
    moved,
    newline,
    pairs,
    quoted,
    replaced,
)

Robots = Sequence[RvizRobot]
Wanted = Callable[[RvizItem], bool]


class RvizJob(NamedTuple):
    """A config to rewrite, robots of a window, colours (None: unchanged), own displays by place."""

    config: RvizConfig
    robots: Robots
    colours: tuple[Colour | None, ...]
    own: frozenset[int]


def make_rviz_job(
    config: RvizConfig, robots: Robots, colours: tuple[Colour | None, ...]
) -> RvizJob:
    """Return the job with the displays that each robot needs for itself: those that change."""
    own = {
        one.block.start
        for one in leaves(config.displays)
        if one.flag != SHARED and any(next(changed_values(one, robot), None) for robot in robots)
    }
    return RvizJob(config, robots, colours, frozenset(own))


def leaves(shown: Iterable[RvizItem]) -> Iterator[RvizItem]:
    """Yield displays that are not groups, and empty groups."""
    for one in shown:
        if one.children:
            yield from leaves(one.children)
        else:
            yield one


def for_one_process(one: RvizItem) -> bool:
    """Return whether an item works only for the robot that its rviz2 process is set up for."""
    return one.flag in (PROCESS, ABSOLUTE)


def has_own_windows(config: RvizConfig, robot: RvizRobot) -> bool:
    """Return whether anything works for one robot only, in an rviz2 of its own, or it was asked for."""
    return robot.apart or (robot.has_process and any(map(is_for_one, shown_in(config))))


def shown_in(config: RvizConfig) -> tuple[RvizItem, ...]:
    """Return the displays, tools and panels of a config."""
    return (*leaves(config.displays), *config.tools, *config.panels)


def is_for_one(it: RvizItem) -> bool:
    """Return whether an item works only for the robot in whose namespace rviz2 runs."""
    return it.flag == PROCESS


def robot_groups(job: RvizJob) -> Iterator[Splice]:
    """Yield the splices that put each robot's displays into a group, after the shared ones."""
    document, shown = job.config.document, job.config.displays
    if not shown:
        return

    def is_shared(one: RvizItem) -> bool:
        return one.block.start not in job.own and not for_one_process(one)

    for one in shown:
        yield from _kept_parts(one, is_shared, lambda leaf: entries(document, leaf, job.robots))
    rows = [remark(document, one) for one in leaves(shown) if for_one_process(one)]
    rows += [_group_of_robot(job, at) for at in range(len(job.robots))]
    yield inserted(document, shown[-1].block.end, "".join(rows))


def _kept_parts(
    one: RvizItem, wanted: Wanted, made: Callable[[RvizItem], Iterable[Splice]]
) -> Iterator[Splice]:
    """Yield the splices that keep the wanted parts of a display and change them."""
    if not any(map(wanted, leaves([one]))):
        yield Splice(one.block.start, one.block.end, "")
    elif one.children:
        for child in one.children:
            yield from _kept_parts(child, wanted, made)
    else:
        yield from made(one)


def _group_of_robot(job: RvizJob, at: int) -> str:
    """Return the group of one robot: copies of the displays with its names; empty if it has none."""
    document, robot = job.config.document, job.robots[at]

    def is_own(one: RvizItem) -> bool:
        return one.block.start in job.own and not for_one_process(one)

    def copy_edits(one: RvizItem) -> Iterator[Splice]:
        yield from item_splices(document, one, robot, job.colours[at])
        # Each window needs its own title; a list of other displays no longer holds.
        name, visible = value(one.node, "Name"), value(one.node, "Visibility")
        if one.flag == DOCK and isinstance(name, yaml.ScalarNode):
            yield replaced(name, titled(one, robot))
        if visible is not None and visible.value:
            yield Splice(visible.start_mark.index, end_of(visible), "{}")

    copies = [
        cut_out(document, one.block.start, one.block.end, _kept_parts(one, is_own, copy_edits))
        for one in job.config.displays
        if any(map(is_own, leaves([one])))
    ]
    if not copies:
        return ""
    return group_text(document, robot.name, job.config.displays[0].block.column, copies)


def group_text(document: YamlText, name: str, column: int, displays: Iterable[str]) -> str:
    """Return a group of displays, whose texts have the ``column`` of their list."""
    end, lead = newline(document), " " * column
    head = f"{lead}- Class: {GROUP}{end}{lead}  Displays:{end}"
    body = "".join(moved(it, 4) for it in displays)
    return f"{head}{body}{lead}  Enabled: true{end}{lead}  Name: {quoted(name)}{end}"


def titled(one: RvizItem, robot: RvizRobot) -> str:
    """Return the name of a robot's window."""
    return f"{robot.name} {one.name}"


def entry_blocks(
    document: YamlText, node: yaml.Node | None
) -> Iterator[tuple[tuple[yaml.ScalarNode, yaml.Node], Block]]:
    """Yield ((key, value), lines) of each entry of a block map."""
    found = pairs(node)
    if node is None or not is_block(node) or len(found) != len(node.value):
        return
    yield from zip(found, blocks(document, node), strict=True)


def entries(document: YamlText, one: RvizItem, robots: Robots) -> Iterator[Splice]:
    """Yield the splices that list the frames of all robots in a shared display, and empty its tree."""
    for place_map, deep in (("Frames", False), ("Tree", True)):
        node = value(one.node, place_map)
        changed = (place.key for robot in robots for place, _ in changed_values(one, robot))
        if one.flag != SHARED or not any(it.startswith(place_map) for it in changed):
            continue
        if deep and node is not None:
            yield Splice(node.start_mark.index, end_of(node), "{}")
            continue
        for (key, _), block in entry_blocks(document, node):
            start, end, _ = block
            places = (it for it in one.places if it.slot.start == key.start_mark.index)
            place = next(filter(is_name, places), None)
            edits: Iterable[tuple[Splice, ...]] = [()]
            if place and place.kind == FRAME:
                edits = dict.fromkeys((replaced(key, robot_value(place, it)),) for it in robots)
            copies = (cut_out(document, start, end, one) for one in edits)
            yield Splice(start, end, "".join(copies))


def tools(job: RvizJob) -> Iterator[Splice]:
    """Yield a tool for each robot it publishes to; a tool that works in one process is left out."""
    document = job.config.document
    for tool in job.config.tools:
        start, end, _ = tool.block
        if for_one_process(tool):
            yield Splice(start, end, remark(document, tool))
            continue
        made = dict.fromkeys(tuple(tool_edits(document, tool, it)) for it in job.robots)
        if tuple(made) != ((),):
            yield Splice(start, end, "".join(cut_out(document, start, end, one) for one in made))


def tool_edits(document: YamlText, tool: RvizItem, robot: RvizRobot) -> Iterator[Splice]:
    """Yield the splices that make a tool publish for the robot, with or without a topic."""
    yield from item_splices(document, tool, robot, None)
    default = rviz_data()["tools"].get(tool.cls, "")
    if value(tool.node, "Topic") is not None or not default:
        return
    topic = robot_topic(robot.topics, default, robot.known)
    if topic == default:
        return
    if not is_block(tool.node):
        # Before the brace, or before a comma at the end.
        last, brace = end_of(tool.node.value[-1][1]), tool.node.end_mark.index - 1
        at = last if "," in document.text[last:brace] else brace
        yield Splice(at, at, f", Topic: {quoted(topic)}")
    else:
        lead = " " * tool.node.start_mark.column
        at = end_of(tool.node)
        yield Splice(at, at, f"{newline(document)}{lead}Topic: {quoted(topic)}")


def panels(job: RvizJob) -> Iterator[Splice]:
    """Yield edits of panels: without those for one process and references to moved displays."""
    document = job.config.document
    for panel in job.config.panels:
        if for_one_process(panel):
            yield Splice(panel.block.start, panel.block.end, remark(document, panel))
            continue
        # Tree paths that start at a display that is in a group now are removed.
        expanded = value(value(panel.node, "Property Tree Widget"), "Expanded")
        if isinstance(expanded, yaml.SequenceNode) and is_block(expanded):
            gone = _moved_paths(job)
            found = list(zip(expanded.value, blocks(document, expanded), strict=True))
            left = [block for item, block in found if gone.match(str(item.value))]
            if found and len(left) == len(found):
                yield Splice(expanded.start_mark.index, end_of(expanded), "[]")
            else:
                yield from (Splice(block.start, block.end, "") for block in left)
        source = value(panel.node, "SyncSource")
        for one in _own_windows(job):
            if isinstance(source, yaml.ScalarNode) and one.name == source.value != "":
                yield replaced(source, titled(one, job.robots[0]))
                break


def _own_windows(job: RvizJob) -> list[RvizItem]:
    """Return the displays with a window that each robot has for itself."""
    own = (one for one in leaves(job.config.displays) if one.block.start in job.own)
    return [one for one in own if one.flag == DOCK]


def _moved_paths(job: RvizJob) -> re.Pattern[str]:
    """Return a pattern for paths to displays that are in groups now."""
    shown = job.config.displays
    kept = {one.name for one in shown if any(it.block.start not in job.own for it in leaves([one]))}
    names = sorted({one.name for one in shown} - kept)
    return re.compile(rf"/(?:{'|'.join(map(re.escape, names))})\d+(?:/|$)" if names else r"(?!)")


def windows(job: RvizJob) -> Iterator[Splice]:
    """Yield the places of windows, for the copies too; Qt's hex state is removed."""
    document = job.config.document
    docks = _own_windows(job)
    titles = {one.name: one for one in docks}
    if not docks and not any(map(for_one_process, job.config.panels)):
        return
    for (key, _), block in entry_blocks(document, value(document.root, "Window Geometry")):
        if key.value == "QMainWindow State":
            yield Splice(block.start, block.end, "")
        elif key.value in titles:
            names = [replaced(key, titled(titles[key.value], robot)) for robot in job.robots]
            copies = [cut_out(document, block.start, block.end, [name]) for name in names]
            yield Splice(block.start, block.end, "".join(copies))


def remark(document: YamlText, one: RvizItem) -> str:
    """Return the comment in place of an item that is left out."""
    title = f" {one.name!r}" if one.name else ""
    why = "it serves the robot of its rviz2 process"
    return f"{' ' * one.block.column}# left out: {one.cls}{title}: {why}{newline(document)}"


def item_splices(
    document: YamlText, one: RvizItem, robot: RvizRobot, colour: Colour | None
) -> list[Splice]:
    """Return the splices that make a display or tool show the robot."""
    made = [*splices_of(document.text, document.file, changed_values(one, robot))]
    if colour:
        # As RViz writes it, if the display has one colour for all its data.
        kinds = [COLOUR]
        if text_of(one.node, "Color Transformer") == "FlatColor":
            kinds.append(FLAT_COLOUR)
        slots = (it.slot for it in one.places if it.kind in kinds)
        made += [Splice(it.start, it.end, "; ".join(map(str, colour))) for it in slots]
    return made
