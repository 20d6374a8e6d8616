"""Reads the words for true and false that launch files and command lines use."""

TRUE_WORDS = ("true", "1", "yes", "on")
FALSE_WORDS = ("false", "0", "no", "off")


def parse_truth(text: str) -> bool | None:
    """Return what the word means, None when it is neither a true nor a false word."""
    word = text.strip().lower()
    if word in TRUE_WORDS:
        return True
    return False if word in FALSE_WORDS else None


def truth_text(value: bool) -> str:
    """Return the word that ROS launch files compare with."""
    return "true" if value else "false"
