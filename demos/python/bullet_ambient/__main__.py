"""Runs the cases of a file, or writes the table of their results: python3 -m bullet_ambient."""

from __future__ import annotations

import argparse
import signal
import sys
import time
from typing import Any, NoReturn

from .cases import _table, failed_file, run_cases, write_table


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: {_plain(message)}\n")


def _plain(text: str) -> str:
    """Returns a text in one line that a terminal can show: names of files may hold escape sequences."""
    return "".join(c if c.isprintable() else "?" for c in text.replace("\n", "\\n"))


def _shard(text: str) -> tuple[int, int]:
    index, count = map(int, text.split("/"))
    if not 0 <= index < count:
        raise ValueError
    return index, count


def _threads(text: str) -> int:
    if not 0 <= int(text) <= 1024:
        raise ValueError
    return int(text)


# Names of the types, for messages of argparse.
_shard.__name__ = "share I/N, with 0 <= I < N,"
_threads.__name__ = "number from 0 to 1024"


def _arguments() -> argparse.Namespace:
    text = 'Runs many scenes: {"scene": ..., "set": {PATH: VALUE}} per line.'
    usage = "python3 -m bullet_ambient --cases FILE.jsonl --out DIR [OPTIONS]"
    parser = _Parser(prog="bullet_ambient", usage=usage, description=text, add_help=False, allow_abbrev=False)
    parser.add_argument("--help", action="help", help="print this")
    parser.add_argument("--cases", metavar="FILE.jsonl", required=True, help="the cases")
    parser.add_argument("--out", metavar="DIR", required=True, help="folder of the results of all shards")
    parser.add_argument("--shard", metavar="I/N", type=_shard, default=(0, 1), help="of the cases those with index I modulo N")
    parser.add_argument("--threads", metavar="T", type=_threads, default=0, help="0: all cores")
    parser.add_argument("--summaries", action="store_true", help="keep no motion, only summary.json")
    parser.add_argument("--collect", metavar="FILE.csv", help="write the table of the cases that are done, and stop")
    parser.add_argument("--quiet", action="store_true", help="print errors only")
    return parser.parse_args()


def _collect(arguments: argparse.Namespace) -> int:
    columns, rows, missing = _table(arguments.cases, arguments.out)
    write_table(arguments.collect, columns, rows)
    if not arguments.quiet:
        print(f"{_plain(arguments.collect)}: {len(rows)} rows of {len(columns)} columns, {missing} cases are not done")
    return 0


def _run(arguments: argparse.Namespace) -> int:
    is_shown = sys.stderr.isatty() and not arguments.quiet
    runs_ended = 0

    def show(ended: int, runs: int) -> None:
        nonlocal runs_ended
        runs_ended = ended
        if is_shown and runs > 0:
            print(f"\r{_plain(arguments.cases)}: {ended} of {runs} run", end="", file=sys.stderr, flush=True)

    start = time.monotonic()
    more: dict[str, Any] = {"shard": arguments.shard, "threads": arguments.threads, "motion": not arguments.summaries}
    cases, done_before, failures = run_cases(arguments.cases, arguments.out, progress=show, **more)
    seconds = time.monotonic() - start
    if is_shown and runs_ended > 0:
        print(file=sys.stderr)
    if not arguments.quiet:
        counts = f"{cases} cases, {done_before} done before, {runs_ended} run in {seconds:.1f} s, {len(failures)} failed"
        print(f"{_plain(arguments.cases)}: {counts}")
    if failures:
        file, first = failed_file(arguments.out, arguments.shard), failures[min(failures)]
        text = f"{len(failures)} of {cases} cases failed, see {file}; the first: {first}"
        print(f"bullet_ambient: {_plain(text)}", file=sys.stderr)
    return 1 if failures else 0


def _sentence(error: Exception) -> str:
    """What the error says, its file first: "cases.jsonl: no such file or directory"."""
    if isinstance(error, OSError) and error.filename and error.strerror:
        return f"{error.filename}: {error.strerror[0].lower()}{error.strerror[1:]}"
    return str(error)


def main() -> int:
    arguments = _arguments()
    for ending in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(ending, signal.default_int_handler)
    try:
        return _collect(arguments) if arguments.collect else _run(arguments)
    except KeyboardInterrupt:
        print("bullet_ambient: interrupted", file=sys.stderr)
    except (OSError, ValueError, RuntimeError) as error:
        print(f"bullet_ambient: {_plain(_sentence(error))}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
