"""The page in a browser without a graphics card: frames, clicks, and what its node costs.

The myCobot moves all the time, and the charts are shown. The browser draws with its processor, so
the figures depend on the machine and on what runs beside it: compare only within one run. Pass the
folder of another checkout to measure its page, too:

    python benchmarks/page_in_browser.py /path/to/other/checkout
"""

import contextlib
import math
import os
import shutil
import socket
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import harness
import psutil
import rclpy
from playwright.sync_api import Browser, Page, sync_playwright
from rclpy.node import Node
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

PORT = 18081
SIZES = ((1280, 800), (390, 844))
LOAD_S = 12.0
WATCHED_S = 10.0
CLICKS = 6
TOPIC = "/arm_controller/joint_trajectory"
JOINTS = (*tuple(f"link{i}_to_link{i + 1}" for i in range(1, 6)), "link6_to_link6_flange")
PERIOD_S = 4.0
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))))
ARGUMENTS = ("--disable-gpu", "--disable-gpu-watchdog", "--no-sandbox")
FRAMES = "() => window.__viserTestpoints?.rendererInfo.render.frame ?? -1"
TIMED_CLICKS = """() => {
  window.clicks = [];
  const types = ["pointerdown", "mousedown", "mouseup", "pointerup", "click"];
  new PerformanceObserver((list) => {
    for (const entry of list.getEntries())
      if (types.includes(entry.name)) window.clicks.push(entry.duration);
  }).observe({type: "event", durationThreshold: 16});
}"""


@contextlib.contextmanager
def page(checkout: str | None) -> Iterator[psutil.Process]:
    """Run the page's node, of another checkout if one is named."""
    environment = {**os.environ}
    if checkout:
        folders = (str(path) for path in Path(checkout).glob("arm_*") if path.is_dir())
        environment["PYTHONPATH"] = os.pathsep.join(folders)
    command = [sys.executable, "-m", "arm_viewer.arm_viewer_node"]
    process = subprocess.Popen(
        [*command, "--ros-args", "-p", f"port:={PORT}"], env=environment, stdout=subprocess.DEVNULL
    )
    try:
        wait_until_served()
        yield psutil.Process(process.pid)
    finally:
        process.terminate()
        process.wait(30)


def wait_until_served() -> None:
    """Wait until something listens on the page's port."""
    deadline_s = time.monotonic() + 60.0
    while True:
        try:
            socket.create_connection(("127.0.0.1", PORT)).close()
            return
        except OSError:
            if time.monotonic() > deadline_s:
                raise
            time.sleep(0.1)


def move_on(node: Node, seconds: float) -> None:
    """Move all joints back and forth for some time."""
    publisher = node.create_publisher(JointTrajectory, TOPIC, 1)
    deadline_s = time.monotonic() + 60.0
    while not publisher.get_subscription_count():
        if time.monotonic() > deadline_s:
            raise SystemExit(f"nobody listens to {TOPIC}")
        time.sleep(0.1)
    time.sleep(0.5)
    message = JointTrajectory(joint_names=list(JOINTS))
    for k in range(1, int(seconds / 0.2)):
        at_s = 0.2 * k
        angle = 0.4 * math.sin(2.0 * math.pi * at_s / PERIOD_S)
        point = JointTrajectoryPoint(positions=[angle] * len(JOINTS))
        point.time_from_start.sec = int(at_s)
        point.time_from_start.nanosec = int(1e9 * (at_s % 1.0))
        message.points.append(point)
    publisher.publish(message)


def browser_s() -> float:
    """Return the processor time of all processes of the browser so far."""
    used_s = 0.0
    for process in psutil.Process().children(recursive=True):
        with contextlib.suppress(psutil.Error):
            if "chrom" in process.name():
                times = process.cpu_times()
                used_s += times.user + times.system
    return used_s


def clicks_ms(shown: Page) -> list[float]:
    """Click on tabs; return how long each click took until the browser painted."""
    shown.evaluate(TIMED_CLICKS)
    for i in range(CLICKS):
        shown.get_by_role("tab", name=("System", "Robot")[i % 2], exact=True).click(force=True)
        shown.wait_for_timeout(700)
    return shown.evaluate("window.clicks")


def visit(browser: Browser, process: psutil.Process, size: tuple[int, int]) -> list[harness.Row]:
    """Open the page in a window of this size, and watch both."""
    shown = browser.new_page(viewport={"width": size[0], "height": size[1]})
    shown.set_default_timeout(120_000)
    shown.goto(f"http://127.0.0.1:{PORT}")
    shown.get_by_role("tab", name="Robot").wait_for(state="attached")
    shown.wait_for_timeout(1000.0 * LOAD_S)
    before, start_s, used_s = shown.evaluate(FRAMES), time.monotonic(), browser_s()
    load = harness.cpu_percent(process, WATCHED_S)
    frames = shown.evaluate(FRAMES) - before
    rate_hz = frames / (time.monotonic() - start_s)
    cost_ms = 1e3 * (browser_s() - used_s) / max(frames, 1)
    clicks = clicks_ms(shown)
    if folder := os.environ.get("PICTURES"):
        shown.screenshot(path=f"{folder}/{size[0]}.png")
    shown.close()
    name = f"{size[0]}x{size[1]}"
    click = f"{statistics.median(clicks):.0f}; {max(clicks):.0f} ms" if clicks else "below 16 ms"
    return [
        harness.Row(f"{name}: frames rendered", f"{rate_hz:.1f} /s"),
        harness.Row(f"{name}: processor of the browser", f"{cost_ms:.0f} ms a frame"),
        harness.Row(f"{name}: a click until it shows, median; largest", click),
        harness.Row(f"{name}: processor of the page's node", f"{load:.1f} % of a core"),
    ]


def main() -> None:
    """Print a table for the installed page and for each checkout that is named."""
    rclpy.init()
    node = rclpy.create_node("page_benchmark")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=ARGUMENTS)
        for checkout in (None, *sys.argv[1:]):
            with page(checkout) as process:
                move_on(node, 100.0)
                rows = [row for size in SIZES for row in visit(browser, process, size)]
                memory = process.memory_info().rss / 1e6
            rows.append(harness.Row("memory of the page's node", f"{memory:.0f} MB"))
            harness.print_table(f"The page in a browser, {checkout or 'here'}", rows)
        browser.close()
    rclpy.try_shutdown()


if __name__ == "__main__":
    with harness.fresh_domain():
        running = harness.Suite("mycobot")
        try:
            running.wait_until_ready()
            main()
        finally:
            running.stop()
