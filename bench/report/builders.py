"""How the records of one experiment become blocks of the page; sections.py says which experiment uses which."""

from __future__ import annotations

import re
from collections import Counter
from typing import Sequence

from blocks import (
    Block,
    Cell,
    Context,
    PlotBlock,
    TableBlock,
    axis_label,
    by_label,
    galleries,
    hint,
    metric_name,
    metrics_of,
    natural,
    record_table,
    value_cell,
    variant_name,
    varying,
)
from plots import Curve, Line, Panel, Point, draw, ratios
from records import Record

# Variants of a method, and the value that stands for each while another one is varied.
_USUAL = {"order": "attention", "cache": "on", "attention": "0.5"}

# Kinds of values, each with a panel of its own, and the word on its axis.
_KINDS = {"time": "time", "bytes": "memory", "rate": "rate", "error": "error", "ratio": "ratio", "count": "count"}


def _stem(*words: str) -> str:
    return re.sub(r"[^a-zA-Z0-9]+", "-", "-".join(filter(None, words))).strip("-").lower()


def _cost(record: Record) -> tuple[float, tuple[float, float] | None] | None:
    """Seconds that were spent, measured where they were, else granted; budgets stay milliseconds."""
    measured = record.values.get("seconds")
    if measured and "budget_ms" not in record.at:
        return measured.median, (measured.min, measured.max)
    for name in ("seconds", "budget_ms", "x"):
        if name in record.at:
            return record.at[name], None
    return (next(iter(record.at.values())), None) if record.at else None


def point(record: Record, metric: str) -> Point | None:
    """A record as a point of a plot of `metric`; None when it has no such value or no place on the x axis."""
    value, cost = record.values.get(metric), _cost(record)
    if value is None or cost is None:
        return None
    factor = 1e-6 if value.kind == "bytes" else 1.0  # MB, as _unit says
    return Point(cost[0], value.median * factor, (value.min * factor, value.max * factor), cost[1], record.loaded)


def curves(records: Sequence[Record], names: Sequence[str], metric: str) -> list[Curve]:
    """One curve for each combination of the labels `names`."""
    found: dict[str, Curve] = {}
    for record in records:
        place = point(record, metric)
        if place:
            name = variant_name(record, names) or record.experiment
            found.setdefault(name, Curve(name)).points.append(place)
    return sorted(found.values(), key=lambda curve: natural(curve.name))


def _usual(records: Sequence[Record], label: str) -> str | None:
    """The value of a label that stands still while others vary: the usual one, or the most frequent."""
    values = Counter(record.labels[label] for record in records if label in record.labels)
    if not values:
        return None
    return _USUAL[label] if _USUAL[label] in values else values.most_common(1)[0][0]


def questions(records: Sequence[Record]) -> list[tuple[str, list[Record], list[str]]]:
    """(title, records, labels that name a curve): methods against one another, then each of their options alone."""
    options = [name for name in _USUAL if len({r.labels[name] for r in records if name in r.labels}) > 1]
    usual = {name: _usual(records, name) for name in options}

    def fixed(record: Record, but: str = "") -> bool:
        return all(record.labels.get(name, usual[name]) == usual[name] for name in options if name != but)

    others = [name for name in varying(records) if name not in ("scene", "path", *_USUAL)]
    methods = [record for record in records if fixed(record)]
    found = [("methods", methods, others or ["method"])]
    for option in options:
        chosen = [record for record in records if option in record.labels and fixed(record, but=option)]
        if len({record.labels[option] for record in chosen}) > 1:
            found.append((option, chosen, [name for name in varying(chosen) if name not in ("scene", "path")]))
    return found


def _floor(context: Context, scene: str, metric: str) -> list[Line]:
    for record in context.everything:
        value = record.median(metric)
        if record.experiment == "reference" and record.labels.get("scene", "") == scene and value:
            return [Line("the reference's own error", value)]
    return []


def error_against_cost(
    context: Context, metrics: Sequence[str], x_label: str, timing: Sequence[str] = ()
) -> list[Block]:
    """For each scene (and path): a figure for each question, the times behind it, all numbers, all pictures."""
    found: list[Block] = []
    for scene, group in by_label(context.records, "scene").items():
        for path, records in by_label(group, "path").items():
            found += _error_figures(context, records, (scene, path), metrics, x_label, timing)
            names = [name for name in varying(records) if name not in ("scene", "path")]
            ordered = sorted(
                records, key=lambda record: (natural(variant_name(record, names)), sum(record.at.values()))
            )
            place = ", ".join(filter(None, (scene, path)))
            found.append(record_table(ordered, f"{place}: all numbers, median and range", names or ["method"]))
            found += galleries(context, ordered, f"{place}: pictures")
    return found


def _error_figures(
    context: Context,
    records: Sequence[Record],
    place: tuple[str, str],
    metrics: Sequence[str],
    x_label: str,
    timing: Sequence[str],
) -> list[Block]:
    """The plots of one scene and path, one a question."""
    found: list[Block] = []
    name, words = records[0].experiment, ", ".join(filter(None, place))
    for title, chosen, names in questions(records):
        panels = [
            Panel(hint(chosen, [m]), x_label, axis_label(m), curves(chosen, names, m), _floor(context, place[0], m))
            for m in metrics
        ]
        found += _plot(context, _stem(name, *place, title), f"{words}: {title}", panels)
        if timing and title == "methods":
            panels = _timing_panels(chosen, names, timing, x_label)
            found += _plot(context, _stem(name, *place, "times"), f"{words}: what a frame costs", panels)
    return found


def _timing_panels(
    records: Sequence[Record], names: Sequence[str], metrics: Sequence[str], x_label: str
) -> list[Panel]:
    panels = []
    for metric in metrics:
        diagonal = "the budget itself" if metric.startswith("frame_") else ""
        log_y = metric != "missed"
        unit = _unit(records, metric)
        panels.append(
            Panel(
                hint(records, [metric]),
                x_label,
                axis_label(metric, unit),
                curves(records, names, metric),
                [],
                True,
                log_y,
                diagonal,
            )
        )
    return panels


def _plot(context: Context, stem: str, title: str, panels: list[Panel]) -> list[Block]:
    plot = draw(context.folder, stem, title, panels)
    return [PlotBlock(plot)] if plot else []


def _unit(records: Sequence[Record], metric: str) -> str:
    for record in records:
        value = record.values.get(metric)
        if value:
            return "MB" if value.kind == "bytes" else value.unit
    return ""


def growth(context: Context, x_units: dict[str, str], group: str = "quantity") -> list[Block]:
    """For each quantity a figure, on logarithmic axes: a panel each for times, bytes and what else was measured."""
    found: list[Block] = []
    for quantity, records in by_label(context.records, group).items():
        records = sorted(records, key=lambda record: sum(record.at.values()))
        names = [name for name in varying(records) if name != group]
        panels = [
            panel for kind in _KINDS for panel in _kind_panels(records, names, kind, x_units.get(quantity, quantity))
        ]
        found += _plot(context, _stem(records[0].experiment, quantity), quantity or records[0].experiment, panels)
        found.append(
            record_table(
                records,
                f"{quantity}: all numbers, median and range".lstrip(": "),
                [group] + names if quantity else names,
            )
        )
    return found


def _kind_panels(records: Sequence[Record], names: Sequence[str], kind: str, x_label: str) -> list[Panel]:
    """A panel for all metrics of a kind that share a unit; its curves carry the metrics' names."""
    units: dict[str, list[str]] = {}
    for metric in metrics_of(records):
        if any(metric in record.values and record.values[metric].kind == kind for record in records):
            units.setdefault(_unit(records, metric), []).append(metric)
    panels = []
    for unit, metrics in units.items():
        found = []
        for metric in metrics:
            for curve in curves(records, names, metric):
                plain = curve.name == records[0].experiment
                curve.name = metric_name(metric) if plain else f"{metric_name(metric)}, {curve.name}"
                found.append(curve)
        word = _KINDS[kind]
        panels.append(Panel(hint(records, metrics), x_label, f"{word} ({unit})" if unit else word, found))
    return panels


def ratio_rows(context: Context, metric: str, x_label: str, mark: str, caption: str) -> list[Block]:
    """A line for each record's ratio from the line at 1, and the table behind it."""
    names = varying(context.records) or list(context.records[0].labels)
    heights = [
        (variant_name(r, names) or r.key, r.values[metric].median) for r in context.records if metric in r.values
    ]
    plot = ratios(
        context.folder, _stem(context.records[0].experiment, metric), caption, x_label, heights, Line(mark, 1.0)
    )
    return ([PlotBlock(plot)] if plot else []) + [record_table(context.records, "All numbers, median and range")]


def hard_cases(context: Context) -> list[Block]:
    """A table of every case with its share of what is allowed; shares above 1 are failures."""
    rows, heights = [], []
    ordered = sorted(context.records, key=lambda record: natural(record.labels.get("number", "")))
    for record in ordered:
        achieved, allowed = record.median("achieved"), record.median("allowed")
        share = achieved / allowed if achieved is not None and allowed else None
        failed = achieved is not None and allowed is not None and achieved > allowed
        name = f"{record.labels.get('number', '')} {record.labels.get('case', record.key)}".strip()
        if share:
            heights.append((name, share))
        cells = [Cell(record.labels.get(label, "")) for label in ("number", "case", "test")]
        cells += [value_cell(record, "achieved"), value_cell(record, "allowed")]
        cells.append(Cell(f"{share:.2g}" if share is not None else "", number=True, bad=failed))
        rows.append(cells)
    plot = ratios(
        context.folder,
        "hard",
        "Error as a share of what is allowed",
        "achieved / allowed, lower is better",
        heights,
        Line("allowed", 1.0),
    )
    table = TableBlock("Every case", ["number", "case", "test", "achieved", "allowed", "share"], rows)
    return ([PlotBlock(plot)] if plot else []) + [table] + galleries(context, ordered, "Pictures")


def plain(context: Context) -> list[Block]:
    """What any experiment gets: its records as a table, and its pictures."""
    return [
        record_table(context.records, "All numbers, median and range"),
        *galleries(context, context.records, "Pictures"),
    ]
