"""The ROS domains in use on this machine: by other users, and one that nobody uses."""

import fcntl
import os
import pwd
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

DOMAINS = range(1, 102)
"""Domain ids whose ports no operating system hands out by itself."""
FIRST_PORT, PORTS_OF_DOMAIN = 7400, 250
"""The first UDP port of domain 0, and the number of ports of a domain (DDSI-RTPS 2.5, 9.6.2.3)."""
MULTICAST_PORTS = 10
"""The first ports of a domain; those of participants follow."""
UDP_SOCKETS = Path("/proc/net/udp")
FOLDER = "ros-domains"


class NoFreeDomainError(RuntimeError):
    """No ROS domain can be reserved; the message says why."""


@contextmanager
def domain_of_its_own() -> Iterator[int]:
    """Return the id of a domain in which nothing on this machine listens, and reserve it.

    Other callers of this function get other domains until the `with` block or the process ends.

    Raises:
        NoFreeDomainError: all of them are in use, or the folder of their locks is not usable.
    """
    folder = Path(tempfile.gettempdir()) / f"{FOLDER}-{os.getuid()}"
    busy = _busy_domains()
    for offset in DOMAINS:
        domain = 1 + (os.getpid() + offset) % len(DOMAINS)
        if domain in busy:
            continue
        try:
            folder.mkdir(exist_ok=True)
            lock = os.open(folder / str(domain), os.O_CREAT | os.O_RDWR | os.O_CLOEXEC)
        except OSError as error:
            raise NoFreeDomainError(
                f"cannot reserve a ROS domain in {folder}: {error.strerror}; remove it, or set "
                "TMPDIR to a folder of yours"
            ) from error
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            os.close(lock)
            continue
        try:
            yield domain
        finally:
            os.close(lock)
        return
    raise NoFreeDomainError(f"all ROS domains from {DOMAINS[0]} to {DOMAINS[-1]} are in use")


def other_users(domain: int, table: Path = UDP_SOCKETS) -> list[str]:
    """Return the names of the users, except this one, whose programs listen in a domain.

    Fast DDS's shared memory can be opened by its owner only, so programs of two users discover each
    other, and then no message arrives. Nothing is known about domains whose ports the system hands
    out.
    """
    if domain and domain not in DOMAINS:
        return []
    first = FIRST_PORT + PORTS_OF_DOMAIN * domain
    ports = range(first + MULTICAST_PORTS, first + PORTS_OF_DOMAIN)
    users = {user for port, user in _udp_sockets(table) if port in ports} - {os.getuid()}
    return sorted(_user_name(user) for user in users)


def describe_users(users: Sequence[str]) -> str:
    """Return a sentence about other users whose programs listen in this domain."""
    who = f"users {', '.join(users)} run" if len(users) > 1 else f"user {users[0]} runs"
    return (
        f"{who} ROS programs in this ROS domain, too: they and yours discover each other, but "
        "no message passes, because shared memory belongs to one user"
    )


def _user_name(user: int) -> str:
    try:
        return pwd.getpwuid(user).pw_name
    except KeyError:
        return f"with id {user}"


def _busy_domains() -> set[int]:
    ports = [port for port, _ in _udp_sockets(UDP_SOCKETS)]
    return {(port - FIRST_PORT) // PORTS_OF_DOMAIN for port in ports if port >= FIRST_PORT}


def _udp_sockets(table: Path) -> Iterator[tuple[int, int]]:
    """Yield the port of each UDP socket, and the id of its user."""
    for line in table.read_text().splitlines()[1:] if table.exists() else []:
        fields = line.split()
        yield int(fields[1].rpartition(":")[2], 16), int(fields[7])
