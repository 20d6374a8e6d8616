"""Robot descriptions: reads URDF and xacro into a `Robot`, with its kinematics and its files.

It imports no ROS. The nodes robot_state_publisher and joint_state_publisher are in `publishers`.
"""

from typing import TYPE_CHECKING

from arm_node.public_names import on_first_use

if TYPE_CHECKING:
    from arm_description.errors import DescriptionError as DescriptionError
    from arm_description.errors import JointStateError as JointStateError
    from arm_description.errors import KinematicsError as KinematicsError
    from arm_description.errors import MeshFileError as MeshFileError
    from arm_description.errors import MimicCycleError as MimicCycleError
    from arm_description.errors import ResourceNotFoundError as ResourceNotFoundError
    from arm_description.errors import SettingsError as SettingsError
    from arm_description.errors import UrdfError as UrdfError
    from arm_description.errors import XacroError as XacroError
    from arm_description.errors import XmlError as XmlError
    from arm_description.kinematics.forward import forward_kinematics as forward_kinematics
    from arm_description.resources import ResourceFinder as ResourceFinder
    from arm_description.resources import resolve_uri as resolve_uri
    from arm_description.urdf.joint_type import JointType as JointType
    from arm_description.urdf.parser import parse_urdf as parse_urdf
    from arm_description.urdf.robot import Box as Box
    from arm_description.urdf.robot import Capsule as Capsule
    from arm_description.urdf.robot import Collision as Collision
    from arm_description.urdf.robot import Cylinder as Cylinder
    from arm_description.urdf.robot import Dynamics as Dynamics
    from arm_description.urdf.robot import Geometry as Geometry
    from arm_description.urdf.robot import Inertial as Inertial
    from arm_description.urdf.robot import Joint as Joint
    from arm_description.urdf.robot import JointLimit as JointLimit
    from arm_description.urdf.robot import Link as Link
    from arm_description.urdf.robot import Material as Material
    from arm_description.urdf.robot import Mesh as Mesh
    from arm_description.urdf.robot import Mimic as Mimic
    from arm_description.urdf.robot import Pose as Pose
    from arm_description.urdf.robot import Robot as Robot
    from arm_description.urdf.robot import SafetyLimits as SafetyLimits
    from arm_description.urdf.robot import Sphere as Sphere
    from arm_description.urdf.robot import Visual as Visual
    from arm_description.urdf.xml_document import parse_xml as parse_xml
    from arm_description.xacro.expansion import expand_xacro as expand_xacro

# The launcher only expands a xacro file, and the parser of URDF, with lxml, takes a tenth as long
# as the whole launcher.
__getattr__, __dir__ = on_first_use(__name__)
