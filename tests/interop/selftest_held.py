"""Faults planted in the small job whose strips end in discs."""

from __future__ import annotations

from typing import Callable

from tiny_hub import HUB, LEVELS, NAME, NODES, SETBACK, Shape, tiny_hub
from tiny_job import THICKNESS, TinyJob

Fault = tuple[str, Callable[[], TinyJob], str]


def changed(change: Callable[[TinyJob], object], shape: Shape | None = None) -> Callable[[], TinyJob]:
    def make() -> TinyJob:
        job = tiny_hub(shape)
        change(job)
        return job

    return make


def part_of(job: TinyJob, name: str) -> dict:
    return next(part for part in job.manifest["parts"] if part["id"] == name)


def connector_of(job: TinyJob) -> dict:
    return part_of(job, NAME)["connector"]


def slot_turned(job: TinyJob) -> None:
    connector = connector_of(job)
    connector["slots"][1]["angle_deg"] += 0.5
    connector["fins"][1][1] += 0.5


def strip_left_out(job: TinyJob) -> None:
    connector = connector_of(job)
    del connector["fins"][0], connector["slots"][0]
    for copy in connector["copies"]:
        copy["fins"].remove("S01")


def ends_swapped(job: TinyJob) -> None:
    """The two ends of the ring, each in the other's window."""
    first, second = connector_of(job)["slots"][1:]
    first["to"], second["to"] = second["to"], first["to"]


def end_twice(job: TinyJob) -> None:
    connector_of(job)["slots"][2]["to"] = connector_of(job)["slots"][1]["to"]


def setback_listed(place: int, by: float) -> Callable[[TinyJob], None]:
    def change(job: TinyJob) -> None:
        part_of(job, "S01")["strip"]["setbacks"][place] += by

    return change


def strips_first(job: TinyJob) -> None:
    steps = job.manifest["assembly"]
    steps[:] = [{**entry, "step": k + 1} for k, entry in enumerate([*steps[1:3], steps[0], steps[3]])]


def connector_missing(job: TinyJob) -> None:
    job.manifest["parts"].remove(part_of(job, NAME))


def strip_goes_through(job: TinyJob) -> None:
    part_of(job, "S01")["strip"]["nodes"] = [1, HUB, 2]


def slit_in_discs(job: TinyJob) -> None:
    slit = {"node": HUB, "from": "top", "width": 4.0, "depth": 15.0, "offset": 0.0, "crossing_deg": 70.0, "partner": "S02"}
    part_of(job, "S01")["strip"]["slits"].append(slit)


def bent_back() -> TinyJob:
    """The strip turns round and passes its own discs."""
    return tiny_hub(Shape(nodes=[*NODES[:2], (-10.0, -19.0, 2.0), *NODES[3:]]))


SHALLOW = (LEVELS[0] + THICKNESS / 2 - 0.5, LEVELS[1] - THICKNESS / 2)
FAULTS: list[Fault] = [
    ("slot of a held end turned", changed(slot_turned), "connectors: slot angles"),
    ("window of a held end turned", lambda: tiny_hub(Shape(turned=0.5)), "connectors: slot cut at its angle"),
    ("ends of a ring swapped", changed(ends_swapped), "connectors: slot angles"),
    ("end of a ring in two slots", changed(end_twice), "connectors: fins they hold"),
    ("strip not in its connector", changed(strip_left_out), "connectors: fins they hold"),
    ("setback of a held end wrong", changed(setback_listed(0, 0.5)), "fins: setback as listed"),
    ("setback of a free end wrong", changed(setback_listed(1, 0.5)), "slits: setbacks of ends as listed"),
    ("strips too near to the axis", lambda: tiny_hub(Shape(setback=0.5)), "fins: setback over the least"),
    ("strips reach into the middle", lambda: tiny_hub(Shape(setback=SETBACK - 3)), "assembly: fins clear of plates"),
    ("notch too shallow for the ring", lambda: tiny_hub(Shape(floors=SHALLOW)), "assembly: fins clear of plates"),
    ("lower disc after strips that nothing else holds", changed(strips_first), "assembly: steps of fins and plates"),
    ("held node without its discs", changed(connector_missing), "slits: strips that meet are held"),
    ("strip through its discs", changed(strip_goes_through), "slits: every strip ends at discs"),
    ("slit where discs stand", changed(slit_in_discs), "slits: every strip ends at discs"),
    ("strip bent into its discs", bent_back, "assembly: plates clear of other fins"),
]
