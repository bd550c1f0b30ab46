# SPDX-License-Identifier: Apache-2.0
"""A description package's own sources changed: what a name becomes is written where it is made."""
