"""Made-up records of every experiment, for tests of the pages: deterministic, with gaps as real runs may have them."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import Any

SCENES = ("cornell",)
VARIANTS: list[dict[str, str]] = [
    {"method": "base"},
    {"method": "path"},
    {"method": "corrective", "order": "attention", "cache": "on"},
    {"method": "corrective", "order": "task", "cache": "on"},
    {"method": "corrective", "order": "attention", "cache": "off"},
]


def png(path: Path, shade: int, side: int = 8) -> None:
    """A grey picture, written without any library."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes((shade + 9 * x + 5 * y) % 256 for x in range(side)) for y in range(side))
    header = struct.pack(">IIBBBBB", side, side, 8, 0, 0, 0, 0)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    )


def value(median: float, kind: str = "error", unit: str = "", spread: float = 0.05) -> dict[str, Any]:
    exact = kind in ("error", "count")
    low, high = (median, median) if exact else (median * (1 - spread), median * (1 + spread))
    better = {"rate": "higher", "ratio": "neither", "count": "neither"}.get(kind, "lower")
    return {"median": median, "min": low, "max": high, "repeats": 5, "unit": unit, "kind": kind, "better": better}


def record(
    key: str, labels: dict[str, Any], at: dict[str, float], values: dict[str, Any], **more: Any
) -> dict[str, Any]:
    return {
        "key": key,
        "experiment": key.split("/")[0],
        "run": 0,
        "labels": labels,
        "at": at,
        "values": values,
        "files": {},
        "loaded": False,
        **more,
    }


def _errors(error: float) -> dict[str, Any]:
    return {
        "relmse": value(error),
        "flip": value(error**0.5 / 2),
        "flip_salient": value(error**0.5 / 3),
        "psnr": value(20 - error),
    }


def _name(labels: dict[str, str]) -> str:
    return "-".join(labels.values())


def still(folder: Path) -> list[dict[str, Any]]:
    found = []
    for scene in SCENES:
        png(folder / f"pictures/{scene}_reference.png", 90)
        files = {"picture": f"pictures/{scene}_reference.png"}
        found.append(record(f"reference/{scene}", {"scene": scene}, {}, {"relmse": value(0.0012)}, files=files))
        for place, labels in enumerate(VARIANTS):
            for seconds in (0.125, 0.5, 2, 8):
                floor = 0.05 if labels["method"] in ("base", "raytrace") else 0.004
                error = floor + (0.3 + 0.04 * place) / (1 + 4 * seconds)
                key = f"still/{scene}/{_name(labels)}@{seconds}s"
                picture, flip = (
                    f"pictures/{scene}-{_name(labels)}-{seconds}.png",
                    f"pictures/{scene}-{_name(labels)}-{seconds}_flip.png",
                )
                png(folder / picture, 100 + place)
                png(folder / flip, 10 + place)
                values = {**_errors(error), "seconds": value(seconds * 1.02, "time", "s")}
                found.append(
                    record(
                        key,
                        {"scene": scene, **labels},
                        {"seconds": seconds},
                        values,
                        files={"picture": picture, "error": flip},
                    )
                )
    return found


def moving() -> list[dict[str, Any]]:
    found = []
    for place, labels in enumerate(VARIANTS[:3]):
        for budget in (8, 16, 33, 66, 125):
            values = {
                **_errors(0.4 / budget + 0.01 * place),
                "flip_step": value(0.02 + 0.2 / budget),
                "flip_step_raytrace": value(0.01 + 0.1 / budget),
                "frame_p95": value(budget * 1.04, "time", "ms"),
            }
            values |= {
                "missed_share": value(max(0, 40 - budget) / 40, "count"),
                "samples_per_second": value(2e5 + 1e4 * place, "rate", "1/s"),
                "peak_bytes": value(3e8, "bytes", "B"),
            }
            key = f"moving/gallery/walk/{_name(labels)}@{budget}ms"
            found.append(
                record(
                    key,
                    {"scene": "gallery", "path": "walk", **labels},
                    {"budget_ms": budget},
                    values,
                    loaded=budget == 8,
                )
            )
    free = {**_errors(0.05), "frame_p50": value(300, "time", "ms")}
    found.append(
        record("moving/gallery/raytrace", {"scene": "gallery", "path": "walk", "method": "raytrace"}, {}, free)
    )
    found.append(
        record(
            "moving/gallery/reference",
            {"scene": "gallery", "path": "walk", "method": "reference"},
            {},
            {"flip": value(0.011)},
        )
    )
    against = {"flip_over_base": value(0.7, "ratio"), "relmse_over_base": value(0.6, "ratio")}
    found.append(
        record("moving/gallery/against@66ms", {"scene": "gallery", "path": "walk"}, {"budget_ms": 66}, against)
    )
    return found


def peers() -> list[dict[str, Any]]:
    found = []
    renderers = [("Cycles (Blender 3.4.1)", 40.0), ("path", 20.0)]
    for quality, factor in (("preview", 1.0), ("medium", 1.5), ("high", 2.0)):
        renderers += [
            (f"corrective, {quality} maps", factor),
            (f"corrective, {quality} maps, bake included", 5 * factor),
        ]
    for renderer, factor in renderers:
        labels = {"scene": "cornell_glossy", "renderer": renderer}
        for step in range(4):
            values = {"seconds": value(factor * 0.1 * 4**step, "time", "s"), "relmse": value(0.5 / 3.5**step)}
            found.append(record(f"peers/cornell_glossy/{renderer}@{4**step}spp", labels, {"spp": 4**step}, values))
        values = {"seconds_to": value(factor, "time", "s"), "sooner_than_cycles": value(40 / factor, "ratio")}
        found.append(record(f"peers/cornell_glossy/{renderer}/to-0.05", labels, {"relmse": 0.05}, values))
    labels = {"scene": "cornell_glossy", "renderer": "our reference against Cycles' picture"}
    found.append(record("peers/cornell_glossy/model", labels, {}, {"own_relmse": value(0.0008)}))
    return found


def others() -> list[dict[str, Any]]:
    found = []
    for exponent in range(4, 8):
        values = {
            "frame_ms": value(0.0002 * 10**exponent, "time", "ms"),
            "peak_bytes": value(140.0 * 10**exponent, "bytes", "B"),
        }
        found.append(
            record(f"growth/triangles@{10**exponent}", {"quantity": "triangles"}, {"x": 10**exponent}, values)
        )
    for threads in (0, 1, 2):
        found.append(
            record(
                f"growth/threads@{threads}",
                {"quantity": "threads"},
                {"x": threads},
                {"frame_ms": value(40 - 9 * threads, "time", "ms")},
            )
        )
    found += peers()
    found.append(record("peers/cycles", {"renderer": "Cycles", "status": "not installed: no curve of its"}, {}, {}))
    for what, ours, theirs in (
        ("aging of fifty thousand samples", 0.9, 7.5),
        ("rendering", 21.0, 45.0),
        ("lattice", 5.1, 8.0),
    ):
        values = {
            "ours": value(ours, "time", "ms"),
            "paper": value(theirs, "time", "ms"),
            "ratio": value(ours / theirs, "ratio"),
        }
        found.append(record(f"paper/{what}", {"what": what}, {}, values))
    for scene, ratio in (("gallery", 0.42), ("cornell", 0.51)):
        values = {
            "loop": value(2.38e6, "rate", "rays/s"),
            "bare": value(5.56e6, "rate", "rays/s"),
            "ratio": value(ratio, "ratio"),
        }
        found.append(record(f"rays/{scene}", {"scene": scene}, {}, values))
    for number, achieved in (("1", 0.001), ("2", 0.02), ("10", 0.9)):
        labels = {"number": number, "case": f"case <{number}> & more", "test": "Some.Test"}
        found.append(record(f"hard/{number}", labels, {}, {"achieved": value(achieved), "allowed": value(0.5)}))
    gaps = {"relmse": {"median": None}, "flip": None, "rmse": {"median": float("nan"), "unit": ""}}
    found.append(
        record(
            "still/cornell/no-values",
            {"scene": "cornell", "method": "path"},
            {},
            gaps,
            files={"picture": "pictures/absent.png"},
        )
    )
    found.append(
        record("brand-new/one", {"what": "an experiment that no table knows"}, {}, {"speed": value(3.0, "rate", "1/s")})
    )
    return found


RUN: dict[str, Any] = {
    "commit": "abc1234",
    "dirty": False,
    "command": "saccade bench quick -o out",
    "seed": 1,
    "started": "2026-11-22T10:00:00Z",
    "machine": {"cpu": "Some Processor", "cores": 2, "memory_bytes": 8 * 2**30, "os": "Debian 12", "kernel": "6.1"},
    "software": {"embree": "3.13.5"},
    "other_load": 0.03,
}


def write(folder: Path, records: list[dict[str, Any]], name: str = "records.json") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(json.dumps({"schema": 1, "runs": [RUN], "records": records}, indent=1), encoding="utf-8")


def write_everything(folder: Path) -> None:
    write(folder, [*still(folder), *moving(), *others()])
