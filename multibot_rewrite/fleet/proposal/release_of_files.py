# SPDX-License-Identifier: Apache-2.0
"""The release that parameter files were written for, by the parameters and the classes of plugins that
only some releases have.

Sources: what the packages declare in each release (``knowledge/declared.schema``), and the classes that
they register (``knowledge/plugin_classes.schema``).
"""

from __future__ import annotations

import os
from collections.abc import Sequence

from multibot_rewrite.base.model import InputError
from multibot_rewrite.base.naming import make_naming
from multibot_rewrite.base.releases import NEWEST_LTS, RELEASES
from multibot_rewrite.base.wording import shorten
from multibot_rewrite.companions.context import make_context
from multibot_rewrite.companions.formats import read_named
from multibot_rewrite.companions.kinds import PARAMS
from multibot_rewrite.description.sources.read import read_file
from multibot_rewrite.description.sources.release_said import SaidRelease
from multibot_rewrite.rules.files.plugin_names import classes_of_other_releases
from multibot_rewrite.rules.files.releases import elsewhere

# The newest that people run first; nobody writes files for the one that changes each day.
_ORDER = (NEWEST_LTS, *(it for it in RELEASES[-2::-1] if it != NEWEST_LTS))
# One parameter may be left over of an older file.
_ENOUGH = 2


def release_of_files(paths: Sequence[str]) -> SaidRelease:
    """The release that has most of what the parameter files set, where another one clearly has less;
    no word of why where all have it alike."""
    lacking = {release: _lacking(paths, release) for release in _ORDER}
    most = len(lacking[NEWEST_LTS])
    best = min(_ORDER, key=lambda it: len(lacking[it]))
    if most - len(lacking[best]) < _ENOUGH:
        return SaidRelease(NEWEST_LTS)
    files = dict.fromkeys(map(os.path.basename, lacking[NEWEST_LTS]))
    return SaidRelease(
        best, f"{NEWEST_LTS} lacks {most} parameters or plugins of {shorten([*files])}"
    )


def _lacking(paths: Sequence[str], release: str) -> list[str]:
    """The file of each parameter, and of each class of a plugin, that a release does not have."""
    context = make_context({}, make_naming("tf-per-robot"), (), release)
    found = []
    for path in paths:
        try:
            file = read_named(PARAMS, read_file(path), path, context)
        except InputError:  # it is told where it is taken
            continue
        found += [path for _ in (*elsewhere(file), *classes_of_other_releases(file))]
    return found
