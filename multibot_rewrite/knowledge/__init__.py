# SPDX-License-Identifier: Apache-2.0
"""What is known of nodes of public packages: one entry a node, by family in ``nodes/*.yaml``.

``README.md`` has every key.
"""
