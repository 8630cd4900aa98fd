"""The commands that write, as small jobs: what `pairs` runs two at once and `power_cut` cuts off."""
import os
import pathlib
import subprocess

SCENE = """title = "Ball"
[[uncertain]]
key = "variables.speed"
uniform = "0.5 1.5 m/s"
[variables]
speed = "SPEED m/s"
[simulation]
duration = "0.4 s"
stop_at_rest = false
[air]
density = 0
[[body]]
name = "ball"
mass = "2 kg"
axes = "0.1 0.1 0.1 m"
position = "0 0 0.3 m"
velocity = ["speed", 0, 0]
friction = 0.5
[[camera]]
name = "side"
position = "0 -3 1 m"
target = "0 0 0.2 m"
[snapshot]
width = 64
height = 64
[[output.still]]
time = "0.1 s"
"""

PICTURE = ["--size", "64x64", "--quality", "draft"]
FILM = PICTURE + ["--fps", "10", "-j", "1"]
# Name: arguments. All write below the folder they run in, and those that can into the same folder `out`.
JOBS = {
    "film": ["render", "ball.toml", "-o", "a.mp4", "--overwrite"] + FILM,
    "film_by_frames": ["render", "ball.toml", "-o", "a.mp4", "--resume"] + FILM,
    "lossless_film": ["render", "ball.toml", "-o", "a.mkv", "--overwrite"] + FILM,
    "frames": ["render", "ball.toml", "-o", "out", "--overwrite"] + FILM,
    "still": ["render", "ball.toml", "-o", "still.png", "--at", "0.1s", "--overwrite"] + PICTURE,
    "results": ["simulate", "ball.toml", "-o", "out", "--overwrite"],
    "figures": ["figure", "ball.toml", "-o", "out", "--overwrite"] + PICTURE,
    "study": ["study", "ball.toml", "-o", "out", "--overwrite", "--jobs", "1"],
    "sample": ["sample", "ball.toml", "-n", "4", "-o", "out", "--overwrite", "--jobs", "1"],
    "eval": ["eval", "ball.toml", "params.in", "results.out"],
    "baselines": ["snapshot", "scenes", "--update", "ball", "-j", "1"],
}


def prepare(folder, speed="1"):
    """What the jobs read."""
    folder = pathlib.Path(folder)
    (folder / "scenes").mkdir(parents=True, exist_ok=True)
    for scene in (folder / "ball.toml", folder / "scenes/ball.toml"):
        scene.write_text(SCENE.replace("SPEED", speed))
    (folder / "params.in").write_text(f"1 variables\n{speed} variables.speed\n1 functions\n1 ASV_1:travel_m\n")


def start(program, job, folder, log, prefix=()):
    return subprocess.Popen([*prefix, program, *JOBS[job]], cwd=folder, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)


def files_in(folder):
    """What lies below a folder: bytes by name."""
    out = {}
    for place, _, names in os.walk(folder):
        for name in names:
            file = os.path.join(place, name)
            with open(file, "rb") as stream:
                out[os.path.relpath(file, folder)] = stream.read()
    return out


def is_temporary(name):
    return name.endswith((".part", ".lock")) or ".frames/" in name
