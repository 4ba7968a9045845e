"""What a recording holds."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rerun.chunk import RrdReader


def read(path: Path, entity: str, component: str, timeline: str = "drilled_length_mm") -> dict[Any, list[Any]]:
    """What an entity's component holds at each tick of a timeline."""
    chunks = RrdReader(path).stream().filter(content=f"/{entity}", components=component, has_timeline=timeline)
    batches = [chunk.to_record_batch() for chunk in chunks]
    return {
        tick: value
        for batch in batches
        for tick, value in zip(batch.column(timeline).to_pylist(), batch.column(component).to_pylist(), strict=True)
    }


def held(path: Path, entity: str, component: str, ticks: Iterable[int]) -> list[Any]:
    """What an entity's component, which is logged where it changes, holds at some ticks of the timeline."""
    changes = read(path, entity, component)
    now: list[Any] = []
    values = []
    for tick in ticks:
        now = changes.get(tick, now)
        values.append(now)
    return values


def static(path: Path, entity: str, component: str) -> list[Any]:
    """What an entity's component was for all time, one after the other."""
    chunks = RrdReader(path).stream().filter(content=f"/{entity}", components=component, is_static=True)
    return [value for chunk in chunks for value in chunk.to_record_batch().column(component).to_pylist()]


def stacked(path: Path, entity: str, component: str) -> NDArray[np.float64]:
    """What an entity's component holds at all ticks, one after the other."""
    return np.array(list(read(path, entity, component).values()), dtype=float)
