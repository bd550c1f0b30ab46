"""What every command does the same: exit codes, and an error is one line instead of a traceback."""

from __future__ import annotations

import io
import signal
import sys
from collections.abc import Callable

from multibot_rewrite.cli.output import print_findings, say
from multibot_rewrite.cli.usage import UNUSABLE, Parser
from multibot_rewrite.model import MultibotError, ProofError, RewriteRefused

__all__ = ["DONE", "INTERRUPTED", "PROGRAM", "STOPPED", "UNUSABLE", "Parser", "guarded"]

DONE, STOPPED, INTERRUPTED = 0, 1, 130
PROGRAM = "multibot"


def guarded(program: str, run: Callable[[], int], own_process: bool) -> int:
    """The exit code of ``run``; what it raises is told in the name of ``program``.

    ``own_process`` tells that nothing else runs here: SIGTERM then ends it as Ctrl-C does.
    """
    # Closed by the caller: nobody wants to hear anything.
    sys.stderr = sys.stderr or io.StringIO()
    if own_process:
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return run()
    except RewriteRefused as error:
        print_findings(error.findings)
        return STOPPED
    except ProofError as error:
        fault = "the proof failed, nothing was written; this is a fault of the tool"
        say(f"{fault}: {error}", program)
        return STOPPED
    except MultibotError as error:
        say(str(error), program)
        return UNUSABLE
    except BrokenPipeError:
        say("standard output was closed before everything was written", program)
        return STOPPED
    except KeyboardInterrupt:
        say("interrupted; no half-written file is left", program)
        return INTERRUPTED
