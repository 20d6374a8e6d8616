"""Add the project's title, icon and scripts to viser's page."""

import re
from functools import cache
from importlib.resources import files
from urllib.parse import quote

TITLE = "Arm suite"
SCRIPTS = ("typed_numbers.js", "quiet.js")
_ICON = re.compile(r'<link\s+rel="icon"\s[^>]*>', re.DOTALL)
_TITLE = re.compile(r"<title>[^<]*</title>")
_HEAD_END = "</head>"


@cache
def served_page(html: str) -> str:
    """Return viser's page with the project's additions.

    Args:
        html: viser's index.html.
    """
    icon = f'<link rel="icon" href="data:image/svg+xml,{quote(_read("icon.svg"))}" />'
    scripts = "".join(f"<script>{_read(name)}</script>" for name in SCRIPTS)
    own = f"<style>{_read('page.css')}</style>{scripts}"
    # A function, because `sub` would interpret backslashes in a replacement string.
    html = _ICON.sub(lambda _: icon, html, count=1)
    html = _TITLE.sub(lambda _: f"<title>{TITLE}</title>", html, count=1)
    head, end, rest = html.partition(_HEAD_END)
    return f"{head}{own}{end}{rest}"


def _read(name: str) -> str:
    return files("arm_viewer.front").joinpath(name).read_text(encoding="utf-8")
