# SPDX-License-Identifier: Apache-2.0
"""The rules of ``multibot check``, and the look-ups they share; all pure."""
