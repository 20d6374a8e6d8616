"""Makes the pictures of the page's tutorial, by walking it as it is printed.

    python docs/make_tutorial_pictures.py

The rows of its table are read from the tutorial itself. What `make_page_pictures.py` needs, this
script needs, too.
"""

import re
import shutil
import tempfile
from pathlib import Path

import cv2
import numpy as np
from make_page_pictures import (
    BROWSERS,
    IMAGES,
    PORT,
    SIZE,
    SOFTWARE_GL,
    TIMEOUT_MS,
    open_page,
    running,
)
from playwright.sync_api import Page, sync_playwright

TUTORIAL = Path(__file__).with_name("tutorials") / "page.md"
ROW = re.compile(r"\| ([^|`]+) \| `(\w+)` \| `([^`]+)` \| (?:`([^`]+)`)? *\|")
THING, LIFTED_M = "red_cylinder", 0.24
DRAWN_MS = 4_000
"""Time in which a picture is drawn without a graphics card."""
BEGINS_MS = 8_000
"""Time in which a motion begins, and a slow page says so."""
RESTS_MS = 2_000
"""Time in which a joint that moves shows another position."""
WEBP_QUALITY = 60


def take(page: Page, step: str) -> None:
    """Save what the page shows as the picture of a step."""
    page.wait_for_timeout(DRAWN_MS)
    pixels = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    assert pixels is not None
    path = str(IMAGES / f"tutorial_{step}.webp")
    cv2.imwrite(path, pixels, [cv2.IMWRITE_WEBP_QUALITY, WEBP_QUALITY])


def press(page: Page, label: str) -> None:
    """Press a button as soon as it can be."""
    usable = page.locator(":not([disabled]):not([aria-disabled=true])")
    found = page.get_by_role("button", name=label, exact=True)
    usable.and_(found).first.dispatch_event("click")


def choose(page: Page, label: str, option: str) -> None:
    """Choose an option of a drop-down list."""
    page.locator(f"xpath=//label[.='{label}']/following::input[1]").click()
    page.get_by_role("option", name=option, exact=True).click()


def enter(page: Page, label: str, text: str) -> None:
    """Type into the field beside a label."""
    fields = page.locator(f"xpath=//label[.='{label}']/following::input[1]")
    field = fields.locator("visible=true")
    field.fill(text)
    field.press("Enter")


def set_goal(page: Page, group: str, place: str, turned: str) -> None:
    """Set the goal of a row of the table."""
    choose(page, "Group", group)
    if not turned:
        choose(page, "Pose", place)
        return
    head = page.get_by_text("Tip by numbers", exact=True)
    head.wait_for()
    # What it holds comes with it; before, an open one would look like one that is folded.
    page.wait_for_timeout(1000)
    if not page.get_by_role("button", name="Set goal", exact=True).is_visible():
        head.click()
    enter(page, "Tip at", place)
    enter(page, "Tip turned", turned)
    # A slow page sends what was typed late.
    page.wait_for_timeout(RESTS_MS)
    press(page, "Set goal")
    page.wait_for_timeout(RESTS_MS)


def move(page: Page) -> None:
    """Plan and execute, and wait until the robot has arrived."""
    positions = page.locator(".arm-plot").first
    press(page, "Plan & Execute")
    # The sentence of the motion before stands there until a slow page has drawn the next one.
    page.wait_for_timeout(BEGINS_MS)
    seen = ""
    while seen != (seen := positions.inner_text()):
        page.wait_for_timeout(RESTS_MS)
    page.get_by_text("The robot has arrived.").first.wait_for()


def walk(page: Page) -> None:
    """Walk the tutorial, and take a picture at each step."""
    rows = ROW.findall(TUTORIAL.read_text(encoding="utf-8"))
    open_page(page)
    take(page, "start")
    press(page, "Recordings")
    press(page, "Record run")
    page.get_by_text(re.compile("nothing dropped")).first.wait_for()
    take(page, "record")
    page.keyboard.press("Escape")
    page.get_by_role("tab", name="Planning").click()
    for number, (_, *row) in enumerate(rows):
        set_goal(page, *row)
        if number == 1:
            take(page, "goal")
        move(page)
        if number == 3:
            take(page, "grip")
    page.get_by_role("tab", name="World", exact=True).click()
    page.locator(f"[data-thing={THING}]").click()
    height_m = page.get_by_text(re.compile(rf"{THING}: x y z")).first.inner_text().split()[6]
    if float(height_m) < LIFTED_M:
        raise SystemExit(f"the {THING} was not lifted: its height is {height_m} m")
    take(page, "lifted")
    press(page, "Recordings")
    # Not the one of planning.
    page.locator("#arm-record-button", has_text="Stop").click()
    page.get_by_role("button", name=re.compile("^Open recording_")).first.click()
    page.get_by_text(re.compile("verified: all")).first.wait_for()
    page.locator("#arm-track").press("End")
    take(page, "replay")


def main() -> None:
    """Make the pictures."""
    browser_path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser_path is None:
        raise SystemExit(f"none of {', '.join(BROWSERS)} is installed: apt install chromium")
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(
            executable_path=browser_path, args=SOFTWARE_GL, timeout=TIMEOUT_MS
        )
        page = browser.new_page(viewport=SIZE)
        page.set_default_timeout(TIMEOUT_MS)
        words = ("launch", "mycobot", "planning:=true", "viewer:=true", f"viewer_port:={PORT}")
        with running(*words, folder=folder):
            walk(page)
        browser.close()


if __name__ == "__main__":
    main()
