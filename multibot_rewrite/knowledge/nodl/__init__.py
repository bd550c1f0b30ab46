# SPDX-License-Identifier: Apache-2.0
"""NoDL interface files (ros-tooling/nodl): what a package says of its own nodes."""
