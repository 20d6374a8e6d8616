"""`python -m arm_cli` is the `arm` command."""

import sys

from arm_cli.main import main

if __name__ == "__main__":
    sys.exit(main())
