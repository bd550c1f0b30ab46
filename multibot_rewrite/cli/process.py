# SPDX-License-Identifier: Apache-2.0
"""What every command does the same: exit codes, and an error is one line instead of a traceback."""

from __future__ import annotations

import argparse
import atexit
import gc
import io
import os
import signal
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from typing import NoReturn

from multibot_rewrite.base.findings.finding import RewriteRefused
from multibot_rewrite.base.model import MultibotError, ProofError, Unusable
from multibot_rewrite.cli.declared.options import Command
from multibot_rewrite.cli.output import check_there, detail, say
from multibot_rewrite.cli.parser import UNUSABLE, make_parser, parsed

# The last two are those of a shell for a process that SIGINT or SIGPIPE ends.
DONE, STOPPED, MISSING, INTERRUPTED, CLOSED = 0, 1, 4, 130, 141
PROGRAM = "multibot"


def leave(code: int) -> NoReturn:
    """End this process at once: taking Python down takes as long as many a job."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        for stream in (sys.stdout, sys.stderr):
            if stream is not None:
                stream.flush()
    except (OSError, ValueError):
        sys.exit(code)  # Python says what is wrong with the stream
    atexit._run_exitfuncs()
    os._exit(code)


def start(command: Command, words: Sequence[str], prog: str = "") -> int:
    """Parse the arguments of a command and run it; returns the exit code."""
    begun = time.monotonic()
    options = parsed(make_parser(command, prog), words)
    try:
        run = import_module(f"{__package__}.{command.module}").run
        # From here on something may be half written: Ctrl-C is an exception. Before that it ends a
        # process at once (``entry``), since an import makes other errors of it: lxml's is an
        # ImportError. A shell's job in the background has SIG_IGN; a process is ours where
        # ``guarded`` has set SIGTERM.
        ours = signal.getsignal(signal.SIGTERM) is signal.default_int_handler
        if ours and signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        check_there(options)
        code: int = run(options)
    except RewriteRefused as error:
        code = _report_refusal(options, error)
    detail(options, f"{time.monotonic() - begun:.1f} s")
    return code


def _report_refusal(options: argparse.Namespace, error: RewriteRefused) -> int:
    """Report why a rewrite is not possible, which no ``--ignore`` changes."""
    from multibot_rewrite.cli.report import (
        NO_ROBOTS,
        About,
        by_themselves,
        report_findings_too,
        report_first,
    )
    from multibot_rewrite.cli.usage import robots

    given = vars(options)
    read = given.get("input") or given.get("fleet") or given.get("plan") or ""
    about = About([read], by_themselves(robots(options)) if "robots" in given else NO_ROBOTS)
    (report_first if options.findings_first else report_findings_too)(
        options, error.findings, about
    )
    return STOPPED


def run_alone(command: Command, arguments: Sequence[str] | None) -> int:
    """Run a command that is a program; without ``arguments`` with those of the process."""
    words = sys.argv[1:] if arguments is None else arguments
    return guarded(command.name, partial(start, command, words), own_process=arguments is None)


def guarded(program: str, run: Callable[[], int], own_process: bool) -> int:
    """Return the exit code of ``run``; its errors are reported in the name of ``program``.

    With ``own_process`` SIGTERM and SIGHUP end it as Ctrl-C does, and this does not return: nothing
    else runs in this process.
    """
    if own_process:
        # A short one: nothing it makes needs the collector of cycles.
        gc.disable()
    code = _run_guarded(program, run, own_process)
    if own_process:
        leave(code)
    return code


def _raise_interrupt(unraisable: sys.UnraisableHookArgs) -> None:
    """Raise Ctrl-C again that a callback, as imports have, would print and forget."""
    if unraisable.exc_type is not KeyboardInterrupt:
        sys.__unraisablehook__(unraisable)
        return
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 0.001)


def _run_guarded(program: str, run: Callable[[], int], own_process: bool) -> int:
    # Closed by the caller: messages go nowhere.
    sys.stderr = sys.stderr or io.StringIO()
    try:
        if own_process:
            sys.unraisablehook = _raise_interrupt
            signal.signal(signal.SIGTERM, signal.default_int_handler)
            if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:  # under nohup it is ignored
                signal.signal(signal.SIGHUP, signal.default_int_handler)
        return run()
    except ProofError as error:
        fault = "verification failed, nothing was written; this is a fault of the tool, report it"
        say(f"{fault}: {error}", program)
        return STOPPED
    except MultibotError as error:
        say(str(error), program)
        return MISSING if isinstance(error, Unusable) else UNUSABLE
    except BrokenPipeError:
        # As head does when it has read enough: no finding, and nothing to tell.
        return CLOSED
    except KeyboardInterrupt:
        say("interrupted; no half-written file is left", program)
        return INTERRUPTED
