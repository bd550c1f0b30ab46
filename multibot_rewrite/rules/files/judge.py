# SPDX-License-Identifier: Apache-2.0
"""A file beside a description -> what the rules for its kind find in it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache

from multibot_rewrite.base.findings.finding import WARNING, Finding, Rule
from multibot_rewrite.base.lazy import lazy_compile
from multibot_rewrite.companions.named_file import PARAMS, NamedFile
from multibot_rewrite.rules import declaration
from multibot_rewrite.rules.declaration import rules_in
from multibot_rewrite.rules.description import names as description_names, rewriting
from multibot_rewrite.rules.description.files import reading, values
from multibot_rewrite.rules.description.multirobot import named_robots
from multibot_rewrite.rules.files import (
    declared,
    demands,
    names,
    plugin_names,
    rcl_rules,
    ros_names,
    same_for_all,
)
from multibot_rewrite.rules.system import clocks


def _each(
    *finders: Callable[[NamedFile], Iterator[Finding]],
) -> Callable[[NamedFile], Iterator[Finding]]:
    """What any of several functions finds, for a rule that they all answer."""

    def found(file: NamedFile) -> Iterator[Finding]:
        for find in finders:
            yield from find(file)

    return found


# They are asked of a description as well; here a file is looked at.
SHARED: tuple[Rule, ...] = (
    reading.leftover._replace(check=_each(ros_names.placeholders, ros_names.unfilled)),
    description_names.invalid_ros_name._replace(check=ros_names.invalid_names),
    description_names.leading_slash._replace(check=ros_names.slashes),
    rewriting.unclaimed_mention._replace(check=names.unknown_uses),
    values.misspelt._replace(
        check=_each(
            declared.unknown_parameters, rcl_rules.misspelt_marks, plugin_names.renamed_nodes
        )
    ),
    values.not_read._replace(
        check=_each(declared.not_read, declared.below_unknown_names, declared.in_the_manager)
    ),
    values.missing._replace(
        check=_each(plugin_names.without_plugin, plugin_names.missing_parameters)
    ),
    values.unreadable_value._replace(
        check=_each(declared.wrong_types, rcl_rules.rejected_values, rcl_rules.outside_of_marks),
        level=WARNING,
    ),
    values.unknown_word._replace(check=plugin_names.unknown_classes),
    clocks.clocks_mixed._replace(check=rcl_rules.mixed_clocks, level=WARNING, formats=(PARAMS,)),
    declaration.ONE_DEVICE._replace(check=same_for_all.one_device, formats=(PARAMS,)),
    named_robots.prefix_only._replace(check=same_for_all.prefix_only),
    values.out_of_range._replace(
        check=_each(declared.out_of_bounds, demands.above_others), level=WARNING
    ),
)
# Up to a reason, which is behind a dash.
_COMMENT = lazy_compile(r"(?:#|--)\s*urdf-lint:\s*ignore\s+((?:MB\d+[,\s]*)+)(?:$|[-:])")


@cache
def rules_for(kind: str) -> tuple[Rule, ...]:
    """The rules for files of a kind, by their codes."""
    return tuple(sorted((it for it in _every() if kind in it.formats), key=lambda it: it.code))


@cache
def codes() -> frozenset[str]:
    """The codes of all rules for files."""
    return frozenset(it.code for it in _every())


def _every() -> Iterator[Rule]:
    yield from (*rules_in("files"), *SHARED)


def judged(file: NamedFile, rules: Iterable[Rule]) -> Iterator[Finding]:
    """What rules find in a file, without what a comment at the end of its line silences."""
    lines = file.text.split("\n")
    for rule in rules:
        for it in rule.check(file) if rule.check else ():
            # The codes in a comment at the end of a line.
            line = lines[it.line - 1]
            found = _COMMENT.search(line) if "urdf-lint" in line else None
            if rule.code not in (found[1].replace(",", " ").split() if found else []):
                said = it.hint or rule.advice
                level = it.level or rule.level
                yield it._replace(code=rule.code, level=level, hint=said, file=file.file)


def judged_once(file: NamedFile) -> list[Finding]:
    """What all rules find in a file, at its first place, in the order of the places."""
    first: dict[tuple[str, str], Finding] = {}
    for it in sorted(judged(file, rules_for(file.kind)), key=lambda it: (it.line, it.column)):
        first.setdefault((it.code, it.message), it)
    return list(first.values())
