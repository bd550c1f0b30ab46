# SPDX-License-Identifier: Apache-2.0
"""Rules about what a launch file starts: its words, its simulator, its models and its nodes."""
