"""Makes the manual's pictures of the page: the arm, what is inside its links, a thing, and a plan.

    python docs/make_page_pictures.py

Needs Chromium (`apt install chromium`) and the Python package playwright; nothing is downloaded.
"""

import contextlib
import os
import shutil
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from pathlib import Path

os.environ.setdefault("AMENT_PREFIX_PATH", sys.prefix)
os.environ.setdefault("ROS_DOMAIN_ID", "62")

from playwright.sync_api import Page, ViewportSize, sync_playwright

IMAGES = Path(__file__).with_name("images")
SIZE: ViewportSize = {"width": 1280, "height": 800}
PORT = 18082
TIMEOUT_MS = 240_000
MOVING_MS = 3_000
"""Time in which the arm reaches its pose and the charts show the motion."""
POSE = "data: [-0.9, 0.5, 0.7, 0.9]"
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
SOFTWARE_GL = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader")


@contextlib.contextmanager
def running(*words: str, folder: str | None = None) -> Iterator[None]:
    """Run `arm WORDS` for a while, in this folder."""
    process = subprocess.Popen([sys.executable, "-m", "arm_cli", *words], cwd=folder)
    try:
        yield
    finally:
        process.terminate()
        process.wait(60)


def open_page(page: Page) -> None:
    """Open the page once it is served, and wait for the robot's sliders."""
    url = f"http://127.0.0.1:{PORT}"
    while True:
        with contextlib.suppress(OSError), urllib.request.urlopen(url, timeout=5):
            break
        page.wait_for_timeout(500)
    page.goto(f"{url}/?fixedDpr=1")
    page.locator(".mantine-Slider-root").first.wait_for()
    page.wait_for_timeout(MOVING_MS)
    warning = page.locator(".mantine-Notification-closeButton")
    if warning.count():
        warning.first.dispatch_event("click")


def take(page: Page, name: str, *ticked: str) -> None:
    """Tick some boxes, and save a screenshot."""
    for label in ticked:
        page.get_by_role("checkbox", name=label, exact=True).dispatch_event("click")
    page.wait_for_timeout(MOVING_MS)
    page.screenshot(path=str(IMAGES / name))


def take_the_arm(page: Page) -> None:
    """Take the arm of the course beside its camera, and what is inside its links."""
    open_page(page)
    topic = "/position_controller/commands"
    command = ("topic", "pub", "--once", topic, "std_msgs/msg/Float64MultiArray", POSE)
    with running(*command):
        take(page, "page.png")
    take(page, "page_inside.png", "Collision", "Frames", "Inertia")


def take_a_plan(page: Page) -> None:
    """Take a plan of the myCobot to a named pose."""
    open_page(page)
    page.get_by_role("tab", name="Planning").click()
    page.locator("input[value='choose...']").first.click()
    page.get_by_role("option", name="ready").first.click()
    page.get_by_role("button", name="Plan", exact=True).click()
    page.get_by_text("planned in").wait_for()
    take(page, "page_planning.png")


def take_a_thing(page: Page) -> None:
    """Take a thing that is chosen, and the overlays of an arm that has moved."""
    open_page(page)
    page.get_by_text("Overlays", exact=True).first.dispatch_event("click")
    page.get_by_role("combobox", name="Trail of").click()
    page.get_by_role("option", name="wrist", exact=True).click()
    for label in ("Robot's centre of mass", "Efforts"):
        page.get_by_role("checkbox", name=label, exact=True).dispatch_event("click")
    topic = "/position_controller/commands"
    with running("topic", "pub", "--once", topic, "std_msgs/msg/Float64MultiArray", POSE):
        page.get_by_role("tab", name="World", exact=True).click()
        page.locator("[data-thing=pink_cylinder]").click()
        take(page, "page_world.png")


def main() -> None:
    """Make the pictures."""
    browser_path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser_path is None:
        raise SystemExit(f"none of {', '.join(BROWSERS)} is installed: apt install chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=browser_path, args=SOFTWARE_GL, timeout=TIMEOUT_MS
        )
        for take_pictures, arguments in (
            (take_the_arm, ("world:=objects", "camera:=side")),
            (take_a_thing, ("world:=objects", "camera:=none")),
            (take_a_plan, ("mycobot", "planning:=true")),
        ):
            page = browser.new_page(viewport=SIZE)
            page.set_default_timeout(TIMEOUT_MS)
            with running("launch", *arguments, "viewer:=true", f"viewer_port:={PORT}"):
                take_pictures(page)
            page.close()
        browser.close()


if __name__ == "__main__":
    main()
