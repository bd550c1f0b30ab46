# SPDX-License-Identifier: Apache-2.0
"""``multibot adopt``: a description package gets an argument that puts a prefix before its names."""

from __future__ import annotations

import argparse

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.wording import plural
from multibot_rewrite.cli.output import deliver_changed, note, note_unread, verified_words
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.cli.usage import arguments_alone
from multibot_rewrite.refactor.adopt import Adopted, adopt


def run(options: argparse.Namespace) -> int:
    """Print a patch, or change the files; returns the exit code."""
    made = adopt(
        options.folder,
        xacro_args=arguments_alone(options),
        definitions=(*configured_definitions(options.folder), *options.definitions),
        trust=options.trust,
        distro=options.distro or "",
    )
    deliver_changed(options, made.before, made.after, write=options.in_place)
    _print_result(options, made)
    return DONE


def _print_result(options: argparse.Namespace, made: Adopted) -> None:
    if made.argument:
        many = plural(len(made.verified), "description")
        if made.configurations:
            many += f" and {plural(len(made.configurations), 'other configuration')}"
        end = verified_words(made.unread) if made.verified else "not verified, see what is left"
        where = plural(len(made.after), "file")
        note(options, f"argument {made.argument}: {many} in {where}; {end}")
    if made.namespace:
        where = plural(len(made.spaced), "description")
        note(options, f"argument {made.namespace}: namespaces and topics in {where}; verified")
    for it in made.launches:
        given = made.namespace and f"{made.namespace}:=".encode() in made.after[it]
        what = f"{made.argument} and {made.namespace}" if given else made.argument
        note(options, f"{it}: it hands {what} on; verified")
    for path, name in made.already.items():
        note(options, f"{path}: it has such an argument already: {name}")
    for one in made.left:
        note(options, f"{one.place}: left as it is: {one.why}")
    note_unread(options, made.unread)
