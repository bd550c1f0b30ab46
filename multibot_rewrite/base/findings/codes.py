# SPDX-License-Identifier: Apache-2.0
"""Codes and names of rules as a person gives them: whole, as they begin, or nearly right."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from multibot_rewrite.base.findings.finding import Rule
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.nearest import nearest
from multibot_rewrite.base.wording import SEVERAL, shorten

# What explains a code, and lists all without one.
ASKED = "multibot inspect"


def known_beginnings(rules: Mapping[str, Rule]) -> set[str]:
    """Return all that ``--select`` takes: codes, and at least two letters that codes begin with."""
    return {code[:size] for code in rules for size in range(2, len(code) + 1)}


def find_rules(word: str, rules: Mapping[str, Rule]) -> list[Rule]:
    """Return the rules with that code or name, or with codes that begin with the word."""
    by_name = [it for it in rules.values() if it.name == word]
    return by_name or [it for it in rules.values() if it.code.startswith(word.upper())]


def no_rule(word: str, rules: Mapping[str, Rule]) -> str:
    """Return the message that no rule has that code, with the nearest one."""
    known = known_beginnings(rules)
    # The longest code that the word begins with, or the code or name most like it.
    begun = (word[:size].upper() for size in range(len(word), 2, -1))
    near = next((it for it in begun if it in known), "")
    near = near or nearest(word.upper(), sorted(known))
    start = f" {word.lower().removesuffix('s')}"
    every = [it for it in rules.values() if not near and start[3:]]
    named = [it for it in every if start in f" {it.name}".replace("-", " ")]
    about = named or [it for it in every if start in it.what.lower()]
    few = shorten([f"{it.code} {it.name}" for it in about], SEVERAL)
    near = near or ("" if named else near_name(word, rules))
    other = f"rules about it: {few}" if few else f"see {ASKED}"
    hint = f"did you mean {near!r}?" if near else other
    return f"no rule has the code {word!r}, and none begins with it; {hint}"


def find_codes(words: Iterable[str], where: str, rules: Mapping[str, Rule]) -> tuple[str, ...]:
    """Return the codes, and beginnings of codes, that the words are or name; raises UsageError."""
    known = {**{it: it for it in known_beginnings(rules)}, **names_to_codes(rules)}
    unknown = next((it for it in words if it not in known), None)
    if unknown is not None:
        raise UsageError(f"{where}: {no_rule(unknown, rules)}")
    return tuple(known[it] for it in words)


def names_to_codes(rules: Mapping[str, Rule]) -> dict[str, str]:
    """Return the code of each rule by the rule's name."""
    return {it.name: code for code, it in rules.items()}


def near_name(word: str, rules: Mapping[str, Rule]) -> str:
    """Return the rule's name that is most like the word; "" if none is."""
    return nearest(word, [it.name for it in rules.values()])


def explained(rule: Rule) -> str:
    """Return a rule with its examples as a text for a terminal."""
    head = f"{rule.code} {rule.name} ({rule.level})"
    parts = [head, "", rule.what, "", f"Why: {rule.why}", "", f"Fix: {rule.fix}"]
    for title, example in examples(rule):
        parts += ["", f"{title}:", "", *(f"    {line}" for line in example.splitlines())]
    return "\n".join(parts) + "\n"


def listed(rules: Iterable[Rule]) -> Iterator[tuple[str, str, str, str]]:
    """Return code, level, name and first sentence of each rule."""
    return ((it.code, it.level, it.name, it.what.partition(". ")[0].rstrip(".")) for it in rules)


def examples(rule: Rule) -> list[tuple[str, str]]:
    """Return titles and texts of a rule's examples, and of the files next to them."""
    page = rule.page
    good = "" if page.good == page.fixed else page.good
    texts = (("Bad", page.bad), ("Fixed by --fix", page.fixed), ("Good", good))
    beside = ((f"With it, {name}", text) for name, text in page.beside.items())
    return [(title, text) for title, text in (*texts, *beside) if text.strip()]
