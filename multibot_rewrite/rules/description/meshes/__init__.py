# SPDX-License-Identifier: Apache-2.0
"""MB7: mesh and texture files, and the packages they are in."""
