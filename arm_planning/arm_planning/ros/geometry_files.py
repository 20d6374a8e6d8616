"""The services save_geometry_to_file and load_geometry_from_file: the world as a .scene file."""

import logging
import os
from pathlib import Path
from typing import Any

from moveit_msgs.srv import LoadGeometryFromFile, SaveGeometryToFile
from rclpy.node import Node

from arm_node.user_file import check_file, read_text
from arm_planning.errors import PlanningError
from arm_planning.robot.model import PlanningModel
from arm_planning.ros.answering import offer_service
from arm_planning.ros.scene_monitor import SceneMonitor
from arm_planning.scene.frames import LinkPoses
from arm_planning.scene.scene import PlanningScene
from arm_planning.scene.scene_file import scene_text, with_scene_file

LOGGER = logging.getLogger("move_group")


class GeometryFiles:
    """Serves both; the answer is only whether it succeeded, so the reason is logged."""

    def __init__(self, node: Node, model: PlanningModel, monitor: SceneMonitor) -> None:
        self._model = model
        self._monitor = monitor
        offer_service(node, SaveGeometryToFile, "save_geometry_to_file", self._save)
        offer_service(node, LoadGeometryFromFile, "load_geometry_from_file", self._load)

    def _save(self, request: Any, answer: SaveGeometryToFile.Response) -> Any:
        path = Path(request.file_path_and_name)
        try:
            _write_whole(path, scene_text(self._monitor.current()))
        except (PlanningError, OSError, ValueError) as error:
            LOGGER.error("cannot save the scene to '%s': %s", path, _reason(error))
            answer.success = False
        else:
            answer.success = True
        return answer

    def _load(self, request: Any, answer: LoadGeometryFromFile.Response) -> Any:
        path = request.file_path_and_name
        try:
            text = read_text(path)
            self._monitor.update(lambda scene: self._with_file(scene, text, path))
        except (PlanningError, OSError, ValueError) as error:
            LOGGER.error("cannot load the scene of '%s': %s", path, _reason(error))
            answer.success = False
        else:
            answer.success = True
        return answer

    def _with_file(self, scene: PlanningScene, text: str, path: str) -> PlanningScene:
        return with_scene_file(scene, LinkPoses(self._model, scene.positions), text, path)


def _write_whole(path: Path, text: str) -> None:
    """Write a file; one of that name stays as it is until the new one is complete."""
    if path.exists():
        check_file(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        temporary.write_text(text, encoding="utf-8")
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _reason(error: Exception) -> str:
    return (error.strerror or str(error)) if isinstance(error, OSError) else str(error)
