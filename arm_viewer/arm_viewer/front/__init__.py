"""viser's page with the project's title, icon, scripts, parts, and every style of this folder."""

import re
from functools import cache
from importlib.resources import files
from urllib.parse import quote

TITLE = "Arm suite"
SCRIPTS = (
    "software_rendering.js",
    "every_message.js",
    "elements.js",
    "link.js",
    "channel.js",
    "poses.js",
    "typed_numbers.js",
    "time_bar.js",
    "timeline.js",
    "dock.js",
    "curve_store.js",
    "chart.js",
    "plots.js",
    "observe.js",
    "calls.js",
    "world.js",
    "picture.js",
    "view_from.js",
    "keys.js",
)
READ_ONLY_SCRIPTS = ("read_only.js",)
"""Only for browsers that may not change anything; first, because what it stops must not act."""
PARTS = ("time_bar.html", "dock.html", "picture.html", "view_from.html", "timeline.html")
_ICON = re.compile(r'<link\s+rel="icon"\s[^>]*>', re.DOTALL)
_TITLE = re.compile(r"<title>[^<]*</title>")
_FRONT = files("arm_viewer.front")
_HEAD_END, _BODY = "</head>", "<body>"


@cache
def served_page(html: str, is_read_only: bool = False) -> str:
    """Return viser's index.html with the project's additions; a browser may be let to look only."""
    icon = f'<link rel="icon" href="data:image/svg+xml,{quote(_read_asset("icon.svg"))}" />'
    scripts = "".join(
        f"<script>{_read_asset(name)}</script>"
        for name in READ_ONLY_SCRIPTS * is_read_only + SCRIPTS
    )
    names = sorted(file.name for file in _FRONT.iterdir() if file.name.endswith(".css"))
    styles = "".join(f"<style>{_read_asset(name)}</style>" for name in names)
    parts = "".join(_read_asset(name) for name in PARTS)
    # A function, because `sub` would interpret backslashes in a replacement string.
    html = _ICON.sub(lambda _: icon, html, count=1)
    html = _TITLE.sub(lambda _: f"<title>{TITLE}</title>", html, count=1)
    head, end, rest = html.partition(_HEAD_END)
    before, body, after = rest.partition(_BODY)
    return f"{head}{styles}{scripts}{end}{before}{body}{parts}{after}"


def _read_asset(name: str) -> str:
    return _FRONT.joinpath(name).read_text(encoding="utf-8")
