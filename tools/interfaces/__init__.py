# SPDX-License-Identifier: Apache-2.0
"""What the nodes of public packages declare, read from their sources: publishers, services, tf."""
