"""Converts octomaps from and to messages."""

from array import array

from octomap_msgs.msg import OctomapWithPose

from arm_planning.ros.convert import pose_message, pose_of
from arm_planning.scene.occupancy_map import OccupancyMap
from arm_planning.scene.octree import decoded, encoded, refused
from arm_planning.scene.scene_changes import OctomapChange

KIND = "OcTree"


def octomap_change_of(message: OctomapWithPose) -> OctomapChange | None:
    """Return the change that a message stands for; None if it says nothing of an octomap.

    Raises:
        PlanningError: its data are not an octree of the kind "OcTree", or it has no resolution.
    """
    octomap = message.octomap
    data = bytes(octomap.data)
    if not octomap.id:
        return None
    frame = message.header.frame_id or octomap.header.frame_id
    pose = pose_of(message.origin, "the octomap")
    if not data:
        return OctomapChange(frame, pose, octomap.resolution, None)
    if octomap.id != KIND:
        raise refused(f"it is of the kind '{octomap.id}', and '{KIND}' is read")
    return OctomapChange(frame, pose, octomap.resolution, decoded(data, binary=octomap.binary))


def octomap_message(octomap: OccupancyMap, frame: str) -> OctomapWithPose:
    """Return an octomap as a message in the planning frame."""
    message = OctomapWithPose()
    message.header.frame_id = message.octomap.header.frame_id = frame
    message.octomap.id = KIND
    message.octomap.binary = True
    message.origin = pose_message(octomap.pose)
    message.octomap.resolution = octomap.resolution_m
    message.octomap.data = array("b", encoded(octomap.cubes))
    return message
