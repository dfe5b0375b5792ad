"""Makes up an OpenStreetMap extract of a city, to measure how large places are read and built.

`city.py BUILDINGS FILE` writes blocks of houses in a grid of streets around latitude 52.5, longitude 13.4.
"""

import math
import random
import sys
from pathlib import Path
from xml.sax.saxutils import quoteattr

LAT_DEG, LON_DEG = 52.5, 13.4
METRE_DEG = 360 / (2 * math.pi * 6_378_137)
# A block from the middle of a street to the middle of the next, metres, and its two rows of houses.
BLOCK_M = 95.0
HOUSES = 11
HOUSE_M = 6.4
KINDS = ["apartments", "apartments", "house", "retail", "office", "garage"]
ROOFS = ["flat", "gabled", "hipped", "half-hipped", "pyramidal", "mansard", "gambrel", "skillion"]


class Extract:
    """Elements in the order of their making."""

    def __init__(self):
        self.nodes, self.ways = [], []

    def node(self, x, y, **tags):
        self.nodes.append((y * METRE_DEG + LAT_DEG, x * METRE_DEG / math.cos(math.radians(LAT_DEG)) + LON_DEG, tags))
        return len(self.nodes)

    def way(self, nodes, **tags):
        self.ways.append((nodes, tags))

    def write(self, file):
        def tags(of):
            return "".join(f"<tag k={quoteattr(k.replace('__', ':'))} v={quoteattr(str(v))}/>" for k, v in of.items())

        file.write("<osm version='0.6'>\n")
        for i, (lat, lon, of) in enumerate(self.nodes, 1):
            file.write(f"<node id='{i}' lat='{lat:.7f}' lon='{lon:.7f}'>{tags(of)}</node>\n")
        for i, (nodes, of) in enumerate(self.ways, 1):
            refs = "".join(f"<nd ref='{n}'/>" for n in nodes)
            file.write(f"<way id='{i}'>{refs}{tags(of)}</way>\n")
        file.write("</osm>\n")


def city(buildings):
    """An extract of a square city with so many buildings, and its side in metres."""
    draw, extract = random.Random(1), Extract()
    blocks = math.ceil(math.sqrt(buildings / (2 * HOUSES)))
    side_m = blocks * BLOCK_M
    at = [i * BLOCK_M - side_m / 2 for i in range(blocks + 1)]
    corners = {(i, j): extract.node(at[i], at[j], highway="crossing") for i in range(len(at)) for j in range(len(at))}
    for i in range(len(at)):
        kind = "secondary" if i % 6 == 0 else "residential"
        for line in [[corners[i, j] for j in range(len(at))], [corners[j, i] for j in range(len(at))]]:
            extract.way(
                line, highway=kind, lanes=4 if kind == "secondary" else 2, sidewalk="both", parking__both="lane"
            )
    made = 0
    for west in at[:-1]:
        for south in at[:-1]:
            for row, depth in ((south + 12, 1), (south + BLOCK_M - 12, -1)):
                for house in range(HOUSES):
                    if made == buildings:
                        continue
                    made += 1
                    x, deep = west + 12 + house * HOUSE_M, depth * draw.uniform(9, 14)
                    places = [(x, row), (x + HOUSE_M, row), (x + HOUSE_M, row + deep), (x, row + deep)]
                    if draw.random() < 0.2:
                        places[3:] = [(x + 3, row + deep), (x + 3, row + deep + depth * 5), (x, row + deep + depth * 5)]
                    ring = [extract.node(*place) for place in places]
                    roof = {"roof__shape": draw.choice(ROOFS)} if draw.random() < 0.5 else {}
                    kind = draw.choice(KINDS)
                    extract.way([*ring, ring[0]], building=kind, building__levels=draw.randint(1, 6), **roof)
            for tree in range(4):
                extract.node(west + 20 + 18 * tree, south + 9, natural="tree")
    return extract, side_m


if __name__ == "__main__":
    made, side_m = city(int(sys.argv[1]))
    with Path(sys.argv[2]).open("w", encoding="utf-8") as file:
        made.write(file)
    print(f"{len(made.ways)} ways and {len(made.nodes)} nodes on a square of {side_m:.0f} m")
