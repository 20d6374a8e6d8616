"""Robot descriptions: URDF and xacro to a `Robot`, its kinematics and its files.

Holds no ROS at import; the nodes robot_state_publisher and joint_state_publisher are in `ros/`.
"""

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
from arm_description.kinematics import forward_kinematics
from arm_description.resources import resolve_uri
from arm_description.robot import (
    Box,
    Capsule,
    Collision,
    Cylinder,
    Dynamics,
    Geometry,
    Inertial,
    Joint,
    JointLimit,
    JointType,
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
from arm_description.urdf import parse_urdf
from arm_description.xacro_expansion import expand_xacro
from arm_description.xml_document import parse_xml

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
