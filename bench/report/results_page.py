"""docs/results.md from its template and the committed records. docs/benchmarks.md describes the template's language.

Every figure of a Book carries an invisible mark of its run; the marks become the line below each table (and section)
that names command and commit.
"""

from __future__ import annotations

import re
from pathlib import Path

from blocks import LOADED_MARK, natural
from book import MARK, Book
from records import Record, RecordError, load_all

try:
    import jinja2
except ModuleNotFoundError as error:
    raise SystemExit(
        "saccade: error: this python3 has no jinja2; run scripts/install and use Debian's own, /usr/bin/python3"
    ) from error

# {{experiment/rest-of-key:metric}} or {{experiment/rest-of-key:metric|format}}
_FIGURE = re.compile(r"\{\{([^\s{}\"'|][^{}\"'|]*/[^{}\"'|]*):(\w+)(?:\|([^{}\"']*))?\}\}")


def with_sources(text: str, book: Book) -> str:
    """The rendered page with its marks turned into source lines: below each table, and at the end of a section for
    what its prose took from other runs."""
    lines: list[str] = []
    table: list[str] = []
    named: set[int] = set()  # runs that a source line of this section has named
    waiting: set[int] = set()  # runs that prose has used since

    def close_table() -> None:
        if table:
            marks = {int(mark) for line in table for mark in MARK.findall(line)}
            if marks:
                lines.extend(["", book.source(sorted(marks), any(LOADED_MARK in line for line in table))])
            named.update(marks)
            table.clear()

    def close_section() -> None:
        rest = waiting - named
        if rest:
            while lines and not lines[-1]:
                lines.pop()
            lines.extend(["", book.source(sorted(rest), False), ""])
        named.clear()
        waiting.clear()

    for line in text.splitlines():
        if line.startswith("|"):
            table.append(line)
        else:
            close_table()
            if line.startswith("#"):
                close_section()
            waiting.update(int(mark) for mark in MARK.findall(line))
        lines.append(MARK.sub("", line))
    close_table()
    close_section()
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).rstrip() + "\n"


def render(template: Path, book: Book) -> str:
    """The page. Raises RecordError that names the template's line."""
    text = template.read_text(encoding="utf-8")
    text = _FIGURE.sub(lambda m: '{{ figure("%s:%s", "%s") }}' % (m[1], m[2], m[3] or ""), text)
    environment = jinja2.Environment(
        trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined, autoescape=False
    )
    names = ("figure", "rows", "labels", "places", "has", "ratio", "after", "plot", "goals", "machines")
    try:
        return with_sources(environment.from_string(text).render({name: getattr(book, name) for name in names}), book)
    except jinja2.TemplateSyntaxError as error:
        raise RecordError(f"{template}:{error.lineno}: {error.message}") from error
    except (RecordError, jinja2.UndefinedError, TypeError, ValueError) as error:
        raise RecordError(f"{template}:{_template_line(error)}: {error}") from error


def _template_line(error: BaseException) -> int:
    """The line of the template on which rendering stopped."""
    trace, line = error.__traceback__, 0
    while trace:
        if trace.tb_frame.f_code.co_filename == "<template>":
            line = trace.tb_lineno
        trace = trace.tb_next
    return line


def committed(docs: Path) -> dict[str, Record]:
    """The records under docs/records."""
    return load_all(sorted((docs / "records").glob("*.json"), key=lambda path: natural(path.name)))


def book_of(docs: Path) -> Book:
    """The committed records and plots."""
    return Book(committed(docs), plots_folder(docs))


def plots_folder(docs: Path) -> Path:
    return docs / "pictures" / "plots"
