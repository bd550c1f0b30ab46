# SPDX-License-Identifier: Apache-2.0
"""What every room uses: names and their spelling, records, findings, bounds."""
