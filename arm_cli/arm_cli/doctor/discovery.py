"""Can this shell's programs and the simulation find each other?"""

from collections.abc import Mapping
from dataclasses import dataclass

from arm_cli.doctor.finding import Finding

NAME = "discovery"
LARGEST_DOMAIN, LAST_SAFE_DOMAIN = 232, 101
RANGES = ("SUBNET", "LOCALHOST", "OFF", "SYSTEM_DEFAULT")
MIDDLEWARE = "rmw_fastrtps_cpp"
DOMAIN, RANGE = "ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE"


@dataclass(frozen=True, slots=True)
class Discovery:
    """Looks at the variables that decide who hears whom."""

    environ: Mapping[str, str]

    def examine(self) -> Finding:
        """Look at the domain, the range and the middleware."""
        return self._domain() or self._range() or self._middleware() or self._all_well()

    def _domain(self) -> Finding | None:
        text = self.environ.get(DOMAIN, "")
        unset = f"export {DOMAIN}=0, the same number in every terminal"
        if not text:
            return None
        if not (text.isascii() and text.isdigit()) or int(text) > LARGEST_DOMAIN:
            return Finding.error(
                NAME, f"{DOMAIN} is {text!r}, no number from 0 to {LARGEST_DOMAIN}", unset
            )
        if int(text) > LAST_SAFE_DOMAIN:
            return Finding.warning(
                NAME,
                f"{DOMAIN} is {text}: Linux may give its ports to other programs; 0 to "
                f"{LAST_SAFE_DOMAIN} are safe",
                unset,
            )
        return None

    def _range(self) -> Finding | None:
        text = self.environ.get(RANGE, "")
        if text == "OFF":
            return Finding.error(
                NAME, f"{RANGE} is OFF: nobody finds anybody", f"export {RANGE}=LOCALHOST"
            )
        if text and text not in RANGES:
            return Finding.error(
                NAME,
                f"{RANGE} is {text!r}; there are {', '.join(RANGES)}",
                f"export {RANGE}=LOCALHOST, or SUBNET for other hosts and containers",
            )
        return None

    def _middleware(self) -> Finding | None:
        text = self.environ.get("RMW_IMPLEMENTATION") or MIDDLEWARE
        if text == MIDDLEWARE:
            return None
        return Finding.error(
            NAME,
            f"RMW_IMPLEMENTATION is {text!r}; the wheels have {MIDDLEWARE} only",
            "unset RMW_IMPLEMENTATION",
        )

    def _all_well(self) -> Finding:
        domain = self.environ.get(DOMAIN) or "0"
        reach = self.environ.get(RANGE) or "not set (LOCALHOST in arm launch, else SUBNET)"
        return Finding.ok(NAME, f"{DOMAIN} {domain}, range {reach}")
