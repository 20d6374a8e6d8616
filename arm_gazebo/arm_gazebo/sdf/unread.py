"""Decide which unread parts of an SDF file the user should hear about."""

from arm_gazebo.build_report import BuildOutcome

SCENE_ELEMENTS = frozenset(
    {
        *("actor", "joint", "gripper", "light", "sensor", "road", "population"),
        *("particle_emitter", "projector", "wind", "model", "include"),
    }
)
"""Elements that add something to the scene, or move it."""
EMPTY_SHAPES = frozenset({"empty"})
"""The children of <geometry> that are not shapes."""
SYSTEM_PLUGINS = (
    *("physics", "scenebroadcaster", "usercommands", "sensors", "contact", "imu", "altimeter"),
    *("magnetometer", "airpressure", "navsat", "forcetorque", "ros", "rosinit", "rosfactory"),
    *("rosstate", "rosclock", "levels", "worldcontrol", "logicalcamera", "logrecord"),
)
"""World plugins that Gazebo itself needs; the simulation does not."""
RIGID = "the links of a model are one rigid body"
NOT_SIMULATED = "it is not simulated"


def unread_outcome(
    tag: str, parent: str, attributes: dict[str, str]
) -> tuple[BuildOutcome, str] | None:
    """Return what happens to an unread element, and why; None if nothing is missing.

    Args:
        tag: tag of the element.
        parent: tag of its parent element.
        attributes: attributes of the element.
    """
    if tag == "joint":
        # A fixed joint changes nothing: the links of a model are one rigid body anyway.
        return None if attributes.get("type") == "fixed" else (BuildOutcome.LEFT_OUT, RIGID)
    if parent == "geometry":
        return None if tag in EMPTY_SHAPES else (BuildOutcome.LEFT_OUT, NOT_SIMULATED)
    if tag in SCENE_ELEMENTS or (tag == "plugin" and not _is_system_plugin(parent, attributes)):
        return BuildOutcome.LEFT_OUT, NOT_SIMULATED
    return BuildOutcome.DROPPED, NOT_SIMULATED


def _is_system_plugin(parent: str, attributes: dict[str, str]) -> bool:
    """Return whether a plugin is one of Gazebo's own systems."""
    file = attributes.get("filename", "").lower().removeprefix("lib").removesuffix(".so")
    words = file.replace("_", "-").split("-")
    plain = [word for word in words if word not in ("gz", "ignition", "gazebo", "sim", "system")]
    return (
        parent == "world"
        and "".join(word for word in plain if not word[:1].isdigit()) in SYSTEM_PLUGINS
    )
