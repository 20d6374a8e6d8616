/* Recordings: the list and the recorder in a menu of the bar, and the timeline at the bottom.

The server plays and reads; this script shows what it says and sends what the user wants. */
(() => {
  "use strict";
  const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];
  const SEEK_MS = 40;
  const REFUSED_MS = 4000;
  const STEPS_S = [0.1, 0.2, 0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600];
  const NOT_LIVE = "not live: nothing here moves a robot";
  const NO_CONTACT = "No contact with the page's process";
  const PADDING = 10;

  let open = { name: "" };
  let moment = 0;
  let curve = null;
  let recorder = null;
  let dragged = null;
  let sought = 0;
  let seekTimer = 0;
  let refusals = null;
  let stopped = null;
  let refusedTimer = 0;
  let isDrawn = true;

  const at = (id) => document.getElementById(id);

  function send(kind, fields) {
    if (!armChannel.send(kind, fields)) showProblem(NO_CONTACT);
  }

  const act = (deed, fields) => send("timeline", { do: deed, ...fields });

  function clockText(seconds, digits = 2) {
    const whole = Math.max(seconds, 0).toFixed(digits);
    const minutes = Math.floor(Number(whole) / 60);
    const rest = (Number(whole) - 60 * minutes).toFixed(digits).padStart(digits ? 3 + digits : 2, "0");
    const hours = Math.floor(minutes / 60);
    return hours ? `${hours}:${String(minutes % 60).padStart(2, "0")}:${rest}` : `${minutes}:${rest}`;
  }

  function sizeText(bytes) {
    const units = ["B", "KiB", "MiB", "GiB", "TiB"];
    let value = bytes;
    let unit = 0;
    for (; value >= 1000 && unit < units.length - 1; unit += 1) value /= 1024;
    return `${value.toFixed(unit > 1 && value < 99.5 ? 1 : 0)} ${units[unit]}`;
  }

  function showProblem(text) {
    at("arm-recordings-problem").textContent = text;
    at("arm-curve-note").textContent = open.name ? text : "";
  }

  /* The open recording. */

  function showOpen() {
    const isOpen = Boolean(open.name);
    const run = open.run;
    document.documentElement.classList.toggle("arm-replay", isOpen);
    document.documentElement.classList.toggle("arm-checks", Boolean(run) && !isOpen);
    document.documentElement.classList.toggle("arm-verified", Boolean(run) && isOpen);
    at("arm-bar").classList.toggle("arm-replayed", isOpen);
    at("arm-banner").hidden = !isOpen && !run;
    at("arm-timeline").hidden = !isOpen;
    at("arm-banner-kind").textContent = run ? "RECORDED RUN" : "RECORDING";
    at("arm-banner-name").textContent = run ? run.name : open.name;
    at("arm-live").textContent = isOpen ? "Back to live" : run && run.is_over ? "Close" : "Cancel";
    showRun(isOpen, run);
    if (!isOpen) return;
    at("arm-timeline").classList.toggle("arm-plays", open.playing);
    at("arm-deck-play").setAttribute("aria-label", open.playing ? "Pause" : "Play");
    at("arm-length").textContent = `/ ${clockText(open.length_s)}`;
    at("arm-track").setAttribute("aria-valuemax", open.length_s.toFixed(3));
    showSpeed();
    showNumbers();
    showMarks();
    if (open.problem) showProblem(open.problem);
    drawSoon();
  }

  /* What is known about a run: beside the timeline once it is shown, until then in the banner. */
  function showRun(isOpen, run) {
    at("arm-verdict").hidden = !run;
    at("arm-run").textContent = run ? `${sign(run)} ${run.text}` : "";
    at("arm-verdict").title = run ? [run.text, ...run.differences, ...run.details].join("\n") : "";
    at("arm-verdict").classList.toggle("arm-differs", Boolean(run) && run.is_over && !run.is_equal);
    const differs = Boolean(run) && run.differences.length > 0;
    at("arm-run-said").textContent = differs ? run.text.split(":")[0] : run ? run.text : "";
    at("arm-run-differs").hidden = !differs;
    at("arm-run-differences").replaceChildren(...lines(run ? run.differences : []));
    at("arm-run-more").replaceChildren(...lines(run ? run.details : []));
    at("arm-run-end").hidden = !run || run.differs_s === null;
    if (!isOpen) at("arm-run-menu").hidePopover();
    const banner = at("arm-banner");
    if (!banner.classList.contains("arm-refused")) {
      banner.querySelector(".arm-word").textContent = isOpen || !run ? NOT_LIVE : `${run.text}; the page is live`;
    }
  }

  function sign(run) {
    if (!run.is_over) return "…";
    if (run.is_equal) return "✓";
    return run.differs_s === null ? "!" : "≠";
  }

  const lines = (texts) => texts.map((text) => armMake("li", {}, text));

  function showSpeed() {
    const select = at("arm-deck-speed");
    const speeds = SPEEDS.includes(open.speed) ? SPEEDS : [...SPEEDS, open.speed];
    if (select.options.length !== speeds.length) {
      select.replaceChildren(...speeds.map((speed) => new Option(`${speed}×`, speed)));
    }
    select.value = String(open.speed);
  }

  function showNumbers() {
    const select = at("arm-curve");
    const wanted = JSON.stringify(open.numbers);
    if (select.dataset.shown !== wanted) {
      select.dataset.shown = wanted;
      const groups = new Map();
      for (const [topic, number] of open.numbers) {
        if (!groups.has(topic)) {
          groups.set(topic, armMake("optgroup", { label: topic }));
        }
        groups.get(topic).append(new Option(number, JSON.stringify([topic, number])));
      }
      select.replaceChildren(...groups.values());
      select.disabled = open.numbers.length === 0;
    }
    if (curve) select.value = JSON.stringify([curve.topic, curve.number]);
  }

  function showMarks() {
    at("arm-marks").replaceChildren(
      ...open.marks.map(([time, text]) => {
        const name = text || clockText(time);
        return armMake(
          "li",
          {},
          armMake("span", {}, text || "mark", armMake("small", {}, clockText(time))),
          button("Go", `Go to ${name}`, () => seek(time, true)),
          button("Remove", `Remove ${name}`, () => act("unmark", { time_s: time })),
        );
      }),
    );
  }

  function button(label, name, act) {
    return armMake("button", { type: "button", "aria-label": name, onclick: act }, label);
  }

  function showMoment() {
    const now = shown();
    at("arm-moment").textContent = clockText(now);
    at("arm-date").textContent = open.name && !open.run ? new Date(1000 * (open.began_s + now)).toLocaleString() : "";
    const track = at("arm-track");
    track.setAttribute("aria-valuenow", now.toFixed(3));
    track.setAttribute("aria-valuetext", clockText(now));
    drawSoon();
  }

  function shown() {
    return dragged === null ? moment : dragged;
  }

  /* Sends where the user is, at most every SEEK_MS, and the last place in any case. */
  function seek(time, isLast) {
    const wanted = Math.min(Math.max(time, 0), open.open_s);
    moment = wanted;
    if (dragged !== null) dragged = wanted;
    clearTimeout(seekTimer);
    const wait = sought + SEEK_MS - performance.now();
    const go = () => {
      sought = performance.now();
      act("seek", { time_s: wanted });
    };
    if (isLast || wait <= 0) go();
    else seekTimer = setTimeout(go, wait);
    showMoment();
  }

  function toggle() {
    act(open.playing ? "pause" : "play");
  }

  function faster(steps) {
    const next = SPEEDS[SPEEDS.indexOf(open.speed) + steps];
    if (next) act("speed", { factor: next });
  }

  function showRefused() {
    const isNew = refusals !== null && open.refusals > refusals;
    refusals = open.refusals;
    if (!isNew) return;
    const banner = at("arm-banner");
    banner.querySelector(".arm-word").textContent = open.refused;
    banner.classList.add("arm-refused");
    clearTimeout(refusedTimer);
    refusedTimer = setTimeout(() => {
      banner.classList.remove("arm-refused");
      banner.querySelector(".arm-word").textContent = NOT_LIVE;
    }, REFUSED_MS);
  }

  /* A verification that somebody ended: what it did not compare. */
  function showStopped() {
    at("arm-stopped").textContent = open.stopped;
    if (stopped !== null && open.stopped && open.stopped !== stopped) armTime.say(open.stopped, false);
    stopped = open.stopped;
  }

  /* The track: the curve, the marks, the played part and the moment. */

  function drawSoon() {
    if (!isDrawn) return;
    isDrawn = false;
    requestAnimationFrame(draw);
  }

  function draw() {
    isDrawn = true;
    const canvas = at("arm-track");
    const { width, height } = canvas.getBoundingClientRect();
    if (!open.name || width < 2 || height < 2) return;
    const scale = devicePixelRatio || 1;
    const size = [Math.round(width * scale), Math.round(height * scale)];
    if (canvas.width !== size[0]) canvas.width = size[0];
    if (canvas.height !== size[1]) canvas.height = size[1];
    // Drawn by the processor: the graphics card is emulated where there is none.
    const paint = canvas.getContext("2d", { willReadFrequently: true });
    paint.setTransform(scale, 0, 0, scale, 0, 0);
    paint.clearRect(0, 0, width, height);
    paint.font = "12px system-ui, sans-serif";
    const place = (time) => PADDING + ((width - 2 * PADDING) * time) / (open.length_s || 1);
    const floor = height - 18;
    paint.fillStyle = "#f1f3f5";
    paint.fillRect(PADDING, 0, width - 2 * PADDING, floor);
    paint.fillStyle = "#ffe3b8";
    paint.fillRect(PADDING, 0, place(shown()) - PADDING, floor);
    if (open.run) drawUncompared(paint, place, floor);
    drawTicks(paint, place, width, floor);
    drawCurve(paint, place, floor);
    drawMarks(paint, place, width, floor);
    paint.fillStyle = "#b45300";
    paint.fillRect(place(shown()) - 1, 0, 2, floor);
    paint.beginPath();
    paint.arc(place(shown()), floor, 6, 0, 2 * Math.PI);
    paint.fill();
  }

  /* What of a run is not compared is hatched, and the first difference is a red line. */
  function drawUncompared(paint, place, floor) {
    const [from, to] = [place(open.open_s), place(open.length_s)];
    if (to - from >= 1) {
      paint.save();
      paint.beginPath();
      paint.rect(from, 0, to - from, floor);
      paint.clip();
      paint.strokeStyle = "#adb5bd";
      paint.lineWidth = 1;
      paint.beginPath();
      for (let x = from - floor; x < to; x += 9) {
        paint.moveTo(x, floor);
        paint.lineTo(x + floor, 0);
      }
      paint.stroke();
      const words = open.run.is_over ? "not compared" : "not compared yet";
      const size = paint.measureText(words).width + 8;
      paint.fillStyle = "#fff";
      paint.fillRect(to - size, 0, size, 17);
      paint.fillStyle = "#495057";
      paint.textAlign = "right";
      paint.fillText(words, to - 4, 13);
      paint.restore();
    }
    if (open.run.differs_s !== null) {
      paint.fillStyle = "#b02525";
      paint.fillRect(place(open.run.differs_s) - 1, 0, 2, floor);
    }
  }

  function drawTicks(paint, place, width, floor) {
    const step = STEPS_S.find((step) => place(step) - place(0) >= 70) || 7200;
    paint.textAlign = "center";
    for (let time = 0; time <= open.length_s + 1e-6; time += step) {
      const x = place(time);
      paint.fillStyle = "#ced4da";
      paint.fillRect(x, 0, 1, floor + 4);
      paint.fillStyle = "#495057";
      if (x > 16 && x < width - 16) paint.fillText(clockText(time, step < 1 ? 1 : 0), x, floor + 15);
    }
  }

  function drawCurve(paint, place, floor) {
    if (!curve || !curve.low.length) return;
    const known = [...curve.low, ...curve.high].filter((value) => value !== null);
    if (!known.length) return;
    const low = known.reduce((least, value) => Math.min(least, value), Infinity);
    const high = known.reduce((most, value) => Math.max(most, value), -Infinity);
    const room = high > low ? high - low : 1;
    const y = (value) => 5 + (floor - 10) * (high > low ? (high - value) / room : 0.5);
    const time = (column) => ((column + 0.5) * open.length_s) / curve.low.length;
    paint.strokeStyle = "#1864ab";
    paint.lineWidth = 1.2;
    paint.beginPath();
    let before = -1;
    curve.low.forEach((least, column) => {
      if (least === null) return;
      const x = place(time(column));
      // What was not recorded is a gap; a slow topic leaves columns out between two messages.
      if (before < 0 || column - before > Math.max(3, curve.low.length / 50)) paint.moveTo(x, y(least));
      else paint.lineTo(x, y(least));
      paint.lineTo(x, y(curve.high[column]));
      before = column;
    });
    paint.stroke();
    paint.fillStyle = "#1864ab";
    paint.textAlign = "left";
    const text = (value) => (Math.abs(value) < 1e-9 ? "0" : Number(value.toPrecision(4)).toString());
    paint.fillText(text(high), PADDING + 3, 13);
    if (high > low) paint.fillText(text(low), PADDING + 3, floor - 4);
  }

  function drawMarks(paint, place, width, floor) {
    for (const [time, text] of open.marks) {
      const x = place(time);
      paint.fillStyle = "#862e9c";
      paint.fillRect(x - 1, 0, 2, floor);
      paint.beginPath();
      paint.moveTo(x - 1, 0);
      paint.lineTo(x + 9, 5);
      paint.lineTo(x - 1, 10);
      paint.fill();
      paint.textAlign = x > width - 120 ? "right" : "left";
      paint.fillText(text.length > 24 ? `${text.slice(0, 23)}…` : text, x + (x > width - 120 ? -5 : 11), 24);
    }
  }

  function pointed(event) {
    const { left, width } = at("arm-track").getBoundingClientRect();
    return ((event.clientX - left - PADDING) / (width - 2 * PADDING)) * open.length_s;
  }

  /* The list and the recorder. */

  function showList({ folder, found }) {
    at("arm-folder").textContent = found.length ? `In ${folder}` : `No recording yet in ${folder}`;
    at("arm-found").replaceChildren(
      ...found.map(([name, bytes, changed, isRun]) => {
        const about = `${isRun ? "run, " : ""}${sizeText(bytes)}, ${new Date(1000 * changed).toLocaleString()}`;
        const deed = button("Open", `Open ${name}`, () => {
          showProblem("");
          act("open", { name });
        });
        return armMake("li", {}, armMake("span", {}, name, armMake("small", {}, about)), deed);
      }),
    );
  }

  function showRecorder() {
    const { recording, starting, seconds, bytes, dropped, path, said } = recorder;
    const drops = starting ? "starting" : dropped ? `${dropped} messages DROPPED` : "nothing dropped";
    const dot = armMake("span", { className: "arm-dot" }, "●");
    at("arm-record-button").textContent = recording ? "Stop" : "Record";
    at("arm-topics").disabled = recording;
    at("arm-run-button").hidden = recording;
    const line = at("arm-recorder");
    if (recording) line.replaceChildren(dot, ` ${clockText(seconds, 0)}, ${sizeText(bytes)}, ${drops}, in ${path}`);
    else line.textContent = said;
    const word = at("arm-recordings");
    word.title = recording ? `Recording to ${path}` : word.dataset.hint;
    word.querySelector(".arm-rec").replaceChildren(...(recording ? [dot.cloneNode(true)] : []));
    word.querySelector(".arm-word").textContent = recording ? sizeText(bytes) : "Recordings";
  }

  function record() {
    showProblem("");
    if (recorder && recorder.recording) send("record", { do: "stop" });
    else {
      const topics = at("arm-topics").value.split(/[\s,]+/).filter(Boolean);
      send("record", { do: "start", topics });
    }
  }

  function openMark() {
    openAbove("arm-mark-menu", "arm-mark");
    at("arm-mark-text").focus();
  }

  function openAbove(menuId, buttonId) {
    const menu = at(menuId);
    menu.showPopover();
    const place = at(buttonId).getBoundingClientRect();
    menu.style.top = `${place.top - menu.offsetHeight - 6}px`;
    menu.style.left = `${Math.max(Math.min(place.left, innerWidth - menu.offsetWidth - 6), 6)}px`;
  }

  function begin() {
    const track = at("arm-track");
    at("arm-live").addEventListener("click", () => act("live"));
    at("arm-deck-play").addEventListener("click", toggle);
    at("arm-deck-speed").addEventListener("change", (event) => {
      act("speed", { factor: Number(event.target.value) });
      event.target.blur();
    });
    at("arm-curve").addEventListener("change", (event) => {
      const [topic, number] = JSON.parse(event.target.value);
      act("curve", { topic, number });
      event.target.blur();
    });
    at("arm-timeline").addEventListener("click", (event) => {
      const by = event.target.closest("[data-by]");
      if (by) seek(shown() + Number(by.dataset.by), true);
      // After the mouse, the space bar plays and pauses again.
      if (event.detail > 0 && event.target.closest("button") && event.target.id !== "arm-mark") {
        event.target.closest("button").blur();
      }
    });
    track.addEventListener("pointerdown", (event) => {
      track.setPointerCapture(event.pointerId);
      dragged = moment;
      seek(pointed(event), false);
    });
    track.addEventListener("pointermove", (event) => {
      if (dragged !== null) seek(pointed(event), false);
    });
    for (const kind of ["pointerup", "pointercancel"]) {
      track.addEventListener(kind, () => {
        if (dragged === null) return;
        seek(dragged, true);
        dragged = null;
      });
    }
    track.addEventListener("keydown", (event) => {
      const place = { Home: 0, End: open.length_s }[event.key];
      const by = { PageUp: 10, PageDown: -10 }[event.key];
      if (place === undefined && by === undefined) return;
      event.preventDefault();
      seek(place ?? shown() + by, true);
    });
    at("arm-record").addEventListener("submit", (event) => {
      event.preventDefault();
      record();
    });
    at("arm-run-button").addEventListener("click", () => {
      showProblem("");
      send("record", { do: "start_run" });
    });
    at("arm-recordings").addEventListener("click", () => send("recordings", {}));
    at("arm-mark").addEventListener("click", openMark);
    at("arm-verdict").addEventListener("click", () => openAbove("arm-run-menu", "arm-verdict"));
    at("arm-run-end").addEventListener("click", () => {
      at("arm-run-menu").hidePopover();
      seek(open.open_s, true);
    });
    at("arm-mark-form").addEventListener("submit", (event) => {
      event.preventDefault();
      act("mark", { time_s: shown(), text: at("arm-mark-text").value });
      at("arm-mark-text").value = "";
      at("arm-mark-menu").hidePopover();
    });
    new ResizeObserver(drawSoon).observe(track);
  }

  armChannel.on("timeline", (message) => {
    const shown = message.name || message.run?.name;
    if (shown && shown !== (open.name || open.run?.name)) {
      at("arm-recordings-menu").hidePopover();
      showProblem("");
    }
    open = message;
    showOpen();
    showMoment();
    showRefused();
    showStopped();
  });
  armChannel.on("timeline_moment", (message) => {
    moment = message.time_s;
    showMoment();
  });
  armChannel.on("timeline_curve", (message) => {
    curve = message;
    const parts = [message.read ? "" : "reading…"];
    if (message.skipped) parts.push(`${message.skipped} messages of another layout left out`);
    at("arm-curve-note").textContent = parts.filter(Boolean).join(" ");
    if (open.name) showNumbers();
    drawSoon();
  });
  armChannel.on("recordings", showList);
  armChannel.on("record", (message) => {
    recorder = message;
    showRecorder();
  });
  armChannel.on("refused", (message) => {
    if (["timeline", "record"].includes(message.of)) showProblem(message.problem);
  });
  addEventListener("DOMContentLoaded", begin);

  /* Keys: what they mean while a recording is open; false leaves them to the live simulation. */
  const KEYS = {
    Space: toggle,
    "→": () => seek(shown() + 1, true),
    "←": () => seek(shown() - 1, true),
    ".": () => seek(shown() + 0.1, true),
    "Shift →": () => seek(shown() + 10, true),
    "Shift ←": () => seek(shown() - 10, true),
    "↑": () => faster(1),
    "↓": () => faster(-1),
    M: openMark,
  };
  window.armTimeline = {
    isOpen: () => Boolean(open.name),
    key(name) {
      if (!open.name || !KEYS[name]) return false;
      KEYS[name]();
      return true;
    },
  };
})();
