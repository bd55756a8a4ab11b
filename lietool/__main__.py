"""Where the program starts: the command ``lietool`` and ``python -m lietool``."""

import sys


def main() -> None:
    """Run the command line; an interrupt is quiet even while it is being imported."""
    try:
        from lietool import cli

        cli.main()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
