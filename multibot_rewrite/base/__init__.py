# SPDX-License-Identifier: Apache-2.0
"""What every package uses: names and their spelling, records, findings, bounds."""
