/* Make the page quick in a browser that draws without a graphics card.

There the processor emulates the card, and four things cost most: charts, whose canvases are drawn
by that emulation too; shadows; antialiasing; and the number of pixels. While the scene moves, this
script therefore draws as many pixels as the browser manages at a steady rate. A scene at rest is
drawn once more, at the full resolution. viser's warning, which covers the robot, is hidden. With a
graphics card the script does nothing. */
(() => {
  "use strict";
  const EMULATED = /swiftshader|llvmpipe|softpipe|software|basic render/i;
  // Below the lower one of these rates there are fewer pixels, above the higher one there are more.
  const RATES_HZ = [20, 34];
  const SHARES = [1, 0.75, 0.5, 0.35];
  const FRAMES_OF_A_MEASUREMENT = 8;
  // viser draws a scene at rest once a second.
  const HEARTBEAT_MS = 900;
  const SHORTEST_REST_MS = 400;
  const WARNING = "Software WebGL";

  const original = HTMLCanvasElement.prototype.getContext;

  function isEmulated() {
    const gl = original.call(document.createElement("canvas"), "webgl2");
    if (!gl) return false;
    const names = gl.getExtension("WEBGL_debug_renderer_info");
    const name = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
    gl.getExtension("WEBGL_lose_context")?.loseContext();
    return EMULATED.test(String(name));
  }

  new MutationObserver((changes, observer) => {
    for (const shown of document.querySelectorAll(".mantine-Notification-root")) {
      if (!shown.textContent.includes(WARNING)) continue;
      shown.style.display = "none";
      observer.disconnect();
    }
  }).observe(document, { childList: true, subtree: true });
  if (!isEmulated()) return;

  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    if (kind === "2d") return original.call(this, kind, { ...options, willReadFrequently: true });
    return original.call(this, kind, { ...options, antialias: false });
  };

  // A resolution in the address is the user's choice.
  const isChosen = new URLSearchParams(location.search).has("fixedDpr");
  let moving = 2; // index of SHARES
  let shown = -1;
  let last = -Infinity;
  let streak = 0;
  let isWholeNext = false;
  let resting = 0;
  let periods = [];

  function show(share) {
    const settings = window.__viserTestpoints?.devSettings;
    if (isChosen || !settings || share === shown) return;
    shown = share;
    settings.set({ fixedDpr: share * devicePixelRatio });
  }

  function measure(period) {
    periods.push(period);
    if (periods.length < FRAMES_OF_A_MEASUREMENT) return;
    const median = periods.sort((a, b) => a - b)[FRAMES_OF_A_MEASUREMENT / 2];
    periods = [];
    if (median > 1000 / RATES_HZ[0]) moving = Math.min(moving + 1, SHARES.length - 1);
    if (median < 1000 / RATES_HZ[1]) moving = Math.max(moving - 1, 0);
  }

  function rest() {
    periods = [];
    isWholeNext = shown !== 1;
    show(1);
  }

  function castNoShadows(scene) {
    scene.traverse((node) => {
      if (node.isLight && node.castShadow) node.castShadow = false;
    });
  }

  function frame(scene) {
    castNoShadows(scene);
    const now = performance.now();
    const period = now - last;
    last = now;
    if (isWholeNext || period > HEARTBEAT_MS) {
      isWholeNext = false;
      streak = 0;
      return;
    }
    // A heartbeat may follow the last frame of a motion closely.
    streak += 1;
    if (streak < 2) return;
    clearTimeout(resting);
    resting = setTimeout(rest, Math.max(SHORTEST_REST_MS, 3 * period));
    measure(period);
    show(SHARES[moving]);
  }

  // viser makes its scene after this script has run, and a new one if its canvas is mounted anew.
  let watched = null;
  setInterval(() => {
    const scene = window.__viserMutable?.scene;
    if (!scene || scene === watched) return;
    watched = scene;
    scene.onBeforeRender = () => frame(scene);
  }, 100);
})();
