# SPDX-License-Identifier: Apache-2.0
"""What runs on the robots, in one form for every source: records, conventions, the file."""
