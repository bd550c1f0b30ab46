# SPDX-License-Identifier: Apache-2.0
"""The helpers of the tests are found by the pytest of Ubuntu 22.04, too: it has no setting for that."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "tests" / "support"))
