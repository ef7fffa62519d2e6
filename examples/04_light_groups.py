"""Lamps that are dimmed and coloured after the solve."""

import isolux

solution = isolux.solve("office", elements=5000, rays=4e6, light_groups={"windows": "window*", "lamps": "pendant*"})
print(solution.light_groups)
evening = solution.mix({"windows": 0.05, "lamps": (1.2, 1.0, 0.8)})
for name in ("windows", "lamps"):
    print(f"{name} alone: {evening.alone(name).mean} lx")
print(f"together: {evening.mean} lx")
