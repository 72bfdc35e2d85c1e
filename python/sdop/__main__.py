"""The command ``sdop``: ``python -m sdop --help``."""

import sys

from ._sdop import main as _main


def main() -> int:
    return _main(["sdop", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
