# SPDX-License-Identifier: Apache-2.0
"""The referee of fleets made from a vendor's bringup: both are started, and what starts is compared."""
