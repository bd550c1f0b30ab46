# SPDX-License-Identifier: Apache-2.0
"""What a name becomes for a robot: kinds, layouts, separators, shared names.

A renamed value is always the old value with one insertion, so a name's spelling is an ``Affix``:
where to insert, and what is put before and after the robot's name.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypedDict

from multibot_rewrite.base.conventions import NAME_SEPARATORS, SHARED_TOPICS, WORLD_FRAMES
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of

PREFIX, POSTFIX, NAMESPACE = "prefix", "postfix", "namespace"
TF_TOPICS = ("tf", "tf_static")
# Order and grouping as shown in reports; the value is the default separator.
SEPARATORS = NAME_SEPARATORS
# What a ROS 2 name can hold: a node name is one token, a topic a path of tokens; no remap rule can
# hold two underscores in a row (rcl lexer.c).
ROS_SEPARATORS = {
    "node": ("_",),
    **dict.fromkeys(("stem", "topic", "subtopic", "service"), ("/", "_")),
    "namespace": ("/",),
}
FRAME_KINDS = frozenset({"link", "frame"})
# A stem is a word topics are made of (camera_name); a subtopic is below a stem or namespace.
TOPIC_KINDS = frozenset({"topic", "subtopic", "service"})
# What a ROS namespace reaches, or is.
ROS_KINDS = frozenset({*TOPIC_KINDS, "stem", "namespace"})
MODEL = "model"
# A use of one of these must be declared in the same file.
CLOSED_KINDS = frozenset({"link", "joint", "model", "group"})
# Declarations of these are looked up by name.
DECLARED_KINDS = (*sorted(CLOSED_KINDS), "frame", "sensor", "light", "shape")
# Stands for a robot in a text that is made to see what is the same for all. Letters alone are taken by
# every file that takes a name.
TWIN = "qzrobotzq"
# Characters that are not part of a plain topic: a substitution or a placeholder is left alone.
NOT_PLAIN = frozenset("{}$ ")


class Layout(NamedTuple):
    """What differs per robot: the frames, the tf topic, the namespace.

    Where frames are named ``at_run_time`` a description keeps its links and joints: nodes put the
    robot's name in front of frames, as robot_state_publisher does with its ``frame_prefix``.
    ``models``: it renames those of a description as an exception, since its values name its own.
    """

    name: str
    short: str
    frames: bool
    tf_per_robot: bool
    namespaced: bool
    about: str
    at_run_time: bool = False
    models: bool = False

    @property
    def renames_models(self) -> bool:
        """Return whether the model has another name for each robot, given by it and not its spawner."""
        return self.models or (self.frames and not self.at_run_time)


LAYOUTS = (
    Layout("tf-per-robot", "L1", False, True, True, "tf topic per robot, shared frame names"),
    Layout("frames-per-robot", "L2", True, False, True, "one /tf, frames per robot"),
    Layout("both", "L3", True, True, True, "tf topic and frames per robot"),
    Layout("postfix", "L4", True, True, False, "everything renamed per robot, no namespaces"),
    Layout(
        *("frame-prefix", "L5", True, False, True),
        "one /tf, frames per robot by frame_prefix, the description keeps its links",
        at_run_time=True,
    ),
)
DEFAULT_LAYOUT = "postfix"
# What becomes of systems of the whole world that a description loads.
WORLD_SYSTEMS = ("keep", LEAVE := "leave")


class Affix(NamedTuple):
    """Insert ``before + robot + after`` at character ``at`` of the old value."""

    at: int
    before: str
    after: str

    def spell(self, text: str, robot: str) -> str:
        """Return ``text`` with the name of ``robot`` in it."""
        return f"{text[: self.at]}{self.before}{robot}{self.after}{text[self.at :]}"


# Kind and text of a name -> where the robot's name goes; None: it is there already.
OwnNames = Mapping[tuple[str, str], Affix | None]
NO_OWN_NAMES: OwnNames = {}


class Naming(NamedTuple):
    """The whole naming policy of one job; ``separators`` holds only the kinds that are renamed.

    ``own`` are names that the description spells for the robot itself, by an argument of its xacro.
    """

    layout: Layout
    affix: str
    topics: str
    separators: Mapping[str, str]
    shared_frames: frozenset[str]
    shared_topics: frozenset[str]
    own: OwnNames = NO_OWN_NAMES

    @property
    def read_as(self) -> Layout:
        """The layout that a description is read for: with namespaces where topics are below them."""
        return self.layout._replace(namespaced=self.topics == NAMESPACE)


def leaves_world_systems(world_systems: str | None, robots: Sequence[str]) -> bool:
    """Return whether systems are left to the world, by default for several robots; or UsageError."""
    if world_systems is None:
        return len(robots) > 1
    _refuse_unknown("world_systems", world_systems, WORLD_SYSTEMS)
    return world_systems == LEAVE


def make_naming(
    layout: str = DEFAULT_LAYOUT,
    affix: str | None = None,
    topics: str | None = None,
    separators: Mapping[str, str] | None = None,
    shared_frames: Iterable[str] = WORLD_FRAMES,
    shared_topics: Iterable[str] = SHARED_TOPICS,
    groups: str = "keep",
) -> Naming:
    """Build the policy from plain words; raises UsageError for a word that is not known.

    ``layout`` is a name or short name of ``LAYOUTS``; ``affix`` is ``prefix`` or ``postfix``
    (default: postfix, where the layout has no other); ``topics`` is ``postfix``, ``prefix`` or
    ``namespace`` (default: what the layout implies).
    ``groups`` is ``keep`` or ``rename``: MoveIt's YAML names an SRDF's groups, and each robot's
    move_group has its own.
    """
    chosen = find_layout(layout)
    usual = PREFIX if chosen.at_run_time else POSTFIX
    side = usual if affix is None else affix
    _refuse_unknown("affix", side, (POSTFIX, PREFIX))
    strategy = topics or (NAMESPACE if chosen.namespaced else side)
    _refuse_unknown("topics", strategy, (POSTFIX, PREFIX, NAMESPACE))
    _refuse_unknown("groups", groups, ("keep", "rename"))
    active = _active_separators(chosen, strategy, _separators(separators or {}))
    if groups == "keep":
        active.pop("group", None)
    if chosen.at_run_time and (side != PREFIX or active["frame"] != "/"):
        # What nodes do is one way: RViz puts a slash behind its TF Prefix (tf_link_updater.cpp).
        what = "affix: prefix" if side != PREFIX else "frame=/"
        raise UsageError(f"in layout {chosen.name} nodes put robot1/ before frames: use {what}")
    return Naming(
        chosen,
        side,
        strategy,
        active,
        frozenset(name.strip("/") for name in shared_frames),
        frozenset(name.strip("/") for name in shared_topics)
        | (frozenset() if chosen.tf_per_robot else frozenset(TF_TOPICS)),
    )


def find_layout(word: str) -> Layout:
    """Return the layout called ``word``; raises UsageError with the names of all layouts."""
    known = {name: it for it in LAYOUTS for name in (it.name, it.short)}
    if word not in known:
        _refuse_unknown("layout", word, tuple(it.name for it in LAYOUTS))
    return known[word]


def _refuse_unknown(what: str, word: str, allowed: tuple[str, ...]) -> None:
    """Raise UsageError unless the word is allowed."""
    if word not in allowed:
        near = did_you_mean_one_of(word, allowed)
        hint = f"{', '.join(allowed)}{near and f'; {near}'}"
        raise UsageError(f"{what} {word!r} is not known, use one of {hint}")


def _separators(given: Mapping[str, str]) -> dict[str, str]:
    """Return the separator of each kind, the given ones in place of the usual; raises UsageError."""
    for kind, separator in given.items():
        _refuse_unknown("separator kind", kind, tuple(SEPARATORS))
        allowed = ROS_SEPARATORS.get(kind, ("/", "_", "__", "-", "."))
        if separator not in allowed:
            raise UsageError(f"separator {kind}={separator!r}: use one of {' '.join(allowed)}")
    # A frame names a link more often than not: they only differ where both were asked for.
    frame = {"frame": given["link"]} if "link" in given else {}
    return {**SEPARATORS, **frame, **given}


def _active_separators(layout: Layout, topics: str, separators: dict[str, str]) -> dict[str, str]:
    """Return the separator of each kind that this layout and topic strategy rename."""
    # A light is no frame and in no other file, so it has no reason to be the same in any layout.
    kinds = {"light", "stem", *TOPIC_KINDS, "namespace" if topics == NAMESPACE else "node"}
    if layout.at_run_time:
        kinds.add("frame")
    elif layout.frames:
        kinds |= set(SEPARATORS) - TOPIC_KINDS - {"stem", "namespace", "node"}
    return {kind: separators[kind] for kind in SEPARATORS if kind in kinds}


def affix(naming: Naming, kind: str, text: str, namespaced: bool = False) -> Affix | None:
    """Return where the robot's name goes in a name of ``kind``; None where it is not renamed.

    ``namespaced`` is true where a ROS namespace reaches the value."""
    if naming.own and (kind, text) in naming.own:
        return naming.own[kind, text]
    separator = naming.separators.get(kind)
    if separator is None:
        return None
    if kind in ROS_KINDS:
        in_namespace = namespaced and naming.topics == NAMESPACE
        return _ros_affix(naming, separator, kind, text, in_namespace)
    if _is_shared_frame(naming, kind, text):
        return None
    return _affix_of_name(naming.affix, separator, text)


def _ros_affix(
    naming: Naming, separator: str, kind: str, text: str, in_namespace: bool
) -> Affix | None:
    if kind == "namespace":
        return _namespace_affix(separator, text)
    if kind == "stem" and in_namespace:
        return _namespace_affix("/", text) if text.startswith("/") else None
    if kind == "stem":
        if not NOT_PLAIN.isdisjoint(text):
            return None
        # The root as a namespace: /robot1.
        return _affix_of_name(naming.affix, separator if text.strip("/") else "", text)
    return _topic_affix(naming, separator, text, kind == "subtopic" or in_namespace)


def _is_shared_frame(naming: Naming, kind: str, text: str) -> bool:
    return kind in FRAME_KINDS and text.strip("/") in naming.shared_frames


def spelled(naming: Naming, robot: str, kind: str, text: str, namespaced: bool = False) -> str:
    """Return ``text``, a name of ``kind``, as it is for ``robot``; unchanged if it is not renamed."""
    there = affix(naming, kind, text, namespaced)
    return there.spell(text, robot) if there else text


def is_of_world(topic: str) -> bool:
    """Return whether a topic or service (``/world/w/set_pose``) is a world's, not a model's.

    Source: gazebosim/gz-sim src/SimulationRunner.cc, systems/user_commands/UserCommands.cc,
    systems/scene_broadcaster/SceneBroadcaster.cc."""
    parts = topic.split("/")
    return parts[:2] == ["", "world"] and len(parts) > 3 and parts[3] != "model"


def is_keyword(text: str) -> bool:
    """Return whether SDF reserves a name, as ``__model__`` (sdformat Utils.cc isReservedName)."""
    return len(text) >= 4 and text.startswith("__") and text.endswith("__")


def _affix_of_name(side: str, separator: str, text: str) -> Affix:
    if side == POSTFIX:
        return Affix(len(text), separator, "")
    return Affix(1 if text.startswith("/") else 0, "", separator)


def _topic_affix(naming: Naming, separator: str, text: str, below: bool) -> Affix | None:
    """Return the affix of a topic; ``below``: a relative name in something that is the robot's."""
    bare = text.strip("/")
    if (
        not bare
        or bare in naming.shared_topics
        or text.startswith(("~", "__"))
        or is_of_world(text)
    ):
        return None
    if text.endswith("/") or not NOT_PLAIN.isdisjoint(text):
        return None
    if below and not text.startswith("/"):
        return None
    side = POSTFIX if naming.topics == POSTFIX else PREFIX
    return _affix_of_name(side, separator, text)


def _namespace_affix(separator: str, text: str) -> Affix | None:
    if not NOT_PLAIN.isdisjoint(text):
        return None
    at = 1 if text.startswith("/") else 0
    return Affix(at, "", separator if text[at:] else "")


def removal(
    naming: Naming, robot: str, kind: str, text: str, namespaced: bool = False
) -> tuple[int, int] | None:
    """Return start and end of the part of ``text`` that was added for ``robot``; None without one."""
    if robot not in text:
        return None
    if naming.own:
        if (kind, text) in naming.own:
            return None
        for (of, stem), own in naming.own.items():
            if of == kind and own is not None and own.spell(stem, robot) == text:
                return own.at, own.at + len(text) - len(stem)
    separator = naming.separators.get(kind)
    if separator is None or _is_shared_frame(naming, kind, text):
        return None
    side = naming.topics if kind in TOPIC_KINDS else naming.affix
    for start, end in _affix_places(side, separator, robot, text):
        stem = text[:start] + text[end:]
        there = affix(naming, kind, stem, namespaced)
        if there is not None and there.spell(stem, robot) == text:
            return start, end
    return None


def _affix_places(side: str, separator: str, robot: str, text: str) -> Iterator[tuple[int, int]]:
    """Yield where in ``text`` an affix may be, the likely place first."""
    end = separator + robot
    if side == POSTFIX and text.endswith(end):
        yield len(text) - len(end), len(text)
    lead = 1 if text.startswith("/") else 0
    for inserted in (robot + separator, f"{robot}/", robot):
        if text.startswith(inserted, lead):
            yield lead, lead + len(inserted)


def overlap(naming: Naming, robots: Iterable[str]) -> list[tuple[str, str, str]]:
    """Return pairs of robots of which two names can become one: robot, robot, separator.

    The name of one ends (begins) like the affix of the other: with a postfix, ``arm`` of ``left_b``
    and ``arm_left`` of ``b`` are both ``arm_left_b``."""
    names = set(robots)
    pairs = set()
    sides = {naming.affix, POSTFIX if naming.topics == POSTFIX else PREFIX}
    for separator in set(naming.separators.values()):
        for robot in names:
            for at in range(len(robot)):
                if not robot.startswith(separator, at):
                    continue
                tail, front = robot[at + len(separator) :], robot[:at]
                met = {POSTFIX: tail, PREFIX: front}
                pairs |= {(robot, met[side], separator) for side in sides if met[side] in names}
    return sorted(pairs)


class Policy(TypedDict, total=False):
    """The options of ``make_naming`` as one value, for what is passed on to it."""

    layout: str
    affix: str
    topics: str | None
    separators: Mapping[str, str] | None
    shared_frames: Iterable[str]
    shared_topics: Iterable[str]
    groups: str
