# SPDX-License-Identifier: Apache-2.0
"""Where the commands get a graph from: saved snapshots, a Zenoh router, or the live graph of ROS.

The options are in ``declared/shared.txt``. What reads a source is imported when that
one is asked for.
"""

from __future__ import annotations

import argparse
import gc
import os
import sys
from collections.abc import Callable, Collection, Generator, Iterable, Mapping
from contextlib import closing
from math import inf
from typing import TYPE_CHECKING

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.output import is_screen, note, shown
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.cli.report import TEXT
from multibot_rewrite.live.watching import Verdict
from multibot_rewrite.producers.ros.request import Request
from multibot_rewrite.rules.check import ABSENCE
from multibot_rewrite.system.environment import settings
from multibot_rewrite.system.parameters import ANSWER_SECONDS, NO_MORE, questions, with_answers
from multibot_rewrite.system.records import System, answering

if TYPE_CHECKING:
    from multibot_rewrite.producers.zenoh.observe import Router

INCONCLUSIVE = 3
CODES = {Verdict.PLANNED: DONE, Verdict.WRONG: STOPPED, Verdict.INCONCLUSIVE: INCONCLUSIVE}
# How long a single look takes at most.
LOOK_SECONDS = 15.0


def check_source(options: argparse.Namespace) -> None:
    """Raise UsageError for options that a saved source or a router does not support."""
    saved, watching = bool(options.snapshot), getattr(options, "watch", False)
    if getattr(options, "bag", None):
        given = vars(options)
        for name in ("watch", "state", "suggest", "report"):
            if given.get(name):
                what = f"{given['bag']} is a recording, which has no nodes"
                raise UsageError(f"{what}: leave out --{name}")
    if saved and watching:
        raise UsageError("--watch is for the live graph, leave out --from")
    if watching and (options.select or options.ignore or options.format != TEXT):
        raise UsageError("--watch shows every finding: leave out --select, --ignore and --format")
    if getattr(options, "state", False) and (saved or options.zenoh):
        raise UsageError("--state asks nodes of the live graph: leave out --from")


# What is wrong with a view.
Judge = Callable[[System], Iterable[Finding]]


def graph(
    options: argparse.Namespace, request: Request | None = None, judge: Judge | None = None
) -> System:
    """Return the graph that the options name; raises Unusable, UsageError, InputError.

    A live one is observed until it is quiet, unless ``request`` says otherwise: a second node of a name
    may come after the planned nodes. Meanwhile a terminal shows what ``judge`` finds.
    """
    if options.snapshot:
        from multibot_rewrite.producers.snapshot_file import read_snapshots

        saved = read_snapshots(options.snapshot)
        # A ``--domain`` is that of a saved graph, if it says its own.
        around, asked = saved.environment, vars(options).get("domain")
        if asked is not None and around.rmw and asked != around.domain:
            what = f"{options.snapshot[0]} is a graph of domain {around.domain}"
            raise UsageError(f"--domain {asked}: {what}; leave it out")
        return saved
    if getattr(options, "bag", None):
        from multibot_rewrite.producers.bags.read import read_bag
        from multibot_rewrite.producers.bags.recording import as_snapshot

        return as_snapshot(read_bag(options.bag))
    asked = request or Request(options.timeout or LOOK_SECONDS)
    looking = f"looking at the graph, for {asked.timeout:g} s at most"
    with shown(looking) as show:
        if options.zenoh:
            from multibot_rewrite.producers.zenoh.observe import look

            return look(asked, _router(options, environ(options.domain)))
        from multibot_rewrite.producers.ros.child import observe

        def tell(said: str | System) -> None:
            show(f"{looking}: {said if isinstance(said, str) else so_far(said, judge)}")

        asked = asked._replace(shows=judge is not None and is_screen(sys.stderr))
        return observe(asked, environ(options.domain), tell)


def so_far(seen: System, judge: Judge | None) -> str:
    """Return a line about a view that may be incomplete: node count and certain faults."""
    found = [it for it in judge(seen) if it.level in (ERROR, WARNING)] if judge else []
    sure = [it for it in found if it.code not in ABSENCE]
    nodes = f"{plural(len(seen.nodes), 'node')} so far"
    if not sure:
        return f"{nodes}, nothing wrong seen" if seen.nodes else nodes
    first = min(sure, key=lambda it: it.level != ERROR)
    more = f", and {plural(len(sure) - 1, 'more finding')}" if len(sure) > 1 else ""
    return f"{nodes}; {first.code} {first.message}{more}"


def at(options: argparse.Namespace, domain: int | None) -> argparse.Namespace:
    """Return the options, for another domain."""
    return argparse.Namespace(**{**vars(options), "domain": domain})


def by_domain(options: argparse.Namespace) -> tuple[argparse.Namespace, list[int]]:
    """Return the options with the domain of ``--domain``, if it is one; all domains if several."""
    asked = list(dict.fromkeys(options.domain or []))
    one = at(options, asked[0] if len(asked) == 1 else None)
    return one, asked if len(asked) > 1 else []


def graphs(options: argparse.Namespace, domains: Collection[int]) -> dict[int, System]:
    """Return the graph of each domain, live or of saved snapshots; raises as ``graph``."""
    if options.snapshot:
        from multibot_rewrite.producers.snapshot_file import read_by_domain

        saved = read_by_domain(options.snapshot)
        if saved.keys() != {*domains}:
            wanted, given = (", ".join(map(str, it)) for it in (domains, saved))
            raise UsageError(f"snapshots of domains {given}: give one of each of {wanted}")
        return saved
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(len(domains)) as pool:
        looks = pool.map(lambda it: graph(at(options, it)), domains)
        return dict(zip(domains, looks, strict=True))


def with_states(
    options: argparse.Namespace, seen: System, parameters: Mapping[str, Collection[str]] = NO_MORE
) -> System:
    """Return the live graph with the answers to ``--state``, also about ``parameters``."""
    # Without the option it is unchanged; otherwise the number of answers is printed.
    if not options.state:
        return seen
    from multibot_rewrite.producers.ros.child import ask

    asked = list(questions(seen, parameters))
    found = ask(asked, ANSWER_SECONDS, environ(options.domain))
    seen = with_answers(seen, found, asked)
    note_answers(options, seen)
    return seen


def note_answers(options: argparse.Namespace, seen: System) -> None:
    """Print how many nodes answered ``--state``."""
    if options.state:
        nodes = plural(len({it.node for it in questions(seen)}), "node")
        note(options, f"{len(answering(seen))} of {nodes} answered --state")


def watched(
    options: argparse.Namespace,
    parameters: Mapping[str, Collection[str]] = NO_MORE,
    domains: Collection[int] = (),
) -> Generator[Mapping[int, System], None, None]:
    """Yield the live graph by domain after each change, once all domains were seen."""
    # With ``--state`` it has the nodes' answers, also about ``parameters``.
    gc.enable()  # no short process any more
    asks = dict(parameters) if options.state else None
    asked = Request(options.timeout or inf, watch=True, asks=asks)
    environs = {it: environ(it) for it in domains} or {0: environ(options.domain)}
    if options.zenoh:
        from multibot_rewrite.producers.zenoh import observe

        looks = observe.watch(asked, {it: _router(options, environs[it]) for it in environs})
    else:
        from multibot_rewrite.producers.ros import child

        looks = child.watch(asked, environs)
    views: dict[int, System] = {}
    with closing(looks) as changes:
        for number, view in changes:
            views[number] = view
            if len(views) == len(environs):
                yield {it: views[it] for it in environs}


def _router(options: argparse.Namespace, given: Mapping[str, str]) -> Router:
    """Return the router to ask, with the domain of ROS_DOMAIN_ID, which is a part of every key."""
    from multibot_rewrite.producers.zenoh.observe import Router

    return Router(options.zenoh, settings(given).domain)


def environ(domain: int | None = None) -> dict[str, str]:
    """Return the environment to observe in, with ``domain`` if one is given.

    Raises UsageError if rcl would end the process without a message.
    """
    result = dict(os.environ)
    if domain is not None:
        result["ROS_DOMAIN_ID"] = str(domain)
    settings(result)
    return result
