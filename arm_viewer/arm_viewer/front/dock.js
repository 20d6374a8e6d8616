/* The dock below viser's page: `armDock.add(name, show)` gives a part a tab, tools and a body.

`show(isShown)` is called when the part comes into sight or leaves it. Height, tab and whether the
dock is open are kept for this browser. */
window.armDock = (() => {
  "use strict";
  const KEPT = "arm-dock";
  const HEIGHT = 262;
  const LEAST = 120;
  const STEP = 24;
  const PHONE = matchMedia("(max-width: 700px)");

  const parts = new Map();
  let kept = {};
  try {
    kept = JSON.parse(localStorage.getItem(KEPT)) || {};
  } catch {
    // A browser may refuse to keep anything.
  }
  let isOpen = kept.isOpen ?? !PHONE.matches;
  let height = kept.height || HEIGHT;
  let chosen = kept.chosen || "";

  const at = (id) => document.getElementById(id);

  function keep() {
    try {
      localStorage.setItem(KEPT, JSON.stringify({ isOpen, height, chosen }));
    } catch {
      // As above.
    }
  }

  function place() {
    const head = at("arm-dock-head").offsetHeight + 1;
    const most = innerHeight * (PHONE.matches ? 0.5 : 0.7);
    const wanted = PHONE.matches ? most : Math.max(LEAST, Math.min(height, most));
    const style = document.documentElement.style;
    style.setProperty("--arm-dock", `${Math.round(isOpen ? wanted : head)}px`);
  }

  function show() {
    if (!parts.has(chosen)) chosen = parts.keys().next().value;
    document.documentElement.classList.toggle("arm-docked", isOpen);
    at("arm-dock").classList.toggle("arm-folded", !isOpen);
    at("arm-dock-body").hidden = !isOpen;
    const fold = at("arm-dock-fold");
    fold.textContent = isOpen ? "▾" : "▴";
    fold.setAttribute("aria-expanded", String(isOpen));
    for (const [name, part] of parts) {
      const isChosen = isOpen && name === chosen;
      part.tab.setAttribute("aria-selected", String(isChosen));
      part.tab.tabIndex = name === chosen ? 0 : -1;
      part.body.hidden = part.tools.hidden = !isChosen;
    }
    place();
    for (const [name, part] of parts) {
      const isShown = isOpen && name === chosen;
      if (part.isShown !== isShown) {
        part.isShown = isShown;
        part.show(isShown);
      }
    }
  }

  function choose(name) {
    // The chosen tab of an open dock folds it.
    isOpen = !(isOpen && chosen === name);
    chosen = name;
    keep();
    show();
  }

  function toggle() {
    isOpen = !isOpen;
    keep();
    show();
  }

  function moveTo(wanted) {
    height = Math.max(LEAST, Math.min(wanted, innerHeight * 0.7));
    keep();
    place();
  }

  function build() {
    const edge = at("arm-dock-edge");
    for (const { tab, tools, body } of parts.values()) {
      at("arm-dock-tabs").append(tab);
      at("arm-dock-tools").append(tools);
      at("arm-dock-body").append(body);
    }
    at("arm-dock").hidden = false;
    at("arm-dock-fold").addEventListener("click", toggle);
    at("arm-dock-tabs").addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      const names = [...parts.keys()];
      const next = names[(names.indexOf(chosen) + step + names.length) % names.length];
      isOpen = false;
      choose(next);
      parts.get(next).tab.focus();
    });
    edge.addEventListener("pointerdown", (event) => edge.setPointerCapture(event.pointerId));
    edge.addEventListener("pointermove", (event) => {
      if (!edge.hasPointerCapture(event.pointerId) || !isOpen) return;
      moveTo(at("arm-dock").getBoundingClientRect().bottom - event.clientY);
    });
    edge.addEventListener("keydown", (event) => {
      const step = { ArrowUp: STEP, ArrowDown: -STEP }[event.key];
      if (step) moveTo(height + step);
    });
    addEventListener("resize", place);
    show();
  }

  function add(name, show) {
    const tab = armMake("button", { type: "button", textContent: name, id: `arm-tab-${name}`, role: "tab" });
    const body = armMake("div", { role: "tabpanel", "aria-labelledby": tab.id });
    const tools = armMake("div", { className: "arm-tools" });
    tab.addEventListener("click", () => choose(name));
    parts.set(name, { tab, body, tools, show, isShown: false });
    return { body, tools };
  }

  // After the parts have added themselves.
  addEventListener("DOMContentLoaded", () => setTimeout(build, 0));
  return { add, toggle, choose };
})();
