"""The executable arm_viewer_node: the page in the browser."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from arm_description.errors import DescriptionError
from arm_node.discovery import answers_held_back
from arm_node.process import NodeProcess, run_process
from arm_viewer.errors import ViewerError


@contextmanager
def application(process: NodeProcess) -> Iterator[None]:
    """Serve the page until the process ends."""
    # Imported once the environment is prepared: message packages are found through it.
    from arm_viewer.page import page_running
    from arm_viewer.page_server import page_server
    from arm_viewer.ros.viewer import Viewer

    with answers_held_back():
        node = Viewer()
    with page_server(node.port) as server, page_running(server, node.latest, node.send):
        node.get_logger().info(f"the page is at http://127.0.0.1:{server.get_port()}")
        process.executor.add_node(node)
        yield


def main(argv: Sequence[str] | None = None) -> int:
    """Run the process; return its exit code."""
    return run_process(application, argv, user_errors=(ViewerError, DescriptionError))


if __name__ == "__main__":
    sys.exit(main())
