# SPDX-License-Identifier: Apache-2.0
"""Regular expressions that are compiled when first used: a run needs only few of them."""

from __future__ import annotations

import re
from typing import Any, AnyStr, cast

_USES = ("findall", "finditer", "fullmatch", "match", "search", "split", "sub")


class _Later:
    """A pattern that becomes one when one of its methods is asked for."""

    def __init__(self, text: Any, flags: int) -> None:
        self._made = text, flags

    def __getattr__(self, name: str) -> Any:
        compiled = re.compile(*self._made)
        # From now on its methods are found without this one.
        self.__dict__.update({use: getattr(compiled, use) for use in _USES})
        return getattr(compiled, name)


def lazy_compile(text: AnyStr, flags: int = 0) -> re.Pattern[AnyStr]:
    """As ``re.compile``, but a mistake in ``text`` is raised at the first use."""
    return cast("re.Pattern[AnyStr]", _Later(text, flags))
