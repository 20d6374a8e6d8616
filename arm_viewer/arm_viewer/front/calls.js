/* The tab `Calls` of the dock: services, actions, topics and parameters, found by typing.

The server makes the form from the type. What was typed is kept for this browser, by the name. */
(() => {
  "use strict";
  const make = armMake;
  const KEPT = "arm-call:";
  const MOST_SHOWN = 200;
  const NO_CONTACT = "No contact with the page's process: nothing was sent.";
  const READ_ONLY = "This page is read-only: nothing can be called.";
  const PHONE = matchMedia("(max-width: 700px)");
  const KINDS = { service: "service", action: "action", topic: "topic", parameters: "parameters of" };

  const isReadOnly = document.documentElement.classList.contains("arm-read-only");
  let callees = [];
  let chosen = null;
  let fields = [];
  let last = 0;
  let opening = 0;
  let placed = 0;

  const { body, tools } = armDock.add("Calls", (isShown) => {
    if (isShown) list();
  });

  const finder = make("input", { type: "search", placeholder: "Find a service, topic, action or node", size: 34, "aria-label": "Find what to call" });
  const back = make("button", { type: "button", className: "arm-call-back", textContent: "‹ All" });
  tools.append(back, finder);
  const box = make("div", { className: "arm-calls" });
  const found = make("div", { className: "arm-call-list" });
  const form = make("form", { noValidate: true, autocomplete: "off" });
  const answer = make("div");
  const told = make("p", { className: "arm-call-told", role: "status" });
  const text = make("pre", { className: "arm-call-answer" });
  answer.append(told, text);
  box.append(found, form, answer);
  body.append(box);
  form.append(make("p", { className: "arm-hint", textContent: "Choose what to call. Its form is made from its type." }));

  function fits([kind, name, type]) {
    const words = finder.value.toLowerCase().split(/\s+/).filter(Boolean);
    const whole = `${KINDS[kind]} ${name} ${type}`.toLowerCase();
    return words.every((word) => whole.includes(word));
  }

  function list() {
    const wanted = callees.filter(fits);
    const rows = wanted.slice(0, MOST_SHOWN).map((callee) => {
      const [kind, name, type] = callee;
      const row = make("button", { type: "button" }, name, make("small", { textContent: `${KINDS[kind]} ${type}` }));
      if (kind === "parameters") row.lastChild.textContent = "parameters";
      row.setAttribute("aria-pressed", String(chosen !== null && chosen[0] === kind && chosen[1] === name));
      row.addEventListener("click", () => choose(callee));
      return row;
    });
    if (!wanted.length) {
      const why = callees.length ? "Nothing that can be called has these words." : "Nothing can be called yet.";
      rows.push(make("p", { className: "arm-hint", textContent: why }));
    } else if (wanted.length > MOST_SHOWN) {
      rows.push(make("p", { className: "arm-hint", textContent: `And ${wanted.length - MOST_SHOWN} more: type a part of the name.` }));
    }
    const top = found.scrollTop;
    found.replaceChildren(...rows);
    found.scrollTop = top;
  }

  function say(sentence, state = "", shown = "") {
    told.textContent = sentence;
    told.className = `arm-call-told ${state}`;
    text.textContent = shown;
    // On a phone the answer is below a long form.
    if (sentence && PHONE.matches) told.scrollIntoView({ block: "nearest" });
  }

  function choose(callee) {
    chosen = callee;
    placed = 0;
    fields = [];
    box.classList.add("arm-chosen");
    back.hidden = false;
    list();
    say("");
    form.replaceChildren(head(), make("p", { className: "arm-hint", textContent: "Waiting for its form" }));
    open();
  }

  function open() {
    opening = ++last;
    const [kind, name] = chosen;
    if (isReadOnly) form.lastChild.textContent = READ_ONLY;
    else if (!armChannel.send("call_form", { number: opening, of: kind, name })) form.lastChild.textContent = NO_CONTACT;
  }

  function head() {
    const [kind, name, type] = chosen;
    return make("h3", { className: "arm-call-head" }, name, make("small", { textContent: kind === "parameters" ? "parameters of this node" : `${kind} ${type}` }));
  }

  function kept() {
    try {
      return JSON.parse(localStorage.getItem(KEPT + chosen[0] + chosen[1])) || {};
    } catch {
      return {};
    }
  }

  function keep() {
    try {
      localStorage.setItem(KEPT + chosen[0] + chosen[1], JSON.stringify(changed()));
    } catch {
      // A browser may refuse to keep anything.
    }
  }

  function valueOf(field) {
    return field.kind === "flag" ? String(field.input.checked) : field.input.value;
  }

  /* What differs from the form as it came. */
  function changed() {
    return Object.fromEntries(fields.filter((f) => valueOf(f) !== f.text).map((f) => [f.path, valueOf(f)]));
  }

  function hint({ type, least, most, about, fixed }) {
    const range = least !== null && most !== null ? ` from ${least} to ${most}` : "";
    const now = type === "builtin_interfaces/msg/Time" ? ", or now" : "";
    return `${type}${now}${/^u?int/.test(type) ? "" : range}${fixed ? ", cannot be set" : ""}${about ? ` · ${about}` : ""}`;
  }

  function row(field, index) {
    const id = `arm-call-${index}`;
    const isText = field.kind === "yaml" || (field.kind === "text" && field.text.includes("\n"));
    const input = make(isText ? "textarea" : "input", { id, spellcheck: false, disabled: field.fixed, title: hint(field) });
    if (field.kind === "flag") Object.assign(input, { type: "checkbox", checked: field.text === "true" });
    else input.value = field.text;
    if (field.kind === "integer" || field.kind === "number") input.inputMode = "decimal";
    if (isText) input.rows = 1;
    field.input = input;
    const label = make("label", { htmlFor: id, textContent: field.path });
    const line = make("div", { className: "arm-call-row" }, label, input, make("small", { textContent: hint(field) }));
    field.mark = () => line.classList.toggle("arm-changed", valueOf(field) !== field.text);
    input.addEventListener("input", () => {
      field.mark();
      if (chosen[0] !== "parameters") keep();
      showDeeds();
    });
    return line;
  }

  function deed(label, act, isMain = false) {
    const button = make("button", { type: isMain ? "submit" : "button", textContent: label });
    if (isMain) button.className = "arm-main";
    else button.addEventListener("click", act);
    return button;
  }

  let main = null;
  let stop = null;
  let again = null;
  const rate = make("input", { type: "text", inputMode: "decimal", value: "10" });
  rate.setAttribute("aria-label", "Rate in Hz");

  function showForm() {
    const [kind] = chosen;
    main = deed({ service: "Call", action: "Send goal", topic: "Publish once", parameters: "Set changed" }[kind], null, true);
    stop = deed({ service: "Stop waiting", action: "Cancel goal", topic: "Stop", parameters: "Stop waiting" }[kind], () => {
      if (!armChannel.send("call_end", { number: placed })) say(NO_CONTACT, "arm-failed");
    });
    again = kind === "topic" ? deed("Publish at", () => place(Number(rate.value))) : null;
    const reset = deed(kind === "parameters" ? "Read again" : "Defaults", () => {
      if (kind === "parameters") return open();
      fields.forEach((f) => {
        if (f.kind === "flag") f.input.checked = f.text === "true";
        else f.input.value = f.text;
        f.mark();
      });
      keep();
    });
    const deeds = make("div", { className: "arm-call-deeds" }, main);
    if (again) deeds.append(again, rate, "Hz");
    deeds.append(stop, reset);
    const rows = fields.map(row);
    if (!rows.length) rows.push(make("p", { className: "arm-hint", textContent: kind === "parameters" ? "It has no parameters." : "It has no fields." }));
    form.replaceChildren(head(), ...rows, deeds);
    if (kind !== "parameters") {
      const values = kept();
      for (const field of fields) {
        if (!(field.path in values)) continue;
        if (field.kind === "flag") field.input.checked = values[field.path] === "true";
        else field.input.value = values[field.path];
        field.mark();
      }
    }
    showDeeds();
  }

  function showDeeds() {
    if (!main) return;
    main.disabled = placed !== 0 || (chosen[0] === "parameters" && !Object.keys(changed()).length);
    if (again) again.disabled = placed !== 0;
    stop.disabled = placed === 0;
  }

  function place(hertz) {
    const [kind, name] = chosen;
    if (!(hertz >= 0)) return say(`'${rate.value}' is not a rate in Hz.`, "arm-failed");
    const number = ++last;
    if (!armChannel.send("call_place", { number, of: kind, name, typed: changed(), rate_hz: hertz })) {
      return say(NO_CONTACT, "arm-failed");
    }
    placed = number;
    say("Sent", "arm-waits");
    showDeeds();
  }

  form.addEventListener("submit", (event) => {
    event.preventDefault();
    if (main && !main.disabled) place(0);
  });
  form.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && event.target.tagName === "TEXTAREA" && (event.ctrlKey || event.metaKey)) form.requestSubmit();
  });
  finder.addEventListener("input", list);
  finder.addEventListener("keydown", (event) => {
    if (event.key === "Enter") found.querySelector("button")?.click();
  });
  back.hidden = true;
  back.addEventListener("click", () => {
    box.classList.remove("arm-chosen");
    back.hidden = true;
  });

  armChannel.on("callees", (message) => {
    callees = message.callees;
    if (!body.hidden) list();
  });
  armChannel.on("call", ({ number, text: sentence, answer: shown, over, failed, form: made }) => {
    if (number === opening) {
      if (made) {
        fields = made;
        showForm();
      } else {
        form.lastChild.textContent = sentence;
        if (failed) form.lastChild.style.color = "#b02525";
      }
    } else if (number === placed) {
      if (over) placed = 0;
      say(sentence, failed ? "arm-failed" : over ? "" : "arm-waits", shown);
      showDeeds();
      if (over && !failed && chosen[0] === "parameters") open();
    }
  });
  armChannel.on("refused", ({ of, number, problem }) => {
    if (!["call_form", "call_place", "call_end"].includes(of)) return;
    if (number === placed) placed = 0;
    say(`${problem[0].toUpperCase()}${problem.slice(1)}.`, "arm-failed");
    showDeeds();
  });
  armChannel.onChange((connected) => {
    if (connected || !placed) return;
    placed = 0;
    say("Contact with the page was lost: nobody knows here what became of it.", "arm-failed");
    showDeeds();
  });
})();
