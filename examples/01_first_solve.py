"""Light a room, and read numbers with error bars."""

import isolux

solution = isolux.solve("cornell-box", elements=5000, error=0.05)
print(solution)
for name, light in solution.objects.items():
    print(f"{name:12} {light.mean} lx")
