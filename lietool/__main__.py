"""``python -m lietool``."""

from lietool.cli import main

if __name__ == "__main__":
    main()
