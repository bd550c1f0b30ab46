# SPDX-License-Identifier: Apache-2.0
"""What hurts any system of several robots, planned or not: rules over a graph and its robots."""
