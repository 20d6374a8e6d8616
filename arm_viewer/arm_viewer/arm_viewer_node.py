"""The executable arm_viewer_node: serves the browser page."""

import io
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from arm_description.errors import DescriptionError
from arm_node.notify import notify
from arm_node.printable import printable
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import first_node
from arm_viewer.errors import ConfigError, ViewerError

if TYPE_CHECKING:
    from rclpy.node import Node

    from arm_viewer.page_server import PageServer


@contextmanager
def application(process: NodeProcess) -> Iterator[None]:
    """Serve the page until the process ends."""
    # Where SciPy is installed, trimesh would import it: 45 MB for what the page never uses.
    sys.modules.setdefault("scipy", None)  # pyright: ignore[reportArgumentType]
    # Imported only after the environment is prepared, because it locates the message packages.
    from arm_viewer.access import TOKEN_VARIABLE, Access
    from arm_viewer.page import page_running
    from arm_viewer.page_server import page_server
    from arm_viewer.recordings.player import Player
    from arm_viewer.recordings.recorder import Recorder
    from arm_viewer.ros.recorded_state import RecordedState
    from arm_viewer.ros.viewer import Viewer
    from arm_viewer.rviz_config import read_config_file

    node = first_node(Viewer)
    config = None
    if node.display_config:
        try:
            config = read_config_file(node.display_config)
        except ConfigError as error:
            # As in RViz: the page shows the robot all the same.
            node.get_logger().error(printable(str(error)))
    token = os.environ.get(TOKEN_VARIABLE, "")
    access = Access.on(node.host, node.is_read_only, token)
    player = Player(node.latest, node.send, RecordedState)
    folder, first = _recordings(node)
    recorder = Recorder(folder)
    if first is not None:
        player.open(first)
    with (
        closing(player),
        closing(recorder),
        page_server(node.port, access=access) as server,
        page_running(server, player.latest, player.send, config, (player, recorder)),
    ):
        if access.needs_token:
            # Not by the node's log, which everybody on the graph can read.
            sys.stdout.write(invitation(server, sys.stdout))
            sys.stdout.flush()
        else:
            node.get_logger().info(f"the page is at {server.url}")
        if not node.port:
            where = "the address with the token" if access.needs_token else server.url
            notify(f"X_REMARK=the page: {where}")
        process.executor.add_node(node)
        yield


def _recordings(node: "Node") -> tuple[Path, Path | None]:
    """Declare the parameters about recordings; return the folder and what is shown first."""
    from arm_node.parameter_values import read_text
    from arm_node.parameters import declare

    folder = declare(
        node, "recordings", ".", read_text, "folder of the recordings that the page lists"
    )
    first = declare(node, "recording", "", read_text, "recording that the page shows first")
    return Path(folder), Path(first) if first else None


def invitation(server: "PageServer", terminal: TextIO) -> str:
    """Return the addresses of a page that needs a token, and the first one as a QR code.

    Args:
        server: serves the page.
        terminal: where it will be printed; the code needs a terminal that is wide enough.
    """
    access = server.access
    urls = [server.url_with(token) for token in (access.token, access.read_only_token) if token]
    words = ["the page is at", "the page is, for looking only, at"][-len(urls) :]
    lines = [f"{word} {url}\n" for word, url in zip(words, urls, strict=True)]
    return "".join(lines) + _qr_code(urls[0], terminal)


def _qr_code(text: str, terminal: TextIO) -> str:
    if not terminal.isatty():
        return ""
    import segno

    code = segno.make(text, error="l")
    if os.get_terminal_size(terminal.fileno()).columns < code.symbol_size()[0]:
        return ""
    drawn = io.StringIO()
    code.terminal(drawn, compact=True)
    return drawn.getvalue()


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    return run_process(application, argv, user_errors=(ViewerError, DescriptionError))


if __name__ == "__main__":
    sys.exit(main())
