# SPDX-License-Identifier: Apache-2.0
"""The program that stands for every program: it writes down how it was started, and waits to be ended.

Copied under the name of each program that a launch file asks for. It uses nothing but Python.
"""

import json
import os
import signal
import sys
import time

# They do their work and end, so that what waits for their end starts.
ENDING = {
    *(
        "spawner",
        "spawner.py",
        "unspawner",
        "hardware_spawner",
        "create",
        "spawn_entity.py",
        "gz_spawn_model",
    ),
    *("sleep", "wait_for_robot_description", "echo", "mkdir", "rm", "cp", "chmod", "touch", "test"),
}
# Longer texts of files are not kept.
LONGEST = 4 << 20


def text(word: str) -> str:
    """Return what a file among the arguments holds."""
    if not os.path.isfile(word) or os.path.getsize(word) > LONGEST:
        return ""
    with open(word, errors="replace") as file:
        return file.read()


def main() -> None:
    """Write down arguments, environment, folder and the files among the arguments."""
    asked = os.environ.get("BRINGUP_ASKED", "")
    row = {
        "words": sys.argv,
        "files": {word: text(word) for word in sys.argv[1:] if text(word)},
        "environ": dict(os.environ),
        "folder": os.getcwd(),
        "pid": os.getpid(),
        "asked": bool(asked),
    }
    place = os.path.join(os.environ["BRINGUP_ROWS"], f"{time.time_ns()}.json")
    with open(f"{place}.part", "w") as out:
        json.dump(row, out)
    os.rename(f"{place}.part", place)
    if asked == "answer":  # what launch files ask a program of a package for is a description
        print('<robot name="not_made"/>')
    if asked or os.path.basename(sys.argv[0]) in ENDING:
        return
    signal.pthread_sigmask(signal.SIG_SETMASK, ())
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGUSR1):
        signal.signal(number, lambda *_: sys.exit(0))
    while True:
        signal.pause()


main()
