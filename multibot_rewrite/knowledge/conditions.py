# SPDX-License-Identifier: Apache-2.0
"""Conditions under which a node, an endpoint, a transform or a claim is there, as entries write them.

Alternatives are joined by ``or``, what must hold together by ``and``. A term asks a parameter:

    PARAMETER                  it is true; ``ONE|OTHER`` asks several, of which one has to do
    PARAMETER = VALUE          it has this value, or one of ``VALUE | VALUE``; ``$other`` is that of
                               another parameter; the class of a plugin may lack its namespace
    PARAMETER != VALUE         it has none of them; so has one that is not set
    PARAMETER has VALUE        it is a list, or a text of several words, that holds one of them
    PARAMETER set, unset       it has a value that is not empty, or none

or it is ``KIND: WORDS``, for what no parameter says (``KINDS``); ``unknown: TEXT`` is what nobody could
say in another way yet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache

from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.base.record import NamedTuple
from multibot_rewrite.base.releases import has_release

Values = Callable[[str], object]
RELEASE, VERSION, UNKNOWN = "release", "version", "unknown"
# Subject -> what its words are.
KINDS = {
    "argument": "an argument of the command line that starts it",
    "bridge": "an entry of its bridge's file: a direction or a topic",
    "display": "a display of the RViz config",
    "given": "a parameter that whoever starts it passes",
    "goal": "what a goal of an action is, or names",
    "hardware": "what the robot has",
    "heard": "an own topic that has a subscriber",
    "lua": "an option of its Lua file",
    "missing": "a parameter that is not passed",
    "nodl": "no: its NoDL file does not have it",
    "panel": "a panel of the RViz config",
    "phase": "what it is doing",
    "program": "the executable that runs it",
    RELEASE: "releases of ROS, for the type of an endpoint",
    "run": "simulated or real",
    "stream": "a stream of the device that is enabled",
    "tool": "a tool of the RViz config",
    "tree": "a node of the behavior tree",
    "unsent": "a topic that no other node sends",
    "use": "what the robot is used for",
    VERSION: "the package, and its version or a newer one",
    UNKNOWN: "a text",
}
AND, OR, ALSO = " and ", " or ", "|"
_KIND = lazy_compile(r"(?P<kind>[a-z]+): (?P<words>\S.*)")
_TERM = lazy_compile(
    r"(?P<parameter>[^\s=!]+)"
    r"(?:\s*(?P<how>!=|=|\bhas\b)\s*(?P<value>.+?)|\s+(?P<state>set|unset))?"
)


class Condition(NamedTuple):
    """One term: ``how`` is ``=``, ``!=``, ``has``, ``set`` or ``unset`` for a parameter, and ``:`` for
    what no parameter says, whose kind is the ``parameter``."""

    parameter: str
    how: str
    values: tuple[str, ...]


@lru_cache(maxsize=2048)
def parse_condition(text: str) -> tuple[tuple[Condition, ...], ...]:
    """The alternatives, each with the terms that must all hold; raises UsageError for a text that is
    none. Of an empty text there are none."""
    told, mark, rest = text.partition(f"{UNKNOWN}: ")
    if mark:  # the text behind it may have any words
        before = (*map(_one, told.removesuffix(AND).split(AND)),) if told else ()
        return ((*before, Condition(UNKNOWN, ":", (rest,))),)
    return tuple(tuple(map(_one, it.split(AND))) for it in text.split(OR)) if text else ()


def joined(text: str, other: str) -> str:
    """Both conditions as one."""
    if not text or text.startswith(f"{UNKNOWN}: "):
        return other if not text else f"{other}{AND}{text}"
    return OR.join(f"{it}{AND}{other}" for it in text.split(OR))


def said(text: str) -> str:
    """The condition as people read it: a version as one or newer, a text as it is."""
    return OR.join(AND.join(map(_said, it.split(AND))) for it in text.split(OR))


def of_release(text: str, release: str) -> str | None:
    """The condition without what it says of releases; None where it never holds in this one."""
    return of_kind(text, RELEASE, lambda words: has_release(words, release))


def of_kind(text: str, kind: str, is_so: Callable[[str], bool]) -> str | None:
    """The condition without what it says of one kind; None where it never holds. Where one alternative
    holds, nothing is left to ask."""
    asked = f"{kind}: "
    left = [
        AND.join(it for it in terms if not it.startswith(asked))
        for terms in (it.split(AND) for it in text.split(OR))
        if all(is_so(it.removeprefix(asked)) for it in terms if it.startswith(asked))
    ]
    return None if not left else "" if "" in left else OR.join(left)


def _said(term: str) -> str:
    if term.startswith(f"{VERSION}: "):
        return f"{term.removeprefix(f'{VERSION}: ')} or newer"
    return term.removeprefix(f"{UNKNOWN}: ")


def _one(text: str) -> Condition:
    kind = _KIND.fullmatch(text.strip())
    if kind is not None:
        if kind["kind"] not in KINDS:
            near = did_you_mean_one_of(kind["kind"], KINDS)
            known = f"{near}{near and ' '}known: {', '.join(KINDS)}"
            raise UsageError(f"{text!r} is of no kind that is known; {known}")
        return Condition(kind["kind"], ":", _words(kind["words"]))
    found = _TERM.fullmatch(text.strip())
    if found is None:
        hint = "write PARAMETER = VALUE, or unknown: and a text"
        raise UsageError(f"{text!r} is no condition; {hint}")
    if found["state"]:
        return Condition(found["parameter"], found["state"], ())
    return Condition(found["parameter"], found["how"] or "=", _words(found["value"] or "true"))


def _words(text: str) -> tuple[str, ...]:
    return tuple(it.strip() for it in text.split(ALSO))


def holds(text: str, value_of: Values) -> bool:
    """Is it surely true of these parameters? ``value_of`` gives None for one that is not set."""
    return not text or verdict(text, value_of) is True


def chosen_type(types: Iterable[tuple[str, str]], value_of: Values) -> str:
    """The type that the parameters choose among those of an endpoint; empty where they choose none."""
    return next((type_ for it, type_ in types if holds(it, value_of)), "")


def verdict(text: str, value_of: Values) -> bool | None:
    """Is it true of these parameters? None where they do not say it."""
    found = [_all(terms, value_of) for terms in parse_condition(text)]
    return True if True in found else None if None in found else False


def _all(terms: tuple[Condition, ...], value_of: Values) -> bool | None:
    found = [_is_true(it, value_of) for it in terms]
    return False if False in found else None if None in found else True


def _is_true(it: Condition, value_of: Values) -> bool | None:
    # A word in <> that nothing was put in place of is no parameter.
    if "<" in it.parameter:
        return None
    if it.how == ":":
        return _is_told(it, value_of)
    given = [value_of(name) for name in it.parameter.split(ALSO)]
    if it.how in ("set", "unset"):
        return any(one not in (None, "", []) for one in given) == (it.how == "set")
    wanted = {word for value in it.values for word in _wanted(value, value_of)}
    if it.how == "has":
        # MoveIt splits a text (moveit2 move_group.cpp configureCapabilities).
        texts = (one.split() if isinstance(one, str) else one for one in given)
        lists = (one for one in texts if isinstance(one, list))
        return any(wanted & _spellings(one) for its in lists for one in its)
    return any(wanted & _spellings(one) for one in given) == (it.how == "=")


def _is_told(it: Condition, value_of: Values) -> bool | None:
    """What a parameter says of a condition that is no parameter's: what a file does not pass, whoever
    starts the node may."""
    if it.parameter == "run":
        simulated = value_of("use_sim_time")
        return simulated == (it.values == ("simulated",)) if isinstance(simulated, bool) else None
    passed = any(value_of(name) not in (None, "", False) for name in it.values)
    return {"given": True, "missing": False}.get(it.parameter) if passed else None


def _wanted(value: str, value_of: Values) -> Iterator[str]:
    if not value.startswith("$"):
        yield value
        return
    other = value_of(value[1:])
    if other is not None:
        yield _word(other)


def _spellings(given: object) -> set[str]:
    """The words a value may be written with; none for a parameter that is not set."""
    if given is None:
        return set()
    word = _word(given)
    return {word, word.rpartition("::")[2], word.rpartition("/")[2]}


def _word(value: object) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)
