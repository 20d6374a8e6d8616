/* The keys of the page, and the list of them that `?` shows. No key acts while one types in a field. */
(() => {
  "use strict";
  const KEYS = [
    { shown: "Space", about: "pause or play", key: " ", act: () => armTime.press("#arm-play") },
    { shown: "→", about: "one step", key: "ArrowRight", repeats: true, act: () => step(1) },
    { shown: ".", about: "one step", key: ".", repeats: true, act: () => step(1) },
    { shown: "Shift →", about: "10 steps", key: "ArrowRight", shift: true, repeats: true, act: () => step(10) },
    { shown: "Ctrl →", about: "100 steps", key: "ArrowRight", ctrl: true, act: () => step(100) },
    { shown: "←", about: "1 s back in a recording", key: "ArrowLeft", repeats: true, replay: true },
    { shown: "Shift ←", about: "10 s back in a recording", key: "ArrowLeft", shift: true, repeats: true, replay: true },
    { shown: "M", about: "mark a moment of a recording", key: "m", replay: true },
    { shown: "↑", about: "faster", key: "ArrowUp", act: () => armTime.faster(1) },
    { shown: "↓", about: "slower", key: "ArrowDown", act: () => armTime.faster(-1) },
    { shown: "R", about: "reset everything and the clock", key: "r", act: () => armTime.reset(false) },
    { shown: "Shift R", about: "reset, and keep the clock", key: "r", shift: true, act: () => armTime.reset(true) },
    { shown: "Ctrl S", about: "save a snapshot", key: "s", ctrl: true, act: () => armTime.save("") },
    { shown: "L", about: "restore the last snapshot", key: "l", act: () => armTime.restoreLast() },
    { shown: "P", about: "fold and unfold the plots", key: "p", act: () => armDock.toggle() },
    { shown: "V", about: "a picture in place of the 3D view, and back", key: "v", act: () => armPicture.toggle() },
    { shown: "Esc", about: "emergency stop", key: "escape", act: () => armTime.stop() },
    { shown: "?", about: "this list", key: "?", act: show },
  ];
  const OF_VISER = [
    ["Ctrl K", "all of this and more, by name"],
    ["W A S D Q E", "move the camera"],
  ];
  const FIELDS = "input, textarea, select, [contenteditable=''], [contenteditable=true], [role=textbox]";
  const OWN_ARROWS = "[role=slider], [role=tab], [role=radio], [role=menuitem], [role=option], [role=separator]";
  const OWN_SPACE = "button, a, summary, [role=button], [role=tab]";

  const REPEAT_MS = 100;
  let acted = 0;

  function step(count) {
    armTime.press(`[data-steps="${count}"]`);
  }

  function show() {
    const dialog = document.getElementById("arm-keys");
    const list = document.getElementById("arm-key-list");
    const rows = [...KEYS.map(({ shown, about }) => [shown, about]), ...OF_VISER];
    list.replaceChildren(
      ...rows.flatMap(([shown, about]) => [
        armMake("dt", {}, armMake("kbd", {}, shown)),
        armMake("dd", {}, about),
      ]),
    );
    if (!dialog.open) dialog.showModal();
  }

  /* Whether what has the focus, or lies above the page, uses the key itself. */
  function isTaken(event) {
    const target = event.target instanceof Element ? event.target : document.body;
    if (target.closest(FIELDS)) return true;
    if (target.closest("dialog, [popover], [role=dialog]")) return true;
    if (document.querySelector("dialog[open], [popover]:popover-open")) return true;
    if (event.key.startsWith("Arrow")) return Boolean(target.closest(OWN_ARROWS));
    return event.key === " " && Boolean(target.closest(OWN_SPACE));
  }

  function find(event) {
    const pressed = event.key.length > 1 && event.key !== "Escape" ? event.key : event.key.toLowerCase();
    return KEYS.find(
      ({ key, shift, ctrl, replay }) =>
        key === pressed &&
        (!replay || armTimeline.isOpen()) &&
        Boolean(ctrl) === (event.ctrlKey || event.metaKey) &&
        // On many keyboards `?` and `.` need the shift key.
        (Boolean(shift) === event.shiftKey || key === "?" || key === "."),
    );
  }

  // In the capture phase, before viser turns the camera by the arrows.
  addEventListener(
    "keydown",
    (event) => {
      if (event.defaultPrevented || event.isComposing || event.altKey) return;
      const found = find(event);
      if (!found || isTaken(event)) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      if (event.repeat && (!found.repeats || event.timeStamp - acted < REPEAT_MS)) return;
      acted = event.timeStamp;
      if (!armTimeline.key(found.shown)) found.act();
    },
    true,
  );
  addEventListener("DOMContentLoaded", () => {
    document.getElementById("arm-help").addEventListener("click", show);
  });
})();
