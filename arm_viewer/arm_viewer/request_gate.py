"""Which requests the page answers: those of the page itself, and of programs that are no browser.

The page drives an arm, and every web site that the user visits may open connections to this
machine. Two headers that a site's scripts cannot change tell it apart. A browser sends with every
WebSocket the Origin that asked for it: it must be the page's own. A site may also let its own name
point here ("DNS rebinding") and so become the same origin: its name then stands in Host, so Host
must be a name of this machine.
"""

from urllib.parse import urlsplit

LOOPBACK_NAMES = ("localhost", "127.0.0.1", "::1")

SECURITY_HEADERS = {
    # Everything comes from the page itself, and nobody shows it in a frame to lure clicks.
    "Content-Security-Policy": (
        "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
        "connect-src 'self' data: blob:; frame-ancestors 'none'"
    ),
    "X-Frame-Options": "DENY",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
"""Sent along with the page."""


def reason_to_refuse(hosts: list[str], origins: list[str]) -> str | None:
    """Return in a sentence why a request is refused, or None where it may pass.

    The port is not compared with the server's: a tunnel (`ssh -L`) may have another one at its
    user's end.

    Args:
        hosts: values of its Host headers.
        origins: values of its Origin headers.
    """
    if len(hosts) != 1 or not _is_loopback(hosts[0]):
        return (
            f"this page is only for this machine, not for {_listed(hosts)}; "
            "open it as http://127.0.0.1 or http://localhost with its port"
        )
    if any(origin != f"http://{hosts[0]}" for origin in origins):
        return f"a page of {_listed(origins)} may not use this one, which is http://{hosts[0]}"
    return None


def _is_loopback(host: str) -> bool:
    try:
        return urlsplit(f"//{host}").hostname in LOOPBACK_NAMES
    except ValueError:
        return False


def _listed(values: list[str]) -> str:
    return ", ".join(map(repr, values)) or "a host that is not named"
