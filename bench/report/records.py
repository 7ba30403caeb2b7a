"""Records of measurements: what `saccade bench` writes and what the pages are made of.

A records file is {"schema": 1, "runs": [...], "records": [...]}; docs/benchmarks.md says what the fields mean.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Mapping

SCHEMA = 1
KINDS = ("error", "time", "ratio", "count", "rate", "bytes")
LOAD_MATTERS = ("time", "rate", "ratio")  # kinds that another program on the machine changes


class RecordError(Exception):
    """What is wrong with a file or a request, in one line that says what to do."""


@dataclass(frozen=True)
class Value:
    """One metric of a record: the median of `repeats` measurements and their range, in `unit`."""

    median: float
    min: float
    max: float
    repeats: int = 1
    unit: str = ""
    kind: str = "error"
    better: str = "lower"


@dataclass(frozen=True)
class Run:
    """One call of a program: where and how its records were made; or `source`, a text that figures are quoted from."""

    commit: str
    command: str
    started: str
    machine: str
    seed: int | None = None
    dirty: bool = False
    other_load: float | None = None
    software: Mapping[str, str] = field(default_factory=dict)
    source: str = ""


@dataclass(frozen=True)
class Record:
    """What was measured under one set of labels (`labels`: which method; `at`: how far it was let run)."""

    key: str
    experiment: str
    run: Run
    labels: Mapping[str, str]
    at: Mapping[str, float]
    values: Mapping[str, Value]
    files: Mapping[str, str]
    loaded: bool
    note: str

    def median(self, metric: str) -> float | None:
        value = self.values.get(metric)
        return value.median if value else None


def machine_text(machine: Mapping[str, Any] | str) -> str:
    """The machine of a run as one phrase."""
    if isinstance(machine, str):
        return machine
    parts = [str(machine["cpu"]).strip()] if machine.get("cpu") else []
    if machine.get("cores"):
        parts.append(f"{machine['cores']} cores")
    if machine.get("memory_bytes"):
        parts.append(f"{machine['memory_bytes'] / 2**30:.0f} GiB")
    parts += [str(machine[name]) for name in ("os", "kernel") if machine.get(name)]
    return ", ".join(parts) or "unnamed machine"


def _finite(number: Any) -> bool:
    return isinstance(number, (int, float)) and not isinstance(number, bool) and math.isfinite(number)


def _value(raw: Any) -> Value | None:
    """A value that is missing, null or not finite is left out."""
    if not isinstance(raw, dict) or not _finite(raw.get("median")):
        return None
    median = float(raw["median"])
    low = float(raw["min"]) if _finite(raw.get("min")) else median
    high = float(raw["max"]) if _finite(raw.get("max")) else median
    return Value(
        median,
        low,
        high,
        int(raw.get("repeats") or 1),
        str(raw.get("unit") or ""),
        str(raw.get("kind") or "error"),
        str(raw.get("better") or "neither"),
    )


def _run(raw: Mapping[str, Any]) -> Run:
    return Run(
        source=str(raw.get("source") or ""),
        commit=str(raw.get("commit") or ""),
        command=str(raw.get("command", "")),
        started=str(raw.get("started", "")),
        machine=machine_text(raw.get("machine", {})),
        seed=raw.get("seed"),
        dirty=bool(raw.get("dirty", False)),
        other_load=raw["other_load"] if _finite(raw.get("other_load")) else None,
        software={str(name): str(version) for name, version in (raw.get("software") or {}).items()},
    )


def label_text(label: Any) -> str:
    return {True: "on", False: "off"}.get(label, str(label)) if isinstance(label, bool) else str(label)


def _record(raw: Mapping[str, Any], runs: list[Run]) -> Record:
    values = {str(name): _value(value) for name, value in (raw.get("values") or {}).items()}
    return Record(
        key=str(raw["key"]),
        experiment=str(raw.get("experiment") or raw["key"].split("/")[0]),
        run=runs[raw.get("run", 0)],
        labels={str(name): label_text(label) for name, label in (raw.get("labels") or {}).items()},
        at={str(name): float(x) for name, x in (raw.get("at") or {}).items() if _finite(x)},
        values={name: value for name, value in values.items() if value},
        files={str(name): str(path) for name, path in (raw.get("files") or {}).items() if path},
        loaded=bool(raw.get("loaded", False)),
        note=str(raw.get("note") or ""),
    )


def read_raw(path: Path) -> dict[str, Any]:
    """A records file as it stands. Raises RecordError."""
    try:
        raw = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RecordError(f"cannot read {path}: {error.strerror}; `saccade bench quick -o DIR` writes one") from error
    except ValueError as error:
        raise RecordError(f"{path} is no JSON: {error}") from error
    if not isinstance(raw, dict) or raw.get("schema") != SCHEMA:
        raise RecordError(f"{path} is no records file of schema {SCHEMA}")
    return raw


def load(path: Path) -> list[Record]:
    """The records of one file. Raises RecordError, naming the record that is wrong."""
    raw = read_raw(path)
    runs = [_run(run) for run in raw.get("runs", [])]
    records = []
    for position, entry in enumerate(raw.get("records", [])):
        try:
            records.append(_record(entry, runs))
        except (KeyError, IndexError, TypeError, ValueError, AttributeError) as error:
            raise RecordError(
                f"{path}: record {position} ({entry!r:.80}) is not as the schema says: {error!r}"
            ) from error
    return records


def load_all(paths: Iterable[Path]) -> dict[str, Record]:
    """The records of several files by key. Raises RecordError where a key occurs twice."""
    records: dict[str, Record] = {}
    for path in paths:
        for record in load(path):
            if record.key in records:
                raise RecordError(f"{path}: the key {record.key} occurs twice; remove the older record")
            records[record.key] = record
    return records


def number_text(number: float, digits: int = 3) -> str:
    """A number for a table: `digits` significant digits, whole numbers with thousands separators."""
    if number == int(number) and abs(number) < 1e15:
        return f"{int(number):,}"
    if abs(number) >= 1000:
        return f"{number:,.0f}"
    if 0 < abs(number) < 1e-4:
        return f"{number:.{digits - 1}e}"
    rounded = float(f"{number:.{digits}g}")
    return f"{rounded:.{max(0, digits - 1 - math.floor(math.log10(abs(rounded))))}f}"


def scaled(number: float, unit: str, kind: str) -> tuple[float, str]:
    """Bytes as MB or GB, rates as thousands or millions; anything else as it is."""
    if kind == "bytes" and unit in ("", "B", "bytes"):
        return (number / 1e9, "GB") if abs(number) >= 1e9 else (number / 1e6, "MB")
    if kind == "rate" and abs(number) >= 1e6:
        return number / 1e6, f"million {unit}".strip()
    return number, unit


def value_text(value: Value) -> str:
    """Median with unit, and the range where there were repeats that differ."""
    number, unit = scaled(value.median, value.unit, value.kind)
    factor = number / value.median if value.median else 1.0
    text = number_text(number)
    low, high = number_text(value.min * factor), number_text(value.max * factor)
    if value.repeats > 1 and low != high:
        text += f" ({low} to {high})"
    return f"{text} {unit}".strip()
