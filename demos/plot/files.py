"""Files that cannot be read or written end a program in one line."""

import csv
import sys
from contextlib import contextmanager


@contextmanager
def reading(source, kind):
    """Reading of `source`, which should be `kind`: "a run of ambient_demo", "a stability atlas"."""
    try:
        yield
    except OSError as error:
        sys.exit(f"{error.filename}: {error.strerror}")
    except (ArithmeticError, LookupError, StopIteration, TypeError, ValueError):
        sys.exit(f"{source}: is not {kind}")


@contextmanager
def writing(file):
    try:
        yield
    except (OSError, ValueError) as error:
        # Kinds of pictures that matplotlib does not know are a ValueError.
        sys.exit(f"{file}: cannot be written: {getattr(error, 'strerror', None) or error}")


def read_table(file, kind, columns):
    """Rows of a CSV file that has at least these columns, as dictionaries of strings."""
    with reading(file, kind), open(file, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
        if not rows or None in rows[0].values() or not set(columns) <= set(rows[0]):
            raise ValueError
        return rows
