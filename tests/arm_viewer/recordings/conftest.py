"""Small recordings, written message by message."""

from contextlib import ExitStack, closing

import pytest
from mcap.writer import CompressionType, Writer

from arm_viewer.recordings.recorded_bag import RecordedBag


@pytest.fixture
def write_mcap(tmp_path):
    """Return a function that writes an MCAP file; each list of messages becomes a chunk."""

    def write(*chunks, name="a.mcap", kind="std_msgs/msg/String", compression="ZSTD"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with path.open("wb") as stream:
            # Its chunks end where `flush` is called below.
            writer = Writer(stream, chunk_size=1 << 40, compression=CompressionType[compression])
            writer.start(profile="ros2")
            schema = writer.register_schema(kind, "ros2msg", b"string data")
            channels = {}
            for chunk in chunks:
                for topic, time_ns, data in chunk:
                    if topic not in channels:
                        channels[topic] = writer.register_channel(topic, "cdr", schema)
                    writer.add_message(channels[topic], time_ns, data, time_ns)
                writer.flush()
            writer.finish()
        return path

    return write


@pytest.fixture
def opened():
    """Return a function that opens a recording, which is closed with the test."""
    with ExitStack() as all_opened:

        def open_recording(path):
            return all_opened.enter_context(closing(RecordedBag(path)))

        yield open_recording
