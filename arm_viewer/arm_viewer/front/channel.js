/* The page's own connection to its server: `armChannel`, for the other scripts of the page.

`on(kind, take)` takes messages, `onBytes(kind, take)` the payloads of binary frames, and
`onChange(take)` whether there is contact. `send(kind, fields)` returns false without contact. The
connection comes back by itself. */
window.armChannel = (() => {
  "use strict";
  const PATH = "/channel";
  const FIRST_WAIT_MS = 250;
  const LONGEST_WAIT_MS = 4000;

  const takers = new Map();
  const byteTakers = new Map();
  const watchers = [];
  let socket = null;
  let wait = FIRST_WAIT_MS;

  function tell(connected) {
    for (const take of watchers) take(connected);
  }

  function receive(event) {
    if (typeof event.data === "string") {
      const message = JSON.parse(event.data);
      for (const take of takers.get(message.kind) || []) take(message);
    } else {
      const take = byteTakers.get(new Uint8Array(event.data, 0, 1)[0]);
      if (take) take(event.data.slice(1));
    }
  }

  function connect() {
    const opening = new WebSocket(`ws://${location.host}${PATH}`);
    opening.binaryType = "arraybuffer";
    opening.onopen = () => {
      socket = opening;
      wait = FIRST_WAIT_MS;
      tell(true);
    };
    opening.onmessage = receive;
    opening.onclose = () => {
      const lost = socket !== null;
      socket = null;
      if (lost) tell(false);
      setTimeout(connect, wait);
      wait = Math.min(2 * wait, LONGEST_WAIT_MS);
    };
  }

  // By then the other scripts have registered, and their parts of the page are there; what waits for
  // viser's script comes later still.
  document.addEventListener("readystatechange", connect, { once: true });

  return {
    on(kind, take) {
      takers.set(kind, [...(takers.get(kind) || []), take]);
    },
    onBytes(kind, take) {
      byteTakers.set(kind, take);
    },
    onChange(take) {
      watchers.push(take);
    },
    send(kind, fields) {
      if (!socket) return false;
      socket.send(JSON.stringify({ ...fields, kind }));
      return true;
    },
    /* Until at most so many bytes wait to be sent. */
    async drained(most) {
      while (socket && socket.bufferedAmount > most) await new Promise((go) => setTimeout(go, 20));
    },
  };
})();
