"""How many requests of a service may wait until its server takes them."""

from rclpy.qos import QoSProfile

SERVICE_QOS = QoSProfile(depth=1000)
"""With ROS's default of ten, a request is dropped for the eleventh, and its client waits for ever.

Not KEEP_ALL, as upstream's controller manager has it: one client that is suspended would in the end
block the answers to all.
"""
