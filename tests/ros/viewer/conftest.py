"""A browser that nobody sees, on a page of a simulation.

Where no Chromium is installed the tests of this folder are not collected, and the report's head
says so; `.ci/run` installs it.
"""

import re
import shutil
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_user import DESK, TIMEOUT_S, PageUser
from playwright.sync_api import sync_playwright

NAMES = ("chromium", "chromium-browser", "google-chrome")

BROWSER = next(filter(None, map(shutil.which, NAMES)), None)
collect_ignore_glob = [] if BROWSER else ["test_*.py"]

# Drawing in software on a busy machine takes its time, which is no reason to give the context up.
ARGUMENTS = ("--disable-gpu", "--disable-gpu-watchdog", "--no-sandbox")
CAMERA_PIXELS = """() => {
  const image = [...document.querySelectorAll("img[src]")].find(
    ({ naturalWidth: x, naturalHeight: y }) => x >= 100 && 3 * x === 4 * y);
  if (!image) return [];
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, canvas.width, canvas.height).data;
  return Array.from(pixels.filter((_, index) => index % 61 === 0));
}"""
FEW_FRAMES = """
  window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 200);
  window.cancelAnimationFrame = clearTimeout;
"""
COUNTED_DRAWING = (Path(__file__).parent / "counted_drawing.js").read_text()


def pytest_report_header() -> str:
    return f"browser tests: {BROWSER or 'left out, as there is no Chromium (apt install chromium)'}"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Say what the pages of a failed test show: what was awaited may stand there in other words."""
    report = yield
    if report.failed:
        for name, value in item.funcargs.items():
            page = value.page if isinstance(value, PageUser) else value
            if hasattr(page, "inner_text"):
                report.sections.append((name, page.inner_text("body")))
    return report


class Visitor(PageUser):
    """A user of the page of a simulation.

    Attributes:
        page: playwright's page, for everything else.
        requests: the addresses of all that the page fetched.
        errors: what the page's scripts failed at.
    """

    def __init__(self, page) -> None:
        super().__init__(page)
        self.requests: list[str] = []
        self.errors: list[str] = []
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("websocket", lambda socket: self.requests.append(socket.url))
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    def visit(self, url: str) -> None:
        """Open the page, and wait until it has its tabs."""
        self.page.goto(url)
        self.page.get_by_role("tab", name="Robot").wait_for(state="attached")

    def place(self, selector: str) -> dict[str, float]:
        """Return x, y, width and height of the first element of a selector, in pixels."""
        return self.page.locator(selector).first.bounding_box()

    def open_tab(self, name: str) -> None:
        """Select a tab."""
        self.page.get_by_role("tab", name=name, exact=True).click()

    def button(self, label: str):
        """Return a button."""
        return self.page.get_by_role("button", name=label, exact=True)

    def controller_button(self, controller: str, label: str):
        """Return the button below a controller's name, where it says `label`."""
        button = f"//b[.='{controller}']/following::button[1][normalize-space(.)='{label}']"
        return self.page.locator(f"xpath={button}")

    def slider(self, label: str):
        """Return the handle of a slider."""
        return self.page.locator(f"xpath=//label[.='{label}']/following::*[@role='slider'][1]")

    def slider_value(self, label: str) -> float:
        """Return what a slider shows."""
        return float(self.slider(label).get_attribute("aria-valuenow"))

    def type_number(self, label: str, text: str, end: str = "", press: bool = False) -> None:
        """Type into the field beside a slider, and press a key at the end.

        Args:
            label: of the slider.
            text: what is typed.
            end: the last key; without it the field is left as it is.
            press: whether `text` is the name of a key to be pressed.
        """
        field = f"//label[.='{label}']/following::input[contains(@class, 'NumberInput')][1]"
        # With force: over a field that is being typed into lies that of the page's script.
        self.page.locator(f"xpath={field}").click(click_count=3, force=True)
        (self.page.keyboard.press if press else self.page.keyboard.type)(text)
        if end:
            self.page.keyboard.press(end)

    def step_back(self) -> None:
        """See more of the 3D view's surroundings."""
        self.page.mouse.move(DESK["width"] / 2, DESK["height"] / 2)
        self.page.mouse.wheel(0, 200)

    def drawn(self) -> dict[str, int]:
        """Return how many things were drawn so far in the 3D view, by their kind."""
        return self.page.evaluate("window.drawn")

    def camera_pixels(self) -> np.ndarray:
        """Return some of the pixels of the first camera's image, as soon as there is one."""
        read: list[int] = []

        def complete() -> bool:
            read[:] = self.page.evaluate(CAMERA_PIXELS)
            return bool(read)

        self.wait_until(complete, "an image of a camera")
        return np.array(read)


@pytest.fixture(scope="module")
def simulation(request, launch_for_file):
    """Return a running simulation with the camera of the file, "side" if it names none."""
    launched = launch_for_file(f"camera:={getattr(request.module, 'CAMERA', 'side')}")
    launched.wait_until_ready()
    return launched


@pytest.fixture(scope="module")
def page_program(launch_for_file):
    """Return a page, in a process of its own."""
    return launch_for_file("arm_viewer", "viewer.launch.py", "viewer_port:=0")


@pytest.fixture(scope="module")
def page_url(page_program) -> str:
    """Return the address of the page."""
    line = page_program.wait_for_line("the page is at http://")
    found = re.search(r"http://127\.0\.0\.1:[1-9]\d*", line)
    assert found is not None, line
    return found[0]


@pytest.fixture(scope="module")
def browser():
    """Return a browser; nothing is downloaded for it."""
    with sync_playwright() as playwright:
        running = playwright.chromium.launch(
            executable_path=BROWSER, args=ARGUMENTS, timeout=TIMEOUT_S * 1000
        )
        yield running
        running.close()


def _new_page(browser, script: str, viewport: Mapping[str, int]):
    page = browser.new_page(viewport=viewport)
    page.set_default_timeout(TIMEOUT_S * 1000)
    page.add_init_script(f"{script}; {COUNTED_DRAWING}")
    return page


@pytest.fixture(scope="module")
def page_at(browser) -> Iterator[Callable[..., Any]]:
    """Return a function that opens the page at an address, for tests of what is beside the 3D view.

    Its arguments are a script that runs before those of the page, and the size of the window. The
    page's scripts must not fail.
    """
    pages, errors = [], []

    def open_(url: str, script: str = "", viewport: Mapping[str, int] = DESK):
        page = _new_page(browser, FEW_FRAMES + script, viewport)
        pages.append(page)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(url)
        return page

    yield open_
    for page in pages:
        page.close()
    assert errors == []


@pytest.fixture(scope="module")
def new_visitor(browser, simulation, page_url) -> Iterator[Callable[..., Visitor]]:
    """Return a function that lets one more visitor open the page of the simulation.

    Its arguments are a script that runs before those of the page, by default one that leaves out
    most frames, and the size of the window.
    """
    pages = []

    def arrive(script: str = FEW_FRAMES, viewport: Mapping[str, int] = DESK) -> Visitor:
        pages.append(_new_page(browser, script, viewport))
        arrived = Visitor(pages[-1])
        arrived.visit(page_url)
        return arrived

    yield arrive
    for page in pages:
        page.close()


@pytest.fixture(scope="module")
def visitor(new_visitor) -> Visitor:
    """Return a visitor of the page of the simulation."""
    return new_visitor()
