# SPDX-License-Identifier: Apache-2.0
"""The process that reads a launch file: ``python -m multibot_rewrite.producers.launch``.

Standard input has the order, standard output gets the graph; what the launch file prints goes to
standard error. Without launch its stand-in reads the file.
"""

from __future__ import annotations

import os
import sys
import tempfile
from contextlib import nullcontext

from multibot_rewrite.producers.launch.door import is_there
from multibot_rewrite.producers.launch.read import UnreadableError, read_graph
from multibot_rewrite.producers.launch.records import order_of, to_json
from multibot_rewrite.producers.launch.stand_in import standing_in

UNREADABLE = 4
NO_LAUNCH = (
    "launch is not installed here, and its stand-in does not know all of it: source ROS 2 "
    "(. /opt/ros/jazzy/setup.bash), or give a system_model.yaml of play_launch"
)


def main() -> int:
    """Read the order, write the graph; returns the exit code."""
    order = order_of(sys.stdin.read())
    # What a launch file prints must not be taken for the answer.
    answer = os.dup(1)
    os.dup2(2, 1)
    with tempfile.TemporaryDirectory(prefix="multibot_launch_") as folder:
        tempfile.tempdir = os.environ["ROS_LOG_DIR"] = folder
        stands_in = not is_there()
        try:
            with standing_in() if stands_in else nullcontext():
                graph = read_graph(order, folder)._replace(stood_in=stands_in)
        except UnreadableError as error:
            doubtful = stands_in and not error.of_file
            print(f"{error}; {NO_LAUNCH}" if doubtful else error, file=sys.stderr)
            return UNREADABLE
    with os.fdopen(answer, "w", encoding="utf-8") as out:
        out.write(to_json(graph))
    return 0


if __name__ == "__main__":
    # What the launch file leaves behind, such as threads, is not waited for.
    code = main()
    sys.stderr.flush()
    os._exit(code)
