"""Finds the DDS participants on this host without DDS, and tells robots from bystanders.

A participant of domain d listens on UDP port 7400 + 250 d + 10 + 2 i, where i is the first free
number (RTPS 2.5, 9.6.2.3), and Fast DDS names its shared-memory ports by the same numbers. So the
kernel's tables show at once whether this host can have other nodes on the ROS graph.

Looking up the ROS graph delays the start of a launch by half a second. A process that only listens,
such as a plotting script, `ros2 topic echo` or RViz, is not worth that delay.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass

from launch_py.fast_dds.shared_memory import SHM_FOLDER, lock_owners

FIRST_PORT, PORTS_OF_DOMAIN, FIRST_UNICAST = 7400, 250, 10
LAST_DOMAIN = 232
UDP_TABLES = ("/proc/net/udp", "/proc/net/udp6")
PID_BITS = 0xFFFF
"""Fast DDS puts only this part of the process id into a participant's GUID."""

_READ_LOCK = re.compile(r"fast(?:rtps|dds)_port(\d+)_el")
_SOCKET = re.compile(r"socket:\[(\d+)\]")


@dataclass(frozen=True, slots=True)
class ParticipantPorts:
    """The ports of one domain on which processes of this host are listening.

    Attributes:
        indices: the numbers i of the participants.
        socket_inodes: the inodes of the UDP sockets.
        owners: the processes that hold the lock of a participant's shared-memory port, by the
            participant's number. A participant without shared memory is not listed.
    """

    indices: frozenset[int]
    socket_inodes: frozenset[int]
    owners: Mapping[int, frozenset[int]]

    @property
    def lock_owners(self) -> frozenset[int]:
        """Every process that holds the lock of a port."""
        return frozenset(pid for pids in self.owners.values() for pid in pids)


def find_ports(domain: int, folder: str = SHM_FOLDER) -> ParticipantPorts:
    """Return the ports of a domain in use on this host, in this network namespace."""
    first = FIRST_PORT + PORTS_OF_DOMAIN * domain + FIRST_UNICAST
    ports = range(first, first + PORTS_OF_DOMAIN - FIRST_UNICAST)
    sockets = {inode: port for port, inode in _udp_sockets() if port in ports}
    owners: dict[int, frozenset[int]] = {}
    for port, pids in _locked_ports(folder):
        if port in ports:
            index = (port - first) // 2
            # The kernel reports 0 for a process in a container that is not visible from here.
            owners[index] = owners.get(index, frozenset()) | pids
    in_tables = frozenset((port - first) // 2 for port in sockets.values())
    return ParticipantPorts(in_tables | owners.keys(), frozenset(sockets), owners)


def domain_of(text: str | None) -> int | None:
    """Return the domain that a value of ROS_DOMAIN_ID stands for, None if it is not a domain."""
    word = (text or "0").strip()
    known = word.isascii() and word.isdigit() and int(word) <= LAST_DOMAIN
    return int(word) if known else None


def own_processes(pid_bits: int, ports: ParticipantPorts) -> list[int]:
    """Return this user's processes with these low bits in their id and a participant on the ports.

    Requiring a port excludes an unrelated process whose id has the same low bits.
    """
    return [
        pid
        for pid in processes_with(pid_bits)
        if _user_of(pid) == os.geteuid() and (pid in ports.lock_owners or _reads(pid, ports))
    ]


def processes_with(pid_bits: int) -> list[int]:
    """Return the living processes whose id ends in these bits."""
    pids = (int(name) for name in os.listdir("/proc") if name.isdigit())
    return [pid for pid in pids if pid & PID_BITS == pid_bits]


def ancestors() -> set[int]:
    """Return this process and all its ancestors."""
    found: set[int] = set()
    pid = os.getpid()
    with suppress(OSError):
        while pid and pid not in found:
            found.add(pid)
            with open(f"/proc/{pid}/stat", encoding="utf-8", errors="replace") as file:
                pid = int(file.read().rpartition(")")[2].split()[1])
    return found


def _udp_sockets() -> Iterator[tuple[int, int]]:
    """Yield port and inode of the UDP sockets of this network namespace; see proc_net_udp(5)."""
    for table in UDP_TABLES:
        with suppress(OSError), open(table, encoding="ascii") as file:
            next(file, None)
            for line in file:
                fields = line.split()
                yield int(fields[1].rpartition(":")[2], 16), int(fields[9])


def _locked_ports(folder: str) -> Iterator[tuple[int, set[int]]]:
    """Yield the ports in shared memory that are locked, and the owners of their locks."""
    owners = lock_owners(folder)
    with suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            match = _READ_LOCK.fullmatch(entry.name)
            if match and entry.inode() in owners:
                yield int(match[1]), owners[entry.inode()]


def _user_of(pid: int) -> int | None:
    with suppress(OSError):
        return os.stat(f"/proc/{pid}").st_uid
    return None


def _reads(pid: int, ports: ParticipantPorts) -> bool:
    """Return whether a process has one of the sockets open."""
    with suppress(OSError), os.scandir(f"/proc/{pid}/fd") as entries:
        for entry in entries:
            with suppress(OSError):
                match = _SOCKET.fullmatch(os.readlink(entry.path))
                if match and int(match[1]) in ports.socket_inodes:
                    return True
    return False


LAUNCHED = b"NOTIFY_SOCKET="
"""Every process that `arm launch` starts has this in its environment."""

ROS_ARGUMENTS = b"--ros-args"
"""Every node that `ros2 launch` starts, and every renamed node, has this on its command line."""


def are_bystanders(ports: ParticipantPorts, names: Iterable[str]) -> bool:
    """Return whether no participant on these ports is likely to have a node with one of the names.

    A bystander is a process of this user that no launch has started and whose command line names
    none of the nodes. A participant whose process is unknown is not a bystander. The names may have
    a namespace.
    """
    if ports.owners.keys() != ports.indices:
        return False
    words = {name.rpartition("/")[2].encode() for name in names} - {b""}
    return all(_is_bystander(pid, words) for pids in ports.owners.values() for pid in pids)


def _is_bystander(pid: int, words: set[bytes]) -> bool:
    folder = f"/proc/{pid}"
    try:
        if os.stat(folder).st_uid != os.geteuid() or LAUNCHED in _content(f"{folder}/environ"):
            return False
        command = _content(f"{folder}/cmdline")
    except OSError:
        return False
    return ROS_ARGUMENTS not in command and not any(word in command for word in words)


def _content(path: str) -> bytes:
    with open(path, "rb") as file:
        return file.read()
