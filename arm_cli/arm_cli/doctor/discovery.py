"""Checks of discovery: its environment variables and its datagrams."""

import contextlib
import errno
import socket
from collections.abc import Mapping

from arm_cli.doctor.diagnosis import Diagnosis
from launch_py.fast_dds.participants import FIRST_PORT, LAST_DOMAIN, PORTS_OF_DOMAIN, domain_of

LAST_SAFE_DOMAIN = 101
RANGES = ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT")
MIDDLEWARE = "rmw_fastrtps_cpp"
DOMAIN, RANGE = "ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE"
LOOPBACK, MULTICAST_GROUP = "127.0.0.1", "239.255.0.1"
RECEIVE_TIMEOUT_S = 1.0


def check_discovery(environ: Mapping[str, str]) -> Diagnosis:
    """Check the environment variables that decide which programs find each other."""
    fault = _domain_fault(environ) or _range_fault(environ) or _middleware_fault(environ)
    if fault is not None:
        return fault
    domain = environ.get(DOMAIN) or "0"
    reach = environ.get(RANGE) or "not set (LOCALHOST in arm launch, else SUBNET)"
    return Diagnosis.ok("discovery", f"{DOMAIN} {domain}, range {reach}")


def _domain_fault(environ: Mapping[str, str]) -> Diagnosis | None:
    text = environ.get(DOMAIN, "")
    unset = f"export {DOMAIN}=0, the same number in every terminal"
    if not text:
        return None
    domain = domain_of(text)
    if domain is None:
        return Diagnosis.error(
            "discovery", f"{DOMAIN} is {text!r}, not a number from 0 to {LAST_DOMAIN}", unset
        )
    if domain > LAST_SAFE_DOMAIN:
        return Diagnosis.warning(
            "discovery",
            f"{DOMAIN} is {text}: Linux may give its ports to other programs; 0 to "
            f"{LAST_SAFE_DOMAIN} are safe",
            unset,
        )
    return None


def _range_fault(environ: Mapping[str, str]) -> Diagnosis | None:
    text = environ.get(RANGE, "")
    if text == "OFF":
        return Diagnosis.error(
            "discovery",
            f"{RANGE} is OFF: programs do not find each other",
            f"export {RANGE}=LOCALHOST",
        )
    if text and text not in RANGES:
        return Diagnosis.error(
            "discovery",
            f"{RANGE} is {text!r}; the choices are {', '.join(RANGES)}",
            f"export {RANGE}=LOCALHOST, or SUBNET for other hosts and containers",
        )
    return None


def _middleware_fault(environ: Mapping[str, str]) -> Diagnosis | None:
    text = environ.get("RMW_IMPLEMENTATION") or MIDDLEWARE
    if text == MIDDLEWARE:
        return None
    return Diagnosis.error(
        "discovery",
        f"RMW_IMPLEMENTATION is {text!r}; the wheels have {MIDDLEWARE} only",
        "unset RMW_IMPLEMENTATION",
    )


def check_ports(
    environ: Mapping[str, str], here: str = LOOPBACK, group: str = MULTICAST_GROUP
) -> Diagnosis:
    """Send datagrams to this process as Fast DDS does, over loopback and by multicast.

    Args:
        environ: the environment, which sets the domain and the discovery range.
        here: the loopback address.
        group: the multicast address of announcements.
    """
    if not _arrives(here, 0):
        return Diagnosis.error(
            "ports",
            f"datagrams to {here} do not arrive: programs do not find each other, not even here",
            "sudo ip link set lo up; look for a firewall: sudo nft list ruleset",
        )
    port = domain_port(environ)
    if port is None:
        return Diagnosis.ok("ports", f"datagrams arrive on {here}")
    return _check_announcements(environ, group, port)


def _check_announcements(environ: Mapping[str, str], group: str, port: int) -> Diagnosis:
    reach = environ.get(RANGE, "")
    if not _may_be_shared(port):
        return _describe_taken(environ, port, reach)
    if reach == "SUBNET" and not _arrives(group, port):
        return Diagnosis.warning(
            "ports",
            f"multicast to {group} does not arrive: programs on other hosts are not found",
            "look for a firewall, or a network without multicast (some containers and WLANs); "
            "export ROS_STATIC_PEERS=HOST names hosts one by one",
        )
    return Diagnosis.ok("ports", f"UDP port {port} is available for announcements")


def _describe_taken(environ: Mapping[str, str], port: int, reach: str) -> Diagnosis:
    sentence = (
        f"UDP port {port}, for announcements in domain {domain_of(environ.get(DOMAIN))}, is taken"
    )
    fix = f"ss -ulpn 'sport = :{port}' shows the program; or choose another {DOMAIN}"
    if reach == "LOCALHOST":
        return Diagnosis.ok("ports", f"{sentence}; on this machine it is not needed")
    if reach == "SUBNET":
        return Diagnosis.error("ports", f"{sentence}: programs do not find each other", fix)
    sentence = f"{sentence}: programs without {RANGE}=LOCALHOST do not find each other"
    return Diagnosis.warning("ports", sentence, fix)


def domain_port(environ: Mapping[str, str]) -> int | None:
    """Return the first UDP port of the domain, by the RTPS specification 9.6.2.1.

    Return None if ROS_DOMAIN_ID is not valid.
    """
    domain = domain_of(environ.get(DOMAIN))
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
    """Return whether a datagram to an address arrives; port 0 means any port."""
    with _socket() as receiver, _socket() as sender:
        try:
            receiver.bind(("" if port else address, port))
            if port:
                group = socket.inet_aton(address) + socket.inet_aton("0.0.0.0")
                receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group)
            receiver.settimeout(RECEIVE_TIMEOUT_S)
            sender.bind(("", 0))
            token = f"arm doctor {sender.getsockname()[1]}".encode()
            sender.sendto(token, (address, receiver.getsockname()[1]))
            # Announcements of other programs also arrive on the domain's port.
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
