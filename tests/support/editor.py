# SPDX-License-Identifier: Apache-2.0
"""An editor for tests: pygls' own client, which starts ``urdf-lint --lsp`` and talks to it by pipes."""

from __future__ import annotations

import asyncio
import os
import shutil
import sys
from collections import defaultdict
from collections.abc import Awaitable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types as lsp
from pygls.lsp.client import BaseLanguageClient
from pygls.uris import to_fs_path

# Seconds, on a machine that has much else to do.
LONGEST = 120
_T = TypeVar("_T")


class Editor:
    """The files that are open, what is shown of them, and what can be asked about a place."""

    def __init__(self) -> None:
        self.loop = asyncio.new_event_loop()
        self.client = BaseLanguageClient("tests", "1")
        self.shown: dict[str, list[lsp.Diagnostic]] = {}
        self.times: defaultdict[str, int] = defaultdict(int)
        self.messages: list[str] = []
        self.version = 0
        self.client.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)(self._published())
        self.client.feature(lsp.WINDOW_SHOW_MESSAGE)(self._message())

    def _published(self) -> Any:
        def published(params: lsp.PublishDiagnosticsParams) -> None:
            self.shown[params.uri] = list(params.diagnostics)
            self.times[params.uri] += 1

        return published

    def _message(self) -> Any:
        return lambda params: self.messages.append(params.message)

    def run(self, doing: Awaitable[_T]) -> _T:
        return self.loop.run_until_complete(asyncio.wait_for(doing, LONGEST))

    def start(self, folder: Path, *options: str) -> None:
        command = shutil.which("urdf-lint", path=os.path.dirname(sys.executable)) or "urdf-lint"
        self.run(self.client.start_io(command, "--lsp", *options, cwd=str(folder)))
        capabilities = lsp.ClientCapabilities()
        params = lsp.InitializeParams(capabilities, root_uri=folder.as_uri())
        self.can = self.run(self.client.initialize_async(params)).capabilities
        self.client.initialized(lsp.InitializedParams())

    def stop(self) -> int | None:
        server = self.client._server
        self.run(self.client.shutdown_async(None))
        self.client.exit(None)
        self.run(self.client.stop())
        self.loop.close()
        return server.returncode if server else None

    def open(self, path: Path, text: str, wait: bool = True) -> list[lsp.Diagnostic]:
        """Open a file with a text, which need not be on the disk; what is shown of it."""
        item = lsp.TextDocumentItem(path.as_uri(), "xml", self._next(), text)
        return self._shown(
            path,
            lambda: self.client.text_document_did_open(lsp.DidOpenTextDocumentParams(item)),
            wait,
        )

    def change(self, path: Path, *texts: str, wait: bool = True) -> list[lsp.Diagnostic]:
        """Type texts, one after the other; what is shown of the last."""

        def type_all() -> None:
            for text in texts:
                document = lsp.VersionedTextDocumentIdentifier(self._next(), path.as_uri())
                whole = [lsp.TextDocumentContentChangeWholeDocument(text)]
                self.client.text_document_did_change(
                    lsp.DidChangeTextDocumentParams(document, whole)
                )

        return self._shown(path, type_all, wait)

    def close(self, path: Path) -> list[lsp.Diagnostic]:
        document = lsp.TextDocumentIdentifier(path.as_uri())
        return self._shown(
            path,
            lambda: self.client.text_document_did_close(lsp.DidCloseTextDocumentParams(document)),
            True,
        )

    def save(self, path: Path) -> None:
        document = lsp.TextDocumentIdentifier(path.as_uri())
        self.client.text_document_did_save(lsp.DidSaveTextDocumentParams(document))

    def _next(self) -> int:
        self.version += 1
        return self.version

    def _shown(self, path: Path, act: Any, wait: bool) -> list[lsp.Diagnostic]:
        uri = path.as_uri()
        before = self.times[uri]

        async def acted() -> None:
            act()
            while wait and self.times[uri] == before:
                await asyncio.sleep(0.005)

        self.run(acted())
        return self.shown.get(uri, [])

    def until(self, path: Path, code: str) -> list[lsp.Diagnostic]:
        """Return what is shown of a file, as soon as a finding with that code is."""

        async def seen() -> None:
            while code not in codes(self.shown.get(path.as_uri(), [])):
                await asyncio.sleep(0.005)

        self.run(seen())
        return self.shown[path.as_uri()]

    def hover(self, path: Path, text: str, word: str) -> str:
        made = self.run(
            self.client.text_document_hover_async(lsp.HoverParams(*at(path, text, word)))
        )
        return made.contents.value if made else ""

    def definition(self, path: Path, text: str, word: str) -> list[tuple[str, int, str]]:
        params = lsp.DefinitionParams(*at(path, text, word))
        return self._places(self.run(self.client.text_document_definition_async(params)))

    def references(
        self, path: Path, text: str, word: str, every: bool = True
    ) -> list[tuple[str, int, str]]:
        """Return the places of a name; without ``every`` none that declares it."""
        params = lsp.ReferenceParams(lsp.ReferenceContext(every), *at(path, text, word))
        return self._places(self.run(self.client.text_document_references_async(params)))

    def _places(self, found: Any) -> list[tuple[str, int, str]]:
        """File, line and text of places, in order."""
        made = []
        for it in found or ():
            path = Path(to_fs_path(it.uri) or "")
            start, end = it.range.start, it.range.end
            line = path.read_text().splitlines()[start.line]
            made.append((path.name, start.line + 1, line[start.character : end.character]))
        return sorted(made)

    def rename(self, path: Path, text: str, word: str, new: str) -> dict[str, str]:
        """Return the texts of the files that change, by name."""
        document, where = at(path, text, word)
        params = lsp.RenameParams(document, where, new)
        return applied(self.run(self.client.text_document_rename_async(params)), {path: text})

    def actions(self, path: Path, line: int, *only: str) -> list[lsp.CodeAction]:
        where = lsp.Range(lsp.Position(line - 1, 0), lsp.Position(line - 1, 0))
        context = lsp.CodeActionContext(self.shown[path.as_uri()], only=only or None)
        document = lsp.TextDocumentIdentifier(path.as_uri())
        params = lsp.CodeActionParams(document, where, context)
        found = self.run(self.client.text_document_code_action_async(params))
        return [it for it in found or () if isinstance(it, lsp.CodeAction)]


def codes(shown: list[lsp.Diagnostic]) -> list[str]:
    return [str(it.code) for it in shown]


def at(path: Path, text: str, word: str) -> tuple[lsp.TextDocumentIdentifier, lsp.Position]:
    """Return the place of a word's second character, or of the cursor, ``|`` in it."""
    before, _, after = word.partition("|") if "|" in word else (word[:1], "", word[1:])
    start = text.index(before + after) + len(before)
    lines = text[:start].split("\n")
    units = len(lines[-1].encode("utf-16-le")) // 2
    return lsp.TextDocumentIdentifier(path.as_uri()), lsp.Position(len(lines) - 1, units)


def applied(edit: lsp.WorkspaceEdit | None, opened: dict[Path, str]) -> dict[str, str]:
    """Return the texts that an edit makes, by the names of the files."""
    made = {}
    for uri, edits in ((edit and edit.changes) or {}).items():
        path = Path(to_fs_path(uri) or "")
        lines = (opened.get(path) or path.read_text()).splitlines(keepends=True)
        for it in sorted(edits, key=lambda it: -it.range.start.line):
            assert it.range.start.character == it.range.end.character == 0
            lines[it.range.start.line : it.range.end.line] = [it.new_text]
        made[path.name] = "".join(lines)
    return made


@contextmanager
def edited(folder: Path, *options: str) -> Iterator[Editor]:
    """Yield an editor whose server is stopped in the end, and says so."""
    editor = Editor()
    editor.start(folder, *options)
    try:
        yield editor
    finally:
        assert editor.stop() == 0
