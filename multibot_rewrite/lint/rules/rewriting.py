"""MB9: what a rewrite would not reach."""

from __future__ import annotations
