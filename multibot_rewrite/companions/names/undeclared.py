"""Names of companion files that the description does not declare."""

from __future__ import annotations

from multibot_rewrite.checks.mentions import mentioned
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.names.by_kind import is_plain, is_shared_frame
from multibot_rewrite.companions.names.rename_map import is_declared, spell
from multibot_rewrite.knowledge.parameters import built_in_nodes
from multibot_rewrite.nearest import did_you_mean
from multibot_rewrite.rosnames import check_topic_name

# What a word of the description may be, where a mention of it matters.
_MENTIONED = ("link", "joint", "frame", "group")


def is_undeclared(context: Context, word: str, value: str) -> bool:
    """Is this a name that the description should declare and does not?

    False if it declares no name of the kind at all.
    """
    declared = context.names.declared.get("link" if word == "frame" else word)
    bare = value[1:] if word == "frame" and value.startswith("/") else value
    if not declared or not is_plain(value) or is_declared(context.names, word, bare):
        return False
    return word != "frame" or not (
        bare in built_in_nodes(context.distro).sent or is_shared_frame(context, bare)
    )


def undeclared_message(context: Context, word: str, value: str) -> tuple[str, str]:
    """Message and hint about a name that the description lacks."""
    known = context.names.declared["link" if word == "frame" else word]
    other = "it stays unchanged; correct it"
    if word == "frame":
        other = "some node must publish it with the robot's name"
    return f"{word} {value!r} is not in the description", did_you_mean(value, known) or other


def renamed_names(context: Context) -> frozenset[str]:
    """The names of the description that differ from robot to robot."""
    return frozenset(
        name
        for word in _MENTIONED
        for name in context.names.declared.get(word, ())
        if spell(context.names, word, name) != name
    )


def holds_a_name(text: str, names: frozenset[str]) -> bool:
    """Does a text of unknown use hold one of these names, or an absolute ROS name?"""
    if mentioned(text, names):
        return True
    return text[:1] == "/" and is_plain(text) and check_topic_name(text) is None
