"""Tracks of a run's trajectories, and what every measure of them needs."""
import functools
import gzip
import math
import os
import re
import statistics
import xml.etree.ElementTree as ElementTree
from bisect import bisect_left
from collections import namedtuple

SCENARIOS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "sumo_scenarios")
SIZES = {"pedestrian": (0.40, 0.48), "bicycle": (1.65, 0.65), "motorcycle": (2.2, 0.9), "car": (4.5, 1.8),
         "bus": (12.0, 2.5)}  # length, width [m] as in the scenarios' vTypes

# front bumper of vehicles, centre of people [m]; angle in degrees clockwise from north; speed [m/s]
Sample = namedtuple("Sample", "time x y angle speed")


class Track:
    """What one agent did: samples in order of time."""

    def __init__(self, name, kind):
        self.name, self.kind, self.samples, self._times = name, kind, [], None

    def __getitem__(self, key):
        return self.samples[key]

    @property
    def length(self):
        return SIZES[self.kind][0]

    @property
    def width(self):
        return SIZES[self.kind][1]

    def at(self, time):
        """Sample at `time` or the next one after; None where the agent was not there."""
        if self._times is None:
            self._times = [s.time for s in self.samples]
        place = bisect_left(self._times, time - 1e-6)
        return self.samples[place] if place < len(self.samples) and self.samples[0].time <= time + 1e-6 else None

    def passes(self, condition):
        """Time of the first sample that meets `condition`, or None."""
        return next((s.time for s in self.samples if condition(s)), None)

    def duration(self):
        return self.samples[-1].time - self.samples[0].time


def read_tracks(path):
    """All tracks by id from SUMO's floating car data."""
    tracks = {}
    wanted = re.compile(r'(id|x|y|angle|type|speed)="([^"]*)"')
    time = 0.0
    with gzip.open(path, "rt", encoding="utf-8") as lines:
        for line in lines:
            line = line.lstrip()
            if line.startswith("<timestep"):
                time = float(re.search(r'time="([^"]*)"', line)[1])
            elif line.startswith(("<vehicle", "<person")):
                v = dict(wanted.findall(line))
                track = tracks.get(v["id"])
                if track is None:
                    track = tracks[v["id"]] = Track(v["id"], v["type"])
                track.samples.append(Sample(time, float(v["x"]), float(v["y"]), float(v["angle"]), float(v["speed"])))
    return tracks


@functools.lru_cache
def net_of(scenario):
    """The scenario's net as XML."""
    return ElementTree.parse(os.path.join(SCENARIOS, scenario, scenario + ".net.xml"))


def lane_points(scenario, lane):
    """Points of a lane's shape in the scenario's net."""
    shape = next(e.get("shape") for e in net_of(scenario).iter("lane") if e.get("id") == lane)
    return [tuple(float(c) for c in point.split(",")[:2]) for point in shape.split()]


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else None


def share(flags):
    return mean(1.0 if flag else 0.0 for flag in flags)


def decelerations(track, window=0.5):
    """(time, mean deceleration over `window`) along a track [m/s^2]: single ticks of rounded speeds are no measure."""
    step = max(1, round(window / (track[1].time - track[0].time))) if len(track.samples) > 1 else 1
    return [(a.time, (a.speed - b.speed) / (b.time - a.time))
            for a, b in zip(track.samples, track.samples[step:])]


def hardest(track):
    return max((d for _, d in decelerations(track)), default=0.0)


def vehicles(tracks):
    return [t for t in tracks.values() if t.kind != "pedestrian"]


def people(tracks):
    return [t for t in tracks.values() if t.kind == "pedestrian"]


def median(values):
    values = list(values)
    return statistics.median(values) if values else None


def deviation(values):
    values = list(values)
    return statistics.stdev(values) if len(values) > 1 else None


def junction_place(scenario, junction):
    """Where a junction of the scenario's net lies [m]."""
    found = next(e for e in net_of(scenario).iter("junction") if e.get("id") == junction)
    return float(found.get("x")), float(found.get("y"))
