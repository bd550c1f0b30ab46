# SPDX-License-Identifier: Apache-2.0
"""From a path to what rules check: which files there are, how they expand, which belong together."""
