/* Keep the tab of viser's panel for this browser and in the address, and let a link carry the dock
and its plots.

This comes before the scripts that recall what it puts in place. */
(() => {
  "use strict";
  const KEPT = { dock: "arm-dock", plots: "arm-plots" };
  const TAB = "arm-tab";
  const MARK = "#view=";
  const TAB_MARK = "#tab=";
  const LINK = "a[href^='?initialCamera']";
  const MAIN = "Robot";
  const LOOK_MS = 200;
  const LOOKS = 150;

  /* The address has the tab, but for the first one. */
  function showTab(name) {
    const hash = name && name !== MAIN ? TAB_MARK + encodeURIComponent(name) : "";
    history.replaceState(null, "", location.pathname + location.search + hash);
  }

  function take() {
    const part = [TAB_MARK, MARK].find((mark) => location.hash.startsWith(mark));
    if (!part) return;
    try {
      const text = decodeURIComponent(location.hash.slice(part.length));
      if (part === TAB_MARK) localStorage.setItem(TAB, text);
      else put(JSON.parse(text));
    } catch {
      // Of an address that was cut off, the camera is all there is.
    }
    // What is changed from here on stays when the page is loaded again.
    showTab("");
  }

  function put(view) {
    for (const [name, key] of Object.entries(KEPT)) {
      if (typeof view[name] === "string") localStorage.setItem(key, view[name]);
      if (view[name] === null) localStorage.removeItem(key);
    }
  }

  function complete(event) {
    const link = event.target.closest?.(LINK);
    if (!link) return;
    const view = {};
    for (const [name, key] of Object.entries(KEPT)) view[name] = localStorage.getItem(key);
    const address = link.getAttribute("href").split("#")[0];
    link.setAttribute("href", address + MARK + encodeURIComponent(JSON.stringify(view)));
  }

  const isMain = (tabs) => [...tabs].some((tab) => tab.textContent === MAIN);
  const tabsOf = (list) => list.querySelectorAll("[role=tab]");

  function keepTab(event) {
    const tab = event.target.closest?.("#root [role=tab]");
    const list = tab?.closest("[role=tablist]");
    if (!list || !isMain(tabsOf(list))) return;
    localStorage.setItem(TAB, tab.textContent);
    showTab(tab.textContent);
  }

  // A tab of viser can be dragged, so it is chosen by the whole gesture and by no click alone.
  function press(tab) {
    const options = { bubbles: true, cancelable: true, isPrimary: true, pointerId: 1, button: 0 };
    for (const kind of ["pointerdown", "pointerup"]) tab.dispatchEvent(new PointerEvent(kind, options));
    tab.click();
  }

  /* Choose the kept tab when it is there; that of planning comes with the first move_group. */
  function chooseTab() {
    const wanted = localStorage.getItem(TAB);
    if (!wanted || wanted === MAIN) return;
    let looks = 0;
    const timer = setInterval(() => {
      looks += 1;
      const found = [...document.querySelectorAll("#root [role=tab]")];
      const tab = found.find((each) => each.textContent === wanted);
      // Whoever has chosen another one meanwhile keeps it.
      const isChosen = localStorage.getItem(TAB) !== wanted;
      const isShown = tab?.getAttribute("aria-selected") === "true";
      if (isChosen || isShown || looks > LOOKS) clearInterval(timer);
      else if (tab) press(tab);
      // Not before it is there: viser takes what the address has when it loads for its server's.
      if (tab && !isChosen) showTab(wanted);
    }, LOOK_MS);
  }

  try {
    take();
    for (const kind of ["pointerdown", "focusin", "contextmenu"]) {
      addEventListener(kind, complete, true);
    }
    for (const kind of ["click", "focusin"]) addEventListener(kind, keepTab, true);
    chooseTab();
  } catch {
    // A browser may refuse to keep anything.
  }
})();
