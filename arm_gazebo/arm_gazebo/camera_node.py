"""The camera process: renders the states that the simulation sends and publishes the images.

The simulation starts it; nobody starts it by hand. It ends when the simulation ends.
"""

import argparse
import logging
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

from arm_gazebo.camera.process import EXIT_BACKEND, CameraSettings
from arm_gazebo.errors import BackendError, GazeboError
from arm_gazebo.feed.child_process import add_parent_arguments, follow_parent
from arm_gazebo.feed.socket_pair import CameraEnd
from arm_node.printable import printable_message
from arm_node.process import EXIT_FAILED, EXIT_USAGE, NodeProcess, run_process
from arm_node.workarounds.discovery import first_node

if TYPE_CHECKING:
    from arm_gazebo.camera.pipeline import CameraPipeline
    from arm_gazebo.rendering.renderer import Renderer

logger = logging.getLogger(__name__)

JOIN_TIMEOUT_S = 2.0


def main(argv: Sequence[str] | None = None) -> int:
    """Run the camera process until the simulation ends; return the exit code."""
    arguments, ros_arguments = _parser().parse_known_args(argv)
    try:
        settings = CameraSettings.from_json(arguments.settings)
        follow_parent(arguments.parent)
        channel = CameraEnd(arguments.socket)
    except GazeboError as error:
        sys.stderr.write(f"{printable_message(str(error))}\n")
        return EXIT_USAGE
    application = partial(_application, settings, channel)
    try:
        return run_process(application, [sys.argv[0], *ros_arguments], (GazeboError,))
    finally:
        channel.close()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    add_parent_arguments(parser)
    parser.add_argument("--settings", required=True, help="CameraSettings as JSON")
    return parser


@contextmanager
def _application(
    settings: CameraSettings, channel: CameraEnd, process: NodeProcess
) -> Iterator[None]:
    from rclpy.node import Node

    from arm_gazebo.camera.pipeline import CameraPipeline
    from arm_gazebo.ros.camera_publisher import CameraDiagnostics, CameraPublisher

    node = first_node(lambda: Node("camera"))
    publishers = [CameraPublisher(node, sensor) for sensor in settings.cameras]
    pipeline = CameraPipeline(
        settings.cameras, publishers, partial(_open_renderer, settings, channel), settings.seed
    )
    CameraDiagnostics(node, settings.cameras, publishers, pipeline)
    process.executor.add_node(node)
    rendering = threading.Thread(
        target=_render, args=(pipeline, channel, process), name="rendering", daemon=True
    )
    rendering.start()
    yield
    rendering.join(JOIN_TIMEOUT_S)


def _render(pipeline: "CameraPipeline", channel: CameraEnd, process: NodeProcess) -> None:
    """Render until the simulation ends or the process is told to stop; runs in its own thread."""
    exit_code = 0
    try:
        while not process.stopping and (messages := channel.receive()) is not None:
            pipeline.handle(messages)
            # Repeated while nothing arrives, because the simulation may have missed the last one.
            channel.tell_progress(camera.progress() for camera in pipeline.statistics)
    except BackendError as error:
        logger.error("%s", error)
        exit_code = EXIT_BACKEND
    except GazeboError as error:
        logger.critical("%s", error)
        exit_code = EXIT_FAILED
    except Exception:
        # The thread's last frame. An OpenGL driver may raise anything; the simulation starts this
        # process again by its exit code.
        logger.critical("rendering failed", exc_info=True)
        exit_code = EXIT_FAILED
    finally:
        pipeline.close()
        process.stop(exit_code)


def _open_renderer(settings: CameraSettings, channel: CameraEnd) -> "Renderer":
    from arm_gazebo.rendering.backend_selection import backend_order, open_renderer
    from arm_gazebo.rendering.pinhole_view import drawn_size

    return open_renderer(
        backend_order(settings.backend, settings.excluded),
        *drawn_size(settings.cameras),
        on_try=channel.tell_backend,
    )


if __name__ == "__main__":
    sys.exit(main())
