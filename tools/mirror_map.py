#!/usr/bin/env python3
"""Mirrors an OpenStreetMap extract, east for west, so that its traffic keeps to the other side.

usage: mirror_map.py IN.osm OUT.osm left|right     the side that its traffic keeps to now

What drives on a mirrored map should do as well as on the map itself: whatever differs by more than chance is a mistake
about sides, or one that this map just happens not to show. Left and right change places in keys and values, lists by
lane run from the other side, and the map is moved where people drive on that side, metres kept: from the left to
Germany, from the right to England. For a .osm.pbf file: osmium cat IN.osm.pbf -o IN.osm. Standard library only.
"""
import math
import re
import sys
import xml.etree.ElementTree as ElementTree

ENGLAND, GERMANY = (52.5, -1.5), (50.5, 9.0)  # latitude, longitude [degrees]
FREE_TEXT = ("name", "note", "source", "description", "addr", "ref")
OTHER = {"left": "right", "right": "left"}


def swap_sides(text):
    return re.sub("left|right", lambda found: OTHER[found.group()], text)


def mirror_tag(tag):
    key, value = tag.get("k"), tag.get("v")
    if key.startswith(FREE_TEXT):
        return
    if key.endswith(":lanes") or ":lanes:" in key:
        value = "|".join(reversed(value.split("|")))
    tag.set("k", swap_sides(key))
    tag.set("v", swap_sides(value))


def main():
    if len(sys.argv) != 4 or sys.argv[3] not in ("left", "right"):
        sys.exit(__doc__)
    try:
        tree = ElementTree.parse(sys.argv[1])
    except (OSError, ElementTree.ParseError) as error:
        sys.exit(f"mirror_map.py: {sys.argv[1]}: {error}; expected an OpenStreetMap XML file (.osm)")
    places = [node for node in tree.iter("node") if node.get("lat")]
    if not places:
        sys.exit(f"mirror_map.py: {sys.argv[1]}: no node with a place; expected an OpenStreetMap extract")
    latitude = sum(float(node.get("lat")) for node in places) / len(places)
    longitude = sum(float(node.get("lon")) for node in places) / len(places)
    to_latitude, to_longitude = GERMANY if sys.argv[3] == "left" else ENGLAND
    scale = math.cos(math.radians(latitude)) / math.cos(math.radians(to_latitude))

    def moved_latitude(text):
        return f"{to_latitude + float(text) - latitude:.7f}"

    def moved_longitude(text):
        return f"{to_longitude - (float(text) - longitude) * scale:.7f}"

    for node in places:
        node.set("lat", moved_latitude(node.get("lat")))
        node.set("lon", moved_longitude(node.get("lon")))
    for bounds in tree.iter("bounds"):
        west, east = moved_longitude(bounds.get("maxlon")), moved_longitude(bounds.get("minlon"))
        south, north = moved_latitude(bounds.get("minlat")), moved_latitude(bounds.get("maxlat"))
        for key, value in (("minlat", south), ("maxlat", north), ("minlon", west), ("maxlon", east)):
            bounds.set(key, value)
    for tag in tree.iter("tag"):
        mirror_tag(tag)
    try:
        tree.write(sys.argv[2], encoding="utf-8", xml_declaration=True)
    except OSError as error:
        sys.exit(f"mirror_map.py: {sys.argv[2]}: {error}; name a file that can be written")


if __name__ == "__main__":
    main()
