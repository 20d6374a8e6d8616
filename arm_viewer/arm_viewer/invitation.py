"""What the page's process prints for those who may open the page with a token."""

import io
import os
from typing import TextIO

import segno

from arm_viewer.page_server import PageServer


def invitation(server: PageServer, terminal: TextIO) -> str:
    """Return the addresses of a page that needs a token, and the first one as a QR code.

    Args:
        server: serves the page.
        terminal: where it will be printed; the code needs a terminal that is wide enough.
    """
    access = server.access
    urls = [server.url_with(token) for token in (access.token, access.read_only_token) if token]
    words = ["the page is at", "the page is, for looking only, at"][-len(urls) :]
    lines = [f"{word} {url}\n" for word, url in zip(words, urls, strict=True)]
    return "".join(lines) + _qr_code(urls[0], terminal)


def _qr_code(text: str, terminal: TextIO) -> str:
    if not terminal.isatty():
        return ""
    code = segno.make(text, error="l")
    if os.get_terminal_size(terminal.fileno()).columns < code.symbol_size()[0]:
        return ""
    drawn = io.StringIO()
    code.terminal(drawn, compact=True)
    return drawn.getvalue()
