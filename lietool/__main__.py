"""Where the program starts: the command ``lietool`` and ``python -m lietool``."""

import os
import sys


def main() -> None:
    """Run the command line; an interrupt is quiet even while it is being imported."""
    # All matrices here are small: threads of the linear algebra would only wait for each other, up to ten
    # times as long as one takes.  It is read when numpy is loaded.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from lietool import cli

        cli.main()
    except KeyboardInterrupt:
        sys.exit(130)
    except ModuleNotFoundError as error:
        # What the command line itself is made of: there is nothing yet to report errors with.
        if error.name != "click":
            raise
        sys.stderr.write(f"lietool: {error}. Install it with: pip install click\n")
        sys.exit(2)


if __name__ == "__main__":
    main()
