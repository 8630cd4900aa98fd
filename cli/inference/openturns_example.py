"""A sensitivity study of the puck by OpenTURNS (Debian: python3-openturns): crashreel runs a table of points in one call.

    PATH=build:$PATH python3 cli/inference/openturns_example.py
"""
import csv
import subprocess
import tempfile

import openturns as ot

SCENE = "scenes/gallery/sample_puck.toml"
INPUTS = ["variables.speed", "variables.friction"]


def travel(points):
    """Rows of speed [m/s] and friction to rows of the distance [m]."""
    with tempfile.TemporaryDirectory() as folder:
        with open(folder + "/params.csv", "w", newline="") as out:
            csv.writer(out).writerows([INPUTS] + [list(p) for p in points])
        subprocess.run(["crashreel", "eval", SCENE, folder + "/params.csv", folder + "/results.csv",
                        "--measure", "travel_m", "--quiet"], check=True)
        with open(folder + "/results.csv") as results:
            return [[float(row["travel_m"])] for row in csv.DictReader(results)]


law = ot.ComposedDistribution([ot.Uniform(26 * 0.44704, 34 * 0.44704), ot.Normal(0.6, 0.04)])
model = ot.PythonFunction(2, 1, func_sample=travel)
indices = ot.SaltelliSensitivityAlgorithm(law, 512, model)
for name, first, total in zip(INPUTS, indices.getFirstOrderIndices(), indices.getTotalOrderIndices()):
    print(f"{name}: alone {first:.2f}, with others {total:.2f}")
