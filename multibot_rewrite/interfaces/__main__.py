"""``python -m multibot_rewrite.interfaces FOLDER... --release jazzy``: what known nodes declare.

Each FOLDER is a checkout of a tag or commit and is called REPOSITORY@VERSION. The table is printed.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from multibot_rewrite.interfaces.checkouts import read_folder
from multibot_rewrite.interfaces.known_nodes import extracted
from multibot_rewrite.interfaces.records import joined
from multibot_rewrite.interfaces.scope import indexed
from multibot_rewrite.interfaces.table import to_table
from multibot_rewrite.model import UsageError


def main(arguments: list[str]) -> int:
    """Print the table; 2 for wrong arguments."""
    parser = argparse.ArgumentParser(
        prog="python -m multibot_rewrite.interfaces", description=__doc__
    )
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    given = parser.parse_args(arguments)
    try:
        source = joined([read_folder(folder) for folder in sorted(given.folders)])
    except UsageError as error:
        print(f"interfaces: {error}", file=sys.stderr)
        return 2
    sys.stdout.write(to_table(extracted(indexed(source))))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
