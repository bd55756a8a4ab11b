"""A process of its own for what is measured: how long it takes, and the most memory that it has."""

import subprocess
import sys
import time
from collections.abc import Sequence

import click


def peak() -> float:
    """The most memory that this process had, in megabytes."""
    try:
        import resource
    except ImportError:
        return float("nan")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (1e6 if sys.platform == "darwin" else 1e3)


def timed(call: Sequence[str]) -> tuple[float, str]:
    """Run a program; return its seconds, and what it printed. Its failure is ours, with its exit code."""
    start = time.perf_counter()
    done = subprocess.run(call, capture_output=True, text=True)
    seconds = time.perf_counter() - start
    if done.returncode:
        # Its own message and exit code say what is wrong, such as that nothing renders here.
        click.echo(done.stderr, err=True, nl=False)
        raise click.exceptions.Exit(done.returncode)
    return seconds, done.stdout
