"""Elastic block that slides with Coulomb friction on springs: explicit finite elements (plane strain, four nodes).

Run `python3 elements.py`; needs numpy and takes five seconds. Prints the values of provenance.toml for several meshes.
"""

import numpy as np

LENGTH, HEIGHT, DENSITY, YOUNG, FRICTION, GRAVITY = 1.0, 0.5, 1000.0, 2.5e6, 0.3, 9.81
# Springs at the base (Pa/m): 2.6 E'/h with h of 16 cells over the height, as the judged solver has them.
CELL = HEIGHT / 16


def stiffness(width, height, poisson):
    """Returns the 8 × 8 stiffness matrix of a rectangle, by 2 × 2 Gauss points."""
    shear = (1 - 2 * poisson) / 2
    law = np.array([[1 - poisson, poisson, 0], [poisson, 1 - poisson, 0], [0, 0, shear]])
    law *= YOUNG / ((1 + poisson) * (1 - 2 * poisson))
    matrix = np.zeros((8, 8))
    for a in (-(3**-0.5), 3**-0.5):
        for b in (-(3**-0.5), 3**-0.5):
            by_x = np.array([b - 1, 1 - b, 1 + b, -1 - b]) / (2 * width)
            by_y = np.array([a - 1, -1 - a, 1 + a, 1 - a]) / (2 * height)
            strain = np.zeros((3, 8))
            strain[0, 0::2], strain[1, 1::2], strain[2, 0::2], strain[2, 1::2] = by_x, by_y, by_y, by_x
            matrix += strain.T @ law @ strain * width * height / 4
    return matrix


class Block:
    """Block at rest on its springs, loaded by its weight across the wall."""

    def __init__(self, rows, poisson, across, retardation=0.0):
        self.across, self.retardation = across, retardation
        columns = 2 * rows
        width, height = LENGTH / columns, HEIGHT / rows
        row = columns + 1
        corner = np.array([j * row + i for j in range(rows) for i in range(columns)])
        nodes = corner[:, None] + np.array([0, 1, row + 1, row])
        self.freedoms = np.stack([2 * nodes, 2 * nodes + 1], -1).reshape(len(nodes), 8)
        self.matrix = stiffness(width, height, poisson)
        self.mass = np.zeros(row * (rows + 1))
        np.add.at(self.mass, nodes.ravel(), DENSITY * width * height / 4)
        self.base = np.arange(row)
        share = np.full(row, width)
        share[[0, -1]] /= 2
        self.spring = 2.6 * YOUNG / (1 - poisson**2) / CELL * share
        sound = (YOUNG * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson)) / DENSITY) ** 0.5
        self.step = 0.3 * min(width, height) / sound
        if retardation:
            self.step = min(self.step, (min(width, height) / sound) ** 2 / (8 * retardation))
        x, y = np.tile(np.arange(row) * width, rows + 1), np.repeat(np.arange(rows + 1) * height, row)
        plane = YOUNG / (1 - poisson**2)
        self.place = np.zeros((len(self.mass), 2))
        self.place[:, 1] = -DENSITY * across * HEIGHT / self.spring.sum() * LENGTH
        self.place[:, 1] += DENSITY * across * ((HEIGHT - y) ** 2 - HEIGHT**2) / (2 * plane)
        self.place[:, 0] = poisson * (1 + poisson) / YOUNG * DENSITY * across * (HEIGHT - y) * (x - LENGTH / 2)
        self.speed = np.zeros_like(self.place)
        self.slip = np.zeros(row)
        for _ in range(8000):
            self.advance(self.step, 0.0, 0.0)
            self.speed *= 1 - 60 * self.step
        self.speed[:] = 0.0
        self.slip[:] = 0.0

    def advance(self, step, along, friction):
        """Advances by a step under gravity along the wall (m/s²)."""
        moved = (self.place + self.retardation * self.speed).ravel()
        inner = np.zeros(2 * len(self.mass))
        np.add.at(inner, self.freedoms.ravel(), (moved[self.freedoms] @ self.matrix).ravel())
        force = self.mass[:, None] * np.array([along, -self.across]) - inner.reshape(-1, 2)
        normal = np.maximum(0.0, -self.spring * self.place[self.base, 1])
        slip = np.where(normal > 0, self.slip + self.speed[self.base, 0] * step, 0.0)
        limit = friction * normal / self.spring
        self.slip = np.clip(slip, -limit, limit)
        force[self.base, 1] += normal
        force[self.base, 0] -= self.spring * self.slip
        self.speed += force / self.mass[:, None] * step
        self.place += self.speed * step

    def run(self, duration, along):
        """Yields time and mean velocity after each step."""
        steps = int(duration / self.step)
        for at in range(steps):
            self.advance(duration / steps, along, FRICTION)
            yield (at + 1) * duration / steps, self.mass @ self.speed / self.mass.sum()


def released(rows):
    """Returns v_x + μ v_y − a t (m/s) at 0.3 s of the viscous block released on 30°."""
    across, along = GRAVITY * 0.75**0.5, GRAVITY / 2
    shear = YOUNG / 2.6
    block = Block(rows, 0.3, across, retardation=3000.0 / shear)
    for time, (x, y) in block.run(0.3, along):
        gained = x + FRICTION * y - (along - FRICTION * across) * time
    return gained


def fluttering(rows, poisson):
    """Returns the largest velocity away from the wall (m/s) within 0.2 s of the elastic block that slides at 5 m/s."""
    block = Block(rows, poisson, GRAVITY)
    block.speed[:, 0] = 5.0
    return max(y for _, (_, y) in block.run(0.2, 0.0))


if __name__ == "__main__":
    for rows in (8, 16):
        print("released, rows", rows, released(rows), flush=True)
    for rows, poisson in ((8, 0.2), (16, 0.2), (24, 0.2), (16, 0.0)):
        print("fluttering, rows", rows, "Poisson ratio", poisson, fluttering(rows, poisson), flush=True)
