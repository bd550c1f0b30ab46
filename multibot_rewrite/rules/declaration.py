# SPDX-License-Identifier: Apache-2.0
"""How a rule is declared on the function that finds it, and how it says where a fault is."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import wraps
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal, Protocol, TypeVar

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding, Rule, declare, rule

if TYPE_CHECKING:
    import yaml

    from multibot_rewrite.related_files.named_file import NamedFile
    from multibot_rewrite.system.index import Index
    from multibot_rewrite.system.records import Place


_Check = TypeVar("_Check", bound=Callable[..., Any])
_Compare = Callable[["Index", "Index"], Iterator[Finding]]
_FileCheck = Callable[["NamedFile"], Iterator[Finding]]
# How pictures show what a finding is about; "" is violet for an error, blue for a warning.
Drawn = Literal["", "missing", "leak", "cross-talk", "unexpected"]
# The robots of an example.
TWO = ("robot1", "robot2")
OF_TWO: Mapping[str, object] = {"robots": TWO}
# What the examples of a rule are written in: lines of a system, and of its plan.
SYSTEM, LAUNCH = "system", "launch"


def system_rule(
    code: str,
    name: str,
    level: str,
    *,
    absence: bool = False,
    drawn: Drawn = "",
    all_ends: bool = False,
    meant: tuple[str, ...] = (),
) -> Callable[[_Check], Rule]:
    """Return a decorator that makes a function a rule about any system.

    The function gets an ``Index``, may ask what is ``expected`` in it, and yields what its own
    ``finding`` makes.

    ``absence``: the rule finds that something is missing, which an incomplete view cannot prove.
    ``all_ends``: a finding names one node, and is about all nodes that use the names. ``meant`` are
    roles: where all who have them at the names of a finding are planned to, it is no fault. The
    examples are lines of ``tests/support/graph_examples.py`` that begin with ``running:``."""
    options = system_options(absence, drawn, all_ends, meant)
    return lambda check: declare(code, name, level, check, formats=(SYSTEM,), options=options)


def system_options(
    absence: bool = False, drawn: Drawn = "", all_ends: bool = False, meant: tuple[str, ...] = ()
) -> dict[str, object]:
    """Return the options of a rule about any system, as in ``system_rule``."""
    options: dict[str, object] = {"absence": absence, "drawn": drawn, "all_ends": all_ends}
    return {**options, "meant": meant, "planned": False}


def planned_rule(
    code: str,
    name: str,
    level: str,
    *,
    absence: bool = False,
    drawn: Drawn = "",
    nodes: bool = True,
) -> Callable[[_Compare], Rule]:
    """Return a decorator that makes a function a rule which only a plan can answer.

    The function gets the ``Index`` of the plan and of what is seen, and is not asked without a
    plan. ``nodes``: it asks which nodes run, which a recording does not know. The rest is as for
    ``system_rule``."""
    options = {**system_options(absence, drawn), "planned": True, "nodes": nodes}

    def declared(compare: _Compare) -> Rule:
        @wraps(compare)
        def check(seen: Index) -> Iterator[Finding]:
            return compare(seen.expected, seen) if seen.expected else iter(())

        return declare(code, name, level, check, formats=(SYSTEM,), options=options)

    return declared


def launch_rule(
    code: str, name: str, *, level: str = ERROR, **options: object
) -> Callable[[_Check], Rule]:
    """Return a decorator that makes a function a rule about a ``Launched``; it yields findings."""
    return rule(code, name, level, formats=(LAUNCH,), options=options)


def of_robots(find: _FileCheck) -> _FileCheck:
    """Return the check, limited to files of certain robots unless robots are named."""

    @wraps(find)
    def found(file: NamedFile) -> Iterator[Finding]:
        if file.is_certain or file.robots:
            yield from find(file)

    return found


def rules_in(package: str, *apart: str) -> list[Rule]:
    """Return the rules in the modules of a package below this one, each once, without ``apart``."""
    name = f"{__package__}.{package}"
    whole = import_module(name)
    files = (it for path in getattr(whole, "__path__", ()) for it in sorted(os.listdir(path)))
    inside = (it[:-3] for it in files if it.endswith(".py") and it != "__init__.py")
    modules = [import_module(f"{name}.{it}") for it in inside if it not in apart]
    found = (it for one in (whole, *modules) for it in vars(one).values() if isinstance(it, Rule))
    return list({id(it): it for it in found}.values())


def robots_rule(
    code: str, name: str, level: str, *formats: str, options: Mapping[str, object] = OF_TWO
) -> Callable[[_FileCheck], Rule]:
    """Return a decorator for a rule about what several robots get of a file, as ``of_robots`` says."""
    return lambda find: declare(
        code, name, level, of_robots(find), formats=formats, options=options
    )


NOT_EXPORTED = declare(
    "MB229",
    "interface-not-exported",
    WARNING,
    formats=(SYSTEM,),
    options=system_options(absence=True),
)
CLAIMED_TWICE = declare(
    "MB240", "interface-claimed-twice", WARNING, formats=(SYSTEM,), options=system_options()
)
OF_NO_NODE = declare("MB244", "section-of-no-node", ERROR, formats=(LAUNCH,))
ONE_DEVICE = declare("MB412", "one-device", WARNING, formats=(SYSTEM,), options=system_options())


def section_message(path: str, readers: Sequence[str]) -> tuple[str, str]:
    """Return message and hint about a section that is for no node, though it has these nodes' name."""
    names = sorted(set(readers))
    base = names[0].rpartition("/")[2]
    message = f"section {path} matches no node: {' and '.join(names)} get nothing of it"
    return message, f"write {names[0] if len(names) == 1 else f'/**/{base}'}:"


class Placed(Protocol):
    """A record with the place where a file has it."""

    @property
    def place(self) -> Place:
        """Return the file and line that the finding is about."""


class OnLine(Protocol):
    """What has a place in a text; lines and columns count from 1."""

    @property
    def line(self) -> int:
        """Return the line, from 1."""

    @property
    def column(self) -> int:
        """Return the column, from 1."""


def remark(at: OnLine, message: str, hint: str = "", level: str = "") -> Finding:
    """Return a finding at a name, without file and rule; an empty ``level`` is the rule's."""
    return Finding("", level, message, hint, "", at.line, at.column)


def remark_at(node: yaml.Node, message: str, hint: str = "", level: str = "") -> Finding:
    """Return a finding at a YAML node, without file and rule as ``remark``."""
    mark = node.start_mark
    return Finding("", level, message, hint, "", mark.line + 1, mark.column + 1)


def at(rule: Rule, place: Place, message: str, hint: str, **more: Any) -> Finding:
    """Return a finding of a rule at a place."""
    return rule.finding(message, hint, **_place_fields(place), **more)


def last_place(records: Iterable[Placed]) -> dict[str, Any]:
    """Return the place fields of a finding, at the last record that has a place; empty without one."""
    places = [it.place for it in records if it.place.file]
    return _place_fields(places[-1]) if places else {}


def _place_fields(place: Place) -> dict[str, Any]:
    """Return the fields of a finding for a place, the column 1 if it is unknown."""
    return {**place._asdict(), "column": place.column or 1}


def see_all(records: Iterable[Placed]) -> str:
    """Return ``; see FILE:LINE and FILE:LINE``: the places of all but the last one."""
    places = dict.fromkeys(str(it.place) for it in records if it.place.file)
    others = [*places][:-1]
    return f"; see {' and '.join(others)}" if others else ""
