# SPDX-License-Identifier: Apache-2.0
"""Settings of nodes that no file of their robot makes."""
