/* The bar at the top of the page: shows what the server says, and sends it what the user wants.

A button that cannot act now keeps its focus and says why. What is older than two seconds is greyed. */
(() => {
  "use strict";
  const STALE_MS = 2000;
  const MESSAGE_MS = 8000;
  const CONFIRM_FROM_MS = 500;
  const CONFIRM_MS = 60000;
  const STOP_MS = 3000;
  const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10, 0];
  const NO_CONTACT = "No contact with the page's process: nothing was sent.";
  const NO_STOP_SENT = "NOT STOPPED: no contact with the page's process. Stop the robot by other means.";

  let bar = null;
  let clock = null;
  let heard = -Infinity;
  let contact = false;
  let answered = null;
  let messageTimer = 0;
  let releaseTimer = 0;
  let stopTimer = 0;
  let standing = "";

  const at = (id) => document.getElementById(id);

  /* Shows a sentence for a while, or else what stands there for as long as it is true. */
  function say(text, failed) {
    const message = at("arm-message");
    const shown = text || standing;
    if (message.textContent !== shown) message.textContent = message.title = shown;
    message.classList.toggle("arm-failed", text ? failed : Boolean(standing));
    clearTimeout(messageTimer);
    messageTimer = text ? setTimeout(() => say("", false), MESSAGE_MS) : 0;
  }

  function run(fields) {
    if (!armChannel.send("run", fields)) say(NO_CONTACT, true);
  }

  function isFresh() {
    return contact && bar !== null && !bar.stale && performance.now() - heard < STALE_MS;
  }

  function reason(needs) {
    if (!contact || bar === null) return "No contact with the page's process";
    // Old news are greyed, but no reason not to try.
    return bar.reasons[needs];
  }

  function showButtons() {
    for (const button of document.querySelectorAll("#arm-bar [data-needs]")) {
      // The emergency stop is never greyed for want of news.
      const why = button.id === "arm-stop" && !contact ? "" : reason(button.dataset.needs);
      button.title = why || button.dataset.hint;
      if (button.tagName === "SELECT") button.disabled = Boolean(why);
      else button.setAttribute("aria-disabled", String(Boolean(why)));
    }
  }

  function stateText() {
    if (!contact) return "No contact";
    if (!isFresh()) return "No answer";
    if (!bar.state) return clock && clock.time_s !== null ? "Clock only" : "No simulation";
    return bar.state[0].toUpperCase() + bar.state.slice(1);
  }

  function showTime() {
    const known = clock !== null && clock.time_s !== null;
    at("arm-state").textContent = stateText();
    at("arm-clock").textContent = known ? `${clock.time_s.toFixed(2)} s` : "";
    at("arm-factor").textContent = known && clock.factor !== null ? `×${clock.factor.toFixed(2)}` : "";
    let lag = "";
    if (known && clock.silent_s !== null) lag = `no /clock for ${clock.silent_s} s`;
    else if (known && clock.lag_s !== null) lag = `${clock.lag_s.toFixed(2)} s behind`;
    at("arm-lag").textContent = lag;
    at("arm-bar").classList.toggle("arm-silent", known && clock.silent_s !== null);
    at("arm-bar").classList.toggle("arm-stale", !isFresh());
  }

  function showSpeed() {
    const select = at("arm-speed");
    if (document.activeElement === select) return;
    const speeds = SPEEDS.includes(bar.speed) || bar.speed === null ? SPEEDS : [bar.speed, ...SPEEDS];
    const wanted = speeds.join();
    if (select.dataset.speeds !== wanted) {
      select.dataset.speeds = wanted;
      select.replaceChildren(...speeds.map((speed) => new Option(speed === 0 ? "max" : `${speed}×`, speed)));
    }
    select.value = String(bar.speed ?? 1);
  }

  function showSnapshots() {
    const list = at("arm-saved");
    const wanted = JSON.stringify(bar.snapshots);
    at("arm-none-saved").hidden = bar.snapshots.length > 0;
    if (list.dataset.shown === wanted) return;
    list.dataset.shown = wanted;
    list.replaceChildren(
      ...bar.snapshots.map(([name, about]) => {
        const text = armMake("span", {}, name, armMake("small", {}, about));
        return armMake("li", {}, text, deed("Restore", name, "restore"), deed("Remove", name, "remove"));
      }),
    );
  }

  function deed(label, name, what) {
    const press = () => {
      run({ do: what, name });
      if (what === "restore") at("arm-snapshot-menu").hidePopover();
    };
    return armMake("button", { type: "button", "aria-label": `${label} ${name}`, onclick: press }, label);
  }

  function showStop() {
    const stopped = bar.stopped.length > 0;
    const all = bar.stopped.includes("/");
    if (stopped) {
      clearTimeout(stopTimer);
      stopTimer = 0;
    } else calm();
    at("arm-bar").classList.toggle("arm-stopped", stopped);
    at("arm-release").hidden = !stopped;
    at("arm-stop-word").textContent = stopped ? "Stopped" : stopTimer ? "Stopping…" : "Emergency stop";
    standing = stopped ? `Emergency stop${all ? "" : ` of ${bar.stopped.join(", ")}`}: brakes and holds until it is released` : "";
    if (!messageTimer) say("", false);
  }

  function showAnswer() {
    const { number, text, done } = bar.answer;
    if (answered !== null && number !== answered && text) say(text, !done);
    answered = number;
  }

  function showBar() {
    const playing = bar.state === "playing";
    at("arm-bar").classList.toggle("arm-playing", playing);
    at("arm-play").querySelector(".arm-word").textContent = playing ? "Pause" : "Play";
    at("arm-play").setAttribute("aria-label", playing ? "Pause" : "Play");
    showSpeed();
    showSnapshots();
    showStop();
    showAnswer();
  }

  function stop() {
    if (!armChannel.send("emergency_stop", { engaged: true })) {
      say(NO_STOP_SENT, true);
      return;
    }
    if (bar && bar.stopped.length) return;
    clearTimeout(stopTimer);
    stopTimer = setTimeout(() => {
      stopTimer = 0;
      say("The emergency stop is not confirmed: look at the robot.", true);
      if (bar) showStop();
    }, STOP_MS);
    if (bar) showStop();
  }

  /* The release takes two clicks, so that none happens by accident. */
  function release() {
    const button = at("arm-release");
    if (button.dataset.asked) {
      calm();
      if (!armChannel.send("emergency_stop", { engaged: false })) say(NO_CONTACT, true);
      return;
    }
    button.dataset.asked = "yes";
    button.textContent = "Release?";
    button.disabled = true;
    clearTimeout(releaseTimer);
    releaseTimer = setTimeout(() => {
      button.disabled = false;
      button.textContent = "Confirm release";
      button.focus();
      releaseTimer = setTimeout(calm, CONFIRM_MS);
    }, CONFIRM_FROM_MS);
  }

  function calm() {
    clearTimeout(releaseTimer);
    const button = at("arm-release");
    delete button.dataset.asked;
    button.disabled = false;
    button.textContent = "Release stop";
  }

  function openMenu(button, byMouse) {
    const menu = at(button.dataset.menu);
    menu.showPopover();
    menu.ontoggle = ({ newState }) => {
      if (newState === "closed" && byMouse) button.blur();
    };
    const place = button.getBoundingClientRect();
    menu.style.top = `${place.bottom + 4}px`;
    menu.style.left = `${Math.max(Math.min(place.left, innerWidth - menu.offsetWidth - 6), 6)}px`;
    menu.querySelector("button, input").focus();
  }

  function act(button, byMouse) {
    if (button.id === "arm-play") run({ do: bar.state === "playing" ? "pause" : "play" });
    else if (button.dataset.steps) run({ do: "step", count: Number(button.dataset.steps) });
    else if (button.dataset.menu) openMenu(button, byMouse);
    else if (button.id === "arm-stop") stop();
  }

  function reset(keepsClock) {
    const why = reason("reset");
    if (why) say(why, true);
    else run({ do: "reset", keeps_clock: keepsClock });
  }

  function restoreLast() {
    const why = reason("restore");
    if (why) say(why, true);
    else run({ do: "restore", name: bar.snapshots[bar.snapshots.length - 1][0] });
  }

  function save(name) {
    const why = reason("save");
    if (why) say(why, true);
    else run({ do: "save", name });
  }

  function begin() {
    at("arm-bar").addEventListener("click", (event) => {
      const button = event.target.closest("button");
      if (!button) return;
      // After the mouse, the space bar is the key for play and pause again.
      const byMouse = event.detail > 0;
      if (byMouse && !button.dataset.menu) button.blur();
      if (button.id === "arm-release") release();
      else if (button.getAttribute("aria-disabled") === "true") say(button.title, true);
      else act(button, byMouse);
    });
    // Whoever turns to something else has not confirmed the release.
    addEventListener("pointerdown", (event) => {
      if (!at("arm-release").contains(event.target)) calm();
    });
    at("arm-speed").addEventListener("change", (event) => {
      run({ do: "speed", factor: Number(event.target.value) });
      event.target.blur();
    });
    at("arm-reset-menu").addEventListener("click", (event) => {
      const button = event.target.closest("button");
      if (!button) return;
      at("arm-reset-menu").hidePopover();
      reset(button.dataset.reset === "keep");
    });
    at("arm-save").addEventListener("submit", (event) => {
      event.preventDefault();
      save(at("arm-name").value);
      at("arm-name").value = "";
    });
    setInterval(() => {
      showButtons();
      showTime();
    }, 500);
  }

  armChannel.on("time_bar", (message) => {
    bar = message;
    heard = performance.now();
    showBar();
    showButtons();
    showTime();
  });
  armChannel.on("clock", (message) => {
    clock = message;
    showTime();
  });
  armChannel.on("refused", (message) => {
    if (message.of === "run" || message.of === "emergency_stop") say(message.problem, true);
  });
  armChannel.onChange((connected) => {
    contact = connected;
    // Another process may count its answers anew.
    if (!connected) answered = null;
    showButtons();
    showTime();
  });
  addEventListener("DOMContentLoaded", begin);

  window.armTime = {
    say,
    press: (selector) => document.querySelector(`#arm-bar ${selector}`).click(),
    faster: (steps) => {
      const select = at("arm-speed");
      const next = select.selectedIndex + steps;
      if (select.disabled) say(select.title, true);
      else if (select.options[next]) run({ do: "speed", factor: Number(select.options[next].value) });
    },
    reset,
    restoreLast,
    save,
    stop: () => at("arm-stop").click(),
  };
})();
