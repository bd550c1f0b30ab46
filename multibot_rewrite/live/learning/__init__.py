# SPDX-License-Identifier: Apache-2.0
"""Running nodes -> a file of nodes and node sets with the names in their code."""
