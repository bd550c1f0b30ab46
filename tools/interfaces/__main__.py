# SPDX-License-Identifier: Apache-2.0
"""``python -m tools.interfaces FOLDER...``: what known nodes declare.

Each FOLDER is a checkout of a tag or commit and is called REPOSITORY@VERSION. The table is printed;
with ``--compare RELEASE``, the differences to the nodes that are known of that release, and nodes
beside them that ``nodes.txt`` does not have; with ``--nodl NODE``, the NoDL document of that node; with
``--plugins``, what plugins of simulators and ros2_control hardware read and our definitions lack
or otherwise (checkouts of a release may be in a folder of its name, the oldest release first); with
``--sdf``, what SDF has, of one checkout of sdformat.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from multibot_rewrite.base.model import UsageError
from multibot_rewrite.base.releases import RELEASES
from multibot_rewrite.description.rewriters.plugin_definitions import load_definitions
from multibot_rewrite.knowledge.node_sets import built_in
from multibot_rewrite.producers.sources.records import joined
from tools.interfaces import plugin_files, sdf_elements
from tools.interfaces.checkouts import read_folder
from tools.interfaces.compare import difference_of, differences
from tools.interfaces.known_nodes import extracted, unlisted
from tools.interfaces.nodl_files import nodl_of
from tools.interfaces.scope import indexed
from tools.interfaces.table import to_table


def main(arguments: list[str]) -> int:
    """Print the table, or differences; 1 where there are some, 2 for wrong arguments."""
    parser = argparse.ArgumentParser(prog="python -m tools.interfaces", description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path, metavar="FOLDER")
    parser.add_argument("--compare", choices=RELEASES, metavar="RELEASE")
    parser.add_argument("--nodl", metavar="NODE")
    parser.add_argument("--plugins", action="store_true")
    parser.add_argument("--sdf", action="store_true")
    given = parser.parse_args(arguments)
    try:
        return _printed(given)
    except UsageError as error:
        print(f"interfaces: {error}", file=sys.stderr)
        return 2


def _printed(given: argparse.Namespace) -> int:
    if given.sdf:
        sys.stdout.write(sdf_elements.to_schema(given.folders[0]))
        return 0
    if given.plugins:
        known = load_definitions((), "", packages=False)
        sys.stdout.write(plugin_files.new_values(given.folders, known))
        return 0
    index = indexed(joined([read_folder(folder) for folder in sorted(given.folders)]))
    facts = tuple(extracted(index))
    if given.nodl:
        made = nodl_of(given.nodl, facts)
        sys.stdout.write(made.text)
        sys.stderr.writelines(f"interfaces: NoDL has no form for {it}\n" for it in made.left_out)
        return 0
    if given.compare:
        new = map(difference_of, unlisted(index))
        rows = sorted({*differences(facts, built_in(given.compare)), *new})
        sys.stdout.writelines("\t".join(row) + "\n" for row in rows)
        return int(bool(rows))
    sys.stdout.write(to_table(facts))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
