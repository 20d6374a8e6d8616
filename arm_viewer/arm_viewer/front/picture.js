/* A picture at its full size in place of the 3D view, and the value of the pixel under the pointer.

The server sends a picture each time this script asks for the next one. */
(() => {
  "use strict";
  const FRAME = 3;
  const ASK_AGAIN_MS = 1000;
  const PLACE_MS = 250;

  let topics = [];
  let chosen = "";
  let about = null;
  let place = null;
  let askTimer = 0;
  let placeTimer = 0;

  const at = (id) => document.getElementById(id);
  const isOpen = () => !at("arm-picture").hidden;

  function ask(first = false) {
    clearTimeout(askTimer);
    if (!isOpen()) return;
    armChannel.send("picture_next", { topic: chosen, first });
    askTimer = setTimeout(ask, ASK_AGAIN_MS);
  }

  function askValue() {
    if (place && about) armChannel.send("picture_value", { topic: chosen, ...place });
  }

  function say(text) {
    at("arm-picture-said").textContent = text;
  }

  function choose(topic) {
    chosen = topic;
    about = place = null;
    at("arm-picture-topic").value = topic;
    at("arm-picture-value").textContent = at("arm-picture-size").textContent = "";
    at("arm-picture-scale").hidden = true;
    const canvas = at("arm-picture-canvas");
    canvas.width = canvas.width;
    say(topic ? "Waiting for a picture" : "No picture is published");
    ask(true);
  }

  function open(topic) {
    at("arm-picture").hidden = false;
    cover();
    clearInterval(placeTimer);
    placeTimer = setInterval(cover, PLACE_MS);
    choose(topics.includes(topic) ? topic : topics[0] || "");
  }

  function close() {
    at("arm-picture").hidden = true;
    clearInterval(placeTimer);
    clearTimeout(askTimer);
  }

  /* Lie on the 3D view: panels beside it are moved, resized and closed by their users. */
  function cover() {
    const sizes = [...document.querySelectorAll("#root canvas")].map((each) => each.getBoundingClientRect());
    const { left, top, width, height } = sizes.sort((a, b) => b.width * b.height - a.width * a.height)[0] || {};
    if (!width) return;
    const style = { left: `${left}px`, top: `${top}px`, width: `${width}px`, height: `${height}px` };
    Object.assign(at("arm-picture").style, style);
  }

  function showTopics(message) {
    topics = message.topics;
    at("arm-picture-topic").replaceChildren(...topics.map((topic) => new Option(topic, topic)));
    at("arm-picture-topic").value = chosen;
    at("arm-picture-scale").querySelector("i").style.background = `linear-gradient(90deg, ${message.scale.join(", ")})`;
    if (isOpen() && !topics.includes(chosen)) choose(topics[0] || "");
  }

  function showAbout(message) {
    if (message.topic !== chosen) return;
    about = message;
    at("arm-picture-size").textContent = `${message.width}x${message.height} ${message.encoding}`;
    const metres = (value) => `${value.toFixed(2)} m`;
    at("arm-picture-scale").hidden = !message.range_m;
    if (message.range_m) {
      [at("arm-picture-near").textContent, at("arm-picture-far").textContent] = message.range_m.map(metres);
    }
    say(message.problem);
    if (message.problem) ask();
  }

  async function show(payload) {
    const shown = about;
    let picture = null;
    try {
      picture = await createImageBitmap(new Blob([payload], { type: "image/jpeg" }));
    } catch {
      // A picture that arrives damaged is left out.
    }
    if (picture && isOpen() && shown === about && about) {
      const canvas = at("arm-picture-canvas");
      if (canvas.width !== picture.width) canvas.width = picture.width;
      if (canvas.height !== picture.height) canvas.height = picture.height;
      // Drawn by the processor: the graphics card is emulated where there is none.
      canvas.getContext("2d", { willReadFrequently: true }).drawImage(picture, 0, 0);
    }
    picture?.close();
    askValue();
    ask();
  }

  /* The pixel at a place of the window; null beside the picture, which keeps its proportions. */
  function pixel(event) {
    if (!about) return null;
    const box = at("arm-picture-canvas").getBoundingClientRect();
    const scale = Math.min(box.width / about.width, box.height / about.height);
    const column = Math.floor((event.clientX - box.left - (box.width - scale * about.width) / 2) / scale);
    const row = Math.floor((event.clientY - box.top - (box.height - scale * about.height) / 2) / scale);
    const isInside = column >= 0 && row >= 0 && column < about.width && row < about.height;
    return isInside ? { column, row } : null;
  }

  function point(found) {
    place = found;
    if (place) askValue();
    else at("arm-picture-value").textContent = "";
  }

  function move(event) {
    const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!by || !about) return;
    event.preventDefault();
    event.stopPropagation();
    const from = place || { column: about.width >> 1, row: about.height >> 1 };
    const kept = (value, size) => Math.min(Math.max(value, 0), size - 1);
    point({ column: kept(from.column + by[0], about.width), row: kept(from.row + by[1], about.height) });
  }

  armChannel.on("picture_topics", showTopics);
  armChannel.on("picture_about", showAbout);
  armChannel.on("picture_value", ({ column, row, text }) => {
    if (place && place.column === column && place.row === row) {
      at("arm-picture-value").textContent = `${text} at ${column}, ${row}`;
    }
  });
  armChannel.onBytes(FRAME, show);
  armChannel.onChange((connected) => {
    if (connected) ask(true);
    else if (isOpen()) say("No contact with the page's process: this picture is old");
  });
  addEventListener("DOMContentLoaded", () => {
    const canvas = at("arm-picture-canvas");
    at("arm-picture-topic").addEventListener("change", (event) => choose(event.target.value));
    at("arm-picture-close").addEventListener("click", close);
    for (const kind of ["pointermove", "pointerdown"]) canvas.addEventListener(kind, (event) => point(pixel(event)));
    canvas.addEventListener("pointerleave", () => point(null));
    canvas.addEventListener("keydown", move);
    addEventListener("resize", () => isOpen() && cover());
    addEventListener("click", ({ target }) => {
      const topic = target instanceof Element && target.closest("#root [data-picture]")?.dataset.picture;
      if (topic) open(topic);
    });
  });
  window.armPicture = { toggle: () => (isOpen() ? close() : open(chosen)) };
})();
