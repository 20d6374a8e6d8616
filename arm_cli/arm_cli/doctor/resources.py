"""Checks of resources that must be free: shared memory, and the port of the page."""

import fcntl
import os
import socket
import tempfile
import time
from http.client import HTTPConnection, HTTPException
from pathlib import Path

from arm_cli.doctor.diagnosis import Diagnosis
from arm_cli.names import this_domain

SHARED_MEMORY = Path("/dev/shm")
NEEDED_BYTES = 8 << 20
ROOMY_BYTES = 128 << 20
"""Below this, cameras use smaller buffers. Docker's default is 64 MiB."""
LEAST_AGE_S = 30.0
"""Younger segments are ignored, because a process locks its segment a moment after creating it."""
PREFIX, LOCK_SUFFIX = "fastrtps_", "_el"
HOST, PORT = "127.0.0.1", 8080
HTTP_TIMEOUT_S = 2.0
OWNER_HEADER = "Arm-Suite-Page"
"""A header of the page's answers: its user id and ROS domain."""


def check_shared_memory(folder: Path = SHARED_MEMORY) -> Diagnosis:
    """Check the shared-memory folder of Fast DDS and the cameras.

    It must be writable and have enough space. Segments left by killed processes are reported.
    """
    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            file.write(b"0")
        status = os.statvfs(folder)
    except OSError as error:
        return Diagnosis.error(
            "shared memory",
            f"{folder} cannot be written to: {error.strerror}",
            f"sudo mount -o remount,rw,mode=1777 {folder}; in a container: --shm-size=1g",
        )
    return _judge_space(folder, status.f_bavail * status.f_frsize, _abandoned_segments(folder))


def _judge_space(folder: Path, free_bytes: int, abandoned: list[str]) -> Diagnosis:
    free = f"{free_bytes >> 20} MiB free in {folder}"
    more = f"sudo mount -o remount,size=1g {folder}; in a container: --shm-size=1g"
    if free_bytes < NEEDED_BYTES:
        return Diagnosis.error("shared memory", f"only {free}", more)
    if free_bytes < ROOMY_BYTES:
        return Diagnosis.warning("shared memory", f"{free}: large pictures may be lost", more)
    if abandoned:
        return Diagnosis.warning(
            "shared memory",
            f"{free}; killed ROS processes left {len(abandoned)} segments there, "
            f"such as {abandoned[0]}",
            f"when no ROS program runs: rm -f {folder}/{PREFIX}* {folder}/sem.{PREFIX}*",
        )
    return Diagnosis.ok("shared memory", free)


def _abandoned_segments(folder: Path) -> list[str]:
    locks = sorted(folder.glob(f"{PREFIX}*{LOCK_SUFFIX}"))
    return [lock.name.removesuffix(LOCK_SUFFIX) for lock in locks if _is_abandoned(lock)]


def _is_abandoned(lock: Path) -> bool:
    """Return whether no process holds the lock of a segment; its owner does while it runs."""
    try:
        if time.time() - lock.stat().st_mtime < LEAST_AGE_S:
            return False
        descriptor = os.open(lock, os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return False
    finally:
        os.close(descriptor)
    return True


def check_page_port(port: int = PORT) -> Diagnosis:
    """Check that the page's TCP port is free, or taken by a page of this user and domain."""
    if _is_free(port):
        return Diagnosis.ok("page", f"port {port} is free for the page")
    other = "arm view --port 8081, arm launch viewer:=true viewer_port:=8081"
    owner = _page_owner(port)
    if owner is None:
        return Diagnosis.warning(
            "page",
            f"port {port} is taken by another program",
            f"ss -tlpn 'sport = :{port}' shows which; end it, or use another port for the page: "
            f"{other}",
        )
    user, _, domain = owner.partition(" ")
    strange = [f"user {user}"] * (user != str(os.getuid()))
    strange += [f"ROS_DOMAIN_ID={domain}"] * (f"ROS_DOMAIN_ID={domain}" != this_domain())
    if strange:
        return Diagnosis.warning(
            "page",
            f"the page on http://{HOST}:{port} is that of {' and '.join(strange)}, not of "
            f"user {os.getuid()} on {this_domain()}",
            f"use another port for a page of your own: {other}",
        )
    return Diagnosis.ok("page", f"a page is running on http://{HOST}:{port}")


def _is_free(port: int) -> bool:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        # Ignore remaining connections of a page that has ended.
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except OSError:
            return False
        return True


def _page_owner(port: int) -> str | None:
    """Return the user id and the ROS domain of a page, or None if there is no page."""
    connection = HTTPConnection(HOST, port, timeout=HTTP_TIMEOUT_S)
    try:
        connection.request("GET", "/")
        return connection.getresponse().getheader(OWNER_HEADER)
    except (OSError, HTTPException):
        return None
    finally:
        connection.close()
