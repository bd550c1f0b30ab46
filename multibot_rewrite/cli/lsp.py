# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint --lsp``: a language server. It says where things are in a text, ``answers`` says what.

Each answer is made by a process of its own, forked from one that has all loaded: no answer makes the
server wait, an outdated one is stopped, and none remembers files as they were."""

from __future__ import annotations

import argparse
import asyncio
import gc
import os
import re
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from io import StringIO
from multiprocessing import get_context
from multiprocessing.connection import Connection
from operator import attrgetter
from typing import Any

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.grouping import lists_by_key
from multibot_rewrite.base.model import MultibotError, Unusable
from multibot_rewrite.cli import answers
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.refactor.rename import Place
from multibot_rewrite.version import __version__

try:
    from lsprotocol import types as lsp
    from pygls.lsp.server import LanguageServer
    from pygls.uris import from_fs_path
    from pygls.workspace import TextDocument
except ImportError as error:
    raise Unusable(f"{error}: editors need it: pip install 'multibot_rewrite[lsp]'") from None

# Seconds: without a change before a file is linted, and after which an answer is given up.
PAUSE, LONGEST = 0.03, 60.0
# How many files are linted at once: on saving, all open ones.
_AT_ONCE = max(4, os.cpu_count() or 1)
_OWN = "file:", "untitled:"
_FIX, _FIX_ALL = lsp.CodeActionKind.QuickFix, lsp.CodeActionKind.SourceFixAll
_SEVERITIES = {ERROR: lsp.DiagnosticSeverity.Error, WARNING: lsp.DiagnosticSeverity.Warning}
_Counter = Callable[[int, int], lsp.Position]
_WHERE = attrgetter("line", "column", "code", "message")
# A tag with its bracket, an attribute with its value, or a word.
_MARKED = re.compile(r"</?[\w:.-]+|[\w:.-]+\s*=\s*(?:\"[^\"]*\"?|'[^']*'?)|[^\s<>]+")
# The ends of a word around the cursor.
_BEFORE, _AFTER = (re.compile(it) for it in (r"[^\s\"'<>=,(){}\[\]]*$", r"^[^\s\"'<>=,(){}\[\]]*"))


class Server(LanguageServer):
    """The open files of an editor, and the findings in them."""

    def __init__(self) -> None:
        # pygls takes other characters for line ends than editors do, so it is to count no lines.
        super().__init__("urdf-lint", __version__, lsp.TextDocumentSyncKind.Full)
        self.options = argparse.Namespace()
        self.context = get_context("forkserver")
        self.context.set_forkserver_preload(["multibot_rewrite.cli.warm"])
        self.found: dict[str, Sequence[Finding]] = {}
        self.running: dict[str, asyncio.Task[None]] = {}
        self.waiting: list[tuple[Any, Connection]] = []
        self.slots = asyncio.Semaphore(_AT_ONCE)

    def opened(self) -> dict[str, TextDocument]:
        """Return the open documents by their URIs as the editor writes them.

        An older text of a file (``git:``) is none: its path is that of the file."""
        documents = self.workspace.text_documents.values()
        return {it.uri: it for it in documents if it.uri.startswith(_OWN)}

    async def ask(self, function: Callable[..., Any], uri: str, *words: Any) -> Any:
        """Return the answer of a function of ``answers``; None for none, an error is shown."""
        texts = {os.path.realpath(it.path): it.source.encode() for it in self.opened().values()}
        path = self.workspace.get_text_document(uri).path
        self.have_one_waiting()
        child, connection = self.waiting.pop()
        try:
            question = texts, function, self.options, path, *words
            asking = asyncio.to_thread(_exchange, connection, question)
            answer = await asyncio.wait_for(asking, LONGEST)
        except (EOFError, OSError, asyncio.TimeoutError):
            return None
        finally:
            child.kill()
            self.have_one_waiting()
        if not isinstance(answer, MultibotError):
            return answer
        self.window_show_message(lsp.ShowMessageParams(lsp.MessageType.Warning, str(answer)))
        return None

    def have_one_waiting(self) -> None:
        """Start a process that waits for a question, unless one does."""
        if not self.waiting:
            ours, theirs = self.context.Pipe()
            child = self.context.Process(target=answers.answer, args=(theirs,), daemon=True)
            child.start()
            theirs.close()
            self.waiting.append((child, ours))

    def diagnose(self, uri: str) -> None:
        """Lint a file, once nobody has typed for a moment."""
        if uri in self.running:
            self.running[uri].cancel()
        self.running[uri] = asyncio.create_task(self._diagnose(uri))

    async def _diagnose(self, uri: str) -> None:
        await asyncio.sleep(PAUSE)
        async with self.slots:
            found = await self.ask(answers.diagnose, uri) if uri in self.opened() else ()
        if found is None:
            return
        # An included file has the findings of all open files that include it.
        old, self.found[uri] = self.found.get(uri, ()), found
        every = [*old, *(it for its in self.found.values() for it in its)]
        uris = {file: self.uri_of(file) for file in {it.file for it in every}}
        for each in {uri, *(uris[it.file] for it in (*old, *found))}:
            document = self.workspace.get_text_document(each)
            # Once, however many uses of a macro or files that include it have the finding.
            own = {_WHERE(it): it for it in every[len(old) :] if uris[it.file] == each}
            lines = _lines(document)
            shown = [_diagnostic(lines, _counter(document, lines), it) for it in own.values()]
            params = lsp.PublishDiagnosticsParams(each, shown, document.version)
            self.text_document_publish_diagnostics(params)

    def uri_of(self, path: str) -> str:
        """Return what the editor calls a file."""
        real = os.path.realpath(path)
        known = (uri for uri, it in self.opened().items() if os.path.realpath(it.path) == real)
        return next(known, None) or from_fs_path(os.path.abspath(path)) or path

    def found_in(self, uri: str) -> list[Finding]:
        """Return the findings in a file, without those in files that it includes."""
        path = os.path.realpath(self.workspace.get_text_document(uri).path)
        return [it for it in self.found.get(uri, ()) if os.path.realpath(it.file) == path]

    def edits_to(self, changes: answers.Edits) -> lsp.WorkspaceEdit:
        """Return the edits of files' lines as the editor takes them."""
        edits: dict[str, list[lsp.TextEdit]] = {}
        for path, start, end, text in changes:
            where = lsp.Range(lsp.Position(start, 0), lsp.Position(end, 0))
            edits.setdefault(self.uri_of(path), []).append(lsp.TextEdit(where, text))
        return lsp.WorkspaceEdit(edits)

    def locations(self, places: Iterable[Place]) -> list[lsp.Location]:
        """Return places as the editor counts."""
        found = []
        for file, its in lists_by_key((it.file, it) for it in places).items():
            document = self.workspace.get_text_document(self.uri_of(file))
            at = _counter(document, _lines(document))
            ranges = (lsp.Range(at(*it.start), at(*it.end)) for it in its)
            found += [lsp.Location(document.uri, it) for it in ranges]
        return found


def _exchange(connection: Connection, question: object) -> Any:
    connection.send(question)
    return connection.recv()


def _lines(document: TextDocument) -> Sequence[str]:
    """Return the lines of a text as editors count them; none of a file that cannot be read."""
    with suppress(OSError, ValueError):
        return [*StringIO(document.source, newline="")]
    return []


def _counter(document: TextDocument, lines: Sequence[str]) -> _Counter:
    """Return what makes of a line and column a position as the editor counts: from 0, in its units."""
    units = document.position_codec.position_to_client_units
    return lambda line, column: units(lines, lsp.Position(line - 1, column - 1))


def _diagnostic(lines: Sequence[str], at: _Counter, it: Finding) -> lsp.Diagnostic:
    line, column = max(it.line, 1), max(it.column, 1)
    marked = _MARKED.match(next(iter(lines[line - 1 : line]), ""), column - 1)
    where = lsp.Range(at(line, column), at(line, (marked.end() if marked else column) + 1))
    message = ": ".join(filter(None, (it.robot, it.node, it.message)))
    text = "; ".join(filter(None, (message, it.hint)))
    severity = _SEVERITIES.get(it.level, lsp.DiagnosticSeverity.Information)
    return lsp.Diagnostic(where, text, severity, it.code, source="urdf-lint")


server = Server()


def run(options: argparse.Namespace) -> int:
    """Serve an editor until it says exit; returns the exit code."""
    gc.enable()
    server.options = options
    server.start_io()
    return DONE


@server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
@server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
@server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
@server.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
def _changed(params: Any) -> None:
    is_saved = isinstance(params, lsp.DidSaveTextDocumentParams)  # others may include it
    for uri in server.opened() if is_saved else [params.text_document.uri]:
        server.diagnose(uri)


@server.feature(lsp.TEXT_DOCUMENT_HOVER)
async def _hover(params: lsp.HoverParams) -> lsp.Hover | None:
    document = server.workspace.get_text_document(params.text_document.uri)
    word = document.word_at_position(params.position, _BEFORE, _AFTER).strip("/:?!-")
    found, line = server.found_in(document.uri), params.position.line + 1
    words = [word, *(it.code for it in found if it.line == line)]
    explained = await server.ask(answers.explain, document.uri, words)
    content = lsp.MarkupContent(lsp.MarkupKind.Markdown, f"```text\n{explained}\n```")
    return lsp.Hover(content) if explained else None


@server.feature(lsp.TEXT_DOCUMENT_CODE_ACTION, lsp.CodeActionOptions([_FIX, _FIX_ALL]))
async def _actions(params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
    document = server.workspace.get_text_document(params.text_document.uri)
    lines = range(params.range.start.line + 1, params.range.end.line + 2)
    fixable = [it for it in server.found_in(document.uri) if it.edits]
    kinds = [_FIX_ALL] * bool(fixable) + [_FIX] * any(it.line in lines for it in fixable)
    asked = [it for it in kinds if it.startswith(tuple(params.context.only or [""]))]
    fixes = await server.ask(answers.fixed, document.uri) if asked else None
    edit = server.edits_to(fixes or [])
    return [lsp.CodeAction("Fix all that urdf-lint can", it, edit=edit) for it in asked if fixes]


async def _places(params: Any) -> list[Place]:
    document = server.workspace.get_text_document(params.text_document.uri)
    at = document.position_codec.position_from_client_units(_lines(document), params.position)
    return await server.ask(answers.places, document.uri, (at.line + 1, at.character + 1)) or []


@server.feature(lsp.TEXT_DOCUMENT_DEFINITION)
@server.feature(lsp.TEXT_DOCUMENT_REFERENCES)
async def _locations(params: Any) -> list[lsp.Location]:
    context = getattr(params, "context", None)  # that of references
    wanted = {False, context.include_declaration} if context else {True}
    places = [it for it in await _places(params) if it.declares in wanted]
    # Robots of one package may each have the name: it is that of the file itself.
    here = server.workspace.get_text_document(params.text_document.uri).path
    own = [it for it in places if os.path.realpath(it.file) == os.path.realpath(here)]
    return server.locations(places if context else own or places)


@server.feature(lsp.TEXT_DOCUMENT_RENAME)
async def _rename(params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
    uri, places = params.text_document.uri, await _places(params)
    edits = places and await server.ask(answers.renamed, uri, places[0], params.new_name)
    return server.edits_to(edits) if edits else None
