"""Finds this user's ROS programs on this machine by the ports of the domain that they have open."""

import os
import re
import socket
import struct
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from launch_py.fast_dds.participants import FIRST_PORT, PORTS_OF_DOMAIN, domain_of

DOMAIN, RANGE = "ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE"
STATIC_PEERS = "ROS_STATIC_PEERS"
PROC = Path("/proc")
TCP_LISTEN = "0A"
"""The state of a listening socket in /proc/net/tcp; see the kernel's tcp_states.h."""
STOPPED = ("T", "t")
"""The states in /proc/PID/stat of a process that a signal or a debugger has stopped."""
_NAMED = re.compile(r"sys\.argv\[0\] = '([^']+)'")


@dataclass(frozen=True, slots=True)
class DomainProgram:
    """A process that has sockets of the domain open.

    The addresses are those for the domain and for web pages; `environ` is what it was started with.
    One that is stopped, by Ctrl-Z, SIGSTOP or a debugger, answers nobody until it goes on.
    """

    pid: int
    program: str
    addresses: frozenset[str]
    environ: Mapping[str, str]
    is_stopped: bool = False

    @property
    def on_loopback_only(self) -> bool:
        """Whether only programs on this machine can reach it."""
        return all(address.startswith("127.") for address in self.addresses)

    @property
    def is_meant_for_localhost(self) -> bool:
        """Whether its environment limits discovery to this machine."""
        return self.environ.get(RANGE) == "LOCALHOST" and not self.environ.get(STATIC_PEERS)


def find_listeners(environ: Mapping[str, str], proc: Path = PROC) -> list[DomainProgram]:
    """Return the programs that have a UDP port of the domain open, ordered by process id."""
    ports = ports_of(environ)
    here = _namespace(proc / "self")
    found: list[DomainProgram] = []
    for folder in sorted(proc.glob("[0-9]*"), key=lambda folder: int(folder.name)):
        if int(folder.name) == os.getpid():
            continue
        with suppress(OSError):  # It has ended, or belongs to another user.
            if _namespace(folder) == here:
                found += _listener(folder, ports)
    return found


def describe_stopped(programs: Sequence[DomainProgram]) -> str:
    """Return which programs are stopped, and what lets them go on; empty if none is."""
    stopped = [one for one in programs if one.is_stopped]
    if not stopped:
        return ""
    which = ", ".join(f"{one.program} ({one.pid})" for one in stopped)
    resume = " ".join(str(one.pid) for one in stopped)
    are, answers = ("are", "answer") if len(stopped) > 1 else ("is", "answers")
    return f"{which} {are} stopped and {answers} nobody until `kill -CONT {resume}`"


def _listener(folder: Path, ports: range) -> Iterator[DomainProgram]:
    inodes = set(_socket_inodes(folder))
    udp = {address for address, port, _ in _sockets(folder / "net/udp", inodes) if port in ports}
    if udp:
        tcp = {
            f"{address}:{port}"
            for address, port, state in _sockets(folder / "net/tcp", inodes)
            if state == TCP_LISTEN
        }
        environ = _pairs((folder / "environ").read_bytes())
        state = (folder / "stat").read_text().rpartition(")")[2].split()[0]
        yield DomainProgram(
            int(folder.name),
            _program(folder),
            frozenset(udp | tcp),
            environ,
            is_stopped=state in STOPPED,
        )


def ports_of(environ: Mapping[str, str]) -> range:
    """Return the ports of the domain, or those of domain 0 if the variable is not valid."""
    first = domain_port(environ) or FIRST_PORT
    return range(first, first + PORTS_OF_DOMAIN)


def domain_port(environ: Mapping[str, str]) -> int | None:
    """Return the first UDP port of the domain, by the RTPS specification 9.6.2.1.

    Return None if ROS_DOMAIN_ID is not valid.
    """
    domain = domain_of(environ.get(DOMAIN))
    return None if domain is None else FIRST_PORT + PORTS_OF_DOMAIN * domain


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
