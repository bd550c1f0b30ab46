# SPDX-License-Identifier: Apache-2.0
"""``multibot adopt``: a description package gets an argument that puts a prefix before its names."""

from __future__ import annotations

import argparse

from multibot_rewrite.base.config import configured_definitions
from multibot_rewrite.base.wording import plural, shorten
from multibot_rewrite.cli.output import deliver_changed, note, note_unread, verified_words
from multibot_rewrite.cli.process import DONE, STOPPED
from multibot_rewrite.cli.usage import arguments_alone
from multibot_rewrite.refactor.adopt import Adopted, adopt

# So many names of a description are shown.
_SHOWN = 10


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
    return STOPPED if made.bare else DONE


def _print_result(options: argparse.Namespace, made: Adopted) -> None:
    if made.argument:
        many = plural(len(made.verified), "description")
        if made.configurations:
            many += f" and {plural(len(made.configurations), 'other configuration')}"
        end = verified_words(made.unread) if made.verified else "not verified, see what is left"
        where = plural(len(made.after), "file")
        note(options, f"argument {made.argument}: {many} in {where}; {end}")
    for path in made.verified:
        own = made.already.get(path)
        what = f"its argument {own} reaches all its names" if own else "it takes the argument"
        note(options, f"{path}: {what}; verified")
    if made.namespace:
        where = plural(len(made.spaced), "description")
        note(options, f"argument {made.namespace}: namespaces and topics in {where}; verified")
    for it in made.launches:
        given = made.namespace and f"{made.namespace}:=".encode() in made.after[it]
        what = f"{made.argument} and {made.namespace}" if given else made.argument
        note(options, f"{it}: it hands {what} on; verified")
    for path in (it for it in made.already if it not in made.verified):
        note(options, f"{path}: it has such an argument already: {made.already[path]}")
    for path, names in made.bare.items():
        what = f"error: {shorten(map(repr, names), _SHOWN)} stay without the prefix"
        note(options, f"{path}: {what}; put the argument before them by hand")
    if made.left:
        note(options, f"left as they are: {plural(len(made.left), 'place')}")
    for one in made.left:
        note(options, f"{one.place}: left as it is: {one.why}")
    note_unread(options, made.unread)
