"""MB3: how names are spelled."""

from __future__ import annotations
