"""The controllers of every manager, each with a button that changes its state."""

from html import escape

from viser import GuiApi

from arm_viewer.panels.panel import in_order, note, say, show
from arm_viewer.requests import Configure, Request, Send, SwitchControllers
from arm_viewer.snapshot import ListedController, Snapshot

BUTTONS = {"active": "Deactivate", "inactive": "Activate", "unconfigured": "Configure"}
"""The button's label by state; a finalized controller can only be unloaded."""
COLOURS = {"active": "#2b8a3e", "inactive": "#d9480f"}
OTHER_COLOUR = "#868e96"


class ControllerPanel:
    """A folder of controllers for each manager."""

    def __init__(self, send: Send) -> None:
        """Send a request for each click with `send`."""
        self._send = send
        self._managers: dict[str, _Manager] = {}

    def build(self, gui: GuiApi) -> None:
        """Create the elements above the folders."""
        self._gui = gui
        self._place = gui.add_folder("Controllers")
        with self._place:
            self._no_manager = gui.add_html(note("There is no controller manager."))
            self._refusal = gui.add_html("", visible=False)

    def update(self, snapshot: Snapshot) -> None:
        """Show the controllers that the managers list."""
        say(self._refusal, snapshot.refusal)
        by_manager: dict[str, list[ListedController]] = {}
        for controller in snapshot.controllers:
            by_manager.setdefault(controller.manager, []).append(controller)
        show(self._no_manager, not by_manager)
        for name in self._managers.keys() - by_manager.keys():
            self._managers.pop(name).remove()
        for name, controllers in by_manager.items():
            if name not in self._managers:
                with self._place:
                    self._managers[name] = _Manager(self._gui, self._send, name)
            self._managers[name].update(controllers)


class _Manager:
    """The controllers of one manager."""

    def __init__(self, gui: GuiApi, send: Send, name: str) -> None:
        self._gui = gui
        self._send = send
        self._folder = gui.add_folder(name)
        self._rows: dict[str, _Row] = {}

    def update(self, controllers: list[ListedController]) -> None:
        names = {controller.name for controller in controllers}
        for name in self._rows.keys() - names:
            self._rows.pop(name).remove()
        for controller in sorted(controllers, key=lambda c: c.name):
            if controller.name not in self._rows:
                with self._folder:
                    self._rows[controller.name] = _Row(self._gui, self._send, controller)
            self._rows[controller.name].update(controller)

    def remove(self) -> None:
        self._folder.remove()


class _Row:
    """Name, state and type of a controller above its button."""

    def __init__(self, gui: GuiApi, send: Send, controller: ListedController) -> None:
        self._send = send
        self._shown: ListedController | None = None
        self._text = gui.add_html("")
        self._button = gui.add_button("", hint=f"{controller.name} of {controller.manager}")
        self._button.on_click(in_order(lambda _: self._change()))

    def update(self, controller: ListedController) -> None:
        if controller == self._shown:
            return
        self._shown = controller
        self._text.content = _describe(controller)
        self._button.visible = controller.state in BUTTONS
        self._button.label = BUTTONS.get(controller.state, "")
        self._button.color = "gray" if controller.state == "active" else None

    def remove(self) -> None:
        self._text.remove()
        self._button.remove()

    def _change(self) -> None:
        if self._shown is not None and self._shown.state in BUTTONS:
            self._send(_next_step(self._shown))


def _next_step(controller: ListedController) -> Request:
    """Return the button's request."""
    manager, name = controller.manager, controller.name
    if controller.state == "active":
        return SwitchControllers(manager, deactivate=(name,))
    if controller.state == "inactive":
        return SwitchControllers(manager, activate=(name,))
    return Configure(manager, name)


def _describe(controller: ListedController) -> str:
    colour = COLOURS.get(controller.state, OTHER_COLOUR)
    # A long type may wrap after the slash.
    kind = escape(controller.type).replace("/", "/<wbr/>")
    claimed = f"<br/>{escape(', '.join(controller.claimed))}" if controller.claimed else ""
    return (
        '<div style="font-size:0.8rem;padding:0.5em 0.75em 0.25em;line-height:1.35;'
        'overflow-wrap:anywhere">'
        f"<b>{escape(controller.name)}</b> "
        f'<span style="color:{colour};float:right">{escape(controller.state)}</span><br/>'
        f'<span style="opacity:0.65">{kind}{claimed}</span></div>'
    )
