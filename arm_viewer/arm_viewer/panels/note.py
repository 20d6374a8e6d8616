"""A sentence on the page, as it stands: markup in a topic's words is none of the page's."""

from html import escape

PROBLEM_COLOUR = "#ff8787"


def note(text: str, colour: str = "inherit") -> str:
    """Return a sentence as HTML; each line becomes a paragraph."""
    lines = "".join(f"<div>{escape(line)}</div>" for line in text.splitlines())
    return (
        f'<div style="color:{colour};font-size:0.8rem;line-height:1.35;padding:0.25em 0.75em;'
        f'overflow-wrap:anywhere">{lines}</div>'
    )
