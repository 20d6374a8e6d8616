/* The other parts of the dock: what nodes log and diagnose, topics, and the tree of frames. */
(() => {
  "use strict";
  const make = armMake;
  const ROW = 24;
  const KEPT = 5000;
  const LEVELS = { 10: "Debug", 20: "Info", 30: "Warning", 40: "Error", 50: "Fatal" };
  const HEALTH = ["OK", "Warning", "Error", "Stale"];
  const state = { part: "", measures: true, frame: "", within: "" };

  function search(label, act) {
    return make("input", { type: "search", placeholder: "Search", "aria-label": label, autocomplete: "off", spellcheck: false, oninput: act });
  }

  const matcher = (text) => {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    return (...fields) => words.every((word) => fields.some((field) => field.toLowerCase().includes(word)));
  };

  /* Rows of one height, of which only those in sight are elements. */
  class Rows {
    constructor(label, draw) {
      this.draw = draw;
      this.rows = [];
      this.filler = make("div");
      this.element = make("div", { className: "arm-rows", tabIndex: 0, role: "list", "aria-label": label, onscroll: () => this.show() }, this.filler);
      new ResizeObserver(() => this.show()).observe(this.element);
    }

    get isAtEnd() {
      const { scrollTop, clientHeight, scrollHeight } = this.element;
      return scrollTop + clientHeight >= scrollHeight - ROW;
    }

    set(rows, follows = false) {
      this.rows = rows;
      this.filler.style.height = `${ROW * rows.length}px`;
      if (follows) this.element.scrollTop = this.element.scrollHeight;
      this.show();
    }

    show() {
      const first = Math.max(0, Math.floor(this.element.scrollTop / ROW) - 2);
      const last = Math.ceil((this.element.scrollTop + this.element.clientHeight) / ROW) + 2;
      const shown = this.rows.slice(first, last).map((row, index) => {
        const element = this.draw(row, first + index);
        element.classList.add("arm-row");
        element.setAttribute("role", "listitem");
        element.style.top = `${ROW * (first + index)}px`;
        return element;
      });
      const focus = document.activeElement?.dataset?.key;
      this.filler.replaceChildren(...shown);
      if (focus) [...this.filler.querySelectorAll("[data-key]")].find(({ dataset }) => dataset.key === focus)?.focus();
    }
  }

  function part(name, kind, ...children) {
    const made = armDock.add(name, (isShown) => {
      if (isShown) state.part = kind;
      else if (state.part === kind) state.part = "";
      tell();
    });
    made.body.classList.add("arm-observed");
    made.body.append(...children);
    return made;
  }

  function tell() {
    armChannel.send("show_part", state);
  }
  armChannel.onChange((connected) => connected && tell());

  const cell = (text, name, title = text) => make("span", { className: `arm-cell ${name}`, textContent: text, title });

  // -- log ----------------------------------------------------------------------------------------

  let entries = [];
  let chosen = null;
  const logRows = new Rows("Log", (entry) => {
    const [time, level, node, text] = entry;
    const row = make(
      "div",
      { className: `arm-level-${level}`, onclick: () => showEntry(entry) },
      cell(clockText(time), "arm-when"),
      cell(LEVELS[level] || String(level), "arm-level"),
      cell(node, "arm-who"),
      cell(text.split("\n")[0], "arm-text", text),
    );
    row.classList.toggle("arm-chosen", entry === chosen);
    return row;
  });
  const entryText = make("pre", { className: "arm-entry", hidden: true });
  const log = part("Log", "log", logRows.element, entryText);
  const level = make("select", { "aria-label": "Level", onchange: showLog });
  level.append(...Object.entries(LEVELS).map(([value, text]) => make("option", { value, textContent: value === "50" ? text : `${text} and worse` })));
  level.value = "20";
  const node = make("select", { "aria-label": "Node", onchange: showLog });
  const logSearch = search("Search the log", showLog);
  const logCount = make("span", { role: "status", className: "arm-total" });
  log.tools.append(level, node, logSearch, logCount);

  function clockText(time) {
    // Stamps of simulated time count from the simulation's start.
    if (time < 1e9) return `${time.toFixed(3)} s`;
    const date = new Date(time * 1000);
    return `${date.toLocaleTimeString("en-GB")}.${String(date.getMilliseconds()).padStart(3, "0")}`;
  }

  function showEntry(entry) {
    chosen = chosen === entry ? null : entry;
    entryText.hidden = chosen === null;
    if (chosen) entryText.textContent = `${chosen[3]}\n\n${chosen[2]}, ${chosen[4]}`;
    logRows.show();
  }

  function showLog() {
    const follows = logRows.isAtEnd;
    const matches = matcher(logSearch.value);
    const least = Number(level.value);
    const shown = entries.filter((entry) => entry[1] >= least && (!node.value || entry[2] === node.value) && matches(entry[2], entry[3]));
    logCount.textContent = `${shown.length} of ${entries.length}`;
    logRows.set(shown, follows);
  }

  armChannel.on("log", (message) => {
    entries = (message.restarts ? [] : entries).concat(message.entries).slice(-KEPT);
    const nodes = ["", ...new Set(entries.map((entry) => entry[2]))].sort();
    if (nodes.length !== node.options.length) {
      const before = node.value;
      node.replaceChildren(...nodes.map((name) => make("option", { value: name, textContent: name || "Every node" })));
      node.value = nodes.includes(before) ? before : "";
    }
    showLog();
  });

  // -- a tree -------------------------------------------------------------------------------------

  /* Rows of a tree: names, their depth and whether they are folded, without what a search leaves out. */
  function branches(children, roots, folded, isFound) {
    const rows = [];
    const seen = new Set();
    const visit = (name, depth) => {
      if (seen.has(name)) return false;
      seen.add(name);
      const at = rows.length;
      const below = children.get(name) || [];
      const isFolded = isFound === null && folded.has(name);
      rows.push({ name, depth, isFolded, isBranch: below.length > 0 });
      let isThere = isFound === null || isFound(name);
      for (const child of isFolded ? [] : below) isThere = visit(child, depth + 1) || isThere;
      if (!isThere) rows.splice(at, 1);
      return isThere;
    };
    for (const root of roots) visit(root, 0);
    return rows;
  }

  function twig({ name, depth, isFolded, isBranch }, folded, show) {
    const fold = () => {
      if (!folded.delete(name)) folded.add(name);
      show();
    };
    const button = make("button", {
      type: "button", className: "arm-twig", textContent: isFolded ? "▸" : "▾", onclick: fold,
      "aria-label": `${isFolded ? "Unfold" : "Fold"} ${name}`, "aria-expanded": String(!isFolded),
    });
    button.dataset.key = `twig ${name}`;
    button.style.visibility = isBranch ? "visible" : "hidden";
    button.style.marginLeft = `${14 * depth}px`;
    return button;
  }

  // -- diagnostics --------------------------------------------------------------------------------

  let components = new Map();
  let component = "";
  const foldedGroups = new Set();
  const healthRows = new Rows("Diagnostics", (row) => {
    const health = worst(row.name);
    const own = components.get(row.name);
    const element = make(
      "div",
      { className: `arm-health-${health}`, onclick: () => own && showComponent(row.name) },
      twig(row, foldedGroups, showHealth),
      cell(HEALTH[health] || String(health), "arm-level"),
      cell(row.name.split(row.name.includes("/") ? "/" : ": ").pop(), "arm-who", row.name),
      cell(own ? own[1] : "", "arm-text"),
    );
    element.classList.toggle("arm-chosen", row.name === component);
    return element;
  });
  const componentText = make("div", { className: "arm-detail" });
  const health = part("Diagnostics", "diagnostics", healthRows.element, componentText);
  const healthSearch = search("Search diagnostics", showHealth);
  const healthTotal = make("span", { role: "status", className: "arm-total" });
  health.tools.append(healthSearch, healthTotal);
  let groups = new Map();

  function groupsOf(name) {
    const mark = name.includes("/") ? "/" : ": ";
    const words = name.split(mark);
    return words.map((_, index) => words.slice(0, index + 1).join(mark)).filter(Boolean);
  }

  function worst(name) {
    const own = components.get(name)?.[0] ?? 0;
    // Stale is worse than fine, but not than an error.
    const rank = (level) => [0, 2, 3, 1][level] ?? 3;
    return (groups.get(name) || []).map(worst).reduce((a, b) => (rank(a) >= rank(b) ? a : b), own);
  }

  function showHealth() {
    const matches = matcher(healthSearch.value);
    const roots = new Set();
    groups = new Map();
    for (const name of components.keys()) {
      const line = groupsOf(name);
      roots.add(line[0]);
      for (let k = 1; k < line.length; k += 1) {
        if (!groups.has(line[k - 1])) groups.set(line[k - 1], []);
        if (!groups.get(line[k - 1]).includes(line[k])) groups.get(line[k - 1]).push(line[k]);
      }
    }
    const isFound = healthSearch.value ? (name) => matches(name, components.get(name)?.[1] || "") : null;
    healthRows.set(branches(groups, [...roots], foldedGroups, isFound));
    const counts = [0, 1, 2, 3].map((level) => [...components.values()].filter(([own]) => own === level).length);
    healthTotal.textContent = components.size
      ? HEALTH.map((text, level) => (counts[level] ? `${counts[level]} ${text}` : "")).filter(Boolean).join(", ")
      : "Nothing on /diagnostics";
  }

  function showComponent(name) {
    component = name;
    const [level, text, hardware, values] = components.get(name) || [0, "", "", []];
    componentText.replaceChildren(
      make("h3", { textContent: name }),
      make("p", { textContent: `${HEALTH[level] || level}${text ? `: ${text}` : ""}${hardware ? ` (${hardware})` : ""}` }),
      make("dl", {}, ...values.flatMap(([key, value]) => [make("dt", { textContent: key }), make("dd", { textContent: value })])),
    );
    healthRows.show();
  }

  armChannel.on("diagnostics", (message) => {
    components = new Map(message.components.map(([name, ...rest]) => [name, rest]));
    showHealth();
    if (!components.has(component)) component = components.keys().next().value || "";
    if (component) showComponent(component);
  });

  // -- topics -------------------------------------------------------------------------------------

  const COLUMNS = [["Topic", "arm-who"], ["Type", "arm-type"], ["Pub", "arm-number"], ["Sub", "arm-number"], ["Rate", "arm-number"], ["Bandwidth", "arm-number"], ["Delay", "arm-number"]];
  let topics = [];
  let order = [0, 1];
  const topicRows = new Rows("Topics", (topic) => {
    const texts = [topic[0], topic[1], String(topic[2]), String(topic[3]), rateText(topic[4]), bytesText(topic[5]), delayText(topic[6])];
    const plot = make("button", { type: "button", className: "arm-twig", textContent: "Plot", "aria-label": `Plot ${topic[0]}`, onclick: () => armPlots.find(topic[0]) });
    plot.dataset.key = topic[0];
    return make("div", {}, ...texts.map((text, index) => cell(text, COLUMNS[index][1])), plot);
  });
  const topicHead = make(
    "div",
    { className: "arm-head" },
    ...COLUMNS.map(([text, name], index) => make("button", { type: "button", className: `arm-cell ${name}`, textContent: text, title: `Sort by ${text.toLowerCase()}`, onclick: () => sort(index) })),
    make("span", { className: "arm-twig" }),
  );
  const topicPart = part("Topics", "topics", make("div", { className: "arm-table" }, topicHead, topicRows.element));
  const topicSearch = search("Search topics", showTopics);
  const measures = make("input", { type: "checkbox", checked: true, onchange: () => ((state.measures = measures.checked), tell()) });
  const topicTotal = make("span", { role: "status", className: "arm-total" });
  topicPart.tools.append(topicSearch, make("label", { title: "Subscribes to every topic, images included, while this part is shown" }, measures, "Measure"), topicTotal);

  const rateText = (rate) => (rate === null ? "" : `${rate.toFixed(1)} Hz`);
  const delayText = (delay) => (delay === null ? "" : `${(delay * 1000).toFixed(1)} ms`.replace("-", "\u2212"));
  const bytesText = (bytes) => (bytes === null ? "" : bytes < 1e3 ? `${bytes} B/s` : bytes < 1e6 ? `${(bytes / 1e3).toFixed(1)} kB/s` : `${(bytes / 1e6).toFixed(1)} MB/s`);

  function sort(column) {
    order = [column, order[0] === column ? -order[1] : column > 1 ? -1 : 1];
    showTopics();
  }

  function showTopics() {
    const matches = matcher(topicSearch.value);
    const [column, sign] = order;
    const compare = (a, b) => (column < 2 ? a[column].localeCompare(b[column]) : (a[column] ?? -1e9) - (b[column] ?? -1e9));
    const shown = topics.filter(([name, types]) => matches(name, types)).sort((a, b) => sign * compare(a, b));
    [...topicHead.children].forEach((head, index) => head.setAttribute("aria-sort", index !== column ? "none" : sign > 0 ? "ascending" : "descending"));
    topicTotal.textContent = `${shown.length} of ${topics.length}`;
    topicRows.set(shown);
  }

  armChannel.on("topics", (message) => {
    topics = message.topics;
    showTopics();
  });

  // -- frames -------------------------------------------------------------------------------------

  let parents = new Map();
  const foldedFrames = new Set();
  const frameRows = new Rows("Frames", (row) => {
    const name = make("button", { type: "button", className: "arm-frame", textContent: row.name, onclick: () => ask(row.name, state.within) });
    name.dataset.key = `frame ${row.name}`;
    const element = make("div", {}, twig(row, foldedFrames, showFrames), name);
    element.classList.toggle("arm-chosen", row.name === state.frame);
    return element;
  });
  const within = make("select", { "aria-label": "Seen from", onchange: () => ask(state.frame, within.value) });
  const poseText = make("dl", { className: "arm-pose" });
  const poseProblem = make("p", { role: "status" });
  const poseName = make("b");
  const pose = make("div", { className: "arm-detail" }, make("p", {}, poseName, " seen from ", within), poseProblem, poseText);
  const frames = part("Frames", "frames", frameRows.element, pose);
  const frameSearch = search("Search frames", showFrames);
  const frameTotal = make("span", { role: "status", className: "arm-total" });
  frames.tools.append(frameSearch, frameTotal);

  const root = (name) => {
    for (let k = 0; k <= parents.size && parents.has(name); k += 1) name = parents.get(name);
    return name;
  };

  function ask(frame, from) {
    state.frame = frame;
    state.within = from || root(frame);
    if (within.value !== state.within) within.value = state.within;
    poseName.textContent = frame;
    frameRows.show();
    tell();
  }

  function showFrames() {
    const children = new Map();
    for (const [child, parent] of parents) children.set(parent, [...(children.get(parent) || []), child]);
    const roots = [...new Set([...parents.values()].filter((name) => !parents.has(name)))].sort();
    const matches = matcher(frameSearch.value);
    frameRows.set(branches(children, roots, foldedFrames, frameSearch.value ? (name) => matches(name) : null));
    frameTotal.textContent = parents.size ? `${new Set([...parents.keys(), ...roots]).size} frames` : "No frames on /tf";
    const names = [...new Set([...roots, ...parents.keys()])].sort();
    if (names.join("\n") !== [...within.options].map(({ value }) => value).join("\n")) {
      within.replaceChildren(...names.map((name) => make("option", { value: name, textContent: name })));
      within.value = state.within;
    }
    const last = [...parents.keys()].at(-1);
    if (!state.frame && last) ask(last, "");
  }

  const number = (value, digits) => value.toFixed(digits).replace(/^-(0\.0*)$/, "$1").replace("-", "\u2212");

  armChannel.on("frames", (message) => {
    const isNew = message.frames.length !== parents.size || message.frames.some(([child, parent]) => parents.get(child) !== parent);
    parents = new Map(message.frames);
    if (isNew) showFrames();
    const found = message.pose;
    poseProblem.textContent = found?.problem || "";
    if (!found?.position) {
      poseText.replaceChildren();
      return;
    }
    const degrees = found.rpy.map((angle) => (angle * 180) / Math.PI);
    const line = (name, unit, labels, values, digits) => [
      make("dt", { textContent: unit ? `${name} (${unit})` : name }),
      make("dd", {}, ...labels.map((label, k) => make("span", {}, make("i", { textContent: label }), ` ${number(values[k], digits)}`))),
    ];
    poseText.replaceChildren(
      ...line("Position", "m", ["x", "y", "z"], found.position, 4),
      ...line("Rotation", "°", ["roll", "pitch", "yaw"], degrees, 2),
      ...line("Rotation", "rad", ["roll", "pitch", "yaw"], found.rpy, 4),
      ...line("Quaternion", "", ["x", "y", "z", "w"], found.quaternion, 4),
    );
  });
})();
