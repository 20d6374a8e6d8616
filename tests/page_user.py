"""What every user of a page in a browser does: tests of the page derive theirs from this one."""

import re
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

TIMEOUT_S = 120.0
DESK, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
RESIZED = """(width) => new Promise((go) => {
  const look = () => requestAnimationFrame(innerWidth === width ? () => go() : look);
  look();
})"""
IS_WHOLE = """(name) => {
  const element = document.getElementById(name);
  const { left, right, top, bottom, width } = element.getBoundingClientRect();
  return width > 0 && left >= 0 && right <= innerWidth && top >= 0 && bottom <= innerHeight &&
    element.scrollWidth <= element.clientWidth + 1;
}"""
DRAWN_PLACES = """([name, attribute, size]) => {
  let numbers = [];
  window.__viserMutable?.nodeRefFromName[name]?.traverse((node) => {
    const places = node.geometry?.attributes[attribute];
    if (places) numbers = Array.from((places.data ?? places).array);
  });
  const rows = Array.from({ length: numbers.length / size }, (_, row) => row * size);
  return rows.map((start) => numbers.slice(start, start + size));
}"""
"""A script that returns the numbers of a node of the 3D view, so many in a row."""
KEEP_WHAT_IS_SAID = """
  window.said = [];
  addEventListener("DOMContentLoaded", () => setTimeout(() => {
    for (const id of ["arm-message", "arm-drop"]) {
      const element = document.getElementById(id);
      const keep = () => window.said.push(
        [element.textContent, element.classList.contains("arm-failed")]);
      new MutationObserver(keep)
        .observe(element, { childList: true, characterData: true, subtree: true });
    }
  }, 0));
"""
"""A script before those of the page: it keeps sentences that stand there for some seconds only."""


class PageUser:
    """A user of playwright's `page`."""

    def __init__(self, page: Any) -> None:
        self.page = page

    def click(self, name: str, role: str = "button") -> None:
        """Click as soon as it can be; a real mouse would wait for two drawn frames."""
        usable = self.page.locator(":not([disabled]):not([aria-disabled=true])")
        found = self.page.get_by_role(role, name=name, exact=True)
        usable.and_(found).dispatch_event("click")

    def checkbox(self, label: str) -> Any:
        """Return a checkbox."""
        return self.page.get_by_role("checkbox", name=label, exact=True)

    def switch(self, label: str, on: bool) -> None:
        """Switch a checkbox on or off, whatever an earlier test left there."""
        box = self.checkbox(label)
        if box.is_checked() != on:
            box.dispatch_event("click")
        self.wait_until(lambda: box.is_checked() == on, f"{label} is {on}")

    def is_whole(self, name: str) -> bool:
        """Return whether an element, by its id, is in the window with all of its text."""
        return self.page.evaluate(IS_WHOLE, name)

    def contacts(self) -> list[list[float]]:
        """Return the points of contacts that are drawn, each x, y and z in m."""
        # viser's client has points as halves, in an array of integers.
        halves = self.page.evaluate(DRAWN_PLACES, ["/contacts/points", "position", 3])
        return np.array(halves, dtype=np.uint16).view(np.float16).tolist()

    def forces(self) -> list[list[float]]:
        """Return the lines of forces that are drawn, each the six coordinates of its ends in m."""
        return self.page.evaluate(DRAWN_PLACES, ["/contacts/forces", "instanceStart", 6])

    def resize(self, size: dict[str, int]) -> None:
        """Give the window another size, and wait until the page's scripts have heard of it."""
        self.page.set_viewport_size(size)
        self.page.evaluate(RESIZED, size["width"])

    def says(self, pattern: str, is_problem: bool = False) -> str:
        """Wait until the page says a sentence that it takes back; return it, and forget all.

        Args:
            pattern: found in the sentence.
            is_problem: whether the sentence must be shown as a problem.
        """

        def found() -> str | None:
            said = self.page.evaluate("window.said")
            fits = (text for text, failed in said if failed or not is_problem)
            return next((text for text in fits if re.search(pattern, text)), None)

        text = self.wait_until(found, f"it says {pattern}")
        self.page.evaluate("window.said.length = 0")
        return text

    def wait_until(self, condition: Callable[[], Any], what: str) -> Any:
        """Wait until a function of the page returns something; return it."""
        deadline = time.monotonic() + TIMEOUT_S
        while not (found := condition()):
            if time.monotonic() > deadline:
                pytest.fail(f"not within {TIMEOUT_S} s: {what}")
            self.page.wait_for_timeout(50)
        return found
