# SPDX-License-Identifier: Apache-2.0
"""Recordings of rosbag2 instead of a running graph: topics, types, QoS, frames, rates; no nodes."""
