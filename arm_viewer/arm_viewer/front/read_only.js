/* In a browser that may only look: says so, and keeps the controls from looking as if they acted.

The server refuses whatever comes from such a browser; this only spares its user the attempt. Tabs and
the heads of panels still work, and so does the 3D view. */
(() => {
  "use strict";
  const CONTROLS =
    "#root button:not([role=tab]):not([data-arm-reads]), #root input, #root textarea, #root [role=slider], " +
    "#root [role=switch], #root label, #arm-bar button:not(#arm-help), #arm-bar select, .arm-menu button";
  const SHOWN_MS = 2500;
  let timer = 0;

  function refuse(event) {
    const target = event.target instanceof Element ? event.target : null;
    if (!target || !target.closest(CONTROLS)) return;
    if (event.type === "keydown" && (event.key === "Tab" || event.key === "Shift")) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const chip = document.getElementById("arm-read-only");
    chip.classList.add("arm-tried");
    clearTimeout(timer);
    timer = setTimeout(() => chip.classList.remove("arm-tried"), SHOWN_MS);
  }

  for (const kind of ["pointerdown", "mousedown", "touchstart", "click", "keydown", "beforeinput", "drop"]) {
    addEventListener(kind, refuse, { capture: true, passive: false });
  }
  document.documentElement.classList.add("arm-read-only");
  addEventListener("DOMContentLoaded", () => {
    const chip = document.createElement("span");
    chip.id = "arm-read-only";
    chip.setAttribute("role", "status");
    chip.textContent = "Read-only";
    chip.title = "This browser may look, and can change nothing";
    document.getElementById("arm-message").before(chip);
  });
})();
