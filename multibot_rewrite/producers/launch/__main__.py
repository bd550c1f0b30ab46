"""The process that reads a launch file: ``python -m multibot_rewrite.producers.launch``.

Standard input has the order, standard output gets the graph; what the launch file prints goes to
standard error. Exit code 3: launch or launch_ros is missing.
"""

from __future__ import annotations

import os
import sys
import tempfile

from multibot_rewrite.producers.launch.read import UnreadableError, read_graph
from multibot_rewrite.producers.launch.records import order_of, to_json

NO_LAUNCH, UNREADABLE = 3, 4


def main() -> int:
    """Read the order, write the graph; returns the exit code."""
    order = order_of(sys.stdin.read())
    # What a launch file prints must not be taken for the answer.
    answer = os.dup(1)
    os.dup2(2, 1)
    with tempfile.TemporaryDirectory(prefix="multibot_launch_") as folder:
        tempfile.tempdir = os.environ["ROS_LOG_DIR"] = folder
        try:
            graph = read_graph(order, folder)
        except UnreadableError as error:
            print(error, file=sys.stderr)
            return UNREADABLE
        except ImportError as error:
            print(f"{type(error).__name__}: {error}", file=sys.stderr)
            return NO_LAUNCH
    with os.fdopen(answer, "w", encoding="utf-8") as out:
        out.write(to_json(graph))
    return 0


if __name__ == "__main__":
    # What the launch file leaves behind, such as threads, is not waited for.
    code = main()
    sys.stderr.flush()
    os._exit(code)
