"""Sections of a Markdown file as HTML: headings, tables, lists and paragraphs; pictures and code are left out."""

import html
import re


def inline(text):
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", html.escape(text.strip(), quote=False))
    text = re.sub(r"\*\*([^*]*)\*\*", r"<b>\1</b>", text)
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", text)


def row(line, tag):
    return "<tr>" + "".join(f"<{tag}>{inline(cell)}</{tag}>" for cell in line.strip().strip("|").split("|")) + "</tr>"


def table(lines):
    rows = "\n".join(row(line, "td") for line in lines[2:])
    return f"<table>\n<thead>{row(lines[0], 'th')}</thead>\n<tbody>\n{rows}\n</tbody>\n</table>"


def bullets(block):
    items = re.split(r"^- ", block, flags=re.MULTILINE)[1:]
    return "<ul>\n" + "\n".join(f"<li>{inline(item)}</li>" for item in items) + "\n</ul>"


def as_html(block):
    if block.startswith("|"):
        return table(block.splitlines())
    if block.startswith("- "):
        return bullets(block)
    return "" if block.startswith(("![", "    ")) else f"<p>{inline(block)}</p>"


def sections_as_html(text):
    """What stands before the first heading of the second level is left out."""
    parts = []
    for title, section in re.findall(r"^## (.*)\n((?:(?!## ).*\n?)*)", text, re.MULTILINE):
        parts.append(f"<h2>{inline(title)}</h2>")
        parts += map(as_html, filter(None, (block.strip("\n") for block in re.split(r"\n\s*\n", section))))
    return "\n".join(filter(None, parts))
