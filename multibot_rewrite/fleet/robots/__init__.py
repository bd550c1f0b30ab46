# SPDX-License-Identifier: Apache-2.0
"""The robots of a fleet: their descriptions, nodes and places."""
