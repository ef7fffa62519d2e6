"""A lamp over a table, made of NumPy arrays; tables of the result."""

import numpy as np

import isolux


def square(size: float, height: float, up: bool) -> tuple[np.ndarray, np.ndarray]:
    """Corners and triangles of a horizontal square."""
    corners = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]]) * size / 2 + [0, height, 0]
    triangles = np.array([[0, 2, 1], [0, 3, 2]])
    return corners, triangles if up else triangles[:, ::-1]


table, up = square(1.2, 0.75, up=True)
lamp, down = square(0.3, 2.0, up=False)
scene = isolux.Scene.from_arrays(
    np.concatenate([table, lamp]),
    np.concatenate([up, down + 4]),
    objects=["table", "table", "lamp", "lamp"],
    reflectivity={"table": (0.5, 0.4, 0.3)},
    emission={"lamp": 30_000},
    name="lamp over a table",
)
print(scene.check())
solution = isolux.solve(scene, elements=2000, error=0.03)
print(solution.to_dataframe(by="object")[["area", "mean", "margin"]].round(2))
brightest = solution.to_dataframe().sort_values("irradiance_luminance").iloc[-1]
print(f"brightest at x = {brightest.x:.2f} m, z = {brightest.z:.2f} m: {brightest.irradiance_luminance:.0f} lx")
