# SPDX-License-Identifier: Apache-2.0
"""What a launch file would start: its description is visited as a launch would, and nothing starts."""
