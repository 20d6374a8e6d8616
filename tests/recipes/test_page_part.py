"""The recipe for a part of the page: how full a robot's battery is."""

import pytest
from checkout import Checkout

OBSERVER = '''\
"""How full the battery is."""

from rclpy.node import Node
from rclpy.qos import QoSPresetProfiles
from sensor_msgs.msg import BatteryState

from arm_node.polled_subscriptions import PolledSubscriptions
from arm_viewer.ros.observer import Observer, TopicTypes
from arm_viewer.ros.topic_reader import TopicReader

TOPIC = "/battery_state"


class BatteryObserver(Observer):
    """Keeps the newest charge."""

    def __init__(self, node: Node, polled: PolledSubscriptions) -> None:
        """Subscribe."""
        qos = QoSPresetProfiles.SENSOR_DATA.value
        self._reader = TopicReader(node, polled, BatteryState, TOPIC, qos)
        self.charge: float | None = None

    def discover(self, topics: TopicTypes) -> None:
        """Forget the charge that nobody publishes any more."""
        if TOPIC not in topics:
            self.charge = None

    def collect(self, now_s: float) -> None:
        """Take what has arrived."""
        message = self._reader.take_newest()
        if message is not None:
            self.charge = message.percentage
'''

PANEL = '''\
"""How full the battery is."""

from viser import GuiApi

from arm_viewer.panels.panel import note
from arm_viewer.snapshot import Snapshot


class BatteryPanel:
    """One line."""

    def __init__(self) -> None:
        self._shown: float | None = None

    def build(self, gui: GuiApi) -> None:
        """Make the line."""
        self._text = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Show the charge."""
        if snapshot.charge is not None and snapshot.charge != self._shown:
            self._shown = snapshot.charge
            self._text.content = note(f"Battery: {snapshot.charge:.0%}")
'''

# What the page in the browser is sent: two lengths, and the messages by zstd.
SCRIPT = """\
import threading
import rclpy
import viser
import zstandard
from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import BatteryState
from websockets.sync.client import connect
from arm_viewer.access import LOCAL_HOST
from arm_viewer.page import page_running
from arm_viewer.page_server import page_server
from arm_viewer.ros.viewer import Viewer

LENGTHS = 16

rclpy.init()
viewer, robot = Viewer(), rclpy.create_node("robot")
battery = robot.create_publisher(BatteryState, "/battery_state", 10)
robot.create_timer(0.1, lambda: battery.publish(BatteryState(percentage=0.42)))
executor = SingleThreadedExecutor()
executor.add_node(viewer)
executor.add_node(robot)
spinning = threading.Thread(target=executor.spin, daemon=True)
spinning.start()
with page_server(0) as server, page_running(server, viewer.latest, viewer.send):
    address = f"ws://{LOCAL_HOST}:{server.get_port()}"
    protocol = f"viser-v{viser.__version__}"
    wanted = {"subprotocols": [protocol], "origin": server.url, "open_timeout": 60.0}
    with connect(address, max_size=None, **wanted) as page:
        said = b""
        while b"Battery: 42%" not in said:
            message = page.recv(timeout=60.0)
            said = zstandard.ZstdDecompressor().decompressobj().decompress(message[LENGTHS:])
print("shown")
executor.shutdown()
spinning.join()
rclpy.try_shutdown()
"""


@pytest.mark.ros
def test_a_part_of_the_page_is_added_through_the_files_of_its_recipe(tmp_path):
    checkout = Checkout(tmp_path, "A part of the page", NAME="battery")
    checkout.write("arm_viewer/arm_viewer/ros/battery_observer.py", OBSERVER)
    checkout.write("arm_viewer/arm_viewer/panels/battery_panel.py", PANEL)
    checkout.insert(
        "arm_viewer/arm_viewer/snapshot.py",
        (
            "    time: SimulationTime | None = None\n",
            "    charge: float | None = None\n    time: SimulationTime | None = None\n",
        ),
    )
    checkout.insert(
        "arm_viewer/arm_viewer/ros/viewer.py",
        (
            "from arm_viewer.ros.camera_observer",
            "from arm_viewer.ros.battery_observer import BatteryObserver\n"
            "from arm_viewer.ros.camera_observer",
        ),
        (
            "        self._log = self._observing(LogObserver(self, polled))\n",
            "        self._battery = self._observing(BatteryObserver(self, polled))\n"
            "        self._log = self._observing(LogObserver(self, polled))\n",
        ),
        (
            "            made_s=now_s,\n",
            "            made_s=now_s,\n            charge=self._battery.charge,\n",
        ),
    )
    checkout.insert(
        "arm_viewer/arm_viewer/page.py",
        (
            "from arm_viewer.panels.camera_panel",
            "from arm_viewer.panels.battery_panel import BatteryPanel\n"
            "from arm_viewer.panels.camera_panel",
        ),
        ('"Control": (ControllerPanel(send),', '"Control": (BatteryPanel(), ControllerPanel(send)'),
    )

    assert checkout.run(SCRIPT) == "shown\n"
