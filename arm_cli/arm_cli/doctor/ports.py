"""Do the datagrams by which ROS programs find each other pass?"""

import contextlib
import errno
import socket
from collections.abc import Mapping
from dataclasses import dataclass

from arm_cli.doctor.discovery import DOMAIN, LARGEST_DOMAIN, RANGE
from arm_cli.doctor.finding import Finding

NAME = "ports"
FIRST_PORT, PORTS_OF_DOMAIN = 7400, 250
"""The port of a domain's announcements, by the RTPS specification 9.6.2.1."""
PATIENCE_S = 1.0


@dataclass(frozen=True, slots=True)
class Ports:
    """Sends datagrams to itself, as Fast DDS will: by the loopback interface and by multicast.

    Attributes:
        environ: says which domain, and how far its programs shall be found.
        here: address of this machine for itself.
        group: address for announcements.
    """

    environ: Mapping[str, str]
    here: str = "127.0.0.1"
    group: str = "239.255.0.1"

    def examine(self) -> Finding:
        """Look at the loopback interface, then at the domain's port for announcements."""
        if not _arrives(self.here, 0):
            return Finding.error(
                NAME,
                f"what is sent to {self.here} does not arrive: nobody finds anybody, not even here",
                "sudo ip link set lo up; look for a firewall: sudo nft list ruleset",
            )
        port = self._port()
        if port is None:
            return Finding.ok(NAME, f"datagrams arrive on {self.here}")
        return self._announcements(port)

    def _announcements(self, port: int) -> Finding:
        reach = self.environ.get(RANGE, "")
        if not _may_be_shared(port):
            return self._taken(port, reach)
        if reach == "SUBNET" and not _arrives(self.group, port):
            return Finding.warning(
                NAME,
                f"multicast to {self.group} does not arrive: other hosts are not found",
                "look for a firewall, or a network without multicast (some containers and WLANs); "
                "export ROS_STATIC_PEERS=HOST names hosts one by one",
            )
        return Finding.ok(NAME, f"UDP port {port} is there for announcements")

    def _taken(self, port: int, reach: str) -> Finding:
        sentence = f"UDP port {port}, for announcements in domain {self._domain()}, is taken"
        fix = f"ss -ulpn 'sport = :{port}' shows by whom; or export {DOMAIN}=another"
        if reach == "LOCALHOST":
            return Finding.ok(NAME, f"{sentence}; on this machine it is not needed")
        if reach == "SUBNET":
            return Finding.error(NAME, f"{sentence}: nobody finds anybody", fix)
        sentence = f"{sentence}: programs without {RANGE}=LOCALHOST do not find each other"
        return Finding.warning(NAME, sentence, fix)

    def _domain(self) -> int | None:
        text = self.environ.get(DOMAIN) or "0"
        known = text.isascii() and text.isdigit() and int(text) <= LARGEST_DOMAIN
        return int(text) if known else None

    def _port(self) -> int | None:
        """Return the port of the domain, None where there is no such domain."""
        domain = self._domain()
        return None if domain is None else FIRST_PORT + PORTS_OF_DOMAIN * domain


def _may_be_shared(port: int) -> bool:
    """Return whether the port is free, or held by programs that share it, as Fast DDS does."""
    with _socket() as probe:
        try:
            probe.bind(("", port))
        except OSError as error:
            return error.errno != errno.EADDRINUSE
        return True


def _arrives(address: str, port: int) -> bool:
    """Return whether a datagram to an address comes back; port 0 takes any."""
    with _socket() as receiver, _socket() as sender:
        try:
            receiver.bind(("" if port else address, port))
            if port:
                group = socket.inet_aton(address) + socket.inet_aton("0.0.0.0")
                receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group)
            receiver.settimeout(PATIENCE_S)
            sender.bind(("", 0))
            token = f"arm doctor {sender.getsockname()[1]}".encode()
            sender.sendto(token, (address, receiver.getsockname()[1]))
            # On the domain's port others' announcements come, too.
            while receiver.recv(len(token)) != token:
                pass
        except OSError:
            return False
    return True


def _socket() -> "contextlib.closing[socket.socket]":
    shared = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    for option in (socket.SO_REUSEADDR, socket.SO_REUSEPORT):
        shared.setsockopt(socket.SOL_SOCKET, option, 1)
    return contextlib.closing(shared)
