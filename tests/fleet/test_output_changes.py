# SPDX-License-Identifier: Apache-2.0
"""What a build must change, by the hashes of the last one and of the files that are there."""

from __future__ import annotations

import pytest

from multibot_rewrite import InputError
from multibot_rewrite.fleet.outputs.manifest import (
    OutputChanges,
    hash_of,
    output_changes,
    read_manifest,
)
from multibot_rewrite.fleet.outputs.output_file import OutputFile

NEW, OLD, MINE = hash_of(b"new"), hash_of(b"old"), hash_of(b"mine")


@pytest.mark.parametrize(
    ("known", "there", "found"),
    [
        # Nothing is there: all is written.
        ({}, {}, (("a",), (), (), ())),
        ({"a": NEW}, {"a": NEW}, ((), (), (), ())),
        ({"a": OLD}, {"a": OLD}, (("a",), (), (), ())),
        # Somebody removed it, or edited it; and somebody else's.
        ({"a": NEW}, {}, (("a",), (), (), ())),
        ({"a": OLD}, {"a": MINE}, (("a",), (), (), ("a",))),
        ({}, {"a": MINE}, (("a",), (), ("a",), ())),
        ({}, {"a": NEW}, ((), (), (), ())),
        # What an earlier build made, and this one does not.
        ({"a": NEW, "b": OLD}, {"a": NEW, "b": OLD}, ((), ("b",), (), ())),
        ({"a": NEW, "b": OLD}, {"a": NEW, "b": MINE}, ((), ("b",), (), ("b",))),
        ({"a": NEW, "b": OLD}, {"a": NEW}, ((), (), (), ())),
    ],
)
def test_what_a_build_changes(
    known: dict[str, str], there: dict[str, str], found: tuple[tuple[str, ...], ...]
) -> None:
    made = [OutputFile("a", b"new", ())]
    assert output_changes(made, known, there) == OutputChanges(*found)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{}",
        "[1]",
        '{"format": "multibot build 0", "outputs": {}}',
        '{"format": "multibot build 1", "outputs": []}',
        '{"format": "multibot build 1", "outputs": {"../x": "0"}}',
        '{"format": "multibot build 1", "outputs": {"/etc/x": "0"}}',
    ],
)
def test_what_is_no_manifest_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="m: not a manifest of multibot build; delete it"):
        read_manifest(text.encode(), "m")
