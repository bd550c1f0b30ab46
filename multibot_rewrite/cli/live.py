"""What the commands that look at the live graph have in common: options, codes, environment."""

from __future__ import annotations

import argparse
import math
import os

from multibot_rewrite.graph.environment import MAX_DOMAIN, settings

INCONCLUSIVE, NO_ROS = 3, 4
# How long a single look takes at most.
LOOK_SECONDS = 15.0


def options(parser: argparse.ArgumentParser) -> None:
    """Add the options that say how long and where to look; ``timeout`` is None if not given."""
    limit = f"look S seconds (default: {LOOK_SECONDS:.0f})"
    parser.add_argument("--timeout", type=seconds, metavar="S", help=limit)
    parser.add_argument(
        "--domain", type=domain, metavar="N", help="instead of ROS_DOMAIN_ID, 0 to 232"
    )


def seconds(text: str) -> float:
    """The value of a time option."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value <= 3600:
        raise argparse.ArgumentTypeError(f"{text!r} is not a time, give seconds up to 3600")
    return value


def full_name(text: str) -> str:
    """The value of an option that names a node or a topic."""
    if not text.startswith("/"):
        raise argparse.ArgumentTypeError(f"{text!r} is not a full name, give for example /{text}")
    return text


def domain(text: str) -> int:
    """The value of ``--domain``."""
    if not text.isdecimal() or int(text) > MAX_DOMAIN:
        raise argparse.ArgumentTypeError(f"{text!r} is not a domain, give 0 to {MAX_DOMAIN}")
    return int(text)


def environ(domain: int | None = None) -> dict[str, str]:
    """The environment to look in, with ``domain`` where one is given.

    Raises UsageError where rcl would end the process without a word.
    """
    result = dict(os.environ)
    if domain is not None:
        result["ROS_DOMAIN_ID"] = str(domain)
    settings(result)
    return result
