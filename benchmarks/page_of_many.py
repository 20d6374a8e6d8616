"""The page with many browsers: the control rate beside them, and how soon one shows the robot.

Two and then ten sockets read all that browsers would, each with eight curves at 500 Hz. Then a real
browser opens the page once. The control rate is simulated time over wall time.
"""

import contextlib
import itertools
import json
import os
import threading
import time
from collections.abc import Iterator

import harness
import rclpy
from page_client import PageClient
from page_in_browser import ARGUMENTS, BROWSER, PORT, page
from playwright.sync_api import sync_playwright
from rclpy.qos import qos_profile_sensor_data
from rclpy.utilities import try_shutdown
from rosgraph_msgs.msg import Clock
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

RATE_HZ = 500
WATCHED_S = 15.0
SETTLED_S = 5.0
TARGETS = {0: "", 2: "99.5 %", 10: "99 %"}
CURVES = tuple(
    f"/joint_states.{quantity}[j{joint}]"
    for quantity, joint in itertools.product(("position", "velocity"), range(4))
)
SHOWN = """() => document.querySelector("#root [role=slider]")
  && document.getElementById("arm-state")?.textContent === "Playing" && performance.now()"""
PAINTED = "() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime"


class Reader:
    """A browser without its drawing: viser's socket, and the page's own with the curves."""

    def __init__(self) -> None:
        """Connect, and ask for the curves."""
        self._page = PageClient(PORT)
        address = f"127.0.0.1:{PORT}"
        self._channel = connect(f"ws://{address}/channel", origin=f"http://{address}")  # pyright: ignore[reportArgumentType]
        self.received_bytes = 0
        for number, name in enumerate(CURVES):
            self._channel.send(json.dumps({"kind": "plot_add", "number": number, "name": name}))
        threading.Thread(target=self._read, args=(self._channel,), daemon=True).start()

    def close(self) -> None:
        """Leave."""
        self._page.close()
        self._channel.close()

    def _read(self, channel: ClientConnection) -> None:
        with contextlib.suppress(ConnectionClosed):
            for frame in channel:
                self.received_bytes += len(frame)


@contextlib.contextmanager
def readers(count: int) -> Iterator[list[Reader]]:
    """Connect as many browsers."""
    connected = [Reader() for _ in range(count)]
    try:
        time.sleep(SETTLED_S)
        yield connected
    finally:
        for reader in connected:
            reader.close()


class SimulatedClock:
    """Simulated time, read from /clock."""

    def __init__(self) -> None:
        """Subscribe."""
        self._node = rclpy.create_node("page_of_many")
        self._time_s = 0.0
        self._node.create_subscription(Clock, "/clock", self._take, qos_profile_sensor_data)

    def rate(self) -> float:
        """Return simulated time over wall time, watched for a while."""
        rclpy.spin_once(self._node)
        began_s, time_s = time.monotonic(), self._time_s
        while time.monotonic() < began_s + WATCHED_S:
            rclpy.spin_once(self._node, timeout_sec=1.0)
        return (self._time_s - time_s) / (time.monotonic() - began_s)

    def _take(self, message: Clock) -> None:
        self._time_s = message.clock.sec + 1e-9 * message.clock.nanosec


def first_seconds() -> list[harness.Row]:
    """Open the page in a browser; return when it is painted and when it can be used."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=ARGUMENTS)
        opened = browser.new_page(viewport={"width": 1280, "height": 800})
        opened.set_default_timeout(120_000)
        opened.goto(f"http://127.0.0.1:{PORT}", wait_until="commit")
        usable_ms = opened.wait_for_function(SHOWN).json_value()
        painted_ms = opened.evaluate(PAINTED)
        browser.close()
    return [
        harness.Row("first paint", f"{painted_ms / 1e3:.1f} s", "2 s"),
        harness.Row("a slider is there, and the bar is live", f"{usable_ms / 1e3:.1f} s", "3 s"),
    ]


def main() -> None:
    """Print the table."""
    rows = []
    with harness.suite("camera:=none", rate_hz=RATE_HZ), page(None) as process:
        rclpy.init()
        clock = SimulatedClock()
        for count, target in TARGETS.items():
            with readers(count) as connected:
                received = sum(reader.received_bytes for reader in connected)
                rate = 100.0 * clock.rate()
                what = f"control rate of {RATE_HZ} Hz, {count} browsers"
                rows.append(harness.Row(what, f"{rate:.1f} %", target))
                if connected:
                    received = sum(reader.received_bytes for reader in connected) - received
                    kilobytes = received / 1e3 / WATCHED_S / count
                    rows.append(harness.Row("the page's own socket, each", f"{kilobytes:.0f} kB/s"))
                    share = harness.cpu_percent(process, WATCHED_S)
                    rows.append(
                        harness.Row("processor of the page's node", f"{share:.0f} % of a core")
                    )
        rows += first_seconds()
        try_shutdown()
    rows.append(harness.Row("load of the machine", f"{os.getloadavg()[0]:.0f}"))
    harness.print_table("The page with many browsers", rows)


if __name__ == "__main__":
    main()
