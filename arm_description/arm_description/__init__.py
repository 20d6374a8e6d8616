"""Robot descriptions: reads URDF and xacro into a `Robot`, with its kinematics and its files.

It imports no ROS. The nodes robot_state_publisher and joint_state_publisher are in `publishers`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from arm_description.errors import (
        DescriptionError,
        JointStateError,
        KinematicsError,
        MeshFileError,
        MimicCycleError,
        ResourceNotFoundError,
        SettingsError,
        UrdfError,
        XacroError,
        XmlError,
    )
    from arm_description.kinematics.forward import forward_kinematics
    from arm_description.resources import ResourceFinder, resolve_uri
    from arm_description.urdf.joint_type import JointType
    from arm_description.urdf.parser import parse_urdf
    from arm_description.urdf.robot import (
        Box,
        Capsule,
        Collision,
        Cylinder,
        Dynamics,
        Geometry,
        Inertial,
        Joint,
        JointLimit,
        Link,
        Material,
        Mesh,
        Mimic,
        Pose,
        Robot,
        SafetyLimits,
        Sphere,
        Visual,
    )
    from arm_description.urdf.xml_document import parse_xml
    from arm_description.xacro.expansion import expand_xacro

__all__ = [
    "Box",
    "Capsule",
    "Collision",
    "Cylinder",
    "DescriptionError",
    "Dynamics",
    "Geometry",
    "Inertial",
    "Joint",
    "JointLimit",
    "JointStateError",
    "JointType",
    "KinematicsError",
    "Link",
    "Material",
    "Mesh",
    "MeshFileError",
    "Mimic",
    "MimicCycleError",
    "Pose",
    "ResourceFinder",
    "ResourceNotFoundError",
    "Robot",
    "SafetyLimits",
    "SettingsError",
    "Sphere",
    "UrdfError",
    "Visual",
    "XacroError",
    "XmlError",
    "expand_xacro",
    "forward_kinematics",
    "parse_urdf",
    "parse_xml",
    "resolve_uri",
]

_EXPORTS = {
    "errors": (
        "DescriptionError",
        "JointStateError",
        "KinematicsError",
        "MeshFileError",
        "MimicCycleError",
        "ResourceNotFoundError",
        "SettingsError",
        "UrdfError",
        "XacroError",
        "XmlError",
    ),
    "kinematics.forward": ("forward_kinematics",),
    "resources": ("ResourceFinder", "resolve_uri"),
    "urdf.joint_type": ("JointType",),
    "urdf.parser": ("parse_urdf",),
    "urdf.robot": (
        "Box",
        "Capsule",
        "Collision",
        "Cylinder",
        "Dynamics",
        "Geometry",
        "Inertial",
        "Joint",
        "JointLimit",
        "Link",
        "Material",
        "Mesh",
        "Mimic",
        "Pose",
        "Robot",
        "SafetyLimits",
        "Sphere",
        "Visual",
    ),
    "urdf.xml_document": ("parse_xml",),
    "xacro.expansion": ("expand_xacro",),
}
_MODULE_OF = {name: module for module, names in _EXPORTS.items() for name in names}


def __getattr__(name: str) -> Any:
    # A public name is imported on first use: the launcher only expands a xacro file, and the parser
    # of URDF, with lxml, takes a tenth as long as the whole launcher.
    if name not in _MODULE_OF:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
