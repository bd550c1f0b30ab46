# SPDX-License-Identifier: Apache-2.0
"""``multibot rename``: one name of a package's descriptions changed where it is made and used."""

from __future__ import annotations

import argparse

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.wording import SEVERAL, plural, shorten
from multibot_rewrite.cli.output import deliver_changed, detail, note, note_unread, verified_words
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.usage import arguments_alone
from multibot_rewrite.refactor.rename import Renaming, rename_symbol


def run(options: argparse.Namespace) -> int:
    """Change the files, or print the difference; returns the exit code."""
    made = rename_symbol(
        options.old,
        options.new,
        options.folder,
        kind=options.kind,
        xacro_args=arguments_alone(options),
        definitions=(*configured_definitions(options.folder), *options.definitions),
        trust=options.trust,
        distro=options.distro or "",
    )
    deliver_changed(options, made.before, made.after, write=not (options.diff or options.output))
    _print_result(options, made)
    return DONE


def _print_result(options: argparse.Namespace, made: Renaming) -> None:
    where = f"{plural(made.places, 'place')} in {plural(len(made.after), 'file')}"
    note(
        options,
        f"{options.kind} {options.old} -> {options.new}: {where}; {verified_words(made.unread)}",
    )
    note_unread(options, made.unread)
    if left := made.left:
        lines = f"{plural(len(left), 'line')} with {options.old!r}"
        shown = shorten((it.place for it in left), SEVERAL)
        note(options, f"left as they are: {lines}: {shown}")
        for mention in left:
            detail(options, f"  {mention.place}: {mention.why}")
