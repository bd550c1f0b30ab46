"""What a build made, with hashes: what a second one has to change, and what somebody else changed."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from hashlib import sha256
from typing import NamedTuple

from multibot_rewrite.fleets.output_file import OutputFile
from multibot_rewrite.model import InputError

MANIFEST = "manifest.json"
# The manifest of a build that replaces files one by one, until it is done.
NOTE = ".manifest.next.json"
FORMAT = "multibot build 1"
NOTHING: Mapping[str, str] = {}


class OutputChanges(NamedTuple):
    """Paths below the output folder: ``write`` is new or differs, ``remove`` an earlier build made
    and this one does not. ``foreign`` would be overwritten and no build made them; ``edited`` were
    changed since an earlier build made them."""

    write: tuple[str, ...]
    remove: tuple[str, ...]
    foreign: tuple[str, ...]
    edited: tuple[str, ...]


def hash_of(data: bytes) -> str:
    """The hash that manifests hold."""
    return sha256(data).hexdigest()


def manifest(files: Iterable[OutputFile], inputs: Mapping[str, bytes], folder: str) -> OutputFile:
    """The manifest of a build into ``folder``; ``inputs`` are the files that were read, by path."""
    data = {
        "format": FORMAT,
        "inputs": {os.path.relpath(path, folder): hash_of(inputs[path]) for path in sorted(inputs)},
        "outputs": {it.path: hash_of(it.data) for it in files},
    }
    return OutputFile(MANIFEST, json.dumps(data, indent=1).encode() + b"\n")


def read_manifest(data: bytes, file: str) -> Mapping[str, str]:
    """The hashes of what a build made, by path; raises InputError for a file that is none."""
    try:
        found = json.loads(data)
        if found["format"] != FORMAT:
            raise ValueError(found["format"])
        outputs = {str(path): str(hash_) for path, hash_ in found["outputs"].items()}
        # What is named here may be deleted: nothing outside of the folder is.
        if any(os.path.isabs(path) or ".." in path.split("/") for path in outputs):
            raise ValueError(outputs)
        return outputs
    except (ValueError, KeyError, TypeError, AttributeError):
        hint = "delete it to build anew, or name another folder"
        raise InputError(f"{file}: this is no manifest of multibot build; {hint}") from None


def output_changes(
    files: Iterable[OutputFile], known: Mapping[str, str], there: Mapping[str, str]
) -> OutputChanges:
    """What a build has to change; ``known`` are the hashes of the last one, ``there`` of what is
    on the disk now, of the paths that are there."""
    wanted = {it.path: hash_of(it.data) for it in files}
    write = [path for path, hash_ in wanted.items() if there.get(path) != hash_]
    remove = [path for path in known if path not in wanted and path in there]
    foreign = [path for path in write if path in there and path not in known]
    touched = (path for path in (*write, *remove) if path in there and path in known)
    edited = [path for path in touched if there[path] != known[path]]
    return OutputChanges(tuple(write), tuple(remove), tuple(foreign), tuple(edited))
