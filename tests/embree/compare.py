#!/usr/bin/env python3
"""Nearest hits of `intray trace --kernel exact29` against Embree's, on the same rays.

Embree computes in f32, so the two differ, and every difference has to be explained by that. With u = 2^-24, the
rounding of f32, and L the greatest distance from a ray's origin to a vertex,

    resolution = 16 u L + 2 u M + 3 g

is how far a ray may pass from an edge before f32 knows on which side (the test of an edge is some ten roundings of
coordinates relative to the origin, so of at most L), with M the largest coordinate (vertices are rounded to f32), and g
the grid unit (exact29 rounds vertices, origins and directions to it). Distances along a ray are known to the resolution
times |e1| |e2| / |N . d|, with d of length 1: what a triangle that is slender, or seen from the side, makes of it.

A ray agrees where both miss, or both hit at one distance within what is known of it. Of two triangles that is a tie.
Any other ray is explained only if the nearer of the two hits is within the resolution of an edge of its triangle, seen
along the ray, or if the ray starts within it of that triangle's plane. What is left fails the comparison.

Needs numpy and embreex (`pip install numpy embreex`); without them it says so and is done.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

try:
    import numpy as np
    from embreex.mesh_construction import TriangleMesh
    from embreex.rtcore_scene import EmbreeScene
except ImportError as missing:
    print(f"skipped: {missing}; `pip install numpy embreex` to compare with Embree")
    sys.exit(0)

ROOT = Path(__file__).resolve().parents[2]
SCENES = ["bunny/bunny_smooth.obj", "sponza-dabrovic/scene.toml"]
ROUNDING = 2.0**-24
GRID_BITS = 29


class Scene:
    """A mesh in file order after fan triangulation, and its camera, as intray reads them."""

    def __init__(self, path):
        self.path = path
        settings = tomllib.loads(path.read_text()) if path.suffix == ".toml" else {}
        self.vertices, self.triangles = read_obj(path.parent / settings["model"] if settings else path)
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        camera = settings.get("camera", {})
        # The framing of a bare OBJ.
        centre, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
        towards = np.array([1, 0.75, 1.5]) / np.linalg.norm([1, 0.75, 1.5])
        self.eye = np.array(camera.get("position", centre + towards * radius / np.sin(np.radians(20))))
        self.look_at = np.array(camera.get("look_at", centre))
        self.up = np.array(camera.get("up", [0, 1, 0]))
        self.fov_y = np.radians(camera.get("fov_y", 40))
        lights = [light["position"] for light in settings.get("light", []) if light["kind"] == "point"]
        origins = np.array([self.eye, *lights])
        # At least the grid unit: the grid holds the scene, with cameras and lights, and little more.
        held = np.maximum(high, origins.max(axis=0)) - np.minimum(low, origins.min(axis=0))
        self.grid_unit = held.max() / (2**GRID_BITS - 64)
        self.low, self.high = low, high

    def random_rays(self, count, random):
        """Origins anywhere in the box of the mesh, directions evenly over the sphere."""
        origins = random.uniform(self.low, self.high, (count, 3))
        directions = random.normal(size=(count, 3))
        return quantised(origins, directions)

    def aimed_rays(self, count, random):
        """From anywhere in the box of the mesh to its vertices, where f32 cannot but err."""
        origins = random.uniform(self.low, self.high, (count, 3))
        return quantised(origins, self.vertices[random.integers(len(self.vertices), size=count)] - origins)

    def camera_rays(self, count):
        """Through the middle of each pixel of a square picture, as near to `count` as it can be."""
        side = max(1, round(count**0.5))
        forward = self.look_at - self.eye
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, self.up)
        right /= np.linalg.norm(right)
        down = np.cross(forward, right)
        place = (2 * (np.arange(side) + 0.5) / side - 1) * np.tan(self.fov_y / 2)
        x, y = (grid.reshape(-1, 1) for grid in np.meshgrid(place, place))
        directions = forward + x * right + y * down
        return quantised(np.broadcast_to(self.eye, directions.shape), directions)


def read_obj(path):
    """Positions, and fans of vertex indices, in the order of the file."""
    positions, triangles = [], []
    with open(path, encoding="utf-8", errors="replace") as lines:
        for line in lines:
            words = line.split()
            if words[:1] == ["v"]:
                positions.append([float(word) for word in words[1:4]])
            elif words[:1] == ["f"]:
                corners = [int(word.split("/")[0]) for word in words[1:]]
                corners = [c - 1 if c > 0 else len(positions) + c for c in corners]
                triangles += [[corners[0], a, b] for a, b in zip(corners[1:], corners[2:])]
    return np.array(positions), np.array(triangles)


def quantised(origins, directions):
    """Rays whose numbers are f32, so that both are given the same ones."""
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return np.ascontiguousarray(origins, np.float32), np.ascontiguousarray(directions, np.float32)


def by_embree(scene, origins, directions):
    """t (infinite for a miss) and triangle of each ray."""
    embree = EmbreeScene(robust=True)
    TriangleMesh(embree, scene.vertices.astype(np.float32), scene.triangles.astype(np.int32))
    found = embree.run(origins, directions, output=1)
    hit = found["geomID"] >= 0
    return np.where(hit, found["tfar"].astype(float), np.inf), np.where(hit, found["primID"].astype(np.int64), -1)


def by_intray(intray, scene, origins, directions):
    """t (infinite for a miss) and triangle of each ray."""
    with tempfile.TemporaryDirectory() as folder:
        rays, hits = Path(folder, "rays.csv"), Path(folder, "hits.csv")
        # 17 digits: what is read is the f32 itself.
        rows = np.hstack([origins, directions]).astype(float)
        np.savetxt(rays, rows, fmt="%.17g", delimiter=",", header="ox,oy,oz,dx,dy,dz", comments="")
        command = [intray, "trace", scene.path, "--rays", rays, "-o", hits, "--kernel", "exact29", "--json"]
        said = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
        assert json.loads(said)["rays"] == len(origins)
        t, prim = np.full(len(origins), np.inf), np.full(len(origins), -1)
        with open(hits, encoding="ascii") as lines:
            assert next(lines) == "hit,t,prim,u,v\n"
            for i, line in enumerate(lines):
                hit, its_t, its_prim, _, _ = line.split(",")
                if hit == "1":
                    t[i], prim[i] = float(its_t), int(its_prim)
        return t, prim


def unexplained(scene, origins, directions, ours, theirs):
    """The indices of rays that differ without a reason, and how many there are of each other kind."""
    (our_t, our_prim), (their_t, their_prim) = ours, theirs
    origins, directions = origins.astype(float), directions.astype(float)
    length = np.linalg.norm(directions, axis=1)
    units = directions / length[:, None]
    corners = [np.where(at, scene.high, scene.low) for at in np.ndindex(2, 2, 2)]
    far = np.max([np.linalg.norm(origins - corner, axis=1) for corner in corners], axis=0)
    largest = max(np.abs(scene.low).max(), np.abs(scene.high).max())
    resolution = 16 * ROUNDING * far + 2 * ROUNDING * largest + 3 * scene.grid_unit

    def known_to(rays, prims):
        """How well f32 knows the distance to a triangle."""
        v0, v1, v2 = (scene.vertices[scene.triangles[prims, k]] for k in range(3))
        e1, e2 = v1 - v0, v2 - v0
        across = np.abs(np.einsum("ij,ij->i", np.cross(e1, e2), units[rays]))
        sizes = np.linalg.norm(e1, axis=1) * np.linalg.norm(e2, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            return resolution[rays] * sizes / across

    missed = np.isinf(our_t) & np.isinf(their_t)
    both = np.flatnonzero(np.isfinite(our_t) & np.isfinite(their_t))
    apart = np.abs(our_t[both] - their_t[both]) * length[both]
    # A triangle that only one of them hits is known no better than the worse of the two.
    close = apart <= np.maximum(known_to(both, our_prim[both]), known_to(both, their_prim[both]))
    agree = missed.copy()
    agree[both[close]] = True
    ties = np.count_nonzero(agree & ~missed & (our_prim != their_prim))

    rest = np.flatnonzero(~agree)
    nearer = np.where(our_t[rest] <= their_t[rest], our_prim[rest], their_prim[rest])
    v = [scene.vertices[scene.triangles[nearer, k]] for k in range(3)]
    edges = [distance_to_segment(origins[rest], units[rest], v[k], v[(k + 1) % 3]) for k in range(3)]
    normal = np.cross(v[1] - v[0], v[2] - v[0])
    with np.errstate(divide="ignore", invalid="ignore"):
        plane = np.abs(np.einsum("ij,ij->i", origins[rest] - v[0], normal)) / np.linalg.norm(normal, axis=1)
    at_edge = np.min(edges, axis=0) <= resolution[rest]
    at_start = plane <= resolution[rest]
    counts = {
        "rays": len(origins),
        "hits": np.count_nonzero(np.isfinite(our_t)),
        "other triangle at one t": ties,
        "at an edge": np.count_nonzero(at_edge),
        "at the start": np.count_nonzero(at_start & ~at_edge),
    }
    return rest[~(at_edge | at_start)], counts


def distance_to_segment(origins, units, a, b):
    """Between the line of each ray and a segment."""
    def across(points):
        relative = points - origins
        return relative - units * np.einsum("ij,ij->i", relative, units)[:, None]

    a, b = across(a), across(b)
    along = b - a
    square = np.einsum("ij,ij->i", along, along)
    with np.errstate(divide="ignore", invalid="ignore"):
        place = np.where(square > 0, -np.einsum("ij,ij->i", a, along) / square, 0)
    return np.linalg.norm(a + along * np.clip(place, 0, 1)[:, None], axis=1)


def check_the_checker(scene, origins, directions, ours):
    """Distances that are off by a thousandth of the scene, and hits that are lost, must not be explained away."""
    some = np.flatnonzero(np.isfinite(ours[0]))[:1000]
    rays, (t, prim) = (origins[some], directions[some]), (ours[0][some], ours[1][some])
    off = np.linalg.norm(scene.high - scene.low) / 1000
    for what, wrong in [("off", (t + off, prim)), ("lost", (np.full_like(t, np.inf), np.full_like(prim, -1)))]:
        left, _ = unexplained(scene, *rays, (t, prim), wrong)
        if len(left) < 0.95 * len(some):
            sys.exit(f"the comparison explains {len(some) - len(left)} of {len(some)} hits that are {what}")


def main():
    parser = argparse.ArgumentParser(description="Compare `intray trace` with Embree.")
    parser.add_argument("--intray", default=ROOT / "target/release/intray", type=Path, help="the command")
    parser.add_argument("--scenes", default=ROOT / "../shared/scenes", type=Path, help="the folder of scenes")
    parser.add_argument("--rays", default=20_000, type=int, help="rays of each kind, of each scene")
    arguments = parser.parse_args()
    failed = False
    for name in SCENES:
        path = arguments.scenes / name
        if not path.is_file():
            print(f"skipped {name}: it is not in {arguments.scenes}")
            continue
        scene = Scene(path)
        random = np.random.default_rng(2009)
        for kind, rays in [
            ("random", scene.random_rays(arguments.rays, random)),
            ("camera", scene.camera_rays(arguments.rays)),
            ("aimed", scene.aimed_rays(arguments.rays, random)),
        ]:
            ours = by_intray(arguments.intray, scene, *rays)
            if kind == "random":
                check_the_checker(scene, *rays, ours)
            left, counts = unexplained(scene, *rays, ours, by_embree(scene, *rays))
            print(f"{name}, {kind}:", ", ".join(f"{count} {what}" for what, count in counts.items()), end="")
            print(f", {len(left)} unexplained")
            for ray in left[:5]:
                origin, direction = (part[ray].tolist() for part in rays)
                print(f"  {origin} + t {direction}: t = {ours[0][ray]}, triangle {ours[1][ray]}")
            failed |= len(left) > 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
