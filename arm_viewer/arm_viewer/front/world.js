/* The tab of the world: its list of things, and files that are dropped on the page. */
(() => {
  "use strict";
  const PART = 45000;
  const SHOWN_MS = 6000;
  const WAITING = 200000;
  const TAB = "World";
  let timer = 0;

  const veil = armMake("div", { id: "arm-drop", hidden: true, role: "status" });
  const picker = armMake("input", {
    type: "file",
    accept: ".urdf,.sdf,.stl",
    hidden: true,
    "aria-label": "File to add to the world",
  });

  function say(text, failed = false, lasts = true) {
    veil.textContent = text;
    veil.hidden = !text;
    veil.classList.toggle("arm-failed", failed);
    clearTimeout(timer);
    if (text && !lasts) timer = setTimeout(() => say(""), SHOWN_MS);
  }

  const hasFiles = (event) => [...(event.dataTransfer?.types || [])].includes("Files");

  function base64(bytes) {
    let text = "";
    for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
    return btoa(text);
  }

  async function send(file) {
    say(`Sending ${file.name} …`);
    [...document.querySelectorAll("#root [role=tab]")].find((tab) => tab.textContent === TAB)?.click();
    for (let offset = 0; offset === 0 || offset < file.size; offset += PART) {
      const data = base64(new Uint8Array(await file.slice(offset, offset + PART).arrayBuffer()));
      if (veil.classList.contains("arm-failed")) return;
      if (!armChannel.send("file_part", { name: file.name, size: file.size, offset, data })) {
        say("The page has lost its server: drop the file again", true, false);
        return;
      }
      await armChannel.drained(WAITING);
    }
  }

  addEventListener("dragover", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    say("Drop a URDF, SDF or STL file to add it to the world");
  });
  addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) say("");
  });
  addEventListener("drop", (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    send(event.dataTransfer.files[0]);
  });
  picker.addEventListener("change", () => {
    if (picker.files.length) send(picker.files[0]);
    picker.value = "";
  });
  addEventListener("click", ({ target }) => {
    const button = target instanceof Element && target.closest("#root button");
    if (!button) return;
    if (button.dataset.thing) armChannel.send("choose_thing", { name: button.dataset.thing });
    else if (button.textContent.trim() === "Choose a file") picker.click();
  });

  armChannel.on("file_taken", ({ name, bytes, of }) => {
    if (bytes < of) say(`Sending ${name}: ${Math.round((100 * bytes) / of)} %`);
    else say("");
  });
  armChannel.on("refused", ({ of, problem }) => {
    if (of === "file_part") say(problem, true, false);
  });
  addEventListener("DOMContentLoaded", () => document.body.append(veil, picker));
})();
