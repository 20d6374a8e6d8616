/* Move the nodes of viser's scene by the frames that the page's own channel brings.

The script writes where viser's client keeps the poses that its own messages bring. It asks the
server for frames only if it finds that place as it knows it; otherwise, in another version of
viser, the poses come by viser's messages. */
(() => {
  "use strict";
  const FRAME = 1;
  const VALUES = 8;
  const LOOK_MS = 100;
  // Shorter than the rest after which the server tells viser.
  const CHECK_MS = 400;

  let names = [];
  const latest = new Map();
  let received = -Infinity;

  function client() {
    const client = window.__viserMutable;
    const root = client?.nodePoseData?.[""];
    const isKnown = Array.isArray(root?.wxyz) && Array.isArray(root?.position);
    return isKnown && root.poseUpdateState && client.requestRender ? client : null;
  }

  function put(entry, pose) {
    entry.position = pose.position;
    entry.wxyz = pose.wxyz;
    // A node that is being made takes its pose when it is there.
    if (entry.poseUpdateState !== "waitForMakeObject") entry.poseUpdateState = "needsUpdate";
  }

  // Poses come by two ways: one of viser's may come later than a newer one of the channel, or
  // before its node is there. While frames come, they are newer; when none come, viser's are.
  function putMissed() {
    const viser = client();
    if (!viser) return;
    if (performance.now() - received > CHECK_MS) {
      latest.clear();
      return;
    }
    for (const [name, pose] of latest) {
      const entry = viser.nodePoseData[name];
      if (entry && entry.position !== pose.position) put(entry, pose);
    }
  }

  armChannel.on("pose_names", (message) => {
    names = message.names;
    const known = new Set(names);
    for (const name of latest.keys()) if (!known.has(name)) latest.delete(name);
  });

  armChannel.onBytes(FRAME, (payload) => {
    received = performance.now();
    const viser = client();
    const values = new Float32Array(payload);
    for (let at = 0; at + VALUES <= values.length; at += VALUES) {
      const name = names[values[at]];
      if (name === undefined) continue;
      const pose = {
        position: [values[at + 1], values[at + 2], values[at + 3]],
        wxyz: [values[at + 4], values[at + 5], values[at + 6], values[at + 7]],
      };
      latest.set(name, pose);
      const entry = viser?.nodePoseData[name];
      if (entry) put(entry, pose);
    }
    viser?.requestRender();
  });

  let connected = false;
  let asked = false;
  armChannel.onChange((isConnected) => {
    connected = isConnected;
    asked = false;
    if (!connected) latest.clear();
  });
  setInterval(() => {
    if (!asked && connected && client()) asked = armChannel.send("poses", {});
  }, LOOK_MS);
  setInterval(putMissed, CHECK_MS);
})();
