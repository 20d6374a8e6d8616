"""The checks on who listens in the domain: this user's ROS programs, and where, and other users."""

import os
import re
import socket
import struct
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from arm_cli.doctor.diagnosis import Diagnosis
from arm_cli.doctor.discovery import RANGE, domain_port
from arm_node.ros_domain import UDP_SOCKETS, describe_users, other_users
from launch_py.fast_dds.participants import FIRST_PORT, PORTS_OF_DOMAIN

PROC = Path("/proc")
TCP_LISTEN = "0A"
"""The state of a listening socket in /proc/net/tcp; see the kernel's tcp_states.h."""
STATIC_PEERS = "ROS_STATIC_PEERS"
_NAMED = re.compile(r"sys\.argv\[0\] = '([^']+)'")


@dataclass(frozen=True, slots=True)
class _Listener:
    """A process that has sockets of the domain open.

    Attributes:
        pid: its process id.
        program: the program's name for the user.
        addresses: the addresses on which it listens, for the domain and for web pages.
        environ: the environment variables that it was started with.
    """

    pid: int
    program: str
    addresses: frozenset[str]
    environ: Mapping[str, str]

    @property
    def on_loopback_only(self) -> bool:
        """Whether only programs on this machine can reach it."""
        return all(address.startswith("127.") for address in self.addresses)

    @property
    def is_meant_for_localhost(self) -> bool:
        """Whether its environment limits discovery to this machine."""
        return self.environ.get(RANGE) == "LOCALHOST" and not self.environ.get(STATIC_PEERS)


def check_listening(environ: Mapping[str, str], proc: Path = PROC) -> Diagnosis:
    """List this user's ROS programs that listen on loopback only, and those that listen elsewhere.

    Args:
        environ: the environment, which sets the domain.
        proc: the mount point of proc(5).
    """
    listeners = find_listeners(environ, proc)
    if not listeners:
        return Diagnosis.ok("listening", "no ROS program of yours listens in this domain")
    exposed = [one for one in listeners if not one.on_loopback_only]
    sentence = "; ".join(filter(None, (_inside(listeners), _outside(exposed))))
    mistaken = [one for one in exposed if one.is_meant_for_localhost]
    if mistaken:
        return Diagnosis.warning(
            "listening",
            f"{sentence}. {_names(mistaken)}: despite {RANGE}=LOCALHOST a host that names "
            f"this one in {STATIC_PEERS} can listen to it and command it",
            "start it with 'arm run PACKAGE PROGRAM' or 'arm launch', which limit it to 127.0.0.1",
        )
    return Diagnosis.ok("listening", sentence)


def check_users(environ: Mapping[str, str], table: Path = UDP_SOCKETS) -> Diagnosis:
    """Name the other users whose programs are in the same domain, whom no message reaches."""
    domain = (_ports(environ).start - FIRST_PORT) // PORTS_OF_DOMAIN
    users = other_users(domain, table)
    if not users:
        return Diagnosis.ok("users", "no other user of this machine is in this domain")
    return Diagnosis.warning(
        "users",
        describe_users(users),
        "export another ROS_DOMAIN_ID, from 0 to 101, or run everything as one user",
    )


def find_listeners(environ: Mapping[str, str], proc: Path = PROC) -> list[_Listener]:
    """Return the programs that have a UDP port of the domain open, ordered by process id."""
    ports = _ports(environ)
    here = _namespace(proc / "self")
    found: list[_Listener] = []
    for folder in sorted(proc.glob("[0-9]*"), key=lambda folder: int(folder.name)):
        if int(folder.name) == os.getpid():
            continue
        with suppress(OSError):  # It has ended, or belongs to another user.
            if _namespace(folder) == here:
                found += _listener(folder, ports)
    return found


def _listener(folder: Path, ports: range) -> Iterator[_Listener]:
    inodes = set(_socket_inodes(folder))
    udp = {address for address, port, _ in _sockets(folder / "net/udp", inodes) if port in ports}
    if udp:
        tcp = {
            f"{address}:{port}"
            for address, port, state in _sockets(folder / "net/tcp", inodes)
            if state == TCP_LISTEN
        }
        environ = _pairs((folder / "environ").read_bytes())
        yield _Listener(int(folder.name), _program(folder), frozenset(udp | tcp), environ)


def _ports(environ: Mapping[str, str]) -> range:
    """Return the ports of the domain, or those of domain 0 if the variable is not valid."""
    first = domain_port(environ) or FIRST_PORT
    return range(first, first + PORTS_OF_DOMAIN)


def _inside(listeners: list[_Listener]) -> str:
    local = [one for one in listeners if one.on_loopback_only]
    return f"on 127.0.0.1 only: {_names(local)}" if local else ""


def _outside(listeners: list[_Listener]) -> str:
    places = sorted({a for one in listeners for a in one.addresses if not a.startswith("127.")})
    return f"on {', '.join(places)}: {_names(listeners)}" if listeners else ""


def _names(listeners: list[_Listener]) -> str:
    return ", ".join(f"{one.program} ({one.pid})" for one in listeners)


def _namespace(folder: Path) -> str:
    return os.readlink(folder / "ns/net")


def _socket_inodes(folder: Path) -> Iterator[str]:
    for descriptor in os.listdir(folder / "fd"):
        with suppress(OSError):
            target = os.readlink(folder / "fd" / descriptor)
            if target.startswith("socket:["):
                yield target[len("socket:[") : -1]


def _sockets(table: Path, inodes: set[str]) -> Iterator[tuple[str, int, str]]:
    """Yield address, port and state of a process's own rows of /proc/PID/net/udp or tcp."""
    for row in table.read_text().splitlines()[1:]:
        fields = row.split()
        if fields[9] in inodes:
            address, _, port = fields[1].partition(":")
            packed = struct.pack("=I", int(address, 16))
            yield socket.inet_ntoa(packed), int(port, 16), fields[3]


def _pairs(block: bytes) -> dict[str, str]:
    words = (os.fsdecode(word).partition("=") for word in block.split(b"\0"))
    return {name: value for name, _, value in words}


def _program(folder: Path) -> str:
    """Return the name of a program; for an interpreter, that of its script or module."""
    words = [os.fsdecode(w) for w in (folder / "cmdline").read_bytes().split(b"\0") if w]
    program = os.path.basename(words[0]) if words else "a program"
    if not program.startswith("python"):
        return program
    if "-c" in words[:-1]:
        # The launcher runs entry points this way, and sets sys.argv[0] to the program's name.
        named = _NAMED.search(words[words.index("-c") + 1])
        return named[1] if named else f"{program} -c"
    return next((os.path.basename(w) for w in words[1:] if not w.startswith("-")), program)
