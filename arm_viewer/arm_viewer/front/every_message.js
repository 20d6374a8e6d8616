/* Send all that a user types and presses, however fast.

viser sends at most one message in 50 ms for all fields and buttons of a panel together, and then
only the last one: of two fields that are filled in and a button that is pressed in that time, the
second field stays as it was for the server. A browser on a busy machine hands over what a user did
in a second at once. This script ends viser's pause as soon as an event has been handled. */
(() => {
  "use strict";
  const PAUSE_MS = 50;
  // How viser's minified function begins that ends the pause: no timer, ready to send.
  const END = /^\(\)=>\{\w+=null,\w+=!0,/;
  const later = window.setTimeout;

  window.setTimeout = (act, delay, ...rest) => {
    if (delay !== PAUSE_MS || !END.test(String(act))) return later(act, delay, ...rest);
    queueMicrotask(act);
    return 0;
  };
})();
