"""`python -m arm_cli` is the `arm` command."""

from arm_cli.main import run

if __name__ == "__main__":
    run()
