# SPDX-License-Identifier: Apache-2.0
"""The published schema of NoDL documents, where this machine has it: it is not part of this project."""

from __future__ import annotations

import os
import warnings
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
import yaml

NAMES = ("nodl.schema.yaml", "parameter.schema.yaml")


def nodl_validator() -> Any:
    """Return the validator of an installed nodl_schema, or of the checkout MULTIBOT_NODL; skips."""
    jsonschema = pytest.importorskip("jsonschema", reason="no jsonschema: pip install '.[test]'")
    folder = _folder()
    if folder is None:
        pytest.skip("no NoDL schema: set MULTIBOT_NODL to a checkout of ros-tooling/nodl")
    schema, parameter = (yaml.safe_load((folder / name).read_text()) for name in NAMES)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        store = {NAMES[1]: parameter}
        resolver = jsonschema.RefResolver.from_schema(schema, store=store)
    return jsonschema.validators.Draft7Validator(schema, resolver=resolver)


def _folder() -> Path | None:
    installed = find_spec("nodl_schema")
    if installed and installed.origin:
        return Path(installed.origin).parent / "schemas"
    root = os.environ.get("MULTIBOT_NODL", "")
    return Path(root, "nodl_schema", "nodl_schema", "schemas") if root else None
