/* The plots: panels of curves of any number of any topic, which the server appends to. */
(() => {
  "use strict";
  const make = armMake;
  const FRAME = 2;
  const KEPT = "arm-plots";
  const WINDOWS = [[5, "5 s"], [10, "10 s"], [30, "30 s"], [60, "1 min"], [300, "5 min"], [Infinity, "Whole run"]];
  const COLOURS = [
    "#1f77b4", "#e8590c", "#2b8a3e", "#d62728", "#7048e8", "#8c564b", "#d6336c", "#5c6b7a",
    "#828c00", "#0b8fa3", "#1a2a6c", "#b7791f", "#00695c", "#ff5fa2", "#5d4037", "#3aa88f",
  ];
  const QUANTITIES = { position: "Position", velocity: "Velocity", effort: "Effort" };
  const LISTED = 200;
  // Drawing takes at most this share of the time.
  const SHARE = 0.3;

  const part = armDock.add("Plots", showPart);
  const grid = make("div", { className: "arm-plots" });
  const hint = make("p", { className: "arm-hint", textContent: "No robot publishes joint states. Add a panel to plot any other topic." });
  part.body.append(hint, grid);

  let robots = [];
  let robot = "";
  let panels = [];
  let isStandard = true;
  let window_s = 10;
  let view = null; // the range of time that was zoomed to
  let frozen = null; // the time at which the plots were paused
  let marked = null;
  let isShown = false;
  let isConnected = false;
  let clock = null; // the server's time, and when it came
  let number = 0;
  let drawn = -Infinity;
  let cost = 0;
  let isDue = false;
  const wanted = new Map();
  const byNumber = new Map();

  function button(text, title, act) {
    return make("button", { type: "button", textContent: text, title, "aria-label": title, onclick: act });
  }

  // -- what is kept -------------------------------------------------------------------------------

  function keep() {
    const state = { window_s: window_s === Infinity ? "all" : window_s };
    if (!isStandard) state.panels = panels.map(({ title, curves }) => ({ title, curves: curves.map(({ store, ...rest }) => rest) }));
    try {
      localStorage.setItem(KEPT, JSON.stringify(state));
    } catch {
      // A browser may refuse to keep anything.
    }
  }

  function recall() {
    try {
      const state = JSON.parse(localStorage.getItem(KEPT)) || {};
      window_s = state.window_s === "all" ? Infinity : state.window_s || 10;
      if (!state.panels) return;
      isStandard = false;
      for (const { title, curves } of state.panels) {
        // They may come from an address.
        addPanel(String(title), curves.filter(({ name }) => typeof name === "string"));
      }
    } catch {
      // What an earlier version kept may not be readable.
    }
  }

  function change() {
    isStandard = false;
    keep();
    ask();
    redraw();
  }

  // -- the curves of the server -------------------------------------------------------------------

  function store(name) {
    if (!wanted.has(name)) {
      number += 1;
      const entry = { number, store: new ArmCurveStore(), isAsked: false };
      wanted.set(name, entry);
      byNumber.set(number, entry.store);
    }
    return wanted.get(name).store;
  }

  /* Ask the server for what the panels draw, and for nothing while they are out of sight. */
  function ask() {
    const used = new Set(panels.flatMap(({ curves }) => curves.map(({ name }) => name)));
    for (const [name, entry] of wanted) {
      const isAsked = isShown && isConnected && used.has(name);
      if (isAsked && !entry.isAsked) {
        entry.store.clear();
        entry.isAsked = armChannel.send("plot_add", { name, number: entry.number });
      } else if (!isAsked && entry.isAsked) {
        armChannel.send("plot_remove", { number: entry.number });
        entry.isAsked = false;
      }
      if (!used.has(name)) {
        wanted.delete(name);
        byNumber.delete(entry.number);
      }
    }
  }

  armChannel.onChange((connected) => {
    isConnected = connected;
    for (const entry of wanted.values()) entry.isAsked = false;
    ask();
  });
  armChannel.on("plot_restart", () => {
    for (const { store } of wanted.values()) store.clear();
    [view, frozen] = [null, null];
    showTools();
  });
  armChannel.onBytes(FRAME, (payload) => {
    const data = new DataView(payload);
    const now = data.getFloat64(0, true);
    clock = [now, performance.now()];
    for (let at = 8; at < payload.byteLength; ) {
      const [count, curves] = [data.getUint32(at, true), data.getUint32(at + 4, true)];
      const times = at + 8 + 4 * curves;
      for (let curve = 0; curve < curves; curve += 1) {
        const found = byNumber.get(data.getUint32(at + 8 + 4 * curve, true));
        const values = times + 4 * count * (curve + 1);
        if (!found) continue;
        for (let k = 0; k < 4 * count; k += 4) {
          found.push(now + data.getFloat32(times + k, true), data.getFloat32(values + k, true));
        }
      }
      at = times + 4 * count * (curves + 1);
    }
    redraw();
  });

  function serverTime() {
    return clock === null ? Date.now() / 1000 : clock[0];
  }

  // -- drawing ------------------------------------------------------------------------------------

  function range() {
    if (view) return view;
    const to = frozen ?? serverTime();
    if (window_s !== Infinity) return [to - window_s, to];
    const first = Math.min(...[...wanted.values()].map(({ store }) => store.firstTime));
    return [Math.min(first, to - 1), to];
  }

  function redraw() {
    if (isDue || !isShown) return;
    isDue = true;
    const wait = drawn + cost / SHARE - performance.now();
    setTimeout(() => requestAnimationFrame(draw), Math.max(0, wait));
  }

  function draw() {
    isDue = false;
    const begun = performance.now();
    const [from, to] = range();
    const now = frozen ?? serverTime();
    for (const panel of panels) {
      panel.chart.draw(panel.curves, from, to, { now, ranges: panel.ranges, marked });
      showValues(panel, marked ?? to);
    }
    drawn = performance.now();
    cost = drawn - begun;
  }

  /* A value with as many digits as its axis shows, and two more. */
  function shownValue(value, [low, high]) {
    if (Number.isNaN(value)) return "–";
    const digits = Math.max(0, Math.ceil(Math.log10(2000 / (high - low))));
    if (digits > 8 || Math.abs(value) >= 1e7) return value.toExponential(3);
    return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "\u2212");
  }

  function showValues({ curves, chart }, time) {
    if (!chart.area) return;
    for (const { store, holds, axis, value } of curves) {
      const text = store.length ? shownValue(store.valueAt(time, holds), chart.area.axes[axis]) : "no data";
      if (value.textContent !== text) value.textContent = text;
    }
  }

  // -- panels -------------------------------------------------------------------------------------

  function addPanel(title, curves) {
    const canvas = make("canvas", { role: "img", "aria-label": title, tabIndex: 0 });
    const legend = make("div", { className: "arm-legend" });
    const panel = { title, curves: [], ranges: [null, null], legend, canvas, chart: new ArmChart(canvas) };
    const selection = make("div", { className: "arm-selection", hidden: true });
    panel.selection = selection;
    panel.element = make(
      "figure",
      { className: "arm-plot" },
      make(
        "figcaption",
        {},
        make("b", { textContent: title }),
        button("+ Curve", `Add a curve to ${title}`, () => find(panel)),
        button("CSV", `Save ${title} as CSV`, () => saveCsv(panel)),
        button("PNG", `Save ${title} as PNG`, () => savePng(panel)),
        button("×", `Close ${title}`, () => removePanel(panel)),
      ),
      legend,
      make("div", { className: "arm-canvas" }, canvas, selection),
    );
    grid.append(panel.element);
    panels.push(panel);
    for (const curve of curves) addCurve(panel, curve);
    watchPointer(panel);
    return panel;
  }

  function removePanel(panel) {
    panel.element.remove();
    panels = panels.filter((other) => other !== panel);
    change();
  }

  function addCurve(panel, { name, label, unit = "", colour, axis, dashed = false, holds = false, hidden = false }) {
    if (panel.curves.some((curve) => curve.name === name)) return;
    const first = panel.curves[0];
    const free = COLOURS.find((candidate) => !panel.curves.some((curve) => curve.colour === candidate));
    const curve = {
      name, label: label || name, unit, dashed, holds, hidden, store: store(name), value: make("output"),
      colour: colour || free || COLOURS[panel.curves.length % COLOURS.length],
      axis: axis ?? (first && unit && first.unit && first.unit !== unit ? 1 : 0),
    };
    const chip = make(
      "button",
      { type: "button", className: "arm-chip", title: name, onclick: () => showCurveMenu(panel, curve, chip) },
      make("i", { style: `background:${curve.colour}`, className: dashed ? "arm-dashed" : "" }),
      make("span", { textContent: curve.label }),
      curve.value,
    );
    curve.chip = chip;
    Object.defineProperty(curve, "chip", { enumerable: false });
    Object.defineProperty(curve, "value", { enumerable: false });
    chip.classList.toggle("arm-hidden", hidden);
    panel.curves.push(curve);
    panel.legend.append(chip);
  }

  function removeCurve(panel, curve) {
    curve.chip.remove();
    panel.curves = panel.curves.filter((other) => other !== curve);
  }

  const menu = make("div", { id: "arm-curve-menu", className: "arm-menu", popover: "auto", role: "menu", "aria-label": "Curve" });

  function showCurveMenu(panel, curve, chip) {
    const item = (text, act) =>
      make("button", { type: "button", role: "menuitem", textContent: text, onclick: () => (menu.hidePopover(), act(), change()) });
    const command = commandOf(curve.name);
    menu.replaceChildren(
      item(curve.hidden ? "Show" : "Hide", () => {
        curve.hidden = !curve.hidden;
        chip.classList.toggle("arm-hidden", curve.hidden);
      }),
      item(curve.axis ? "Move to the left axis" : "Move to the right axis", () => (curve.axis = 1 - curve.axis)),
      ...(command ? [item("Add its command", () => addCurve(panel, { ...command, colour: curve.colour, axis: curve.axis }))] : []),
      item("Remove", () => removeCurve(panel, curve)),
    );
    menu.showPopover();
    const place = chip.getBoundingClientRect();
    const box = menu.getBoundingClientRect();
    menu.style.left = `${Math.max(4, Math.min(place.left, innerWidth - box.width - 4))}px`;
    menu.style.top = `${Math.max(4, place.top - box.height - 4)}px`;
  }

  // -- the standard panels ------------------------------------------------------------------------

  function stateCurve(joint, quantity, index) {
    const [name, , , unit] = joint.curves[quantity];
    return { name, label: joint.name, unit, colour: COLOURS[index % COLOURS.length], axis: 0 };
  }

  function commandCurve(joint, quantity, index) {
    const [, name, holds, unit] = joint.curves[quantity];
    if (!name) return null;
    return { name, label: `${joint.name} command`, unit, colour: COLOURS[index % COLOURS.length], axis: 0, dashed: true, holds };
  }

  function commandOf(name) {
    for (const { joints } of robots) {
      for (const [index, joint] of joints.entries()) {
        for (const quantity of Object.keys(joint.curves)) {
          if (joint.curves[quantity][0] === name) return commandCurve(joint, quantity, index);
        }
      }
    }
    return null;
  }

  function showStandard() {
    const found = robots.find(({ name }) => name === robot) || robots[0];
    for (const panel of panels) panel.element.remove();
    panels = [];
    for (const [quantity, title] of Object.entries(QUANTITIES)) {
      const joints = (found?.joints || []).map((joint, index) => [joint, index]).filter(([joint]) => joint.curves[quantity]);
      if (!joints.length) continue;
      addPanel(title, [
        ...joints.map(([joint, index]) => stateCurve(joint, quantity, index)),
        ...joints.map(([joint, index]) => commandCurve(joint, quantity, index)).filter(Boolean),
      ]);
    }
    hint.hidden = panels.length > 0;
    ask();
    redraw();
  }

  armChannel.on("plot_joints", (message) => {
    robots = message.robots;
    showRobots();
    if (isStandard) showStandard();
  });

  // -- the pointer: values, zoom ------------------------------------------------------------------

  function watchPointer(panel) {
    const { canvas, chart, selection } = panel;
    let begun = null;
    const inside = (event) => {
      const { left, top, width, height } = chart.area;
      return [Math.max(left, Math.min(event.offsetX, left + width)), Math.max(top, Math.min(event.offsetY, top + height))];
    };
    const box = ([x, y]) => {
      const { top, height } = chart.area;
      const isTall = Math.abs(y - begun[1]) > 20;
      const [low, high] = isTall ? [Math.min(y, begun[1]), Math.max(y, begun[1])] : [top, top + height];
      return { left: Math.min(x, begun[0]), right: Math.max(x, begun[0]), low, high, isTall };
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (!chart.area || event.button) return;
      begun = inside(event);
      // A finger shows values; only a mouse selects.
      if (event.pointerType === "mouse") canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!chart.area) return;
      const point = inside(event);
      marked = chart.timeAt(point[0]);
      if (begun && event.pointerType === "mouse" && event.buttons & 1) {
        const { left, right, low, high } = box(point);
        Object.assign(selection.style, { left: `${left}px`, width: `${right - left}px`, top: `${low}px`, height: `${high - low}px` });
        selection.hidden = right - left < 5;
      }
      redraw();
    });
    canvas.addEventListener("pointerup", (event) => {
      const isSelected = begun && !selection.hidden;
      selection.hidden = true;
      if (isSelected) {
        const { left, right, low, high, isTall } = box(inside(event));
        view = [chart.timeAt(left), chart.timeAt(right)];
        if (isTall) panel.ranges = [0, 1].map((axis) => [chart.valueAt(high, axis), chart.valueAt(low, axis)]);
        showTools();
        redraw();
      }
      begun = null;
    });
    for (const name of ["pointerleave", "pointercancel"]) {
      canvas.addEventListener(name, () => {
        marked = null;
        redraw();
      });
    }
    canvas.addEventListener("dblclick", goLive);
    canvas.addEventListener(
      "wheel",
      (event) => {
        if (!chart.area) return;
        event.preventDefault();
        const about = chart.timeAt(inside(event)[0]);
        const factor = 1.2 ** Math.sign(event.deltaY);
        const [from, to] = range();
        view = [about - (about - from) * factor, about + (to - about) * factor];
        showTools();
        redraw();
      },
      { passive: false },
    );
    canvas.addEventListener("keydown", (event) => {
      const shift = { ArrowLeft: -0.1, ArrowRight: 0.1 }[event.key];
      const zoom = { "+": 1 / 1.2, "-": 1.2 }[event.key];
      if (!shift && !zoom) return;
      event.preventDefault();
      event.stopPropagation();
      const [from, to] = range();
      const [middle, half] = [(from + to) / 2 + (shift || 0) * (to - from), ((to - from) / 2) * (zoom || 1)];
      view = [middle - half, middle + half];
      showTools();
      redraw();
    });
  }

  function goLive() {
    [view, frozen] = [null, null];
    for (const panel of panels) panel.ranges = [null, null];
    showTools();
    redraw();
  }

  // -- tools --------------------------------------------------------------------------------------

  const windows = make("select", { "aria-label": "Window of time" });
  windows.append(...WINDOWS.map(([, text], index) => make("option", { value: index, textContent: text })));
  windows.addEventListener("change", () => {
    window_s = WINDOWS[windows.value][0];
    view = null;
    keep();
    showTools();
    redraw();
  });
  const pause = button("Pause", "Pause the plots", () => {
    frozen = frozen === null ? serverTime() : null;
    if (frozen === null) view = null;
    showTools();
    redraw();
  });
  const live = button("Back to now", "End zoom and pause (double click)", goLive);
  const which = make("select", { "aria-label": "Joints of", hidden: true });
  which.addEventListener("change", () => {
    robot = which.value;
    isStandard = true;
    keep();
    showStandard();
  });
  const standard = button("Joints", "Show position, velocity and effort of all joints", () => {
    isStandard = true;
    keep();
    showStandard();
  });
  function findForNewPanel(text = "") {
    let count = 1;
    while (panels.some(({ title }) => title === `Plot ${count}`)) count += 1;
    const panel = addPanel(`Plot ${count}`, []);
    hint.hidden = true;
    change();
    panel.element.scrollIntoView({ block: "nearest" });
    find(panel, text);
  }

  const more = button("+ Panel", "Add a panel", () => findForNewPanel());
  part.tools.append(windows, pause, live, standard, which, more);

  function showTools() {
    windows.value = String(WINDOWS.findIndex(([size]) => size === window_s));
    pause.textContent = frozen === null ? "Pause" : "Continue";
    pause.title = frozen === null ? "Pause the plots" : "Continue the plots";
    pause.setAttribute("aria-label", pause.title);
    pause.setAttribute("aria-pressed", String(frozen !== null));
    live.hidden = view === null;
  }

  function showRobots() {
    which.hidden = robots.length < 2;
    which.replaceChildren(...robots.map(({ name }) => make("option", { value: name, textContent: name })));
    if (robots.some(({ name }) => name === robot)) which.value = robot;
    else robot = robots[0]?.name || "";
  }

  function showPart(shown) {
    isShown = shown;
    ask();
    redraw();
  }

  // -- finding a number by typing -----------------------------------------------------------------

  let numbers = [];
  let target = null;
  const typed = make("input", { type: "search", placeholder: "Type a topic, field or joint", "aria-label": "Curve", autocomplete: "off", spellcheck: false });
  const list = make("ul", { role: "listbox", "aria-label": "Curves" });
  const count = make("p", { className: "arm-count", role: "status" });
  const finder = make("div", { className: "arm-menu arm-finder", popover: "auto", role: "dialog", "aria-label": "Add a curve" }, typed, count, list);

  function find(panel, text = "") {
    target = panel;
    typed.value = text;
    armChannel.send("plot_numbers", {});
    finder.showPopover();
    showFound();
    typed.focus();
  }

  function offers() {
    const pairs = robots.flatMap(({ name, joints }) =>
      joints.flatMap((joint, index) =>
        Object.keys(joint.curves)
          .filter((quantity) => joint.curves[quantity][1])
          .map((quantity) => ({
            text: `${name === "/" ? "" : `${name} `}${joint.name} ${quantity}: command and state`, unit: joint.curves[quantity][3],
            curves: [stateCurve(joint, quantity, index), commandCurve(joint, quantity, index)].map(({ colour, axis, ...curve }) => curve),
          })),
      ),
    );
    const known = new Map(pairs.flatMap(({ curves }) => curves.map((curve) => [curve.name, curve])));
    return [...pairs, ...numbers.map(([name, unit]) => ({ text: name, unit, curves: [known.get(name) || { name, unit }] }))];
  }

  function showFound() {
    const words = typed.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = offers().filter(({ text }) => words.every((word) => text.toLowerCase().includes(word)));
    count.textContent = found.length > LISTED ? `${found.length} numbers, the first ${LISTED} shown` : `${found.length} numbers`;
    list.replaceChildren(
      ...found.slice(0, LISTED).map((offer) => {
        const isThere = offer.curves.every(({ name }) => target.curves.some((curve) => curve.name === name));
        return make(
          "li",
          {},
          make(
            "button",
            { type: "button", role: "option", "aria-selected": String(isThere), onclick: () => take(offer, isThere) },
            make("span", { textContent: offer.text }),
            make("small", { textContent: offer.unit }),
          ),
        );
      }),
    );
  }

  function take(offer, isThere) {
    for (const curve of offer.curves) {
      const drawn = target.curves.find(({ name }) => name === curve.name);
      if (isThere) removeCurve(target, drawn);
      else addCurve(target, { ...curve, colour: curve.dashed ? target.curves.at(-1)?.colour : undefined });
    }
    change();
    showFound();
  }

  typed.addEventListener("input", showFound);
  typed.addEventListener("keydown", (event) => {
    if (event.key === "Enter") list.querySelector("button")?.click();
    if (event.key === "ArrowDown") list.querySelector("button")?.focus();
  });
  list.addEventListener("keydown", (event) => {
    const step = { ArrowDown: "nextElementSibling", ArrowUp: "previousElementSibling" }[event.key];
    if (!step) return;
    event.preventDefault();
    (event.target.closest("li")[step]?.firstChild || typed).focus();
  });
  armChannel.on("plot_numbers", ({ topics }) => {
    numbers = Object.entries(topics).flatMap(([topic, paths]) => paths.map(([path, unit]) => [`${topic}.${path}`, unit]));
    if (finder.matches(":popover-open")) showFound();
  });

  // -- files --------------------------------------------------------------------------------------

  function save(blob, name) {
    const link = make("a", { href: URL.createObjectURL(blob), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  function saveCsv({ title, curves }) {
    const [from, to] = range();
    const places = curves.map(({ store }) => Math.max(0, store.until(from)));
    const field = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const lines = [["time [s]", ...curves.map(({ name, unit }) => (unit ? `${name} [${unit}]` : name))].map(field).join(",")];
    for (;;) {
      const times = curves.map(({ store }, k) => (places[k] < store.length ? store.times[places[k]] : Infinity));
      const time = Math.min(...times);
      if (!(time <= to)) break;
      const row = curves.map(({ store }, k) => {
        if (times[k] !== time) return "";
        const value = store.values[places[k]++];
        return Number.isNaN(value) ? "" : String(Number(value.toPrecision(9)));
      });
      lines.push([time.toFixed(6), ...row].join(","));
    }
    save(new Blob([`${lines.join("\n")}\n`], { type: "text/csv" }), `${title}.csv`);
  }

  function savePng({ title, curves, canvas }) {
    const ratio = canvas.width / canvas.clientWidth;
    const head = 40 * ratio;
    const picture = make("canvas", { width: canvas.width, height: canvas.height + head });
    const context = picture.getContext("2d", { willReadFrequently: true });
    context.fillStyle = "#fff";
    context.fillRect(0, 0, picture.width, picture.height);
    context.drawImage(canvas, 0, head);
    context.fillStyle = "#212529";
    context.font = `bold ${13 * ratio}px sans-serif`;
    context.fillText(title, 8 * ratio, 16 * ratio);
    context.font = `${11 * ratio}px sans-serif`;
    let x = 8 * ratio;
    for (const { label, colour, hidden } of curves) {
      if (hidden) continue;
      context.fillStyle = colour;
      context.fillText(label, x, 33 * ratio);
      x += context.measureText(`${label}   `).width;
    }
    picture.toBlob((blob) => save(blob, `${title}.png`));
  }

  /* Open the plots with a new panel for the numbers of a topic. */
  window.armPlots = {
    find(topic) {
      armDock.choose("Plots");
      findForNewPanel(`${topic}.`);
    },
  };

  recall();
  showTools();
  addEventListener("DOMContentLoaded", () => document.body.append(menu, finder));
  new ResizeObserver(redraw).observe(grid);
})();
