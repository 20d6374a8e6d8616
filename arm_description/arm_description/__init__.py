"""Robot descriptions: reads URDF and xacro into a `Robot`, with its kinematics and its files.

It imports no ROS. The nodes robot_state_publisher and joint_state_publisher are in `publishers`.
"""

from typing import TYPE_CHECKING, Any

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

if TYPE_CHECKING:
    from arm_description.kinematics.forward import forward_kinematics

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


def __getattr__(name: str) -> Any:
    # Imported on first use: reading a description, as the launcher does, needs no NumPy.
    if name != "forward_kinematics":
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    from arm_description.kinematics.forward import forward_kinematics

    return forward_kinematics
