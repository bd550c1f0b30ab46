# SPDX-License-Identifier: Apache-2.0
"""Behavior trees of Nav2."""
