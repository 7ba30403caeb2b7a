"""What a template of the results page may ask of the records; every figure it gives carries the mark of its run."""

from __future__ import annotations

import fnmatch
import re
from pathlib import Path
from typing import Sequence

from blocks import LOADED_MARK
from records import LOAD_MATTERS, Record, RecordError, Run, Value, number_text

_SPEC = re.compile(r"^[+]?,?(\.\d+)?[fgde%]?$")
_SCALES = {"k": 1e-3, "M": 1e-6, "G": 1e-9}
MARK = re.compile("\x01(\\d+)\x02")


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
        return self._book.figure(f"{self._record.key}:{metric}", how, absent)

    def has(self, metric: str) -> bool:
        return metric in self._record.values

    def label(self, name: str) -> str:
        """A label or a place that not every record has: nothing where it is absent."""
        return getattr(self, name, "")

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

    def __init__(self, records: dict[str, Record], plots: Path) -> None:
        """`plots`: folder of the plots that were taken over, beside the page's own folder."""
        self.records = records
        self.plots = plots
        self.asked_plots: list[str] = []
        self.complaints: list[str] = []  # what somebody has to write before the page is whole
        self.used: dict[str, Record] = {}
        self.runs: list[Run] = []
        for record in records.values():
            if record.run not in self.runs:
                self.runs.append(record.run)
        self.machine_names = list(dict.fromkeys(run.machine for run in self.runs if not run.source))
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

    def figure(self, name: str, how: str = "", absent: str | None = None) -> str:
        """The value of "key:metric" in the form `how`; `absent` instead where there is none, if it is given."""
        key, _, metric = name.rpartition(":")
        if absent is not None and not (key in self.records and metric in self.records[key].values):
            return absent
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

    def labels(self, experiment: str, name: str) -> list[str]:
        """The values that a label has in an experiment, in the files' order."""
        return list(dict.fromkeys(r.labels[name] for r in self.select(experiment) if name in r.labels))

    def places(self, experiment: str, name: str, **labels: str) -> list[str]:
        """Where (`at`) an experiment was measured, in rising order."""
        return [f"{x:g}" for x in sorted({r.at[name] for r in self.select(experiment, **labels) if name in r.at})]

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

    def after(self, seconds: float, experiment: str, metric: str, how: str = "", place: str = "", **labels: str) -> str:
        """What a method has after so many seconds: the figure of its longest measurement that took no longer; with
        `place` only of those that say it in `at` ("spp": was given samples a pixel, "seconds": was given time)."""
        found = [
            (record.values["seconds"].median, record.key)
            for record in self.select(experiment, **labels)
            if metric in record.values and "seconds" in record.values and (not place or place in record.at)
        ]
        in_time = [pair for pair in found if pair[0] <= seconds]
        return self.figure(f"{max(in_time)[1]}:{metric}", how) if in_time else "–"

    def plot(self, name: str, description: str) -> str:
        """A plot of the measurement as a picture, once it has been taken over; nothing before."""
        self.asked_plots.append(name)
        file = self.plots / f"{name}.png"
        return f"![{description}]({self.plots.parent.name}/{self.plots.name}/{file.name})" if file.is_file() else ""

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
            if len(self.machine_names) > 1 and not run.source:
                commit += f" on machine {self.machine_letter(run.machine)}"
            commits = by_command.setdefault(where, [])
            if commit and commit not in commits:
                commits.append(commit)
        parts = [f"{where} ({', '.join(commits)})" if commits else where for where, commits in by_command.items()]
        text = f"<sub>Source: {'; '.join(parts)}.</sub>"
        return text + (f"<sub> {LOADED_MARK} other programs were running.</sub>" if loaded else "")

    def machine_letter(self, machine: str) -> str:
        return chr(ord("A") + self.machine_names.index(machine))

    def machines(self) -> str:
        """The machines of all runs, with the letters by which source lines call them when there are several."""
        if len(self.machine_names) == 1:
            return self.machine_names[0]
        return "; ".join(f"{self.machine_letter(machine)}: {machine}" for machine in self.machine_names)


class Goal:
    """A record of experiment "goal": labels `what`, `of` (pattern "key:metric"), optionally `format`; a value `least`
    or `most`; the note is the cause where it is missed. Of several records that match the worst is judged, or the best
    where the label `judge` says so."""

    def __init__(self, book: Book, record: Record) -> None:
        self._book, self._record = book, record
        self._side = "least" if "least" in record.values else "most"
        if self._side not in record.values or "of" not in record.labels:
            raise RecordError(f"the goal {record.key} needs a label of and a value least or most")
        self._limit = record.values[self._side]

    def row(self) -> dict[str, str]:
        """what, ours, goal, ratio, verdict, cause (empty where the goal is met)."""
        labels, how = self._record.labels, self._record.labels.get("format", "")
        sign = "≥" if self._side == "least" else "≤"
        goal = self._book.marked(self._record, f"{sign} {formatted(self._limit, how)}")
        row = {"what": labels.get("what", self._record.key), "goal": goal, "ratio": "–"}
        found = self._matching()
        if not found:
            return row | self._without_figure()
        record, value = found[0]
        missed = value.median < self._limit.median if self._side == "least" else value.median > self._limit.median
        row["ours"] = self._book.figure(f"{record.key}:{self._metric()}", how) + self._place(record, len(found))
        if self._limit.median:
            row["ratio"] = number(value.median / self._limit.median, ".2f")
        return row | (self._missed(record) if missed else {"verdict": "met", "cause": ""})

    def _without_figure(self) -> dict[str, str]:
        """Nothing was measured, or what was measured says by its status why it has no figure: it did not get there."""
        tried = [record for record in self._candidates() if "status" in record.labels]
        if not tried:
            return {"ours": "–", "verdict": "not measured", "cause": ""}
        return {"ours": self._book.marked(tried[0], tried[0].labels["status"])} | self._missed(tried[0])

    def _missed(self, record: Record) -> dict[str, str]:
        if not self._record.note:
            wanted = f"{record.key} misses the goal {self._record.key}; write the cause into the goal's note"
            self._book.complaints.append(wanted)
        return {"verdict": "**falls short**", "cause": self._record.note or "cause not written yet"}

    def _metric(self) -> str:
        return self._record.labels["of"].rpartition(":")[2]

    def _place(self, record: Record, candidates: int) -> str:
        """Which of several records it is."""
        return f" ({record.labels.get('scene', record.key)})" if candidates > 1 else ""

    def _candidates(self) -> list[Record]:
        pattern = self._record.labels["of"].rpartition(":")[0]
        return [record for key, record in self._book.records.items() if fnmatch.fnmatchcase(key, pattern)]

    def _matching(self) -> list[tuple[Record, Value]]:
        """What the goal speaks of; the one that it is judged by first."""
        metric = self._metric()
        found = [(record, record.values[metric]) for record in self._candidates() if metric in record.values]
        best = self._record.labels.get("judge") == "best"
        return sorted(found, key=lambda pair: pair[1].median, reverse=(self._side == "most") != best)
