"""Draws what one agent may choose from: its half-planes in velocity space, what it would like and what it chooses.

usage: velocity_space.py SCENARIO FILE.svg
"""
import sys

import numpy as np
import sumo_gamma

COLOURS = {"kinematic": "#999", "neighbour": "#c33", "obstacle": "#850", "lane_boundary": "#27a", "direction": "#a3a",
           "road_limit": "#e80"}
REACH, SCALE = 16.0, 20.0  # [m/s], pixels a metre per second


def busiest(session):
    """The driven agent with most half-planes of neighbours, and its velocity space."""
    spaces = [(row, session.velocity_space(row)) for row in np.flatnonzero(session.driven)]
    return max(spaces, key=lambda entry: entry[1].kinds.count("neighbour"))


def pixels(velocity):
    return (velocity[0] + REACH) * SCALE, (REACH - velocity[1]) * SCALE


def line(point, normal, colour):
    along = np.array([-normal[1], normal[0]])
    (x1, y1), (x2, y2) = pixels(point - 2 * REACH * along), pixels(point + 2 * REACH * along)
    (x3, y3), (x4, y4) = pixels(point), pixels(point + normal)
    return (f'<path d="M{x1:.1f} {y1:.1f} L{x2:.1f} {y2:.1f} M{x3:.1f} {y3:.1f} L{x4:.1f} {y4:.1f}" '
            f'stroke="{colour}" fill="none"/>')


def dot(velocity, colour, name):
    x, y = pixels(velocity)
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5" fill="{colour}"><title>{name}</title></circle>'


def main(scenario, file):
    with sumo_gamma.Session(scenario, duration=30, quiet=True) as session:
        while session.time < 25:
            session.drive()
        session.observe()
        row, space = busiest(session)
        size = 2 * REACH * SCALE
        parts = [line(p, n, COLOURS[k]) for p, n, k in zip(space.points, space.normals, space.kinds)]
        parts += [dot(session.velocities[row], "#000", "now"), dot(space.preferred, "#393", "preferred"),
                  dot(space.chosen, "#06c", "chosen")]
        with open(file, "w", encoding="utf-8") as stream:
            stream.write(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size:.0f} {size:.0f}">\n'
                         + "\n".join(parts) + "\n</svg>\n")
        print(f"{session.ids[row]}: {len(space.kinds)} half-planes, {space.hard} of them hard; "
              f"wants {np.linalg.norm(space.preferred):.2f} m/s, chooses {np.linalg.norm(space.chosen):.2f} m/s")


if __name__ == "__main__":
    main(*sys.argv[1:3])
