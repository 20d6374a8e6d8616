"""A ROS domain that nobody else on this machine uses."""

import fcntl
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

DOMAINS = range(1, 102)
"""Domain ids whose ports no operating system hands out by itself."""
FIRST_PORT, PORTS_OF_DOMAIN = 7400, 250
"""The first UDP port of domain 0, and the number of ports of a domain (DDSI-RTPS 2.5, 9.6.2.3)."""
FOLDER = "ros-domains"


class NoFreeDomainError(RuntimeError):
    """Every ROS domain is in use; the message says so."""


@contextmanager
def domain_of_its_own() -> Iterator[int]:
    """Return the id of a domain in which nothing on this machine listens, and reserve it.

    Other callers of this function get other domains until the `with` block or the process ends.

    Raises:
        NoFreeDomainError: all of them are in use.
    """
    folder = Path(tempfile.gettempdir()) / f"{FOLDER}-{os.getuid()}"
    folder.mkdir(exist_ok=True)
    busy = _busy_domains()
    for offset in DOMAINS:
        domain = 1 + (os.getpid() + offset) % len(DOMAINS)
        if domain in busy:
            continue
        lock = os.open(folder / str(domain), os.O_CREAT | os.O_RDWR | os.O_CLOEXEC)
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


def _busy_domains() -> set[int]:
    table = Path("/proc/net/udp")
    lines = table.read_text().splitlines()[1:] if table.exists() else []
    ports = (int(line.split()[1].rpartition(":")[2], 16) for line in lines)
    return {(port - FIRST_PORT) // PORTS_OF_DOMAIN for port in ports if port >= FIRST_PORT}
