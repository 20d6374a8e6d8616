"""The camera process, which renders the images, and the feed that sends it states."""
