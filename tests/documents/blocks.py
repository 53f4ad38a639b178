"""The blocks of code of the Markdown pages, with the invisible comments that stand directly before them.

    <!-- given: ... -->     what the block takes for granted: parameters of a function around C++, statements before Python,
                            commands before commands
    <!-- not run: ... -->   why nobody runs it here; of commands, programs and options are looked up all the same
    <!-- quicker: A -> B --> the commands are run with B in place of A, which takes less time
    <!-- usage -->          not commands but their forms: programs and options are looked up
"""

import re
import textwrap
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SHOWN = ("text", "math")  # languages of blocks that only show something
COMMANDS = "commands"  # the language of blocks that are indented
NOTE = re.compile(r"<!-- (given|not run|quicker|usage)(?:: (.*?))? -->", re.DOTALL)


@dataclass
class Block:
    page: Path
    line: int  # of its first line
    language: str
    text: str
    notes: dict = field(default_factory=dict)

    def __str__(self):
        return f"{self.page.relative_to(ROOT)}:{self.line}"


def pages():
    """All but the history."""
    own = [page for page in ROOT.glob("*.md") if page.name != "CHANGELOG.md"]
    return [*sorted(own), *sorted(ROOT.glob("data/*.md")), *sorted(ROOT.glob("docs/*.md"))]


def notes_before(lines, end):
    """The notes that end right above this line, blank lines between."""
    found = {}
    above = "\n".join(lines[:end]).rstrip()
    while match := re.search(r"<!-- (?:(?!-->).)*-->$", above, re.DOTALL):
        note = NOTE.fullmatch(match[0])
        if not note:
            break
        found[note[1]] = note[2] or ""
        above = above[: match.start()].rstrip()
    return found


def is_indented(line):
    return line.startswith("    ")


def blocks_of(page):
    """Fenced blocks, and indented ones that stand alone or below a comment."""
    lines = page.read_text().splitlines()
    found, at = [], 0
    while at < len(lines):
        fence = re.match(r"(```|~~~)(\w*)$", lines[at])
        alone = at == 0 or not lines[at - 1].strip() or lines[at - 1].endswith("-->")
        begin, language = (at + 1, fence[2]) if fence else (at, COMMANDS)
        if fence:
            end = lines.index(fence[1], begin)
            at = end + 1
        elif is_indented(lines[at]) and alone:
            end = next((i for i in range(at, len(lines)) if lines[i].strip() and not is_indented(lines[i])), len(lines))
            at = end
        else:
            at += 1
            continue
        text = textwrap.dedent("\n".join(lines[begin:end])).rstrip() + "\n"
        found.append(Block(page, begin + 1, language, text, notes_before(lines, begin - bool(fence))))
    return found


def all_blocks(*languages):
    return [block for page in pages() for block in blocks_of(page) if block.language in languages]
