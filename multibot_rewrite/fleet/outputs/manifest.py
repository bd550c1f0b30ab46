# SPDX-License-Identifier: Apache-2.0
"""The hashes of what a build read and wrote: what the next build must change, and what it must not."""

import json
import os
from collections.abc import Iterable, Mapping
from hashlib import sha256
from typing import NamedTuple

from multibot_rewrite.base.bounded import load_json
from multibot_rewrite.base.model import InputError
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.release_said import BUILD, MANIFEST
from multibot_rewrite.fleet.fleet_plan import FleetPlan
from multibot_rewrite.fleet.outputs.output_file import OutputFile

# The manifest of a build in progress that replaces files one by one.
NOTE = ".manifest.next.json"


class OutputChanges(NamedTuple):
    """Paths that a build writes, removes, overwrites without having written, or finds edited."""

    write: tuple[str, ...]
    remove: tuple[str, ...]
    foreign: tuple[str, ...]
    edited: tuple[str, ...]


def hash_of(data: bytes) -> str:
    """Return the hash that manifests hold."""
    return sha256(data).hexdigest()


def manifest(
    files: Iterable[OutputFile], inputs: Mapping[str, bytes], folder: str, plan: FleetPlan
) -> OutputFile:
    """Return the manifest of a build into ``folder``; ``inputs`` are the files read, by path."""
    data = {
        "format": BUILD,
        "distro": plan.file.distro,
        "inputs": {os.path.relpath(path, folder): hash_of(inputs[path]) for path in sorted(inputs)},
        "outputs": {it.path: hash_of(it.data) for it in files},
    }
    return OutputFile(MANIFEST, json.dumps(data, indent=1).encode() + b"\n")


def inputs_of(folder: str) -> Mapping[str, str]:
    """Return the hashes of what a build into ``folder`` read, by path; none without its manifest."""
    path = os.path.join(folder, MANIFEST)
    try:
        found = load_json(read_file(path))["inputs"] if os.path.isfile(path) else {}
        paths = {os.path.normpath(os.path.join(folder, it)): str(found[it]) for it in found}
    except (ValueError, KeyError, TypeError, AttributeError):
        return {}
    return paths


def read_manifest(data: bytes, file: str) -> Mapping[str, str]:
    """Return the hashes of what a build wrote, by path; raises InputError for no manifest."""
    try:
        found = load_json(data)
        if found["format"] != BUILD:
            raise ValueError(found["format"])
        outputs = {str(path): str(hash_) for path, hash_ in found["outputs"].items()}
        # Files that are named here may be deleted, so none may be outside of the folder.
        if any(os.path.isabs(path) or ".." in path.split("/") for path in outputs):
            raise ValueError(outputs)
        return outputs
    except (ValueError, KeyError, TypeError, AttributeError):
        hint = "delete it to build again, or choose another folder"
        raise InputError(f"{file}: not a manifest of multibot build; {hint}") from None


def output_changes(
    files: Iterable[OutputFile], known: Mapping[str, str], there: Mapping[str, str]
) -> OutputChanges:
    """Return what a build must change, by the hashes of the last build and those on disk."""
    wanted = {it.path: hash_of(it.data) for it in files}
    write = [path for path, hash_ in wanted.items() if there.get(path) != hash_]
    remove = [path for path in known if path not in wanted and path in there]
    foreign = [path for path in write if path in there and path not in known]
    touched = (path for path in (*write, *remove) if path in there and path in known)
    edited = [path for path in touched if there[path] != known[path]]
    return OutputChanges(tuple(write), tuple(remove), tuple(foreign), tuple(edited))
