"""`arm completion`: what a shell needs to offer words on Tab."""

import argparse

SHELLS = ("bash", "zsh", "fish")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the verb's arguments."""
    parser.add_argument("shell", choices=SHELLS)
    parser.epilog = (
        "For good: add 'eval \"$(arm completion bash)\"' to ~/.bashrc, the same with zsh to "
        "~/.zshrc, or 'arm completion fish | source' to ~/.config/fish/config.fish."
    )


def run(options: argparse.Namespace) -> None:
    """Print the script."""
    from argcomplete.shell_integration import shellcode

    # argcomplete writes one script for bash and zsh alike.
    shell = "fish" if options.shell == "fish" else "bash"
    print(shellcode(["arm"], shell=shell))
