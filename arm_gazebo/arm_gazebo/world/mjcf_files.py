"""Check the files that an untrusted MJCF names: they must be in its folder or below."""

from pathlib import Path

from arm_gazebo.mjcf.references import check_readable, references
from arm_gazebo.world.refusal import Refusal, RequestError


def check_mjcf_files(text: str, path: Path | None = None) -> None:
    """Refuse an untrusted MJCF that names files outside its own folder, or that are not regular.

    Args:
        text: the MJCF.
        path: its file; None for a text without a file, which may not name any files.

    Raises:
        RequestError: it names a file outside its folder; the message says which.
        ModelError: a file is not a regular one.
        XmlError: the MJCF, or one that it includes, is not XML.
    """
    for reference in references(text, path):
        if reference.source is None:
            problem = "a text has no folder; give a uri instead"
        elif Path(reference.value).is_absolute() or ".." in Path(reference.value).parts:
            problem = "it is outside the folder of the MJCF file"
        else:
            continue
        raise RequestError(
            Refusal.MISSING_ASSETS,
            f"{reference.attribute}='{reference.value}' is not read: {problem}",
        )
    if path is not None:
        check_readable(text, path)
