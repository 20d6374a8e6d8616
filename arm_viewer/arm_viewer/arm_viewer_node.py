"""The executable arm_viewer_node: serves the browser page."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_description.errors import DescriptionError
from arm_node.printable import printable
from arm_node.process import NodeProcess, run_process
from arm_node.workarounds.discovery import first_node
from arm_viewer.errors import ConfigError, ViewerError


@contextmanager
def application(process: NodeProcess) -> Iterator[None]:
    """Serve the page until the process ends."""
    # Where SciPy is installed, trimesh would import it: 45 MB for what the page never uses.
    sys.modules.setdefault("scipy", None)  # pyright: ignore[reportArgumentType]
    # Imported only after the environment is prepared, because it locates the message packages.
    from arm_viewer.page import page_running
    from arm_viewer.page_server import page_server
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
    with page_server(node.port) as server, page_running(server, node.latest, node.send, config):
        node.get_logger().info(f"the page is at http://127.0.0.1:{server.get_port()}")
        process.executor.add_node(node)
        yield


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    return run_process(application, argv, user_errors=(ViewerError, DescriptionError))


if __name__ == "__main__":
    sys.exit(main())
