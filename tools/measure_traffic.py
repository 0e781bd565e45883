#!/usr/bin/env python3
"""Computes what a small scenario of sumo_scenarios/ is there to show from the folder that a run of it left.

usage: measure_traffic.py SCENARIO RUN_FOLDER     prints one JSON object (SI units; flows in vehicles an hour)
       measure_traffic.py --table OUT             Markdown rows for runs OUT/SCENARIO-all beside OUT/SCENARIO-none

Reads results.json, trajectories.fcd.xml.gz and the scenario's net; standard library only.
"""
import json
import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))
from flow_measures import arterial, gap_acceptance, grid, ring_road, zebras  # noqa: E402
from tracks import (SIZES, decelerations, hardest, lane_points, mean, net_of, people, read_tracks, share,  # noqa: E402
                    vehicles)

# ---- one function a scenario: tracks -> figures ---------------------------------------------------------------------

def discharge(tracks, scenario, green):
    """Headways at the stop line, in the green from `green` on, of who had queued in each lane: from the fourth on."""
    lanes = []
    for lane in (0, 1):
        (_, _), (line, y) = lane_points(scenario, f"in_{lane}")
        crossings = []
        for track in vehicles(tracks):
            time = track.passes(lambda s: s.x >= line)
            if time is None or not green <= time < green + 58 or abs(track.at(time).y - y) > 1.6:
                continue
            crossings.append((time, min(s.speed for s in track.samples if s.time <= time) < 3.0))
        crossings.sort()
        queue = 0  # who stood in it or had to wait at its end
        while queue < len(crossings) and crossings[queue][1]:
            queue += 1
        times = [t for t, _ in crossings[:queue]]
        lanes.append({"queue": queue, "start_up": times[0] - green if times else None,
                      "fourth": times[3] - green if len(times) > 3 else None,
                      "headways": [b - a for a, b in zip(times[3:], times[4:])]})
    return lanes


def queues_at(tracks, scenario, time):
    """Tracks of who stands in each lane before the line at `time`, first the one at the line."""
    lanes = []
    for lane in (0, 1):
        (_, _), (line, y) = lane_points(scenario, f"in_{lane}")
        here = [(s.x, track) for track in vehicles(tracks) if (s := track.at(time)) and s.time < time + 0.2
                and s.x <= line and s.speed < 0.3 and abs(s.y - y) < 1.6]
        lanes.append([track for _, track in sorted(here, key=lambda one: -one[0])])
    return lanes


def setting_off(tracks, scenario, green):
    """How queues start: gaps of those who stand, speed of the wave of starts, accelerations from 0 to 5 m/s."""
    gaps, waves, accelerations = [], [], []
    for queue in queues_at(tracks, scenario, green - 0.5):
        stood = [track.at(green - 0.5) for track in queue]
        gaps += [a.x - ahead.length - b.x for a, ahead, b in zip(stood, queue, stood[1:])]
        starts = [next(s.time for s in track.samples if s.time >= green and s.speed > 0.5) for track in queue]
        if len(queue) > 3:
            waves.append((stood[0].x - stood[-1].x) / (starts[-1] - starts[0]))
        for track, start in zip(queue[:5], starts):
            fast = next((s.time for s in track.samples if s.time > start and s.speed >= 5.0), None)
            if fast:
                accelerations.append(4.5 / (fast - start))
    gaps.sort()
    return {"standing_gap": gaps[len(gaps) // 2] if gaps else None, "starting_wave": mean(waves),
            "start_acceleration": mean(accelerations)}


def saturation(tracks):
    lanes = discharge(tracks, "saturation", green=57.0)
    headways = [h for lane in lanes for h in lane["headways"]]
    lost = [lane["fourth"] - 4 * mean(headways) for lane in lanes if lane["fourth"] is not None and headways]
    return {**setting_off(tracks, "saturation", green=57.0), "start_up_lost_time": mean(lost),
            "saturation_flow": 3600 / mean(headways) if headways else None, "headways": len(headways),
            "queues": [lane["queue"] for lane in lanes], "start_up": mean(lane["start_up"] for lane in lanes if lane["queue"]),
            "longest_headway": max(headways, default=None)}


ARMS = {"west": (1, 0), "east": (-1, 0), "north": (0, -1), "south": (0, 1)}  # direction of driving in


def approaches(tracks, scenario, arms):
    """(track, arm, distance of the front to the end of its lane as a function of a sample) of who comes from `arms`."""
    ends = {arm: lane_points(scenario, arm + "_in_0")[-1] for arm in arms}
    found = []
    for track in vehicles(tracks):
        arm = track.name.split("_")[0]
        if arm in arms:
            (ex, ey), (dx, dy) = ends[arm], ARMS[arm]
            found.append((track, arm, lambda s, ex=ex, ey=ey, dx=dx, dy=dy: (ex - s.x) * dx + (ey - s.y) * dy))
    return found


def halts(tracks, scenario, arms):
    """For each vehicle from `arms` that entered the junction: did it stand at its line, since when, when did it go in."""
    rows = []
    for track, arm, distance in approaches(tracks, scenario, arms):
        entered = track.passes(lambda s: distance(s) < -0.5)
        if entered is None:
            continue
        stood = track.passes(lambda s: -0.5 <= distance(s) < 4.0 and s.speed < 0.3)
        rows.append({"name": track.name, "arm": arm, "entered": entered, "stood": stood})
    return rows


def two_way_stop(tracks):
    minor = halts(tracks, "two_way_stop", ["north", "south"])
    main = [t for t in vehicles(tracks) if t.name.startswith(("west_east", "east_west"))]
    return {"minor_entered": len(minor), "halted_share": share(r["stood"] is not None for r in minor),
            "main_road_hardest_braking": max(map(hardest, main)),
            "main_road_slowest": min(min(s.speed for s in t.samples) for t in main),
            "minor_mean_wait": mean(r["entered"] - r["stood"] for r in minor if r["stood"] is not None)}


def crossing_ways(scenario):
    """Pairs of (from edge, to edge) of the junction `centre` whose ways meet, from its request matrix."""
    net = net_of(scenario)
    junction = next(j for j in net.iter("junction") if j.get("id") == "centre")
    place = {lane: i for i, lane in enumerate(junction.get("intLanes").split())}
    way = {place[c.get("via")]: (c.get("from"), c.get("to")) for c in net.iter("connection") if c.get("via") in place}
    return {(way[int(r.get("index"))], way[foe]) for r in junction.iter("request")
            for foe, bit in enumerate(reversed(r.get("foes"))) if bit == "1"}


def all_way_stop(tracks):
    rows = halts(tracks, "all_way_stop", list(ARMS))
    stood = [r for r in rows if r["stood"] is not None]
    way = lambda r: tuple(arm + end for arm, end in zip(r["name"].split(".")[0].split("_"), ("_in", "_out")))
    meet = crossing_ways("all_way_stop")
    # of two that stood at their lines at once and whose ways meet: who came later went first
    pairs = [(a, b) for a in stood for b in stood
             if (way(a), way(b)) in meet and a["stood"] + 1.0 < b["stood"] < a["entered"]]
    times = sorted(r["entered"] for r in rows)
    middle = [t for t in times if 15 <= t <= 85]
    return {"entered": len(rows), "halted_share": share(r["stood"] is not None for r in rows),
            "pairs_at_once": len(pairs), "out_of_turn_share": share(b["entered"] < a["entered"] for a, b in pairs),
            "mean_wait": mean(r["entered"] - r["stood"] for r in stood),
            "flow": 3600 * (len(middle) - 1) / (middle[-1] - middle[0]) if len(middle) > 1 else None}


def roundabout(tracks):
    on_ring = lambda s: math.hypot(s.x, s.y) < 26.5
    ring, halted, waits, turns = 0, 0, [], []
    for track in vehicles(tracks):
        inside = [s for s in track.samples if on_ring(s)]
        if not inside:
            continue
        ring += 1
        halted += any(s.speed < 0.2 for s in inside)
        waits.append(sum(b.time - a.time for a, b in zip(track.samples, track.samples[1:])
                         if a.speed < 0.3 and not on_ring(a)))
        # angle about the centre that was swept: positive is counter-clockwise
        angles = [math.atan2(s.y, s.x) for s in inside]
        turns.append(sum((b - a + math.pi) % (2 * math.pi) - math.pi for a, b in zip(angles, angles[1:])))
    return {"went_round": ring, "halted_on_ring": halted, "mean_wait_at_entry": mean(waits),
            "clockwise": sum(t < 0 for t in turns), "slowest_lap_speed": None if not ring else min(
                mean(s.speed for s in t.samples if on_ring(s)) for t in vehicles(tracks)
                if any(on_ring(s) for s in t.samples))}


def roundabout_entry(tracks):
    """Vehicles an hour on the ring past its western entry and into it from a queue, a stage of 300 s each, its first 30 s
    left out, beside the capacity after the Highway Capacity Manual, 6th edition (one lane, one circulating lane)."""
    ring, entered = [], []
    for track in vehicles(tracks):
        if track.name.startswith("ring"):
            ring.append(track.passes(lambda s: s.x < 0 and s.y <= 0))
        else:
            entered.append(track.passes(lambda s: math.hypot(s.x, s.y) < 26.5))
    stages = []
    for begin in range(0, 900, 300):
        def flow(times):
            return 3600 * sum(t is not None and begin + 30 <= t < begin + 300 for t in times) / 270
        circulating = flow(ring)
        capacity = 1380 * math.exp(-1.02e-3 * circulating)
        stages.append({"ring": circulating, "entered": flow(entered), "hcm": capacity,
                       "entered_over_hcm": flow(entered) / capacity})
    return {"stages": stages}


def over_road(walkers, road):
    """Of each who steps on the carriageway of the road along y = 0, `road` [m] wide to either side: wait at the kerb
    before that [s], where [m], whether it was on both sides."""
    found = []
    for track in walkers:
        # the last stay at the kerb before the carriageway was stepped on
        step = next((i for i, s in enumerate(track.samples) if abs(s.y) < road), None)
        if step is None:
            continue
        crossed = min(s.y for s in track.samples) < -road and max(s.y for s in track.samples) > road
        wait = sum(b.time - a.time for a, b in zip(track.samples[:step], track.samples[1:step + 1])
                   if a.speed < 0.3 and abs(a.y) < road + 2.5)
        found.append((wait, track[step].x, crossed))
    return found


def mid_block(tracks):
    found = over_road(people(tracks), 3.2)
    waits = [wait for wait, _, _ in found]
    return {"people_crossed": sum(crossed for _, _, crossed in found),
            "on_the_crossing": sum(abs(x) < 10.0 for _, x, _ in found),
            "mean_wait_at_kerb": mean(waits), "longest_wait_at_kerb": max(waits, default=None),
            "mean_car_delay": mean(c.duration() - 520 / 13.89 for c in vehicles(tracks)),
            "hardest_braking": max(map(hardest, vehicles(tracks)))}


def zebra(tracks):
    walkers, cars = people(tracks), vehicles(tracks)
    road = 3.2  # half width of the carriageway [m]
    found = over_road(walkers, road)
    waits, crossed = [wait for wait, _, _ in found], sum(crossed for _, _, crossed in found)
    cut_off, passed = 0, 0
    for car in cars:
        way = 1 if car[-1].x > car[0].x else -1
        time = car.passes(lambda s: s.x * way > -2.0)  # the front reaches the stripes
        if time is None:
            continue
        passed += 1
        front = car.at(time)
        for walker in walkers:
            s = walker.at(time)
            # on the stripes in the car's way, or within a step of it
            if s and abs(s.x) < 2.5 and abs(s.y) < road and abs(s.y - front.y) < 0.9 + 0.24 + 0.5:
                cut_off += 1
                break
    free = 240 / 13.89
    return {"people_crossed": crossed, "mean_wait_at_kerb": mean(waits), "waited_over_3_s": share(w > 3 for w in waits),
            "cars_passed": passed, "cars_that_cut_off": cut_off,
            "mean_car_delay": mean(c.duration() - free for c in cars),
            "hardest_braking": max(map(hardest, cars))}


def overtakings(tracks, prefix):
    """Passes of bicycles by cars on one road: (car, bicycle, time abreast, least lateral gap, speed difference)."""
    cars = [t for t in tracks.values() if t.name.startswith(prefix + ".car")]
    bicycles = [t for t in tracks.values() if t.name.startswith(prefix + ".bicycle")]
    found, met = [], 0
    for car in cars:
        for bicycle in bicycles:
            times = [s.time for s in car.samples if bicycle.at(s.time)]
            if not times:
                continue
            offsets = [(t, car.at(t), bicycle.at(t)) for t in times]
            behind = offsets[0][1].x < offsets[0][2].x - bicycle.length
            if not behind:
                continue
            met += 1
            abreast = [(t, a, b) for t, a, b in offsets if a.x > b.x - bicycle.length and a.x - car.length < b.x]
            if abreast and offsets[-1][1].x - car.length > offsets[-1][2].x:
                gap = min(abs(a.y - b.y) for _, a, b in abreast) - (car.width + bicycle.width) / 2
                t, a, b = abreast[len(abreast) // 2]
                found.append({"car": car.name, "time": t, "gap": gap, "faster_by": a.speed - b.speed, "y": a.y})
    return found, met


def bicycle_overtaken(tracks):
    figures = {}
    oncoming = [t for t in tracks.values() if t.name.startswith("oncoming")]
    for prefix, name in (("two", "two_lanes"), ("one", "one_lane")):
        passes, met = overtakings(tracks, prefix)
        figures[name] = {"overtakings": len(passes), "pairs_met": met,
                         "least_gap": min((p["gap"] for p in passes), default=None),
                         "mean_gap": mean(p["gap"] for p in passes),
                         "mean_car_speed": mean(mean(s.speed for s in t.samples) for t in tracks.values()
                                                if t.name.startswith(prefix + ".car"))}
    # over the middle (y = 0) with somebody coming: time until the two would meet
    least = math.inf
    for car in tracks.values():
        if not car.name.startswith("one.car"):
            continue
        for s in car.samples:
            if s.y + car.width / 2 <= 0.05:
                continue
            for other in oncoming:
                o = other.at(s.time)
                if o and o.x > s.x:
                    least = min(least, (o.x - s.x) / max(0.1, o.speed + s.speed))
    figures["least_time_to_oncoming"] = None if least == math.inf else least
    return figures


def bus_stop(tracks):
    stands = []
    for track in tracks.values():
        if track.kind == "bus":
            standing = [s for s in track.samples if s.speed < 0.1 and abs(s.x - 220) < 10]
            stands.append({"bus": track.name, "at": mean(s.x for s in standing),
                           "since": standing[0].time if standing else None,
                           "until": standing[-1].time if standing else None,
                           "seconds": standing[-1].time - standing[0].time if standing else 0.0})
    passed = {"two": 0, "one": 0}
    for stand in stands:
        road = stand["bus"].split(".")[0]
        if stand["since"] is None:
            continue
        for track in tracks.values():
            a, b = (track.at(stand["since"]), track.at(stand["until"]))
            if track.name.startswith(road + ".car") and a and a.x < stand["at"] - 12:
                passed[road] += b is None or b.x - track.length > stand["at"]
    cars = lambda prefix: [t for t in tracks.values() if t.name.startswith(prefix)]
    return {"stops": len(stands), "largest_error": max(abs(s["at"] - 220) if s["at"] else math.inf for s in stands),
            "shortest_stand": min(s["seconds"] for s in stands), "longest_stand": max(s["seconds"] for s in stands),
            "passed_on_two_lanes": passed["two"], "passed_on_one_lane": passed["one"],
            "mean_delay_two_lanes": mean(t.duration() - 400 / 13.89 for t in cars("two.car")),
            "mean_delay_one_lane": mean(t.duration() - 400 / 13.89 for t in cars("one.car")),
            "oncoming_slowest": min(s.speed for t in cars("oncoming") for s in t.samples)}


def corners(track, sample):
    """Corners of a vehicle's outline in order."""
    angle = math.radians(90 - sample.angle)
    forward, left = (math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))
    return [(sample.x - back * forward[0] + side * left[0], sample.y - back * forward[1] + side * left[1])
            for back, side in ((0, track.width / 2), (track.length, track.width / 2),
                               (track.length, -track.width / 2), (0, -track.width / 2))]


def outline_gap(one, other):
    """Least distance of two outlines that don't overlap: from a corner of one to a side of the other."""
    def to_side(p, a, b):
        dx, dy = b[0] - a[0], b[1] - a[1]
        along = min(1.0, max(0.0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)))
        return math.hypot(p[0] - a[0] - along * dx, p[1] - a[1] - along * dy)

    return min(to_side(p, a, b) for box, points in ((one, other), (other, one)) for p in points
               for a, b in zip(box, box[1:] + box[:1]))


def mixed_queue(tracks, green=57.0):
    (_, _), (line, _) = lane_points("mixed_queue", "in_0")
    cars = [t for t in tracks.values() if t.kind == "car"]
    figures, gaps = {}, []
    for kind in ("motorcycle", "bicycle"):
        passed = []
        for rider in (t for t in tracks.values() if t.kind == kind and t.at(green)):
            beside = set()  # standing cars that it went by within a metre
            for s in rider.samples:
                if s.time > green or s.speed < 0.5:
                    continue
                for car in cars:
                    c = car.at(s.time)
                    if c and c.speed < 0.5 and s.x > c.x - car.length and s.x - rider.length < c.x:
                        gap = outline_gap(corners(rider, s), corners(car, c))
                        if gap < 1.0:
                            beside.add(car.name)
                            gaps.append(gap)
            passed.append(sum(tracks[name].at(green).x - SIZES["car"][0] / 2 < rider.at(green).x for name in beside))
        figures[kind + "s"] = {"at_the_light": len(passed), "cars_passed_each": mean(passed),
                               "filtered_share": share(n > 0 for n in passed)}
    figures["least_gap_while_filtering"] = min(gaps, default=None)
    times = [t.passes(lambda s: s.x >= line) for t in tracks.values() if t.name[:4] != "side" and t.at(green)]
    figures["crossed_in_green"] = share(t is not None and t < green + 58 for t in times)
    figures["last_crossing_after_green"] = max((t - green for t in times if t), default=None)
    return figures


def weidmann(density):
    """Speed of people at a density [1/m^2] (Weidmann 1993), [m/s]."""
    return 1.34 * (1 - math.exp(-1.913 * (1 / density - 1 / 5.4))) if density > 0 else 1.34


def sidewalk_counterflow(tracks):
    """Density and speed after Edie in the middle 14 m of each sidewalk from 8 to 28 s, beside Weidmann's speed."""
    begin, end, west, east, width = 8.0, 28.0, 8.0, 22.0, 3.0
    walks = []
    for k in range(4):
        time = distance = 0.0
        wrong = 0
        for track in tracks.values():
            if not track.name.startswith(f"{k}."):
                continue
            for a, b in zip(track.samples, track.samples[1:]):
                if begin <= a.time < end and west <= a.x <= east:
                    way = 1 if track[-1].x > track[0].x else -1
                    time += b.time - a.time
                    distance += (b.x - a.x) * way
                    wrong += abs(a.y - 8 * k + width / 2) > width / 2 + 0.1
        density = time / ((end - begin) * (east - west) * width)
        walks.append({"density": density, "speed": distance / time if time else None, "weidmann": weidmann(density),
                      "off_the_sidewalk": wrong})
    return {"walks": walks, "largest_difference": max(abs(w["speed"] - w["weidmann"]) for w in walks)}


def lane_drop(tracks):
    (first, _), (end, _) = lane_points("lane_drop", "narrow_0")[0], lane_points("lane_drop", "wide_1")[-1]
    left_y = lane_points("lane_drop", "wide_1")[-1][1]
    right_y = lane_points("lane_drop", "wide_0")[-1][1]
    rows = []
    for track in vehicles(tracks):
        time = track.passes(lambda s: s.x >= first)
        before = next((s for s in track.samples if s.x >= end - 40), None)
        if time is not None and before is not None:
            rows.append((time, abs(before.y - left_y) < abs(before.y - right_y)))
    rows.sort()
    busy = [r for r in rows if 40 <= r[0] <= 130]
    return {"passed": len(rows),
            "flow": 3600 * (len(busy) - 1) / (busy[-1][0] - busy[0][0]) if len(busy) > 1 else None,
            "alternating_share": share(a[1] != b[1] for a, b in zip(busy, busy[1:])),
            "from_left_share": share(r[1] for r in busy),
            "longest_gap": max((b[0] - a[0] for a, b in zip(busy, busy[1:])), default=None),
            "hardest_braking": max(map(hardest, vehicles(tracks)))}


def platoon(tracks):
    roads = {}
    for speed in ("14", "25", "33"):
        cars = sorted((t for t in tracks.values() if t.name.startswith(speed + ".")), key=lambda t: t.name)
        half = {"14": 600, "25": 1000, "33": 1400}[speed]
        minima, hard, stops, cruising, gaps = [], [], [], [], []
        for car in cars:
            window = [s for s in car.samples if s.x > 0.4 * half]
            minima.append(min((s.speed for s in window), default=math.nan))
            hard.append(max((d for t, d in decelerations(car) if t >= window[0].time), default=0.0) if window else 0.0)
            slow = [s.speed < 0.2 for s in window]
            stops.append(sum(b and not a for a, b in zip(slow, slow[1:])))
            cruising.append(max((s.speed for s in car.samples), default=0.0))
        for ahead, behind in zip(cars, cars[1:]):
            for s in behind.samples[::10]:
                other = ahead.at(s.time)
                if other:
                    gaps.append(other.x - ahead.length - s.x)
        roads[speed] = {"cars": len(cars), "speed_minima": [round(v, 2) for v in minima],
                        "largest_shrink": max((a - b for a, b in zip(minima, minima[1:])), default=0.0),
                        "hardest_braking": [round(v, 2) for v in hard], "most_stops": max(stops, default=0),
                        "leader_cruise": cruising[0] if cruising else None, "least_gap": min(gaps, default=None)}
    return {"roads": roads}


MEASURES = {f.__name__: f for f in (saturation, two_way_stop, all_way_stop, roundabout, roundabout_entry, zebra,
                                    mid_block, bicycle_overtaken, bus_stop, mixed_queue, sidewalk_counterflow, lane_drop,
                                    platoon)}
# what only `sumo-gamma validate` asks for
FLOWS = {f.__name__: f for f in (gap_acceptance, ring_road, zebras, arterial, grid)}


def red_lights(results):
    """Of those who met a red light, by type: how many went at it, beside the share that the run's behavior asks for."""
    found = {}
    for kind in ("motorcycle", "bicycle", "car", "pedestrian"):
        counts, asked = results["rules"]["by_types"][kind], results["behavior"]["by_type"][kind]
        asked = asked["jaywalking_rate" if kind == "pedestrian" else "red_light_running"]
        met, ran = counts["red_lights_met"], counts["red_light_crossings"]
        found[kind] = {"met": met, "ran": ran, "asked": asked, "excess": ran / met - asked if met else None}
    return found


def common(results, tracks):
    """What every scenario is asked."""
    agents, collisions, flow = results["agents"], results["collisions"], results["flow"]
    return {"inserted": agents["inserted"], "arrived": agents["arrived"], "removed": agents["removed"],
            "colliding_pairs": collisions["unique_pairs"], "deep_pairs": collisions["deep_pairs"],
            "stuck": flow["stuck_agents"], "longest_standstill": flow["longest_standstill_s"],
            "red_light_crossings": results["rules"]["red_light_crossings"],
            "wrong_way_s": results["rules"]["wrong_way_s"], "off_road_s": results["rules"]["off_road_s"],
            "sidewalk_by_vehicle_s": results["rules"]["sidewalk_by_vehicle_s"],
            "accel_p95": results["smoothness"]["accel_p95"], "jerk_p95": results["smoothness"]["jerk_p95"],
            "mean_time_in_scenario": mean(t.duration() for t in tracks.values())}


def rounded(value):
    if isinstance(value, float):
        return round(value, 3) if math.isfinite(value) else None
    if isinstance(value, dict):
        return {k: rounded(v) for k, v in value.items()}
    return [rounded(v) for v in value] if isinstance(value, list) else value


def measure(scenario, folder):
    with open(os.path.join(folder, "results.json"), encoding="utf-8") as stream:
        results = json.load(stream)
    tracks = read_tracks(os.path.join(folder, "trajectories.fcd.xml.gz"))
    own = red_lights(results) if scenario == "red_lights" else {**MEASURES, **FLOWS}[scenario](tracks)
    if scenario == "zebras" and own["met"]:
        own["excess"] = own["let_go_share"] - results["behavior"]["by_type"]["car"]["yielding_rate"]
    return rounded({"scenario": scenario, **common(results, tracks), **own})


# what docs/micro_scenarios.md shows of each scenario: words, where to find it, decimals
HEADLINES = {
    "saturation": [("flow of a lane from the queue", "saturation_flow", "vehicles/h", 0)],
    "two_way_stop": [("side road halts", "halted_share", "", 2), ("its wait", "minor_mean_wait", "s", 1),
                     ("slowest on the main road", "main_road_slowest", "m/s", 1)],
    "all_way_stop": [("halt", "halted_share", "", 2), ("out of turn", "out_of_turn_share", "", 2),
                     ("flow", "flow", "vehicles/h", 0)],
    "roundabout": [("halts on the ring", "halted_on_ring", "", 0), ("wait before it", "mean_wait_at_entry", "s", 1),
                   ("slowest lap", "slowest_lap_speed", "m/s", 1)],
    "roundabout_entry": [],
    "zebra": [("people cut off", "cars_that_cut_off", "", 0), ("wait at the kerb", "mean_wait_at_kerb", "s", 1),
              ("delay of cars", "mean_car_delay", "s", 1), ("hardest braking", "hardest_braking", "m/s²", 1)],
    "mid_block": [("crossed", "people_crossed", "", 0), ("on the crossing", "on_the_crossing", "", 0),
                  ("wait at the kerb", "mean_wait_at_kerb", "s", 1), ("the longest", "longest_wait_at_kerb", "s", 1),
                  ("hardest braking", "hardest_braking", "m/s²", 1)],
    "bicycle_overtaken": [("overtaken, two lanes", "two_lanes.overtakings", "", 0),
                          ("least gap", "two_lanes.least_gap", "m", 1),
                          ("overtaken over the middle", "one_lane.overtakings", "", 0),
                          ("least gap", "one_lane.least_gap", "m", 1)],
    "bus_stop": [("largest error of place", "largest_error", "m", 2), ("cars passed", "passed_on_two_lanes", "", 0),
                 ("delay, two lanes", "mean_delay_two_lanes", "s", 1), ("one lane", "mean_delay_one_lane", "s", 1)],
    "mixed_queue": [("motorcycles that filter", "motorcycles.filtered_share", "", 2),
                    ("bicycles", "bicycles.filtered_share", "", 2),
                    ("least gap", "least_gap_while_filtering", "m", 2)],
    "sidewalk_counterflow": [("pairs of people in overlap by more than 0.1 m", "deep_pairs", "", 0)],
    "lane_drop": [("flow", "flow", "vehicles/h", 0), ("in turn", "alternating_share", "", 2),
                  ("hardest braking", "hardest_braking", "m/s²", 1)],
    "platoon": [("shrinking of minima, 14, 25, 33 m/s",
                 ("roads.14.largest_shrink", "roads.25.largest_shrink", "roads.33.largest_shrink"), "m/s", 2),
                ("hardest braking at 33 m/s", "roads.33.hardest_braking", "m/s²", 1)],
}


def headline(figures, scenario):
    """One cell of the table."""
    def number(path, decimals):
        value = figures
        for key in path.split("."):
            value = value[key]
        value = max(value) if isinstance(value, list) else value
        return "–" if value is None else f"{max(value, 0.0) if path.endswith('shrink') else value:,.{decimals}f}"

    cells = []
    for words, paths, unit, decimals in HEADLINES[scenario]:
        values = [number(p, decimals) for p in ((paths,) if isinstance(paths, str) else paths)]
        cells.append(f"{words} {', '.join(values)} {unit}".strip())
    if scenario == "sidewalk_counterflow":
        cells += [f"{w['density']:.2f} /m²: {w['speed']:.2f} m/s (Weidmann {w['weidmann']:.2f})" for w in figures["walks"]]
    if scenario == "roundabout_entry":
        cells += [f"{s['entered']:,.0f} vehicles/h enter beside {s['ring']:,.0f} on the ring (HCM 6: {s['hcm']:,.0f})"
                  for s in figures["stages"]]
    cells.append(f"**{figures['colliding_pairs']} / {figures['stuck']} / {figures['arrived']} of {figures['inserted']}**")
    return "; ".join(cells)


def table(out):
    """Markdown rows for the runs OUT/SCENARIO-all and OUT/SCENARIO-none."""
    for scenario in MEASURES:
        cells = [headline(measure(scenario, os.path.join(out, f"{scenario}-{c}")), scenario) for c in ("all", "none")]
        print(f"| `{scenario}` | {cells[0]} | {cells[1]} |")


def main(arguments):
    if len(arguments) == 2 and arguments[0] in (*MEASURES, *FLOWS, "red_lights"):
        print(json.dumps(measure(*arguments), indent=1))
        return 0
    if len(arguments) == 2 and arguments[0] == "--table":
        table(arguments[1])
        return 0
    print(__doc__, file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
