"""The qualities of service that many topics have, and that of services."""

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""A subscriber that comes later gets the last message."""
NEWEST = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
"""Only the newest message counts; it matches every publisher."""
SERVICE_QOS = QoSProfile(depth=1000)
"""How many requests of a service may wait until its server takes them.

With ROS's default of ten, a request is dropped for the eleventh, and its client waits for ever. Not
KEEP_ALL, as upstream's controller manager has it: one client that is suspended would in the end
block the answers to all.
"""
