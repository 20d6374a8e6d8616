"""Saves what the page shows as an RViz configuration or as a link, and opens the former."""

from collections.abc import Iterable
from queue import Empty, SimpleQueue

from viser import GuiApi, GuiEvent, GuiUploadButtonHandle, ViserServer

from arm_viewer.errors import ConfigError
from arm_viewer.panels.panel import fill, say
from arm_viewer.panels.robot_panel import RobotPanel
from arm_viewer.rviz_config import PageConfig, read_config, write_config
from arm_viewer.scene.first_view import FirstView
from arm_viewer.snapshot import Snapshot

FILE_NAME = "page.rviz"


class ConfigPanel:
    """The buttons `Save Config As` and `Open Config`, named as in RViz's menu, and a link."""

    def __init__(
        self, server: ViserServer, robots: RobotPanel, view: FirstView, first: PageConfig | None
    ) -> None:
        """Save and set the switches of `robots`, and `view`; `first` is set at once."""
        self._server = server
        self._robots = robots
        self._view = view
        self._saved_for: SimpleQueue[int] = SimpleQueue()
        self._linked_for: SimpleQueue[int] = SimpleQueue()
        self._opened: SimpleQueue[tuple[PageConfig, tuple[int, ...]]] = SimpleQueue()
        self._refused: SimpleQueue[str] = SimpleQueue()
        if first is not None:
            self._opened.put((first, ()))

    def build(self, gui: GuiApi) -> None:
        """Create the buttons."""
        with gui.add_folder("Configuration"):
            save = gui.add_button(
                "Save Config As", color="gray", hint="a file that RViz also opens"
            )
            load = gui.add_upload_button(
                "Open Config", color="gray", hint="an RViz configuration: displays and view"
            )
            link = gui.add_button(
                "Link to View", color="gray", hint="an address that opens the page with this view"
            )
            self._remark = gui.add_html("", visible=False)
        link.on_click(lambda event: self._linked_for.put(event.client_id or 0))
        save.on_click(lambda event: self._saved_for.put(event.client_id or 0))
        load.on_upload(self._open)

    def update(self, snapshot: Snapshot) -> None:
        """Send the requested files, and show the configurations that were opened."""
        try:
            while True:
                self._save(self._saved_for.get_nowait(), snapshot)
        except Empty:
            pass
        if not self._linked_for.empty():
            self._link(self._linked_for.get())
        if not self._refused.empty():
            say(self._remark, self._refused.get())
        if not self._opened.empty():
            self._show(*self._opened.get(), snapshot)

    def _open(self, event: GuiEvent[GuiUploadButtonHandle]) -> None:
        file = event.target.value
        try:
            config = read_config(file.content, file.name)
        except ConfigError as error:
            self._refused.put(str(error))
        else:
            self._opened.put((config, (event.client_id or 0,)))

    def _save(self, client_id: int, snapshot: Snapshot) -> None:
        client = self._server.get_clients().get(client_id)
        if client is None:
            return
        shown = {key: switch.value for key, switch in self._robots.switches.items()}
        parents = {step.parent for step in snapshot.transforms.values()}
        roots = sorted(parents - snapshot.transforms.keys())
        frame = roots[0] if roots else "world"
        content = write_config(PageConfig(shown, self._view.current(client_id), frame))
        client.send_file_download(FILE_NAME, content, save_immediately=True)

    def _link(self, client_id: int) -> None:
        view = self._view.current(client_id)
        if view is not None:
            # viser's client reads these words of its address.
            address = f"?initialCameraPosition={_words(view.position)}"
            address += f"&initialCameraLookAt={_words(view.target)}"
            fill(self._remark, f'<small><a href="{address}">the page with this view</a></small>')

    def _show(self, config: PageConfig, client_ids: tuple[int, ...], snapshot: Snapshot) -> None:
        for key, switch in self._robots.switches.items():
            switch.value = config.shown.get(key, switch.value)
        if config.view is not None:
            self._view.choose(config.view, client_ids)
        remark = config.remark
        if config.fixed_frame in snapshot.transforms:
            remark += f" The page draws in the root of /tf, not in {config.fixed_frame}."
        say(self._remark, remark.strip())


def _words(numbers: Iterable[float]) -> str:
    # Adding 0 makes -0 a 0.
    return ",".join(f"{round(number, 4) + 0.0:g}" for number in numbers)
