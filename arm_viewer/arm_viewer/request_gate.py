"""Decide which requests the page accepts: its own, and those of programs other than browsers.

The page drives an arm, and every web site that the user visits could open connections to this
machine. Two headers that a site's scripts cannot change identify such a site. A browser sends the
Origin with every WebSocket request, and it must be the page's own. A site may also point its own
name to this machine ("DNS rebinding") and so become the same origin. Its name is then in the Host
header, so Host must be a name of this machine.
"""

from urllib.parse import urlsplit

LOOPBACK_NAMES = ("localhost", "127.0.0.1", "::1")

SECURITY_HEADERS = {
    # All content comes from the page itself, and no site may embed it in a frame (clickjacking).
    "Content-Security-Policy": (
        "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; "
        "connect-src 'self' data: blob:; frame-ancestors 'none'"
    ),
    "X-Frame-Options": "DENY",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
"""Headers of every response."""


def reason_to_refuse(hosts: list[str], origins: list[str]) -> str | None:
    """Return why a request is refused, in a sentence, or None to accept it.

    The port is not compared with the server's, because a tunnel (`ssh -L`) may have another one at
    the user's end.

    Args:
        hosts: values of the request's Host headers.
        origins: values of the request's Origin headers.
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
    return ", ".join(map(repr, values)) or "an unnamed host"
