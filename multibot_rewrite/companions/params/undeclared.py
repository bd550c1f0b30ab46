"""Names of companion files against those of the description: what it lacks, what stays unclaimed."""

from __future__ import annotations

from multibot_rewrite.checks.mentions import mentioned
from multibot_rewrite.companions.context import Context
from multibot_rewrite.companions.params.known import built_in_params
from multibot_rewrite.companions.params.spelled import is_plain, is_shared_frame
from multibot_rewrite.companions.respell import is_declared, respell
from multibot_rewrite.nearest import did_you_mean
from multibot_rewrite.rosnames import check_topic_name

# What a word of the description may be, where a mention of it matters.
_MENTIONED = ("link", "joint", "frame", "group")


def lacks(context: Context, word: str, value: str) -> bool:
    """Is this plain name one that the description should have and does not?

    False where it has none of the kind at all: then nothing is known of them.
    """
    declared = context.names.declared.get("link" if word == "frame" else word)
    bare = value[1:] if word == "frame" and value.startswith("/") else value
    if not declared or not is_plain(value) or is_declared(context.names, word, bare):
        return False
    return word != "frame" or not (bare in built_in_params().sent or is_shared_frame(context, bare))


def said_of(context: Context, word: str, value: str) -> tuple[str, str]:
    """Message and hint about a name that the description lacks."""
    known = context.names.declared["link" if word == "frame" else word]
    other = "it stays as it is"
    if word == "frame":
        other = "a node or driver must send it under the robot's name"
    return f"{word} {value!r} is not in the description", did_you_mean(value, known) or other


def renamed(context: Context) -> frozenset[str]:
    """The names that the description declares and that each robot spells in its own way."""
    return frozenset(
        name
        for word in _MENTIONED
        for name in context.names.declared.get(word, ())
        if respell(context.names, word, name) != name
    )


def mentions(text: str, names: frozenset[str]) -> bool:
    """Does a text that nothing is known of hold one of these names, or an absolute name of the
    graph?"""
    if mentioned(text, names):
        return True
    return text[:1] == "/" and is_plain(text) and check_topic_name(text) is None
