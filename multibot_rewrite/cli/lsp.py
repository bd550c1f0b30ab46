# SPDX-License-Identifier: Apache-2.0
"""``urdf-lint --lsp``: a language server. It says where things are in a text; ``answers`` says what.

Each answer is made by a process of its own, forked from one that has all loaded: no answer makes the
server wait, one that is out of date is stopped, and none knows files as they were before.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

try:
    from lsprotocol import types as lsp
    from pygls.lsp.server import LanguageServer
    from pygls.uris import from_fs_path
    from pygls.workspace import TextDocument
except ImportError as error:
    from multibot_rewrite.base.model import Unusable

    hint = "pip install 'multibot_rewrite[lsp]'"
    raise Unusable(f"an editor cannot be served: {error}; {hint}") from None

from multibot_rewrite.base.findings.finding import ERROR, WARNING, Finding
from multibot_rewrite.base.model import MultibotError
from multibot_rewrite.cli import answers
from multibot_rewrite.cli.process import DONE
from multibot_rewrite.refactor.symbols import Place
from multibot_rewrite.version import __version__

# Seconds: without a change before a file is linted, and after which an answer is given up.
PAUSE, MOST = 0.05, 60.0
_FIX, _FIX_ALL = lsp.CodeActionKind.QuickFix, lsp.CodeActionKind.SourceFixAll
_WARM = "multibot_rewrite.cli.warm"
_SEVERITIES = {ERROR: lsp.DiagnosticSeverity.Error, WARNING: lsp.DiagnosticSeverity.Warning}
# A name, a tag with its bracket or an attribute with its value.
_MARKED = re.compile(r"</?[\w:.-]+|[\w:.-]+\s*=\s*(?:\"[^\"]*\"?|'[^']*'?)|[^\s<>]+")
_WORD = re.compile(r"[^\s\"'<>=,(){}\[\]]+")


def run(options: argparse.Namespace) -> int:
    """Serve an editor until it says exit; returns the exit code."""
    gc.enable()
    server = Server(options)
    for name, (function, about) in _FEATURES.items():
        server.feature(name, about)(function)
    server.start_io()
    return DONE


class Server(LanguageServer):
    """The open files of an editor, and what was found in them."""

    def __init__(self, options: argparse.Namespace) -> None:
        super().__init__("urdf-lint", __version__)
        self.options = options
        self.context = get_context("forkserver")
        self.context.set_forkserver_preload([_WARM])
        self.found: dict[str, Sequence[Finding]] = {}
        self.running: dict[str, asyncio.Task[None]] = {}
        self.spares: list[asyncio.Future[tuple[BaseProcess, Connection]]] = []

    async def ask(self, function: Callable[..., Any], uri: str, *given: Any) -> Any:
        """Return what a function of ``answers`` returns for a file; None where it does not end well. An
        error of this package is shown."""
        documents = self.workspace.text_documents.values()
        texts = {os.path.realpath(it.path): it.source.encode() for it in documents}
        path = self.workspace.get_text_document(uri).path
        self.spare()
        child, connection = await self.spares.pop()
        try:
            connection.send((texts, function, self.options, path, *given))
            made = await asyncio.wait_for(asyncio.to_thread(connection.recv), MOST)
        except (EOFError, OSError, asyncio.TimeoutError):
            made = None
        finally:
            child.kill()
            self.spare()
        if isinstance(made, MultibotError):
            self.window_show_message(lsp.ShowMessageParams(lsp.MessageType.Warning, str(made)))
            return None
        return made

    def spare(self) -> None:
        """Have a process that only waits for a question."""
        if not self.spares:
            self.spares.append(asyncio.ensure_future(asyncio.to_thread(self._started)))

    def _started(self) -> tuple[BaseProcess, Connection]:
        ours, theirs = self.context.Pipe()
        child = self.context.Process(target=answers.answer, args=(theirs,), daemon=True)
        child.start()
        theirs.close()
        return child, ours

    def diagnose(self, *uris: str) -> None:
        """Lint files that are open, once nobody has typed for a moment."""
        for uri in uris:
            if uri in self.running:
                self.running[uri].cancel()
            self.running[uri] = asyncio.create_task(self._diagnose(uri))

    async def _diagnose(self, uri: str) -> None:
        await asyncio.sleep(PAUSE)
        is_open = uri in self.workspace.text_documents
        found = await self.ask(answers.diagnose, uri) if is_open else ()
        if found is not None:
            self.publish(uri, found)

    def publish(self, uri: str, found: Sequence[Finding]) -> None:
        """Show what was found in an open file, in the files that it is about."""
        old, self.found[uri] = self.found.get(uri, ()), found
        for each in {uri, *(self.uri_of(it.file) for it in (*old, *found))}:
            its = {
                it: 0 for own in self.found.values() for it in own if self.uri_of(it.file) == each
            }
            document = self.workspace.get_text_document(each)
            shown = [_diagnostic(document, it) for it in its]
            self.text_document_publish_diagnostics(
                lsp.PublishDiagnosticsParams(each, shown, document.version)
            )

    def uri_of(self, path: str) -> str:
        """Return what the editor calls a file."""
        real, documents = os.path.realpath(path), self.workspace.text_documents.values()
        known = (it.uri for it in documents if os.path.realpath(it.path) == real)
        return next(known, None) or from_fs_path(os.path.abspath(path)) or path

    def changes(self, files: Mapping[str, bytes]) -> lsp.WorkspaceEdit:
        """Return the edits that make these texts of files."""
        documents = {it: self.workspace.get_text_document(self.uri_of(it)) for it in files}
        edits = {it.uri: list(_edits(it.lines, files[path])) for path, it in documents.items()}
        return lsp.WorkspaceEdit(changes={uri: it for uri, it in edits.items() if it})

    def location(self, it: Place) -> lsp.Location:
        """Return a place as the editor counts."""
        document = self.workspace.get_text_document(self.uri_of(it.file))
        return lsp.Location(document.uri, _range(document, *it.start, *it.end))


def _range(document: TextDocument, line: int, column: int, end: int, last: int) -> lsp.Range:
    """Return a range as the editor counts: from 0, in its units."""
    ends = lsp.Position(line - 1, column - 1), lsp.Position(end - 1, last - 1)
    return lsp.Range(
        *(document.position_codec.position_to_client_units(document.lines, it) for it in ends)
    )


def _diagnostic(document: TextDocument, it: Finding) -> lsp.Diagnostic:
    line, column = max(it.line, 1), max(it.column, 1)
    text = document.lines[line - 1] if line <= len(document.lines) else ""
    marked = _MARKED.match(text, column - 1)
    where = _range(document, line, column, line, (marked.end() if marked else column) + 1)
    about = ": ".join(filter(None, (it.robot, it.node, it.message)))
    words = f"{about}; {it.hint}" if it.hint else about
    severity = _SEVERITIES.get(it.level, lsp.DiagnosticSeverity.Information)
    return lsp.Diagnostic(where, words, severity, it.code, source="urdf-lint")


def _edits(old: Sequence[str], new: bytes) -> Iterator[lsp.TextEdit]:
    """Return the edits of whole lines that make a text of another."""
    lines = new.decode().splitlines(keepends=True)
    for tag, start, end, first, last in SequenceMatcher(None, old, lines, False).get_opcodes():
        if tag != "equal":
            where = lsp.Range(lsp.Position(start, 0), lsp.Position(end, 0))
            yield lsp.TextEdit(where, "".join(lines[first:last]))


def _initialized(ls: Server, _: lsp.InitializedParams) -> None:
    ls.spare()


def _changed(ls: Server, params: Any) -> None:
    ls.diagnose(params.text_document.uri)


def _saved(ls: Server, _: lsp.DidSaveTextDocumentParams) -> None:
    ls.diagnose(*ls.workspace.text_documents)  # one may include it


def _cursor(ls: Server, params: Any) -> tuple[str, int, int]:
    """Return the uri of a file, and line and column, from 0, of the cursor in it."""
    document = ls.workspace.get_text_document(params.text_document.uri)
    at = document.position_from_client_units(params.position)
    return document.uri, at.line, at.character


async def _hover(ls: Server, params: lsp.HoverParams) -> lsp.Hover | None:
    uri, line, column = _cursor(ls, params)
    text = next(iter(ls.workspace.get_text_document(uri).lines[line:]), "")
    around = (it[0] for it in _WORD.finditer(text) if it.start() <= column <= it.end())
    codes = [it.code for it in ls.found.get(uri, ()) if it.line == line + 1]
    said = await ls.ask(answers.explain, uri, next(around, "").strip("/:?!"), codes)
    content = lsp.MarkupContent(lsp.MarkupKind.Markdown, f"```text\n{said}\n```")
    return lsp.Hover(content) if said else None


async def _actions(ls: Server, params: lsp.CodeActionParams) -> list[lsp.CodeAction]:
    uri, where, only = params.text_document.uri, params.range, params.context.only or ()
    path = ls.workspace.get_text_document(uri).path
    mended = [it for it in ls.found.get(uri, ()) if it.edits and it.file == path]
    here = [it for it in mended if where.start.line < it.line <= where.end.line + 1]
    asked: list[tuple[str, str, Finding | None]] = [
        (f"Fix {it.code}: {it.message}", _FIX, it) for it in here
    ]
    asked += [("Fix all that urdf-lint can", _FIX_ALL, None)] if mended else []
    actions = []
    for title, kind, finding in asked:
        if only and not any((kind + ".").startswith(it + ".") for it in only):
            continue
        if (text := await ls.ask(answers.fixed, uri, finding)) is not None:
            actions.append(lsp.CodeAction(title, kind, edit=ls.changes({path: text})))
    return actions


async def _places(ls: Server, params: Any) -> list[Place]:
    uri, line, column = _cursor(ls, params)
    return await ls.ask(answers.places, uri, (line + 1, column + 1)) or []


async def _definition(ls: Server, params: lsp.DefinitionParams) -> list[lsp.Location]:
    return [ls.location(it) for it in await _places(ls, params) if it.declares]


async def _references(ls: Server, params: lsp.ReferenceParams) -> list[lsp.Location]:
    own = params.context.include_declaration
    return [ls.location(it) for it in await _places(ls, params) if own or not it.declares]


async def _rename(ls: Server, params: lsp.RenameParams) -> lsp.WorkspaceEdit | None:
    for place in (await _places(ls, params))[:1]:
        made = await ls.ask(answers.renamed, params.text_document.uri, place, params.new_name)
        return ls.changes(made or {})
    return None


_FEATURES: Mapping[str, tuple[Callable[..., Any], Any]] = {
    lsp.INITIALIZED: (_initialized, None),
    lsp.TEXT_DOCUMENT_DID_OPEN: (_changed, None),
    lsp.TEXT_DOCUMENT_DID_CHANGE: (_changed, None),
    lsp.TEXT_DOCUMENT_DID_SAVE: (_saved, None),
    lsp.TEXT_DOCUMENT_DID_CLOSE: (_changed, None),
    lsp.TEXT_DOCUMENT_HOVER: (_hover, None),
    lsp.TEXT_DOCUMENT_CODE_ACTION: (_actions, lsp.CodeActionOptions([_FIX, _FIX_ALL])),
    lsp.TEXT_DOCUMENT_DEFINITION: (_definition, None),
    lsp.TEXT_DOCUMENT_REFERENCES: (_references, None),
    lsp.TEXT_DOCUMENT_RENAME: (_rename, None),
}
