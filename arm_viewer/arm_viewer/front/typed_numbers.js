/* Send numbers typed beside the sliders when they are complete, exactly as typed.

viser's own field sends a number at every key: "-0.5" is first 0 and then 0.5, because the sign is
lost. It also overwrites the typed text with the joint's position. This script therefore puts its own
field over viser's while the user types. Enter, Tab or leaving the field sends the text to the
server, which answers with the problem, or with nothing. */
(() => {
  "use strict";
  const FIELD = "input.mantine-NumberInput-input";
  const KIND = "typed_number";
  const NO_CONTACT = "The page's server does not answer: the number was not taken.";
  const SHOWN_MS = 10000;

  let editor = null;
  let last = 0;
  let tabbing = false;
  const waiting = new Map();

  function sliderOf(field) {
    const row = field.closest(".mantine-Flex-root");
    return row ? row.querySelector(".mantine-Slider-root") : null;
  }

  function isNumberOfSlider(target) {
    return target instanceof HTMLInputElement && target.matches(FIELD) && sliderOf(target);
  }

  function take({ number, problem }) {
    const field = waiting.get(number);
    waiting.delete(number);
    if (field && problem) showProblem(field, problem);
  }

  armChannel.on(KIND, take);
  armChannel.on("refused", (message) => {
    if (message.of === KIND) take(message);
  });
  armChannel.onChange((connected) => {
    if (connected) return;
    waiting.forEach((field) => showProblem(field, NO_CONTACT));
    waiting.clear();
  });

  function send(field, slider, text) {
    const number = ++last;
    if (armChannel.send(KIND, { number, slider, text })) waiting.set(number, field);
    else showProblem(field, NO_CONTACT);
  }

  function showProblem(field, problem) {
    const note = armMake("div", { role: "status", className: "arm-problem" }, problem);
    document.body.append(note);
    const place = field.getBoundingClientRect();
    note.style.top = `${place.bottom + 4}px`;
    note.style.right = `${Math.max(innerWidth - place.right, 8)}px`;
    setTimeout(() => note.remove(), SHOWN_MS);
  }

  function coverField(field) {
    const place = field.getBoundingClientRect();
    for (const side of ["left", "top", "width", "height"]) editor.style[side] = `${place[side]}px`;
  }

  function edit(field) {
    const slider = sliderOf(field).id;
    let sent = field.value;
    const own = armMake("input", {
      type: "text",
      inputMode: "decimal",
      autocomplete: "off",
      spellcheck: false,
      className: `${field.className} arm-editor`,
      "aria-label": "position",
      value: sent,
    });
    editor = own;
    coverField(field);
    document.body.append(own);
    const follow = () => coverField(field);
    const commit = () => {
      if (own.value !== sent) send(field, slider, own.value);
      sent = own.value;
    };
    const close = () => {
      if (editor !== own) return;
      editor = null;
      commit();
      removeEventListener("scroll", follow, true);
      removeEventListener("resize", follow);
      own.remove();
    };
    own.addEventListener("blur", close);
    own.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Enter") {
        sent = null;
        commit();
        own.select();
      } else if (event.key === "Escape") {
        own.value = sent;
        close();
      } else if (event.key === "Tab") {
        // Tab then continues from viser's field, as if the user had typed there.
        tabbing = true;
        field.focus();
        tabbing = false;
      }
    });
    addEventListener("scroll", follow, true);
    addEventListener("resize", follow);
    own.focus();
    own.select();
  }

  function guard(kind, handle) {
    // In the capture phase, before viser's page sees the event.
    addEventListener(
      kind,
      (event) => {
        if (!isNumberOfSlider(event.target)) return;
        event.stopImmediatePropagation();
        handle(event.target);
      },
      true,
    );
  }

  guard("focusin", (field) => {
    if (!tabbing) edit(field);
  });
  guard("focusout", () => {});
  guard("keydown", () => {});
  // Text dropped on the field, or set by a program.
  guard("input", (field) => send(field, sliderOf(field).id, field.value));
})();
