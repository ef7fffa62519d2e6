"""A picture, false colours with a legend, and a convergence plot, written into the folder that is named (or this one)."""

import sys
from pathlib import Path

import isolux

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
solution = isolux.solve("cornell-box", elements=20_000, rays=1e7)

solution.save(folder / "cornell-box.png", width=640)
picture = solution.render(width=640, linear=True)
print(f"{picture.shape[1]} x {picture.shape[0]} pixels, brightest {picture.max():.0f} cd/m²")

solution.plot(backend="matplotlib").savefig(folder / "irradiance.png")
solution.plot("relative_error", backend="matplotlib", colors="magma").savefig(folder / "error.png")

methods = {
    "random numbers": {"method": "stochastic-ray", "sequence": "random"},
    "Sobol": {"method": "stochastic-ray", "sequence": "sobol"},
}
curves = isolux.convergence("cornell-box", methods, rays=[1e4, 3e4, 1e5, 3e5], elements=500, seeds=4)
for name in methods:
    slope, margin = curves.slope(name)
    print(f"{name}: the error falls as N^{slope:.2f} ± {margin:.2f}")
curves.plot().savefig(folder / "convergence.png")
