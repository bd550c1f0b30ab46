"""What the commands that look at the live graph have in common: exit codes and environment."""

from __future__ import annotations

import os

from multibot_rewrite.graph.environment import settings

INCONCLUSIVE, NO_ROS = 3, 4
# How long a single look takes at most.
LOOK_SECONDS = 15.0


def environ(domain: int | None = None) -> dict[str, str]:
    """The environment to look in, with ``domain`` where one is given.

    Raises UsageError where rcl would end the process without a message.
    """
    result = dict(os.environ)
    if domain is not None:
        result["ROS_DOMAIN_ID"] = str(domain)
    settings(result)
    return result
