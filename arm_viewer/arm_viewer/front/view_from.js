/* This browser's 3D view as a camera of the robot sees it, and the way back.

The server sends the camera's pose whenever it changes. The script gives it to viser's client as viser's
own messages would, and the rest of the page does not see it. */
(() => {
  "use strict";
  const PLACE_MS = 250;

  let topic = "";
  let pose = null;
  let before = null;
  let sent = [];
  let placeTimer = 0;

  const sign = () => document.getElementById("arm-view-from");

  function client() {
    const viser = window.__viserMutable;
    return viser?.messageQueue && viser.cameraControl && viser.camera ? viser : null;
  }

  /* All of the camera's picture is within the view, whatever the window's proportions. */
  function fov(camera) {
    return 2 * Math.atan(Math.max(pose.half[1], pose.half[0] / camera.aspect));
  }

  function show() {
    const viser = client();
    if (!viser || !pose) return;
    drop(viser);
    sent = [
      { type: "SetCameraPositionMessage", position: pose.position, initial: false },
      { type: "SetCameraLookAtMessage", look_at: pose.target, initial: false },
      { type: "SetCameraUpDirectionMessage", position: pose.up, initial: false },
      { type: "SetCameraFovMessage", fov: fov(viser.camera), initial: false },
    ];
    viser.messageQueue.push(...sent);
    viser.requestRender();
  }

  /* Takes back what viser's client has not read yet, which it does once a frame. */
  function drop({ messageQueue }) {
    for (const message of sent) {
      const place = messageQueue.indexOf(message);
      if (place >= 0) messageQueue.splice(place, 1);
    }
    sent = [];
  }

  function keep() {
    const { cameraControl, camera } = client();
    const place = (read) => read(camera.position.clone());
    before = {
      position: place((at) => cameraControl.getPosition(at)),
      target: place((at) => cameraControl.getTarget(at)),
      up: camera.up.clone(),
      fov: camera.fov,
    };
  }

  function look(from) {
    if (!client()) return;
    if (!topic) keep();
    [topic, pose] = [from, null];
    say("");
    sign().hidden = false;
    cover();
    clearInterval(placeTimer);
    placeTimer = setInterval(cover, PLACE_MS);
    armChannel.send("view_from", { topic });
  }

  function free() {
    if (!topic) return;
    topic = "";
    pose = null;
    sign().hidden = true;
    clearInterval(placeTimer);
    armChannel.send("view_from", { topic });
    const viser = client();
    if (!viser) return;
    drop(viser);
    const { cameraControl, camera } = viser;
    camera.up.copy(before.up);
    camera.fov = before.fov;
    camera.updateProjectionMatrix();
    cameraControl.updateCameraUp();
    cameraControl.setLookAt(...before.position.toArray(), ...before.target.toArray(), false);
    viser.requestRender();
  }

  function say(problem) {
    sign().querySelector("span").textContent = problem || `View from ${topic}`;
  }

  /* Lie on the upper edge of the 3D view; a window of other proportions needs another field of view. */
  let covered = "";
  function cover() {
    const canvas = document.querySelector("#root canvas[data-engine]")?.getBoundingClientRect();
    if (!canvas) return;
    Object.assign(sign().style, { left: `${canvas.left}px`, top: `${canvas.top}px` });
    const size = `${canvas.width} ${canvas.height}`;
    if (size !== covered) show();
    covered = size;
  }

  armChannel.on("view_from_pose", (message) => {
    if (message.topic !== topic) return;
    say(message.problem);
    if (message.problem) return;
    pose = message;
    show();
  });
  armChannel.onChange((connected) => {
    if (connected && topic) armChannel.send("view_from", { topic });
  });
  addEventListener("DOMContentLoaded", () => {
    sign().querySelector("button").addEventListener("click", free);
    // Before viser hears of it: what fits the view, fits the free one.
    addEventListener(
      "click",
      ({ target }) => {
        const button = target instanceof Element && target.closest("#root button");
        if (!button) return;
        if (button.dataset.viewFrom) look(button.dataset.viewFrom);
        else if (button.textContent.trim() === "Fit view") free();
      },
      true,
    );
  });
})();
