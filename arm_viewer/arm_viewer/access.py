"""Who may open the page, and who may only look at it."""

import hmac
import ipaddress
import re
import secrets
import socket
from dataclasses import dataclass
from enum import Enum
from urllib.parse import parse_qsl, urlencode, urlsplit

from websockets.datastructures import Headers

from arm_viewer.errors import PageError

LOCAL_HOST = "127.0.0.1"
LOOPBACK_NAMES = ("localhost", LOCAL_HOST, "::1")
ALL_ADDRESSES = ("0.0.0.0", "::")
PARAMETER = "token"
"""The parameter of the address that has the token."""
TOKEN_BYTES = 16
TOKEN_VARIABLE = "ARM_VIEW_TOKEN"
"""The environment variable that names the token, so that it survives a restart of the page.

Other users of the machine and of the graph can read arguments and parameters, but not this.
"""
_TOKEN = re.compile(r"[A-Za-z0-9_-]{16,128}")
_OTHER_NETWORK = ("192.0.2.1", 9)
"""An address that no machine has (RFC 5737)."""


class Role(Enum):
    """What the sender of a request may do."""

    STRANGER = "stranger"
    VIEWER = "viewer"
    """Sees the page, and can change nothing."""
    USER = "user"


@dataclass(frozen=True, slots=True)
class Access:
    """The rule of one page; any thread may use it.

    A page of this machine alone needs no token. Any other has a token for the whole page, or none
    if it is read-only, and another one for looking.

    Attributes:
        host: the address that the page listens on.
        is_read_only: whether everybody may only look.
        token: for the whole page; "" where there is none.
        read_only_token: for looking; "" where there is none.
    """

    host: str = LOCAL_HOST
    is_read_only: bool = False
    token: str = ""
    read_only_token: str = ""

    @classmethod
    def on(cls, host: str, is_read_only: bool = False, token: str = "") -> "Access":
        """Return the rule for a page on an address, with tokens if others can reach it.

        Args:
            host: the address.
            is_read_only: whether everybody may only look.
            token: for the whole page; a new one by default. That for looking is made from it,
                and does not reveal it.

        Raises:
            PageError: the token is too short, or does not fit into an address.
        """
        if is_loopback(host):
            return cls(host, is_read_only)
        if token and not _TOKEN.fullmatch(token):
            raise PageError(
                f"the token in {TOKEN_VARIABLE} is not 16 to 128 letters, digits, - and _; "
                "`openssl rand -hex 16` makes one"
            )
        token = token or secrets.token_urlsafe(TOKEN_BYTES)
        for_looking = hmac.digest(token.encode(), b"read only", "sha256")[:TOKEN_BYTES].hex()
        return cls(host, is_read_only, "" if is_read_only else token, for_looking)

    @property
    def needs_token(self) -> bool:
        """Whether a browser must show a token."""
        return bool(self.token or self.read_only_token)

    def role(self, path: str, headers: Headers, cookie: str) -> Role:
        """Return what the sender of a request may do.

        Args:
            path: the request's path with its query.
            headers: the request's headers.
            cookie: the name of the page's cookie.
        """
        if not self.needs_token:
            return Role.VIEWER if self.is_read_only else Role.USER
        roles = (self.role_of(offered) for offered in _offered(path, headers, cookie))
        return next((role for role in roles if role is not Role.STRANGER), Role.STRANGER)

    def role_of(self, offered: str) -> Role:
        """Return the role that a token gives; the time taken does not depend on the token."""
        is_user = _is_equal(offered, self.token)
        is_viewer = _is_equal(offered, self.read_only_token)
        if is_user:
            return Role.USER
        return Role.VIEWER if is_viewer else Role.STRANGER

    def reason_to_refuse(self, hosts: list[str], origins: list[str]) -> str | None:
        """Return why a request is refused, in a sentence, or None to accept it.

        The page drives an arm, and every web site that the user visits could open connections to
        this machine. Two headers that a site's scripts cannot change identify such a site. A
        browser sends the Origin with every WebSocket request, and it must be the page's own. A
        site may also point its own name to this machine ("DNS rebinding") and so become the same
        origin. Its name is then in the Host header, so Host must be a name of this machine, or an
        address where the page is not for this machine alone. Other programs are accepted.

        The port is not compared with the server's, because a tunnel (`ssh -L`) may have another
        one at the user's end.

        Args:
            hosts: values of the request's Host headers.
            origins: values of the request's Origin headers.
        """
        if len(hosts) != 1 or not self._is_own_name(hosts[0]):
            whose, names = "this machine", "http://127.0.0.1 or http://localhost"
            if not is_loopback(self.host):
                whose = f"names and addresses of {socket.gethostname()}"
                names = f"http://{shown_host(self.host)}"
            return (
                f"this page is only for {whose}, not for {_listed(hosts)}; open it as {names} with "
                "its port"
            )
        if any(origin != f"http://{hosts[0]}" for origin in origins):
            return f"a page of {_listed(origins)} may not use this one, which is http://{hosts[0]}"
        return None

    def _is_own_name(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        if name in (*LOOPBACK_NAMES, self.host):
            return True
        if is_loopback(self.host):
            return False
        own = socket.gethostname().lower()
        return name in (own, f"{own}.local") or _is_address(name)


def is_loopback(host: str) -> bool:
    """Return whether only this machine reaches what listens on an address."""
    return host in LOOPBACK_NAMES or (_is_address(host) and ipaddress.ip_address(host).is_loopback)


def shown_host(host: str) -> str:
    """Return a listening address as it stands in a URL that others open."""
    name = _outward_address() if host in ALL_ADDRESSES else host
    return f"[{name}]" if ":" in name else name


def without_token(path: str) -> str:
    """Return a path without the token in its query."""
    address = urlsplit(path)
    kept = [(n, v) for n, v in parse_qsl(address.query, True) if n != PARAMETER]
    return f"/?{urlencode(kept)}" if kept else "/"


def has_token(path: str) -> bool:
    """Return whether a path's query has a token, valid or not."""
    return any(name == PARAMETER for name, _ in parse_qsl(path.partition("?")[2]))


def _outward_address() -> str:
    """Return this machine's address in its network, without sending anything."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(_OTHER_NETWORK)
        except OSError:
            # Without a network.
            return socket.gethostname()
        return probe.getsockname()[0]


def _offered(path: str, headers: Headers, cookie: str) -> list[str]:
    """Return the tokens of a request; the one in the address comes first."""
    found = [value for name, value in parse_qsl(path.partition("?")[2]) if name == PARAMETER]
    for part in ";".join(headers.get_all("Cookie")).split(";"):
        name, _, value = part.strip().partition("=")
        if name == cookie:
            found.append(value)
    return found


def _is_equal(offered: str, token: str) -> bool:
    return bool(token) & hmac.compare_digest(offered.encode(errors="replace"), token.encode())


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _listed(values: list[str]) -> str:
    return ", ".join(map(repr, values)) or "an unnamed host"
