"""``multibot learn``: a file of nodes and stacks from nodes that are running now."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Sequence

from multibot_rewrite.cli.files import write_all
from multibot_rewrite.cli.live import (
    INCONCLUSIVE,
    LOOK_SECONDS,
    NO_ROS,
    domain,
    environ,
    full_name,
    seconds,
)
from multibot_rewrite.cli.output import print_bytes, say
from multibot_rewrite.cli.process import DONE, PROGRAM
from multibot_rewrite.cli.walk import check_target
from multibot_rewrite.graph.check import doubts
from multibot_rewrite.graph.learning.choosing import choose_nodes, helpers_without_owner, left_out
from multibot_rewrite.graph.learning.learn import LearnedNode, learn
from multibot_rewrite.graph.learning.nodes_file import to_yaml
from multibot_rewrite.graph.live.child import RosUnusable, observe
from multibot_rewrite.graph.live.request import Request
from multibot_rewrite.graph.snapshot import Snapshot, from_json
from multibot_rewrite.model import UsageError
from multibot_rewrite.remap.stacks import built_in
from multibot_rewrite.sources.read import read_file

MORE = """\
examples:
  multibot learn --node /my_driver /my_planner --stack mine -o mine.yaml
  multibot learn --namespace /robot1 --stack mine -o mine.yaml      all nodes of a robot
  multibot learn --snapshot graph.json --stack mine -o mine.yaml    needs no ROS
  multibot remap rover.urdf robot1 robot2 --nodes mine.yaml --stack mine
exit codes: 0 done; 2 wrong use, unreadable input, or a node that is not there or there twice; 3 the
view may be incomplete, what is seen is written all the same; 4 rclpy or its RMW is missing or does
not start
"""
_WORD = re.compile(r"[A-Za-z0-9_.-]+")


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command."""
    parser.epilog = MORE
    parser.add_argument(
        "--node", nargs="+", type=full_name, default=[], metavar="NODE",
        help="full names (default: all nodes but tools)",
    )  # fmt: skip
    parser.add_argument(
        "--namespace", type=full_name, metavar="NS", help="the robot's, below which the nodes are"
    )
    parser.add_argument(
        "--stack", type=_stack, default="learned", metavar="NAME", help="default: %(default)s"
    )
    parser.add_argument(
        "-o", "--output", metavar="FILE", help="write it there, not to standard output"
    )
    parser.add_argument("--snapshot", metavar="FILE", help="what multibot snapshot wrote")
    parser.add_argument(
        "--timeout", type=seconds, metavar="S", help=f"look S seconds (default: {LOOK_SECONDS:.0f})"
    )
    parser.add_argument(
        "--domain", type=domain, metavar="N", help="instead of ROS_DOMAIN_ID, 0 to 232"
    )


def _stack(text: str) -> str:
    if not _WORD.fullmatch(text):
        raise argparse.ArgumentTypeError(f"{text!r} is no name of a stack, give one word")
    return text


def run(options: argparse.Namespace) -> int:
    """Look, learn, write, say what is to be known of it; returns the exit code."""
    try:
        graph = _graph(options)
    except RosUnusable as error:
        say(str(error), PROGRAM)
        return NO_ROS
    doubtful = doubts(graph)
    for caveat in doubtful:
        say(f"incomplete: {caveat.message}", PROGRAM)
    namespace = options.namespace or "/"
    names = choose_nodes(graph, options.node, namespace)
    library = built_in()
    learned = learn(graph, names, namespace, library)
    data = to_yaml(learned, options.stack, library).encode()
    if options.output in (None, "-"):
        print_bytes(data)
    else:
        write_all([(options.output, data)])
    for note in _notes(graph, learned, options.namespace, bool(options.node)):
        say(f"note: {note}", PROGRAM)
    say(f"{len(learned)} node{'s' * (len(learned) != 1)} learned as stack {options.stack}", PROGRAM)
    return INCONCLUSIVE if doubtful else DONE


def _graph(options: argparse.Namespace) -> Snapshot:
    if options.snapshot is None:
        # Until it is quiet: a helper node or a second one of a name may come after the first.
        return observe(Request(options.timeout or LOOK_SECONDS), environ(options.domain))
    if options.timeout is not None or options.domain is not None:
        raise UsageError("--timeout and --domain are for the live graph, leave out --snapshot")
    if options.output:
        check_target(options.output, [options.snapshot], "--output")
    return from_json(read_file(options.snapshot), options.snapshot)


def _notes(
    graph: Snapshot, learned: Sequence[LearnedNode], namespace: str | None, named: bool
) -> Iterator[str]:
    for node in learned:
        yield from (f"{node.seen}: {remark}" for remark in node.remarks)
    lost = helpers_without_owner(graph, [node.seen for node in learned])
    if lost:
        yield f"whose helpers these are is not seen, they are left out: {', '.join(lost)}"
    tools = left_out(graph, [node.seen for node in learned], namespace or "/")
    if tools and not named:
        yield f"left out as tools: {', '.join(tools)}; to learn one give its name to --node"
    first = {node.facts.name.partition("/")[0] for node in learned if "/" in node.facts.name}
    if namespace is None and len(first) == 1 and all("/" in node.facts.name for node in learned):
        where = f"/{first.pop()}"
        yield f"all are below {where}; if that is the robot's namespace, add --namespace {where}"
