# SPDX-License-Identifier: Apache-2.0
"""The conditions of nodes, endpoints, transforms and claims; ``README.md`` has the grammar."""

from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache
from typing import NamedTuple

from multibot_rewrite.base.bounded import own_rows
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import did_you_mean_one_of
from multibot_rewrite.base.releases import has_release
from multibot_rewrite.knowledge.packages import by_version

Values = Callable[[str], object]
RELEASE, VERSION, PROGRAM, HEARD, UNSENT = "release", "version", "program", "heard", "unsent"
OPEN_KIND, CHOSEN, NODL, SOURCE = "open", "chosen", "nodl", "source"
_ROWS = own_rows(__file__, "conditions.schema")
# Subject -> what its words are, and who decides.
KINDS = {kind: what for kind, what, _ in _ROWS if what}
# What is open -> as people read it. What is open may be there: no rule needs it, and it needs nobody.
# The launch file of a fleet starts such a node only where a parameter file declares it; CHOSEN is a
# word of nodes alone.
OPEN = {it.removeprefix("open: "): text for it, _, text in _ROWS if it.startswith("open: ")}
AND, OR, ALSO = " and ", " or ", "|"
# A kind, or what is asked of a parameter -> how people read it.
_SAID = {kind: text for kind, _, text in _ROWS if text}
_KIND = lazy_compile(r"(?P<kind>[a-z]+): (?P<words>\S.*)")
_TERM = lazy_compile(
    r"(?P<parameter>[^\s=!]+)"
    r"(?:\s*(?P<how>!=|=|\b(?:has|lacks|names)\b)\s*(?P<value>\S.*)|\s+(?P<state>set|unset))?"
)


class Condition(NamedTuple):
    """One term: ``how`` is =, !=, has, lacks, names, set or unset; ``:`` for what no parameter says."""

    parameter: str
    how: str
    values: tuple[str, ...]


@lru_cache(maxsize=2048)
def parse_condition(text: str) -> tuple[tuple[Condition, ...], ...]:
    """Return the alternatives (none for an empty text), each with all its terms; raises UsageError."""
    return tuple(tuple(map(_parse_term, it.split(AND))) for it in text.split(OR)) if text else ()


def joined(text: str, other: str) -> str:
    """Return the condition that holds where both hold."""
    return OR.join(f"{it}{AND}{other}" for it in text.split(OR)) if text else other


def readable(text: str) -> str:
    """Return the condition as people read it."""
    return OR.join(AND.join(map(_readable_term, it.split(AND))) for it in text.split(OR))


@lru_cache(maxsize=4096)  # so many facts, so few conditions
def condition_in_release(text: str, release: str) -> str | None:
    """Return the condition without its releases; None if it never holds in this one."""

    def decide(it: Condition) -> bool | None:
        """Return whether a term about releases holds in this one; None for another term."""
        return has_release(by_version(it.values[0]), release) if it.parameter == RELEASE else None

    return settled(text, decide)


def settled(text: str, decide: Callable[[Condition], bool | None]) -> str | None:
    """Return what ``decide`` leaves open: empty if the condition holds, None if it never holds."""
    left = []
    for terms in (it.split(AND) for it in text.split(OR)) if text else ():
        known = {it: decide(_parse_term(it)) for it in terms}
        if False not in known.values():
            left.append(AND.join(it for it, is_so in known.items() if is_so is None))
    return "" if "" in left or not text else OR.join(left) or None


def words_in(text: str, kind: str) -> Iterator[str]:
    """Yield the values of all terms of a kind."""
    for terms in parse_condition(text):
        yield from (
            word for it in terms if (it.how, it.parameter) == (":", kind) for word in it.values
        )


def _readable_term(term: str) -> str:
    """Return a term in words; a reason that is no term, such as a parameter file, as it is."""
    if _TERM.fullmatch(term) is None and term.partition(": ")[0] not in KINDS:
        return term
    it = _parse_term(term)
    values = " or ".join(it.values)
    if (it.how, it.parameter) == (":", OPEN_KIND):
        return OPEN[values]
    if it.how == ":":
        return _SAID[it.parameter].format(values)
    return f"{it.parameter.replace(ALSO, ' or ')} {_SAID.get(it.how, it.how)} {values}".rstrip()


def _parse_term(text: str) -> Condition:
    kind = _KIND.fullmatch(text.strip())
    if kind is not None:
        if kind["kind"] not in KINDS:
            near = did_you_mean_one_of(kind["kind"], KINDS)
            known = f"{near}{near and ' '}known: {', '.join(KINDS)}"
            raise UsageError(f"{text!r} is of no kind that is known; {known}")
        words = _split_values(kind["words"])
        if kind["kind"] == OPEN_KIND and (len(words) > 1 or words[0] not in OPEN):
            raise UsageError(f"open: {ALSO.join(words)!r} is none of {', '.join(OPEN)}")
        return Condition(kind["kind"], ":", words)
    found = _TERM.fullmatch(text.strip())
    if found is None:
        hint = "write PARAMETER = VALUE, or open: and a word"
        raise UsageError(f"{text!r} is no condition; {hint}")
    if found["state"]:
        return Condition(found["parameter"], found["state"], ())
    return Condition(
        found["parameter"], found["how"] or "=", _split_values(found["value"] or "true")
    )


def _split_values(text: str) -> tuple[str, ...]:
    return tuple(it.strip() for it in text.split(ALSO))


def holds(text: str, value_of: Values) -> bool:
    """Return whether a condition surely holds; ``value_of`` gives None for an unset parameter."""
    return not text or verdict(text, value_of) is True


def chosen_type(types: Iterable[tuple[str, str]], value_of: Values) -> str:
    """Return the endpoint type that the parameters choose; empty if they choose none."""
    return next((type_ for it, type_ in types if holds(it, value_of)), "")


def verdict(text: str, value_of: Values) -> bool | None:
    """Return whether a condition holds with these parameters; None if they leave it open."""
    found = []
    for terms in parse_condition(text):
        each = [_is_true(it, value_of) for it in terms]
        found.append(False if False in each else None if None in each else True)
    return True if True in found else None if None in found else False


def _is_true(it: Condition, value_of: Values) -> bool | None:
    """Return whether a term holds with these parameters; None if they leave it open."""
    # A word in <> that nothing was put in place of is no parameter; files and the command line are not
    # at hand here.
    if "<" in it.parameter or it.parameter.startswith("-") or it.how == "names":
        return None
    if it.how == ":":
        return _is_so(it, value_of)
    given = [value_of(name) for name in it.parameter.split(ALSO)]
    if it.how in ("set", "unset"):
        return any(one not in (None, "", []) for one in given) == (it.how == "set")
    others = (value_of(value[1:]) for value in it.values if value.startswith("$"))
    wanted = {value for value in it.values if not value.startswith("$")}
    wanted |= {word_of(other) for other in others if other is not None}
    if it.how in ("has", "lacks"):
        # MoveIt splits a text (moveit2 move_group.cpp configureCapabilities).
        texts = (one.split() if isinstance(one, str) else one for one in given)
        lists = (one for one in texts if isinstance(one, list))
        return any(wanted & _spellings(one) for its in lists for one in its) == (it.how == "has")
    return any(wanted & _spellings(one) for one in given) == (it.how == "=")


def _is_so(it: Condition, value_of: Values) -> bool | None:
    """Return whether a term holds that is no comparison of a parameter; None if that is open."""
    if it.parameter == "run":
        simulated = value_of("use_sim_time")
        return simulated == (it.values == ("simulated",)) if isinstance(simulated, bool) else None
    if it.parameter == "option":
        name, _, first = it.values[0].partition(" = ")
        asked = (first, *it.values[1:])
        return None if (value := value_of(name)) is None else word_of(value) in asked
    # What a file does not pass, whoever starts the node may.
    passed = any(value_of(name) not in (None, "", False) for name in it.values)
    return {"given": True, "missing": False}.get(it.parameter) if passed else None


def _spellings(given: object) -> set[str]:
    """Return the texts a value may be written with; none for a parameter that is not set."""
    if given is None:
        return set()
    word = word_of(given)
    return {word, word.rpartition("::")[2], word.rpartition("/")[2]}


def word_of(value: object) -> str:
    """Return a parameter's value as the text that a YAML file has for it."""
    return str(value).lower() if isinstance(value, bool) else str(value)
