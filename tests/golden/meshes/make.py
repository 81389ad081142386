#!/usr/bin/env python3
"""Makes figure.obj (a plain standing figure) and tunic.obj (pleated cloth round it)."""
import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent


class Mesh:
    def __init__(self):
        self.vertices, self.faces = [], []

    def tube(self, rings, sides, closed):
        """rings: (centre, radius function of the angle), from the bottom up."""
        first = len(self.vertices)
        for (cx, cy, cz), radius in rings:
            for j in range(sides):
                a = 2 * math.pi * j / sides
                r = radius(a)
                self.vertices.append((cx + r * math.sin(a), cy, cz + r * math.cos(a)))
        at = lambda i, j: first + i * sides + j % sides + 1
        for i in range(len(rings) - 1):
            for j in range(sides):
                self.faces.append((at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)))
        if closed:
            for i, turn in ((0, -1), (len(rings) - 1, 1)):
                self.vertices.append(rings[i][0])
                pole = len(self.vertices)
                for j in range(sides):
                    pair = (at(i, j), at(i, j + 1))
                    self.faces.append((*pair[::turn], pole))

    def save(self, name):
        lines = [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in self.vertices]
        lines += ["f " + " ".join(map(str, f)) for f in self.faces]
        (HERE / name).write_text("\n".join(lines) + "\n")


def solid(mesh, points, sides=24):
    """points: (x, y, z, radius) from the bottom up."""
    mesh.tube([((x, y, z), lambda a, r=r: r) for x, y, z, r in points], sides, True)


def ball(mesh, x, y, z, radius, stretch=1.0):
    rings = 12
    angles = [math.pi * (i + 0.5) / rings for i in range(rings)]
    solid(mesh, [(x, y - stretch * radius * math.cos(t), z, radius * math.sin(t)) for t in angles])


figure = Mesh()
ball(figure, 0, 1.62, 0.01, 0.10, 1.25)
solid(figure, [(0, 0.82, 0, 0.10), (0, 0.90, 0, 0.165), (0, 1.05, 0, 0.125), (0, 1.28, 0, 0.155),
               (0, 1.40, 0, 0.12), (0, 1.46, 0, 0.055), (0, 1.54, 0, 0.05)])
for side in (-1, 1):
    solid(figure, [(0.13 * side, 0.0, 0.03, 0.055), (0.125 * side, 0.10, 0, 0.04), (0.11 * side, 0.48, 0, 0.055),
                   (0.09 * side, 0.86, 0, 0.085)])
    solid(figure, [(0.47 * side, 0.92, 0.02, 0.028), (0.42 * side, 1.00, 0.02, 0.032), (0.28 * side, 1.22, 0, 0.042),
                   (0.17 * side, 1.38, 0, 0.06)])
figure.save("figure.obj")

tunic = Mesh()
profile = [(0.62, 0.30), (0.70, 0.275), (0.80, 0.245), (0.90, 0.21), (1.00, 0.16), (1.06, 0.145), (1.15, 0.155),
           (1.28, 0.175), (1.36, 0.16)]
tunic.tube([((0, y, 0), lambda a, y=y, r=r: r + max(0.0, 1.06 - y) * 0.045 * math.cos(14 * a)) for y, r in profile],
           112, False)
tunic.save("tunic.obj")
