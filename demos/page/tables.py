"""Headings and tables of a Markdown file as HTML."""

import html
import re


def inline(text):
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", html.escape(text.strip()))
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", text)


def row(line, tag):
    return "<tr>" + "".join(f"<{tag}>{inline(cell)}</{tag}>" for cell in line.strip().strip("|").split("|")) + "</tr>"


def tables_as_html(text):
    """Sections that contain no table are left out."""
    parts = []
    for title, section in re.findall(r"^## (.*)\n((?:(?!## ).*\n?)*)", text, re.MULTILINE):
        tables = re.findall(r"^(\|.*)\n\|[-|]+\|\n((?:\|.*\n)+)", section, re.MULTILINE)
        if tables:
            parts.append(f"<h2>{inline(title)}</h2>")
        for head, body in tables:
            rows = "\n".join(row(line, "td") for line in body.splitlines())
            parts.append(f"<table>\n<thead>{row(head, 'th')}</thead>\n<tbody>\n{rows}\n</tbody>\n</table>")
    return "\n".join(parts)
