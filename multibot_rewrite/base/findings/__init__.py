# SPDX-License-Identifier: Apache-2.0
"""What every check reports, and the rules that the reports come from."""
