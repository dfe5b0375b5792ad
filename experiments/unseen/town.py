"""A town that nobody built, as an OpenStreetMap extract: where streets, houses and trees are is drawn at random."""

import math
import random

# Half of its side, and how far its streets are apart, metres.
_HALF_M, _BLOCK_M = 550.0, (45.0, 140.0)
# How far a crossing is from where a grid would have it, metres.
_JITTER_M = 12.0
# Of an edge between two crossings that there is no street, and of a lot that it is empty.
_MISSING, _EMPTY = 0.2, 0.25
_STREETS = [("residential", 6), ("tertiary", 3), ("secondary", 1)]
_LAND = [("landuse", "grass", 2), ("leisure", "park", 1), ("landuse", "residential", 3)]
_EARTH_M = 6_371_000.0


class _Map:
    """Nodes and ways as they are added, in metres about the middle."""

    def __init__(self, lat_deg: float, lon_deg: float) -> None:
        self.lat_deg, self.lon_deg = lat_deg, lon_deg
        self.nodes: list[str] = []
        self.ways: list[str] = []

    def node(self, x_m: float, y_m: float, **tags: str) -> int:
        lat = self.lat_deg + math.degrees(y_m / _EARTH_M)
        lon = self.lon_deg + math.degrees(x_m / (_EARTH_M * math.cos(math.radians(self.lat_deg))))
        number = len(self.nodes) + 1
        self.nodes.append(f'<node id="{number}" lat="{lat:.7f}" lon="{lon:.7f}">{_tags(tags)}</node>')
        return number

    def way(self, nodes: list[int], **tags: str) -> None:
        refs = "".join(f'<nd ref="{node}"/>' for node in nodes)
        self.ways.append(f'<way id="{len(self.ways) + 1}">{refs}{_tags(tags)}</way>')


def _tags(tags: dict[str, str]) -> str:
    return "".join(f'<tag k="{key.replace("_", ":")}" v="{value}"/>' for key, value in tags.items())


def osm(lat_deg: float, lon_deg: float) -> str:
    """The extract of a town about a place; always the same town."""
    draw, town = random.Random(1), _Map(lat_deg, lon_deg)

    def lines() -> list[float]:
        found = [-_HALF_M]
        while found[-1] < _HALF_M:
            found.append(found[-1] + draw.uniform(*_BLOCK_M))
        return found

    xs, ys = lines(), lines()

    def crossing(x: float, y: float) -> tuple[float, float, int]:
        x, y = (value + draw.uniform(-_JITTER_M, _JITTER_M) for value in (x, y))
        return x, y, town.node(x, y)

    grid = [[crossing(x, y) for y in ys] for x in xs]
    kinds, weights = zip(*_STREETS)
    for along in (grid, [list(row) for row in zip(*grid)]):
        for i, street in enumerate(along):
            kind = draw.choices(kinds, weights)[0]
            for a, b in zip(street, street[1:]):
                if draw.random() >= _MISSING:
                    town.way([a[2], b[2]], highway=kind, name=f"Street {i}")
    for i in range(len(xs) - 1):
        for j in range(len(ys) - 1):
            corners = [grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]]
            _block(town, draw, [corner[:2] for corner in corners])
    head = ['<?xml version="1.0" encoding="UTF-8"?>', '<osm version="0.6">']
    return "\n".join([*head, *town.nodes, *town.ways, "</osm>\n"])


def _block(town: _Map, draw: random.Random, corners: list[tuple[float, float]]) -> None:
    """Houses along the sides of a block, turned any way, trees among them, and what its land is used for."""
    middle = [sum(corner[k] for corner in corners) / 4 for k in (0, 1)]
    inside = [[c[k] + (middle[k] - c[k]) * 0.15 for k in (0, 1)] for c in corners]
    (key, value, _), land = draw.choices(_LAND, [weight for *_, weight in _LAND])[0], [town.node(*p) for p in inside]
    town.way([*land, land[0]], **{key: value})
    stand: list[tuple[int, tuple[float, float], float]] = []
    for i, (a, b) in enumerate(zip(corners, [*corners[1:], corners[0]])):
        length_m = math.dist(a, b)
        along = [(b[k] - a[k]) / length_m for k in (0, 1)]
        inward = [-along[1], along[0]]
        at_m = draw.uniform(14, 20)
        while at_m < length_m - 20:
            wide_m, deep_m, off_m = draw.uniform(6, 18), draw.uniform(7, 14), draw.uniform(8, 22)
            x, y = (a[k] + along[k] * (at_m + wide_m / 2) + inward[k] * (off_m + deep_m / 2) for k in (0, 1))
            at_m += wide_m + draw.uniform(0.5, 9)
            reach_m = math.hypot(wide_m, deep_m) / 2
            # Beside those of the same side, at a corner also before those of the next.
            if any(side != i and math.dist((x, y), other) < reach_m + far_m for side, other, far_m in stand):
                continue
            stand.append((i, (x, y), reach_m))
            if draw.random() < _EMPTY:
                town.node(x, y, natural="tree")
                continue
            turn = math.atan2(along[1], along[0]) + draw.gauss(0, 0.2)
            cos, sin = math.cos(turn), math.sin(turn)
            half = [(u * wide_m / 2, v * deep_m / 2) for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
            outline = [town.node(x + u * cos - v * sin, y + u * sin + v * cos) for u, v in half]
            town.way([*outline, outline[0]], building="yes", building_levels=str(draw.randint(1, 6)))
