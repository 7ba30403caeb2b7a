"""What a section of the page is made of: plots, tables and galleries, and how records become tables and galleries."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Iterable, Sequence

from plots import Plot
from records import LOAD_MATTERS, Record, value_text

# Metric: how it is called, in the order of columns.
METRICS: dict[str, str] = {
    "relmse": "relative MSE",
    "rmse": "RMSE",
    "psnr": "PSNR",
    "ssim": "SSIM",
    "flip": "FLIP, mean",
    "flip_median": "FLIP, median",
    "flip_p95": "FLIP, 95th percentile",
    "flip_salient": "FLIP weighted by saliency",
    "flip_step": "FLIP from frame to frame",
    "relerr": "RMS error over mean irradiance",
    "relerr_with_dark": "the same with points in closed bodies",
    "p99": "99th percentile",
    "error": "RMS error of what is kept",
    "walk_rmse": "RMS error of the walk",
    "walk_flip": "FLIP of the walk",
    "seconds": "time",
    "frame_p50": "frame time, median",
    "frame_p95": "frame time, 95th percentile",
    "frame_p99": "frame time, 99th percentile",
    "missed_share": "share of missed deadlines",
    "samples_per_second": "samples a second",
    "rays_per_second": "rays a second",
    "samples_per_frame": "samples a frame",
    "reused_per_frame": "reused samples a frame",
    "seconds_to": "seconds to this relative MSE",
    "peak_bytes": "peak memory",
    "ours": "ours",
    "paper": "the paper's",
    "achieved": "achieved",
    "allowed": "allowed",
}

_PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg", ".svg")
_PLAIN_LABELS = ("method", "renderer", "what", "shows", "case", "test", "scene", "step")  # whose values name themselves
REMARKS = ("status", "result")  # labels that say how it went, not what was measured
_LABEL_ORDER = ("number", "scene", "path", "renderer", "method", "order", "cache", "attention")
# What stands under a picture; a record without any of these shows all it has.
_PICTURE_METRICS = ("relmse", "psnr", "flip", "flip_salient", "seconds", "frame_p95")
_TABLE_OPEN_ROWS = 16  # a longer table starts folded
LOADED_MARK = "†"


@dataclass(frozen=True)
class Cell:
    text: str
    number: bool = False
    bad: bool = False


@dataclass(frozen=True)
class PlotBlock:
    plot: Plot
    kind: str = "plot"


@dataclass(frozen=True)
class TableBlock:
    caption: str
    columns: list[str]
    rows: list[list[Cell]]
    kind: str = "table"

    @property
    def folded(self) -> bool:
        return len(self.rows) > _TABLE_OPEN_ROWS


@dataclass(frozen=True)
class GalleryRow:
    """Pictures side by side, each with its role, and the numbers under them."""

    title: str
    pictures: list[tuple[str, str]]
    numbers: str
    loaded: bool


@dataclass(frozen=True)
class GalleryBlock:
    caption: str
    rows: list[GalleryRow]
    folded: bool = False
    kind: str = "gallery"


Block = PlotBlock | TableBlock | GalleryBlock


@dataclass
class Context:
    """What a section may look at: its own records, everybody's, and where the page stands."""

    folder: Path
    records: list[Record]
    everything: list[Record] = field(default_factory=list)


def metric_name(metric: str) -> str:
    plain = metric.removesuffix("_ms")
    plain = f"{plain.removesuffix('_bytes')} memory" if plain.endswith("_bytes") else plain
    return METRICS.get(metric, plain.replace("_", " "))


def axis_label(metric: str, unit: str = "") -> str:
    """A metric as the title of an axis."""
    name = metric_name(metric)
    return name if not unit or (unit == "1/s" and "second" in name) else f"{name} ({unit})"


def hint(records: Iterable[Record], metrics: Sequence[str]) -> str:
    """Which way of the metrics is better, in words; nothing where they disagree."""
    better = {record.values[metric].better for record in records for metric in metrics if metric in record.values}
    words = {"lower": "lower is better ↓", "higher": "higher is better ↑"}
    return words.get(better.pop(), "") if len(better) == 1 else ""


def natural(text: str) -> tuple[tuple[int, float, str], ...]:
    """A sorting key by which 8 comes before 16 and words keep their alphabet."""
    parts: list[tuple[int, float, str]] = []
    for part in text.replace(",", " ").split():
        try:
            parts.append((0, float(part), ""))
        except ValueError:
            parts.append((1, 0.0, part))
    return tuple(parts)


def varying(records: Iterable[Record]) -> list[str]:
    """Labels that differ among the records (a missing one counts): what is general first."""
    records = list(records)
    seen = list(dict.fromkeys(name for record in records for name in record.labels))
    seen.sort(key=lambda name: _LABEL_ORDER.index(name) if name in _LABEL_ORDER else len(_LABEL_ORDER))
    return [name for name in seen if len({record.labels.get(name) for record in records}) > 1]


def variant_name(record: Record, names: Sequence[str]) -> str:
    """A record's curve or row by the labels that matter: "corrective, order task"."""
    words = []
    for name in names:
        if name in record.labels and name not in REMARKS:
            value = record.labels[name]
            words.append(value if name in _PLAIN_LABELS else f"{name} {value}")
    return ", ".join(words)


def at_text(record: Record) -> str:
    names = {"budget_ms": "ms", "seconds": "s", "x": "", "samples": "samples", "spp": "spp"}
    return ", ".join(f"{x:,.10g} {names.get(name, name)}".strip() for name, x in record.at.items())


def by_label(records: Iterable[Record], name: str) -> dict[str, list[Record]]:
    """Records by the value of one label; those without it stand under ""."""
    groups: dict[str, list[Record]] = {}
    for record in records:
        groups.setdefault(record.labels.get(name, ""), []).append(record)
    return dict(sorted(groups.items(), key=lambda group: natural(group[0])))


def metrics_of(records: Iterable[Record]) -> list[str]:
    """Metrics that occur, known ones first and in the table's order."""
    found = dict.fromkeys(metric for record in records for metric in record.values)
    known = [metric for metric in METRICS if metric in found]
    return known + [metric for metric in found if metric not in METRICS]


def value_cell(record: Record, metric: str) -> Cell:
    value = record.values.get(metric)
    if value is None:
        return Cell("")
    mark = LOADED_MARK if record.loaded and value.kind in LOAD_MATTERS else ""
    return Cell(value_text(value) + mark, number=True)


def record_table(records: Sequence[Record], caption: str, labels: Sequence[str] | None = None) -> TableBlock:
    """One row a record: labels that differ, where it was measured, and all metrics as median and range."""
    names = list(labels) if labels is not None else (varying(records) or list(records[0].labels))
    names += [name for name in REMARKS if name not in names and any(name in record.labels for record in records)]
    metrics = metrics_of(records)
    with_at = any(record.at for record in records)
    with_note = any(record.note for record in records)
    columns = (
        names
        + (["at"] if with_at else [])
        + [metric_name(metric) for metric in metrics]
        + (["note"] if with_note else [])
    )
    rows = []
    for record in records:
        row = [Cell(record.labels.get(name, "")) for name in names]
        row += [Cell(at_text(record), number=True)] if with_at else []
        row += [value_cell(record, metric) for metric in metrics]
        row += [Cell(record.note)] if with_note else []
        rows.append(row)
    return TableBlock(caption, columns, rows)


def is_picture(folder: Path, path: str) -> bool:
    """A picture that a browser shows and that lies inside the page's folder."""
    if not path.lower().endswith(_PICTURE_SUFFIXES):
        return False
    target = (folder / path).resolve()
    return target.is_relative_to(folder.resolve()) and target.is_file()


def reference_picture(record: Record, everything: Iterable[Record]) -> str:
    """The picture that a record was compared with: its own, or that of its scene's reference."""
    if "reference" in record.files:
        return record.files["reference"]
    for other in everything:
        if other.experiment == "reference" and other.labels.get("scene") == record.labels.get("scene"):
            return other.files.get("picture", "")
    return ""


def gallery_row(context: Context, record: Record, title: str) -> GalleryRow | None:
    """Reference | method | error map, with the numbers; None when the record has no picture."""
    shown = [("reference", reference_picture(record, context.everything))]
    own = "this method" if "error" in record.files else "picture"
    shown += [(own, record.files.get("picture", "")), ("FLIP map", record.files.get("error", ""))]
    shown += [(role, path) for role, path in record.files.items() if role not in ("picture", "error", "reference")]
    pictures = [(role, path) for role, path in shown if path and is_picture(context.folder, path)]
    if not any(role != "reference" for role, _ in pictures):
        return None
    metrics = [metric for metric in _PICTURE_METRICS if metric in record.values] or metrics_of([record])
    numbers = [f"{metric_name(metric)} {value_cell(record, metric).text}" for metric in metrics]
    return GalleryRow(title, pictures, " · ".join(numbers), record.loaded)


def galleries(context: Context, records: Sequence[Record], caption: str) -> list[Block]:
    """The pictures of each variant where it was let run longest, and, folded, all others."""
    names = [name for name in varying(records) if name != "scene"]
    variants: dict[str, list[Record]] = {}
    for record in records:
        variants.setdefault(variant_name(record, names), []).append(record)
    last, others = [], []
    for variant, group in variants.items():
        group = sorted(group, key=lambda record: sum(record.at.values()))
        rows = [gallery_row(context, record, " at ".join(filter(None, (variant, at_text(record))))) for record in group]
        rows = [row for row in rows if row]
        last += rows[-1:]
        others += rows[:-1]
    found = [GalleryBlock(caption, last)] if last else []
    return found + ([GalleryBlock(f"{caption}: all other times and budgets", others, folded=True)] if others else [])
