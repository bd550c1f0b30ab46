# SPDX-License-Identifier: Apache-2.0
"""An RViz config for one robot -> one for all robots, or one for each robot with its own tf topic."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import yaml

from multibot_rewrite.base.bounded import compose_yaml
from multibot_rewrite.base.conventions import WORLD_FRAMES
from multibot_rewrite.base.findings.finding import Finding
from multibot_rewrite.base.model import InputError, ProofError, UsageError
from multibot_rewrite.base.naming import TF_TOPICS, Naming
from multibot_rewrite.planning.of_runs import target_of
from multibot_rewrite.related_files.context import Context
from multibot_rewrite.related_files.named_file import RVIZ, NamedFile
from multibot_rewrite.related_files.names.placeholders import without_robot
from multibot_rewrite.related_files.rviz.display_groups import (
    has_own_windows,
    item_splices,
    leaves,
    make_rviz_job,
    panels,
    remark,
    robot_groups,
    tool_edits,
    tools,
    windows,
)
from multibot_rewrite.related_files.rviz.read_config import (
    ABSOLUTE,
    FRAME,
    PROCESS,
    Colour,
    RvizConfig,
    RvizRobot,
    fixed_frame,
    frame_of,
    is_name,
    palette,
    read_colour,
    read_config,
    targets,
    value,
    views_of,
)
from multibot_rewrite.related_files.rviz.window_checks import config_findings
from multibot_rewrite.related_files.sites import site_at
from multibot_rewrite.related_files.yaml_text import (
    Splice,
    YamlText,
    as_item,
    blocks,
    cut_out,
    inserted,
    is_block,
    is_text,
    newline,
    pairs,
    replaced,
    spliced,
)
from multibot_rewrite.system.records import TOPIC

__all__ = ["RvizRobot", "RvizText", "rewrite_rviz", "start_command", "world_frame"]


# The number of results that are parsed again as a check.
PROVED = 4


class RvizText(NamedTuple):
    """A config; ``robot`` is empty if it shows all, ``relays`` (from, to) must be forwarded first.

    rviz2 must be started with ``namespace`` and ``remaps``."""

    robot: str
    text: str
    namespace: str = ""
    remaps: tuple[tuple[str, str], ...] = ()
    relays: tuple[tuple[str, str], ...] = ()


def rewrite_rviz(
    document: YamlText, robots: Sequence[RvizRobot], *, world: str = "", relayed: bool = False
) -> tuple[tuple[RvizText, ...], tuple[Finding, ...]]:
    """Return the configs of a fleet, and the findings about them.

    One window reads one tf topic: a layout with a tf topic for each robot gives a config for each,
    unless the frames differ and the topics are ``relayed`` to ``/tf``. Displays that work for one
    process are in a config for each robot, in addition to that for all. ``world`` is the frame that all
    robots are in (default: ``world_frame``). Raises InputError for a file that is not a config of RViz
    2 and for an unknown colour, UsageError if there is no robot.
    """
    if not robots:
        raise UsageError("there is no robot to show; name at least one")
    config = read_config(document)
    naming = robots[0].names.naming
    together = not naming.layout.tf_per_robot or (relayed and naming.layout.frames)
    colours = tuple(_robot_colour(robot, at, len(robots)) for at, robot in enumerate(robots))
    world = world or world_frame(naming)

    def windows_for(upto: int) -> tuple[RvizText, ...]:
        some = robots[:upto] if not together or has_own_windows(config, robots[0]) else ()
        each = map(lambda *it: _window_for_one(config, *it), some, colours)
        return (
            *([_window_for_all(config, robots[:upto], colours[:upto], world)] if together else ()),
            *each,
        )

    made = windows_for(len(robots))
    # All others differ from these in names only.
    for text in made if len(robots) <= PROVED else windows_for(PROVED):
        try:
            compose_yaml(text.text, document.file)
        except InputError as error:
            raise ProofError(f"the rewritten config is broken: {error}") from None
    return made, tuple(config_findings(config, robots, world, together))


def world_frame(naming: Naming) -> str:
    """Return the frame that all robots share: map, or another frame of the world, or any other."""
    shared = sorted(naming.shared_frames)
    return next((frame for frame in (*WORLD_FRAMES, *shared) if frame in shared), "")


def start_command(made: RvizText, file: str) -> list[str]:
    """Return the command that starts rviz2 with a config written to ``file``."""
    words = [f"__ns:={made.namespace}"] if made.namespace else []
    words += [f"{source}:={target}" for source, target in made.remaps]
    given = [text for word in words for text in ("-r", word)]
    return ["rviz2", "-d", file, *(["--ros-args", *given] if given else [])]


def _robot_colour(robot: RvizRobot, at: int, count: int) -> Colour | None:
    """Return the robot's colour; one of several robots without a colour gets one of the palette."""
    if robot.colour:
        return read_colour(robot.colour, robot.name)
    return palette(at) if count > 1 else None


def _tf_topics(robot: RvizRobot) -> tuple[tuple[str, str], ...]:
    """Return the remappings to the robot's tf topics, with absolute targets."""
    name, naming = robot.topics.robot, robot.topics.naming
    found = []
    for topic in TF_TOPICS:
        target = target_of(f"/{topic}", TOPIC, name, naming)
        full = target if target.startswith("/") or not target else f"/{name}/{target}"
        found += [(f"/{topic}", full)] if full not in ("", f"/{topic}") else []
    return tuple(found)


def _window_for_all(
    config: RvizConfig, robots: Sequence[RvizRobot], colours: tuple[Colour | None, ...], world: str
) -> RvizText:
    job = make_rviz_job(config, robots, colours)
    # The world frame, if some robot has its own version of the Fixed Frame.
    node = fixed_frame(config)
    fixed = []
    if isinstance(node, yaml.ScalarNode) and world:
        own = any(frame_of(node, robot) != node.value for robot in robots)
        fixed = [replaced(node, world)] if own else []
    splices = [
        *robot_groups(job),
        *tools(job),
        *panels(job),
        *windows(job),
        *fixed,
        *_view_splices(config, robots),
    ]
    relays = [(target, topic) for robot in robots for topic, target in _tf_topics(robot)]
    return RvizText("", spliced(config.document, splices), relays=tuple(relays))


def _window_for_one(config: RvizConfig, robot: RvizRobot, colour: Colour | None) -> RvizText:
    """Return the config of a window for one robot, which runs in its namespace if there is one."""
    document = config.document
    gone = (ABSOLUTE,) if robot.has_process else (ABSOLUTE, PROCESS)
    splices: list[Splice] = []
    for one in (*leaves(config.displays), *config.panels):
        if one.flag in gone:
            splices.append(Splice(one.block.start, one.block.end, remark(document, one)))
        else:
            splices += item_splices(document, one, robot, colour if robot.colour else None)
    for tool in config.tools:
        if tool.flag in gone:
            splices.append(Splice(tool.block.start, tool.block.end, remark(document, tool)))
        else:
            splices += tool_edits(document, tool, robot)
    for node in (fixed_frame(config), *targets(config)):
        splices += frame_splices(node, robot)
    namespace = f"/{robot.topics.robot}" if robot.names.naming.layout.namespaced else ""
    tf = _tf_topics(robot)
    more = tuple(it for it in robot.rules if it[0] not in dict(tf))
    return RvizText(robot.name, spliced(document, splices), namespace, (*tf, *more))


def frame_splices(node: yaml.Node | None, robot: RvizRobot) -> list[Splice]:
    """Return the change of a frame in a scalar, if it has another name for the robot."""
    new = frame_of(node, robot)
    return [replaced(node, new)] if isinstance(node, yaml.ScalarNode) and new != node.value else []


def _view_splices(config: RvizConfig, robots: Sequence[RvizRobot]) -> Iterator[Splice]:
    """Yield the splices of views: the current one for the first robot, a saved one for each."""
    document = config.document
    current, saved = views_of(config)
    copies = ""
    if current is not None and _follows_robot(current, robots):
        yield from frame_splices(value(current, "Target Frame"), robots[0])
        views, listed = value(config.manager, "Views"), isinstance(saved, yaml.SequenceNode)
        column = views.start_mark.column + 2 if views is not None else 2
        column = saved.start_mark.column if saved and listed else column
        lines = blocks(document, current)
        start, end = lines[0].start, lines[-1].end
        for robot in robots:
            text = _named_view(document, current, robot, start, end)
            copies += as_item(text, lines[0].column, column)
    if isinstance(saved, yaml.SequenceNode) and saved.value and is_block(saved):
        for view, (start, end, _) in zip(saved.value, blocks(document, saved), strict=True):
            if _follows_robot(view, robots):
                made = [_named_view(document, view, robot, start, end) for robot in robots]
                yield Splice(start, end, "".join(made))
        yield inserted(document, blocks(document, saved)[-1].end, copies)
    elif copies and isinstance(saved, yaml.ScalarNode):
        text = f"{newline(document)}{copies}".rstrip()
        yield Splice(saved.start_mark.index, saved.end_mark.index, text)


def _follows_robot(view: yaml.Node | None, robots: Sequence[RvizRobot]) -> bool:
    target = value(view, "Target Frame")
    if not isinstance(target, yaml.ScalarNode) or not is_block(view):
        return False
    return any(frame_of(target, robot) != target.value for robot in robots)


def _named_view(document: YamlText, view: yaml.Node, robot: RvizRobot, start: int, end: int) -> str:
    splices = frame_splices(value(view, "Target Frame"), robot)
    name = value(view, "Name")
    if isinstance(name, yaml.ScalarNode):
        splices.append(replaced(name, f"{robot.name} {name.value}"))
    return cut_out(document, start, end, splices)


# Titles of displays and windows: never names of links.
_TITLES = ("Name", "Class")


def read_rviz(document: YamlText, context: Context) -> NamedFile:
    """Return the names of a config; raises InputError for one that is not for RViz 2."""
    config = read_config(document)
    shown = (*leaves(config.displays), *config.tools)
    frames = (
        it for it in (fixed_frame(config), *targets(config)) if isinstance(it, yaml.ScalarNode)
    )
    names = (
        *(site_at(it, FRAME, without_robot(str(it.value), "")) for it in frames),
        *(it for one in shown for it in filter(is_name, one.places)),
    )
    claimed = {it.slot.start for one in shown for it in one.places}
    others = tuple(
        site_at(it, "", str(it.value))
        for one in shown
        for it in _scalars(one.node)
        if it.start_mark.index not in claimed and is_text(it)
    )
    return NamedFile(
        RVIZ,
        document.file,
        document.text,
        context,
        {},
        names,
        others,
        document=document,
        shown=tuple(leaves(config.displays)),
    )


def read_for(document: YamlText, robots: Sequence[RvizRobot], release: str) -> NamedFile:
    """Return the names of a config for these robots, with the names that any of them declares."""
    every = [it.names.declared for it in robots]
    declared = {
        kind: {name: it for own in every for name, it in own.get(kind, {}).items()}
        for kind in {kind for own in every for kind in own}
    }
    names = robots[0].names._replace(declared=declared)
    return read_rviz(document, Context(names, names, {}, release))


def _scalars(node: yaml.Node) -> Iterator[yaml.ScalarNode]:
    """Yield the values of a display and its maps, without titles."""
    for key, there in pairs(node):
        if key.value in (*_TITLES, "Displays"):
            continue
        if isinstance(there, yaml.ScalarNode):
            yield there
        yield from _scalars(there)
