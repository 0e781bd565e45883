"""What streams are measured by: gap acceptance, following, the macroscopic fundamental diagram, yielding to people."""
import bisect
import math
from collections import defaultdict, namedtuple

from tracks import deviation, junction_place, mean, median, people, share, vehicles

# critical headway and follow-up time of a minor movement at a two-way stop with a main road of two lanes [s]
# (Highway Capacity Manual, chapter 20)
CRITICAL_HEADWAY = {"right": (6.2, 3.3), "through": (6.5, 4.0), "left": (6.4, 3.5), "major": (4.1, 2.2)}


def slope(points):
    """Of the regression line through [(x, y)]."""
    x, y = mean(p[0] for p in points), mean(p[1] for p in points)
    return sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)


def capacity(conflicting, critical, follow_up):
    """Vehicles an hour that find a gap in a random stream of `conflicting` vehicles an hour (HCM Eq. 20-18)."""
    if conflicting <= 0:
        return 3600 / follow_up
    return conflicting * math.exp(-conflicting * critical / 3600) / (1 - math.exp(-conflicting * follow_up / 3600))


def siegloch(gaps):
    """(critical headway, follow-up time) [s] under a queue that never ends: the line of the mean gap over the number that
    went into it (Siegloch 1973). gaps: [(length [s], number)]. None where fewer than two such numbers were seen thrice."""
    lengths = defaultdict(list)
    for length, number in gaps:
        lengths[number].append(length)
    points = [(n, mean(seen)) for n, seen in lengths.items() if n > 0 and len(seen) > 2]
    if len(points) < 2:
        return None
    follow_up = slope(points)
    return mean(y for _, y in points) - follow_up * (mean(x for x, _ in points) - 0.5), follow_up


def passings(tracks, place, move):
    """Times [s] at which vehicles of the main road pass the middle of a junction of `gap_acceptance`, and at which those of
    its queue leave their line. tracks: of those who drive there."""
    x, y = junction_place("gap_acceptance", place)
    main, queue = [], []
    for track in tracks:
        arm = arm_of(track)[1]
        if arm == "queue":
            queue.append(track.passes((lambda s: s.x < x + 4.0) if move == "major" else (lambda s: s.y > y - 4.0)))
        else:
            main.append(track.passes((lambda s: s.x > x) if arm == "west" else (lambda s: s.x < x)))
    return tuple(sorted(t for t in times if t is not None) for times in (main, queue))


def arm_of(track):
    """(junction, arm) that a vehicle of `gap_acceptance` comes from: "right_200", "west"."""
    return tuple(track.name.split(".")[0].rsplit("_", 1))


def gap_acceptance(tracks, begin=60.0, end=480.0):
    """By movement and conflicting flow: vehicles an hour that leave a queue without end, over HCM's capacity at the flow
    that there was; critical headway and follow-up time, and the capacity that they ask for."""
    figures, here = {}, defaultdict(list)
    for track in vehicles(tracks):
        here[arm_of(track)[0]].append(track)
    for move, usual in CRITICAL_HEADWAY.items():
        flows, gaps = {}, []
        for asked in (200, 600, 1000):
            place = f"{move}_{asked}"
            main, queue = ([t for t in times if begin <= t < end] for times in passings(here[place], place, move))
            conflicting, entered = (3600 * len(times) / (end - begin) for times in (main, queue))
            gaps += [(b - a, bisect.bisect(queue, b) - bisect.bisect(queue, a)) for a, b in zip(main, main[1:])]
            flows[str(asked)] = {"conflicting": conflicting, "entered": entered,
                                 "over_hcm": entered / capacity(conflicting, *usual)}
        own = siegloch(gaps)
        figures[move] = {"flows": flows, "critical_headway": own and own[0], "follow_up_time": own and own[1],
                         "over_own": own and sum(f["entered"] for f in flows.values()) /
                         sum(capacity(f["conflicting"], *own) for f in flows.values())}
    return figures


def following(ring, middle, times, length=1000.0):
    """Of each driver on a ring: the median time gap to who is ahead at equal speed [s]."""
    gaps = defaultdict(list)
    for time in times:
        # along the ring [m], counter-clockwise as they drive
        here = sorted((math.atan2(s.y - middle[1], s.x - middle[0]) / (2 * math.pi) * length, track.name, s.speed, track.length)
                      for track in ring if (s := track.at(time)))
        for (at, name, speed, _), (ahead, _, leader, long) in zip(here, here[1:] + here[:1]):
            gap = (ahead - at) % length - long
            if speed > 2.0 and abs(speed - leader) < 0.5 and gap < 6.0 * speed:
                gaps[name].append(gap / speed)
    return [median(seen) for seen in gaps.values() if len(seen) > 9]


def ring_road(tracks, begin=120.0, end=300.0):
    """Flow over density of rings of 1 km, after Edie: the largest flow, the density there, the speed of waves beyond it and the
    density at which nobody moves; time gaps of drivers who follow on the rings of 20 and 30 cars; on those of 230 m the
    slowest that anybody is in the last 100 s."""
    rings, gaps = [], []
    for cars in (10, 20, 30, 40, 50, 60, 80, 110):
        ring = [t for t in tracks.values() if t.name.startswith(f"cars_{cars}.")]
        times = [begin + k for k in range(int(end - begin))]
        seen = [s for track in ring for time in times if (s := track.at(time))]
        rings.append({"density": len(seen) / len(times), "flow": 3.6 * sum(s.speed for s in seen) / len(times)})
        if cars in (20, 30):
            (east, y), (west, _) = (junction_place("ring_road", f"cars_{cars}_{side}") for side in ("east", "west"))
            gaps += following(ring, ((east + west) / 2, y), times)
    top = max(rings, key=lambda r: r["flow"])
    beyond = [(r["density"], r["flow"]) for r in rings if r["density"] >= top["density"]]
    wave = slope(beyond) if len(beyond) > 1 else None  # [km/h]
    slowest = {f"slowest_of_{cars}": min((s.speed for t in tracks.values() if t.name.startswith(f"short_{cars}.")
                                          for s in t.samples if s.time >= end - 100.0), default=None) for cars in (15, 22)}
    return {"rings": rings, **slowest, "capacity": top["flow"], "density_at_capacity": top["density"], "wave_speed": wave,
            "jam_density": beyond[-1][0] - beyond[-1][1] / wave if wave else None, "followers": len(gaps),
            "time_gap": mean(gaps), "time_gap_variation": deviation(gaps) / mean(gaps) if len(gaps) > 1 else None}


ROAD, STRIPES = 3.2, 2.0  # half widths of the carriageway and of the crossings of `zebras` [m]

# a car at a crossing: when it was far before it, on the stripes from, to [s]; its lane, 0 or 1; the car and its way, 1 or -1
Passing = namedtuple("Passing", "far on off lane car way")


def time_over(track, inside):
    """First and last time of a track at which `inside` holds; None where it never does."""
    times = [s.time for s in track.samples if inside(s)]
    return (times[0], times[-1]) if times else None


class Crossing:
    """Who crosses on foot at one of the crossings: times at the kerb, on the carriageway and in the middle of each lane."""

    def __init__(self, place, walkers):
        self.walkers = []
        for walker in walkers:
            road = time_over(walker, lambda s: abs(s.x - place) < STRIPES + 1.0 and abs(s.y) < ROAD)
            if road:
                lanes = [time_over(walker, lambda s, y=y: abs(s.y - y) < 1.15) for y in (-0.5 * ROAD, 0.5 * ROAD)]
                kerb = walker.passes(lambda s: abs(s.x - place) < STRIPES + 1.0 and abs(s.y) < ROAD + 0.8)
                self.walkers.append((kerb, road, lanes))

    def met_by(self, time, until):
        """When the one steps on the road who comes to the kerb until then; None where there is none, or somebody is on the road
        or at the kerb at `time`."""
        if any(kerb <= time <= road[1] for kerb, road, _ in self.walkers):
            return None
        return min((road[0] for kerb, road, _ in self.walkers if time < kerb < until), default=None)


def passing_of(car, place, far):
    """How a car passes the crossing at x = `place`; None where it doesn't come to it."""
    way = 1 if car[-1].x > car[0].x else -1
    before = car.passes(lambda s: (s.x - place) * way > -far)
    on = car.passes(lambda s: (s.x - place) * way > -STRIPES)
    if on is None:
        return None
    off = car.passes(lambda s: (s.x - place) * way - car.length > STRIPES)
    return Passing(before, on, off if off is not None else car[-1].time, int(car.at(on).y > 0), car, way)


def zebras(tracks, far=55.0, near=30.0):
    """Drivers with nobody ahead of them to whose way somebody comes on foot while they are between `far` and `near` [m] before a
    crossing: too near for people to be across before them, far enough to halt; and the share that lets these go first. People
    and cars that cross each other's way within 5 s of each other."""
    met, let, least, apart, first = 0, 0, [], [], []
    for number in range(5):
        place = 200.0 * number
        crossing = Crossing(place, [w for w in people(tracks) if w.name.split(".")[0].endswith(f"_{number}")])
        over = [passing for car in vehicles(tracks) if (passing := passing_of(car, place, far))]
        for one in over:
            ahead = any(other.lane == one.lane and other.far <= one.far < other.on and other is not one for other in over)
            if not ahead and one.car.at(one.far).speed > 8.0:
                step = crossing.met_by(one.far, one.car.passes(lambda s: (s.x - place) * one.way > -near))
                if step is not None:
                    met, let = met + 1, let + (step < one.on)
            between, walker_first = min(((one.on - t[1], True) if t[1] < one.on else (t[0] - one.off, False)
                                         for _, _, lanes in crossing.walkers if (t := lanes[one.lane])), default=(math.inf, False))
            if between < 5.0:
                apart.append(between)
                first.append(walker_first)
                if walker_first:
                    least.append(min(s.speed for s in one.car.samples if one.far <= s.time <= one.on))
    return {"met": met, "let_go": let, "let_go_share": let / met if met else None, "encroachments": len(apart),
            "person_first": share(first), "least_speed_behind_people": median(least),
            "encroachment_below_1_s": share(e < 1.0 for e in apart), "encroachment_below_2_s": share(e < 2.0 for e in apart)}


def arterial(tracks, begin=240.0, end=900.0):
    """Space-mean speeds by kind on a road of three signals with more demand than they let through."""
    way, time = defaultdict(float), defaultdict(float)
    for track in vehicles(tracks):
        if track.name.startswith("side"):
            continue
        for a, b in zip(track.samples, track.samples[1:]):
            if begin <= a.time < end and 100.0 < a.x < 1200.0:
                way[track.kind] += b.x - a.x
                time[track.kind] += b.time - a.time
    speed = {kind: way[kind] / time[kind] for kind in way if time[kind] > 0}
    return {"speeds": speed, "motorcycles_over_cars": speed["motorcycle"] / speed["car"] if len(speed) == 2 else None}


def grid(tracks, interval=60.0, end=900.0):
    """The macroscopic fundamental diagram: vehicles in the network and vehicle kilometres an hour, a minute each. Scatter: of
    production about the mean of its four neighbours in accumulation, over the largest; hysteresis: what is lost while the
    network empties, at equal accumulation, likewise."""
    time, way = [0.0] * int(end / interval), [0.0] * int(end / interval)
    for track in vehicles(tracks):
        for a, b in zip(track.samples, track.samples[1:]):
            k = int(a.time / interval)
            if k < len(time):
                time[k] += b.time - a.time
                way[k] += 0.5 * (a.speed + b.speed) * (b.time - a.time)
    points = [(t / interval, 3.6 * d / interval) for t, d in zip(time, way)]
    most = max(p for _, p in points)
    fullest = max(range(len(points)), key=lambda k: points[k][0])
    ordered = sorted(p for p in points if p[0] > 10.0)
    scatter = [p - mean(q for _, q in ordered[i - 2:i] + ordered[i + 1:i + 3])
               for i, (_, p) in enumerate(ordered) if 2 <= i < len(ordered) - 2]
    filling = sorted(points[:fullest + 1])
    lost = []
    for n, p in points[fullest + 1:]:
        k = bisect.bisect(filling, (n, 0.0))
        if 0 < k < len(filling):
            (a, pa), (b, pb) = filling[k - 1], filling[k]
            lost.append((pa + (pb - pa) * (n - a) / (b - a) if b > a else pa) - p)
    return {"points": [list(p) for p in points], "most_production": most,
            "accumulation_there": max(points, key=lambda p: p[1])[0],
            "most_accumulation": points[fullest][0], "production_when_fullest": points[fullest][1] / most,
            "scatter": math.sqrt(mean(s * s for s in scatter)) / most if scatter else None,
            "hysteresis": mean(lost) / most if lost else None}
