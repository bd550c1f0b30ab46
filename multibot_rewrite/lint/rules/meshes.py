"""MB7: files that a description asks for."""

from __future__ import annotations
