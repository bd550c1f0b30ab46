# SPDX-License-Identifier: Apache-2.0
"""What a rewrite does to names, on records: the plan of a fleet."""
