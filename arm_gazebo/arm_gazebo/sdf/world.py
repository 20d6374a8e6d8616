"""SDF worlds, as the tutorials write them, made into MuJoCo specifications."""

from pathlib import Path

import mujoco

from arm_description.errors import ResourceNotFoundError
from arm_description.names import listing
from arm_description.resources import resolve_uri
from arm_description.robot import Pose
from arm_gazebo.build_report import BuildReport
from arm_gazebo.mesh.library import MeshLibrary
from arm_gazebo.sdf.body import add_model, add_plane
from arm_gazebo.sdf.element import SdfElement
from arm_gazebo.sdf.frames import SdfFrames, pose_of
from arm_gazebo.sdf.light import add_light, add_sky, add_sun
from arm_gazebo.sdf.model import SdfModel, SdfPlane, placement_offset, read_model

GROUND = ("ground_plane", "ground plane")
SUN = ("sun",)
"""Models of Gazebo's own that worlds include by name, or from its web site."""
PLACED = "placement_frame"
"""What says which of a model's frames its pose places, where it is not the model's own."""
GROUND_SIZE_M = 100.0
GROUND_COLOR = (0.8, 0.8, 0.8, 1.0)


def read_sdf_world(path: Path, report: BuildReport) -> mujoco.MjSpec:
    """Return the specification of an SDF world.

    Args:
        path: of the file; its folder is where plain paths in it start.
        report: gets what is not simulated, and what is repaired.

    Raises:
        WorldError: it is no SDF, or a value in it makes no sense; the message names file, line
            and element.
    """
    root = SdfElement.read(path)
    reader = _WorldReader(root.needed("world"), report)
    return reader.read()


class _WorldReader:
    """Adds what is in a <world> to a specification."""

    def __init__(self, world: SdfElement, report: BuildReport) -> None:
        self._world = world
        self._report = report
        self._spec = mujoco.MjSpec()
        self._spec.compiler.degree = False
        # As in the shipped worlds: what friction holds does not creep.
        self._spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        self._spec.option.impratio = 10.0
        self._meshes = MeshLibrary(self._spec, [world.source.parent.resolve()])
        self._names: set[str] = set()

    def read(self) -> mujoco.MjSpec:
        """Return the specification of all that is in the world."""
        world = self._world
        self._spec.modelname = world.name or "world"
        self._spec.option.gravity = world.numbers("gravity", 3, (0.0, 0.0, -9.8))
        add_sky(self._spec, world)
        for light in world.children("light"):
            add_light(self._spec, light)
        models = world.children("model")
        placed = {part.name: part for part in (*models, *world.children("frame"))}
        offsets = {model: placement_offset(model, model.attribute(PLACED)) for model in models}
        included: list[tuple[SdfElement, SdfElement]] = []
        for include in world.children("include"):
            model = self._model_of(include)
            if model is None:
                self._add_known(include)
                continue
            included.append((include, model))
            name = include.text("name") or model.name
            placed[name] = include if include.child("pose") else model
            frame = include.text(PLACED) or model.attribute(PLACED)
            offsets[placed[name]] = placement_offset(model, frame)
        frames = SdfFrames(placed, offsets)
        for model in models:
            self._add(read_model(model, model.name), pose_of(frames.matrix(model)), model)
        for include, model in included:
            self._add_include(include, model, frames)
        self._report.add(*world.unread())
        return self._spec

    def _add_include(self, include: SdfElement, model: SdfElement, frames: SdfFrames) -> None:
        name = include.text("name") or model.name
        pose = include if include.child("pose") else model
        static = include.flag("static") if include.child("static") else None
        self._add(read_model(model, name, static), pose_of(frames.matrix(pose)), include)
        self._report.add(*model.unread())

    def _model_of(self, include: SdfElement) -> SdfElement | None:
        """Return the <model> that an <include> means, None for one that no folder has."""
        uri = include.text("uri")
        if not uri:
            raise include.error("needs a <uri>")
        try:
            if uri.startswith(("http://", "https://")):
                raise ResourceNotFoundError(f"'{uri}' is on the web, from where nothing is fetched")
            found = resolve_uri(uri, [include.source.parent.resolve()])
        except ResourceNotFoundError as error:
            if _last_word(uri) in (*GROUND, *SUN):
                return None
            hint = "is GZ_SIM_RESOURCE_PATH the folder of the models?"
            raise include.error(f"cannot be had: {error}\n{hint}") from error
        return SdfElement.read(_model_file(found, include)).needed("model")

    def _add_known(self, include: SdfElement) -> None:
        if _last_word(include.text("uri")) in SUN:
            add_sun(self._spec)
            return
        size = (GROUND_SIZE_M, GROUND_SIZE_M)
        add_plane(self._spec.worldbody, SdfPlane(Pose(), size, GROUND_COLOR))
        add_plane(self._spec.worldbody, SdfPlane(Pose()))

    def _add(self, model: SdfModel, pose: Pose, element: SdfElement) -> None:
        name = model.robot.name
        if not name:
            raise element.error("needs a name")
        if name in self._names:
            raise element.error(f"is the second one called '{name}'")
        self._names.add(name)
        add_model(self._spec, self._meshes, model, pose, self._report)


def _last_word(uri: str) -> str:
    return uri.rstrip("/").rpartition("/")[2].lower()


def _model_file(found: Path, include: SdfElement) -> Path:
    """Return the SDF file that is meant by a file, or by a model's folder."""
    if found.is_file():
        return found
    file = sdf_file_in(found)
    if file is not None:
        return file
    there = listing(sorted(path.name for path in found.iterdir()))
    raise include.error(f"means the folder {found}, which has no .sdf file; it has {there}")


def sdf_file_in(folder: Path) -> Path | None:
    """Return the SDF file of a model's folder, or None."""
    files = (folder / "model.sdf", *sorted(folder.glob("*.sdf")))
    return next((file for file in files if file.is_file()), None)
