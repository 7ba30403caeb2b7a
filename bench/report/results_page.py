"""docs/results.md from its template and the committed records. docs/benchmarks.md describes the template's language.

Every number in the page comes through a Figure, which leaves an invisible mark of its run; the marks become the line
below each table (and section) that names command and commit.
"""

from __future__ import annotations

import fnmatch
import re
from pathlib import Path
from typing import Any, Sequence

from blocks import LOADED_MARK, natural
from records import LOAD_MATTERS, Record, RecordError, Run, Value, load_all, number_text

try:
    import jinja2
except ModuleNotFoundError as error:
    raise SystemExit(
        "saccade: error: this python3 has no jinja2; run scripts/install and use Debian's own, /usr/bin/python3"
    ) from error

# {{experiment/rest-of-key:metric}} or {{experiment/rest-of-key:metric|format}}
_FIGURE = re.compile(r"\{\{([^\s{}\"'|][^{}\"'|]*/[^{}\"'|]*):(\w+)(?:\|([^{}\"']*))?\}\}")
_SPEC = re.compile(r"^[+]?,?(\.\d+)?[fgde%]?$")
_SCALES = {"k": 1e-3, "M": 1e-6, "G": 1e-9}
_MARK = re.compile("\x01(\\d+)\x02")


def number(value: float, spec: str) -> str:
    """A number by a Python format ("" = three significant digits), with a proper minus and a space before %."""
    text = format(value, spec) if spec else number_text(value)
    return text.replace("-", "−", 1 if text.startswith("-") else 0).replace("%", " %")


def formatted(value: Value, how: str) -> str:
    """Median in the form `how`: a Python format, then any of the words k, M, G, range, unit, times."""
    words = how.split()
    spec = words.pop(0) if words and _SPEC.match(words[0]) else ""
    unknown = [word for word in words if word not in (*_SCALES, "range", "unit", "times")]
    if unknown:
        raise RecordError(f'the format "{how}" has an unknown word: {unknown[0]}')
    factor = next((_SCALES[word] for word in words if word in _SCALES), 1.0)
    text = number(value.median * factor, spec)
    low, high = number(value.min * factor, spec), number(value.max * factor, spec)
    if "times" in words:
        text = f"× {text}"
    if "range" in words and low != high:
        text += f" ({low} to {high})"
    return f"{text} {value.unit}" if "unit" in words and value.unit else text


class Row:
    """A record inside a loop of the template: labels by name (`row.scene`), figures by call (`row("flip", ".3f")`)."""

    def __init__(self, book: "Book", record: Record) -> None:
        self._book, self._record = book, record

    def __call__(self, metric: str, how: str = "", absent: str | None = None) -> str:
        if metric not in self._record.values and absent is not None:
            return absent
        return self._book.figure(f"{self._record.key}:{metric}", how)

    def has(self, metric: str) -> bool:
        return metric in self._record.values

    @property
    def note(self) -> str:
        return self._record.note

    def __getattr__(self, name: str) -> str:
        if name in self._record.labels:
            return self._record.labels[name]
        if name in self._record.at:
            return self._book.marked(self._record, number_text(self._record.at[name]))
        raise AttributeError(f"the record {self._record.key} has no label {name}")


class Book:
    """The records that a template may use; notes which it used."""

    def __init__(self, records: dict[str, Record]) -> None:
        self.records = records
        self.used: dict[str, Record] = {}
        self.runs: list[Run] = []
        for record in records.values():
            if record.run not in self.runs:
                self.runs.append(record.run)
        self.machines = list(dict.fromkeys(run.machine for run in self.runs if not run.source))
        self._loaded_runs: set[int] = set()

    def marked(self, record: Record, text: str) -> str:
        """The text with the invisible mark of its run; the record counts as used."""
        self.used[record.key] = record
        return f"\x01{self.runs.index(record.run)}\x02{text}"

    def find(self, name: str) -> tuple[Record, Value]:
        """The value of "key:metric". Raises RecordError."""
        key, _, metric = name.rpartition(":")
        record = self.records.get(key)
        if record is None:
            raise RecordError(f"no record has the key {key}; measure it or take the placeholder away")
        if metric not in record.values:
            raise RecordError(f"the record {key} has no metric {metric}; it has {', '.join(record.values)}")
        return record, record.values[metric]

    def figure(self, name: str, how: str = "") -> str:
        record, value = self.find(name)
        mark = LOADED_MARK if record.loaded and value.kind in LOAD_MATTERS else ""
        return self.marked(record, formatted(value, how) + mark)

    def rows(self, experiment: str, **labels: str) -> list[Row]:
        """Records of an experiment that have these labels, in the files' order."""
        return [Row(self, record) for record in self.select(experiment, **labels)]

    def select(self, experiment: str, **labels: str) -> list[Record]:
        return [
            record
            for record in self.records.values()
            if record.experiment == experiment and all(record.labels.get(n) == v for n, v in labels.items())
        ]

    def has(self, pattern: str) -> bool:
        """Whether a record's key matches the shell pattern."""
        return any(fnmatch.fnmatchcase(key, pattern) for key in self.records)

    def ratio(self, ours: str, theirs: str, how: str = ".2f") -> str:
        """The quotient of two figures."""
        (record, value), (other, divisor) = self.find(ours), self.find(theirs)
        if not divisor.median:
            raise RecordError(f"{theirs} is zero, a ratio to it says nothing")
        quotient = value.median / divisor.median
        return self.marked(other, self.marked(record, formatted(Value(quotient, quotient, quotient), how)))

    def goals(self) -> list[dict[str, str]]:
        """What the plan or a paper asks for beside what we have; see Goal."""
        return [Goal(self, record).row() for record in self.select("goal")]

    def source(self, marks: Sequence[int], loaded: bool) -> str:
        """The line that says which commands, at which commits, gave the figures of these runs."""
        by_command: dict[str, list[str]] = {}
        for index in sorted(set(marks)):
            run = self.runs[index]
            where = run.source or (f"`{run.command}`" if "`" not in run.command else run.command)
            commit = f"{run.commit}{' + changes' if run.dirty else ''}" if run.commit else ""
            if len(self.machines) > 1 and not run.source:
                commit += f" on machine {self.machine_letter(run.machine)}"
            commits = by_command.setdefault(where, [])
            if commit and commit not in commits:
                commits.append(commit)
        parts = [f"{where} ({', '.join(commits)})" if commits else where for where, commits in by_command.items()]
        text = f"<sub>Source: {'; '.join(parts)}.</sub>"
        return text + (f"<sub> {LOADED_MARK} other programs were running.</sub>" if loaded else "")

    def machine_letter(self, machine: str) -> str:
        return chr(ord("A") + self.machines.index(machine))

    def machine_list(self) -> str:
        """The machines of all runs, with the letters by which source lines call them when there are several."""
        if len(self.machines) == 1:
            return self.machines[0]
        return "; ".join(f"{self.machine_letter(machine)}: {machine}" for machine in self.machines)


class Goal:
    """A record of experiment "goal": labels `what`, `of` (pattern "key:metric"), optionally `format`; a value `least`
    or `most`; the note is the cause where it is missed. Several records that match are judged by the worst."""

    def __init__(self, book: Book, record: Record) -> None:
        self._book, self._record = book, record
        self._side = "least" if "least" in record.values else "most"
        if self._side not in record.values or "of" not in record.labels:
            raise RecordError(f"the goal {record.key} needs a label of and a value least or most")
        self._limit = record.values[self._side]

    def row(self) -> dict[str, str]:
        """what, ours, goal, ratio, verdict, cause (empty where the goal is met), source."""
        labels, how = self._record.labels, self._record.labels.get("format", "")
        sign = "≥" if self._side == "least" else "≤"
        goal = self._book.marked(self._record, f"{sign} {formatted(self._limit, how)}")
        row = {"what": labels.get("what", self._record.key), "goal": goal, "source": self._record.run.source}
        found = self._matching()
        if not found:
            return row | {"ours": "–", "ratio": "–", "verdict": "not measured", "cause": ""}
        record, value = found[0]
        missed = value.median < self._limit.median if self._side == "least" else value.median > self._limit.median
        if missed and not self._record.note:
            raise RecordError(f"{record.key} misses the goal {self._record.key}; write the cause into the goal's note")
        quotient = value.median / self._limit.median if self._limit.median else None
        return row | {
            "ours": self._book.figure(f"{record.key}:{self._metric()}", how) + self._place(record, len(found)),
            "ratio": "–" if quotient is None else number(quotient, ".2f"),
            "verdict": "**falls short**" if missed else "met",
            "cause": self._record.note if missed else "",
        }

    def _metric(self) -> str:
        return self._record.labels["of"].rpartition(":")[2]

    def _place(self, record: Record, candidates: int) -> str:
        """Which of several records it is."""
        return f" ({record.labels.get('scene', record.key)})" if candidates > 1 else ""

    def _matching(self) -> list[tuple[Record, Value]]:
        """What the goal speaks of, the worst first."""
        pattern, metric = self._record.labels["of"].rpartition(":")[0], self._metric()
        found = [
            (record, record.values[metric])
            for key, record in self._book.records.items()
            if fnmatch.fnmatchcase(key, pattern) and metric in record.values
        ]
        return sorted(found, key=lambda pair: pair[1].median, reverse=self._side == "most")


def with_sources(text: str, book: Book) -> str:
    """The rendered page with its marks turned into source lines: below each table, and at the end of a section for
    what its prose took from other runs."""
    lines: list[str] = []
    table: list[str] = []
    named: set[int] = set()  # runs that a source line of this section has named
    waiting: set[int] = set()  # runs that prose has used since

    def close_table() -> None:
        if table:
            marks = {int(mark) for line in table for mark in _MARK.findall(line)}
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
            waiting.update(int(mark) for mark in _MARK.findall(line))
        lines.append(_MARK.sub("", line))
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
    names: dict[str, Any] = {"figure": book.figure, "rows": book.rows, "has": book.has, "ratio": book.ratio}
    names |= {"goals": book.goals, "machines": book.machine_list}
    try:
        return with_sources(environment.from_string(text).render(names), book)
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


def committed(folder: Path) -> dict[str, Record]:
    """The records under docs/records."""
    return load_all(sorted(folder.glob("*.json"), key=lambda path: natural(path.name)))
