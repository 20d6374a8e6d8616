"""Messages that rosbag2 compressed one by one, before it wrote them to the file.

Only metadata.yaml says so, which a bag can lose. But no message in CDR begins like a frame of zstd,
so that the messages themselves tell.
"""

from arm_cli.bag.chunk_sizes import MAX_CHUNK_BYTES
from arm_cli.errors import BagError

MODE, FORMAT = "MESSAGE", "zstd"
"""How metadata.yaml names this compression."""
_FRAME_START = b"\x28\xb5\x2f\xfd"


def is_compressed(data: bytes) -> bool:
    """Return whether a message, which is CDR if it is not compressed, is compressed."""
    return data[:4] == _FRAME_START


def decompressed(data: bytes, topic: str) -> bytes:
    """Return a message without its compression.

    Raises:
        BagError: the message is damaged, or too large.
    """
    import zstandard

    try:
        # rosbag2 writes the size of the message into the frame.
        size = zstandard.get_frame_parameters(data).content_size
        if size <= MAX_CHUNK_BYTES:
            return zstandard.ZstdDecompressor().decompress(data)
    except zstandard.ZstdError as error:
        raise BagError(f"a compressed message of {topic} is damaged: {error}") from error
    found = "an unknown number of" if size == zstandard.CONTENTSIZE_UNKNOWN else str(size)
    raise BagError(
        f"a message of {topic} decompresses to {found} bytes; the limit is {MAX_CHUNK_BYTES}"
    )
