"""Publishing what is serialised already, without rclpy's checks."""

from rclpy.publisher import Publisher


class RawPublisher:
    """A publisher as the middleware offers it, for what is published at every tick.

    `rclpy.publisher.Publisher` looks at the type and takes hold of its handle at each call, which
    takes longer than the middleware does. The hold is against a `destroy` in between; neither
    these calls nor `destroy` lets go of the interpreter, so there is no in between.
    """

    def __init__(self, publisher: Publisher) -> None:
        """Wrap a publisher; it stays the caller's to destroy."""
        self._handle = publisher.handle

    def publish(self, message: bytes) -> None:
        """Publish a serialised message.

        Raises:
            RCLError: the publisher is destroyed already.
        """
        self._handle.publish_raw(message)

    def wanted(self) -> bool:
        """Whether anybody subscribes."""
        return self._handle.get_subscription_count() > 0
