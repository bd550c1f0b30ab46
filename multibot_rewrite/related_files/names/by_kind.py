# SPDX-License-Identifier: Apache-2.0
"""What each name becomes for a robot: one function for each kind of name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from multibot_rewrite.base.conventions import PLACEHOLDER
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.naming import FRAME_KINDS, NAMESPACE, NOT_PLAIN, PREFIX, spelled
from multibot_rewrite.knowledge.node_sets import is_apart
from multibot_rewrite.related_files.context import NAMESPACE_SLOT, TAG_SLOT, Context, number_slot
from multibot_rewrite.related_files.names.rename_map import is_declared, spell

Speller = Callable[[Context, str], str]
_WORD = lazy_compile(r"[\w./-]+")
# What the code of a node puts between a joint_stem and a name.
STEM_END = "_"
# Names that nodes put a prefix of the robot before, and the kind of these by that of the prefix.
_PREFIXES = {f"{kind}_prefix": kind for kind in ("link", "joint", "gpio")}
PREFIXED = {"stem": "frame", "joint_stem": "joint", **_PREFIXES}


def is_plain(value: str) -> bool:
    """Return whether a value is a name, without substitutions or placeholders for a launch file."""
    return bool(value) and "<" not in value and NOT_PLAIN.isdisjoint(value)


def is_filled(value: str) -> bool:
    """Return whether a value is a text without placeholders, though perhaps no name."""
    return bool(value) and not PLACEHOLDER.search(value)


def joint(context: Context, value: str) -> str:
    """Return the robot's name of a joint, or of a joint below a controller: ``controller/joint``."""
    if is_declared(context.names, "joint", value):
        return spell(context.names, "joint", value)
    above, slash, name = value.rpartition("/")
    if not slash or not is_declared(context.names, "joint", name):
        return value
    return f"{_path_before_name(context, above)}/{spell(context.names, 'joint', name)}"


def interface(context: Context, value: str) -> str:
    """Return ``elbow/position``, or a chained ``controller/elbow/position``, with the robot's names."""
    owner, slash, last = value.rpartition("/")
    if not slash:
        return value
    first, inside, rest = owner.partition("/")
    if inside and not is_component(context, rest.rpartition("/")[2]):
        # drive/linear/velocity: no part of the robot, so only drive is a controller.
        return f"{_path_before_name(context, first)}/{rest}/{last}"
    if inside or is_component(context, owner):
        return f"{_path_before_name(context, owner)}/{last}"
    # Descriptions do not declare all their gpios.
    return f"{spell(context.names, 'gpio', owner)}/{last}"


def is_component(context: Context, value: str) -> bool:
    """Return whether the description declares a joint, sensor or gpio of this name."""
    return is_declared(context.names, "component", value)


def _path_before_name(context: Context, value: str) -> str:
    """Return a path of joints and controllers (``drive/left_wheel``), each with its robot's name."""
    parts = (
        component(context, it) if is_component(context, it) else controller(context, it)
        for it in value.split("/")
    )
    return "/".join(parts)


def component(context: Context, value: str) -> str:
    """Return the robot's name of a joint, sensor or gpio that the description declares."""
    return spell(context.names, "component", value) if is_component(context, value) else value


def controller(context: Context, value: str) -> str:
    """Return the robot's name of a controller, which differs only without namespaces."""
    naming = context.topics.naming
    return spelled(naming, NAMESPACE_SLOT, "node", value) if is_plain(value) else value


def node(context: Context, value: str) -> str:
    """Return a node's name as the robot's nodes use it; a node for all robots keeps its name."""
    bare = value.strip("/")
    place = context.nodes.get(bare, "")
    if place and NAMESPACE_SLOT not in place:
        return place if context.topics.naming.topics == NAMESPACE else value
    below = place.startswith(f"/{NAMESPACE_SLOT}/") if place else is_apart(bare, context.distro)
    # A relative name is also the id of Nav2's bonds, so it stays; the remap rules lead to the node.
    if below and context.topics.naming.topics != NAMESPACE:
        return f"/{NAMESPACE_SLOT}{value}" if value.startswith("/") else value
    above, slash, name = value.rpartition("/")
    if slash and not above and context.topics.naming.topics == NAMESPACE and is_plain(value):
        return f"/{NAMESPACE_SLOT}{value}"
    return above + slash + controller(context, name)


def namespace(context: Context, value: str) -> str:
    """Return the robot's version of an absolute namespace; a relative one is below the robot's."""
    naming = context.topics.naming
    if not value.startswith("/") or naming.topics != NAMESPACE:
        return value
    return spelled(naming, NAMESPACE_SLOT, "namespace", value)


def stem(context: Context, value: str) -> str:
    """Return the robot's version of a beginning of frame names: only a prefix can be added."""
    return spell(context.names, "frame", value) if _has_prefix(context) else value


def joint_stem(context: Context, value: str) -> str:
    """Return the prefix that the node puts before joints, with _ after it, unless it is empty."""
    whole = _prefix_for_kind("joint", context, f"{value}{STEM_END}" if value else "")
    return whole.removesuffix(STEM_END) if whole.endswith(STEM_END) else value


def before_frames(between: str) -> Speller:
    """Return a function for the prefix that a node puts before frames at run time."""

    def speller(context: Context, value: str) -> str:
        """Return the prefix with the robot's name, in a layout that uses it; otherwise the value."""
        at_run_time = context.names.naming.layout.at_run_time
        return f"{TAG_SLOT}{between}" if at_run_time else value

    return speller


def words(context: Context, value: str) -> str:
    """Return a text with names of the description renamed: ``joints(shoulder,elbow)``."""
    return _WORD.sub(lambda found: _renamed_word(context, found[0]), value)


def _renamed_word(context: Context, value: str) -> str:
    kinds = (kind for kind in ("joint", "link") if is_declared(context.names, kind, value))
    kind = next(kinds, "")
    return spell(context.names, kind, value) if kind else value


def _has_prefix(context: Context) -> bool:
    return context.names.naming.affix == PREFIX


def _prefix_for_kind(kind: str, context: Context, value: str) -> str:
    """Return the robot's version of a prefix that the node puts before names of this kind."""
    separator = context.names.naming.separators.get(kind)
    own = _argument_prefix(context, kind)
    if own:
        return own if value in ("", own) else f"{own}{value}"
    if separator is None or not _has_prefix(context) or (value and not is_plain(value)):
        return value
    return f"{TAG_SLOT}{separator}{value}"


def _argument_prefix(context: Context, kind: str) -> str:
    """Return the prefix that a xacro argument puts before names of this kind; empty for none."""
    texts = (
        text.removesuffix(plain)
        for (of, plain), text in context.names.own.items()
        if of == kind and plain and text.endswith(plain)
    )
    return next((it for it in texts if it), "")


def port(_: Context, value: str) -> str:
    """Return the slot for a port that only one node on a computer can have; 0 stays."""
    return number_slot(int(value)) if value.isdecimal() and int(value) else value


def output(_: Context, value: str) -> str:
    """Return a file or folder that a node writes: ``/tmp/pose.txt`` is ``/tmp/pose_robot1.txt``."""
    head, slash, name = value.rstrip("/").rpartition("/")
    stem, dot, ending = name.rpartition(".")
    if not name.strip(".~") or not is_filled(value):
        return value
    named = f"{stem}_{TAG_SLOT}{dot}{ending}" if stem else f"{name}_{TAG_SLOT}"
    return f"{head}{slash}{named}"


def _speller(kind: str) -> Speller:
    """Return the function that renames names of a kind."""
    return lambda context, value: spell(context.names, kind, value)


# Topics and services depend on their node as well, see ``node_topics``.
SPELLERS: Mapping[str, Speller] = {
    "joint": joint,
    "interface": interface,
    "controller": controller,
    "node": node,
    "namespace": namespace,
    "stem": stem,
    **{word: partial(_prefix_for_kind, kind) for word, kind in _PREFIXES.items()},
    "joint_stem": joint_stem,
    "doubles": before_frames(""),
    "doubles_as_is": before_frames("/"),
    "component": component,
    "words": words,
    "port": port,
    "output": output,
    **{word: _speller(word) for word in ("frame", "link", "sensor", "gpio", "hardware", "group")},
}


def expressible(context: Context, kind: str) -> bool:
    """Return whether a prefix parameter of this kind can express the fleet's naming."""
    of = PREFIXED.get(kind)
    if of is None or of not in context.names.naming.separators or _argument_prefix(context, of):
        return True
    ends = kind != "joint_stem" or context.names.naming.separators[of] == STEM_END
    return ends and _has_prefix(context)


def is_shared_frame(context: Context, value: str) -> bool:
    """Return whether a value is one frame for all robots, such as map."""
    return value.strip("/") in context.names.naming.shared_frames


def frames_differ(context: Context) -> bool:
    """Return whether the robots have different frame names."""
    return not FRAME_KINDS.isdisjoint(context.names.naming.separators)


def is_emptied(context: Context, kind: str, text: str) -> bool:
    """Return whether a rewrite takes out a prefix, put before frames with the robot's name."""
    bare = frames_differ(context) and not context.names.naming.layout.at_run_time
    return bare and kind == "doubles_as_is" and is_plain(text)
