"""kill -9 at random moments: a target is absent or complete, and the next run cleans up.

DELTAZ_KILLS is the number of kills of each case (4; half of it where a case has two states or edits), DELTAZ_KILL_SEED makes a run repeatable.
The moments are spread over the time a command takes: one at random in each of as many equal parts.
"""
import os
import random
import shutil
import subprocess
import time

from harness import RAINIER, build, case, main, no_leftovers, program, require, run, small_dem

KILLS = int(os.environ.get("DELTAZ_KILLS", "4"))
SEED = os.environ.get("DELTAZ_KILL_SEED", str(time.time_ns()))


def killed_after(seconds, command):
    """Starts a command and kills it; True if it was still running."""
    process = subprocess.Popen(list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        process.wait(timeout=seconds)
        return False
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return True


def spread(moments, count, end):
    """Moments in order, one in each of `count` equal parts of 0 .. end."""
    return [moments.uniform(part, part + 1) * end / count for part in range(count)]


def duration(command):
    begin = time.monotonic()
    subprocess.run(list(map(str, command)), check=True, capture_output=True)
    return time.monotonic() - begin


@case
def a_killed_build_leaves_nothing_or_everything(folder):
    print(f"seed {SEED}, {KILLS} kills")
    moments = random.Random(SEED)
    target = folder / "area.dz"
    command = [program("dbbuild"), "terrain", RAINIER, "-o", target, "-q"]
    whole = duration(command)
    digest = run("dbbuild", "info", target, "--digest").out
    shutil.rmtree(target)
    absent = complete = 0
    for moment in spread(moments, KILLS, 1.05 * whole):
        killed_after(moment, command)
        if target.exists():
            complete += 1
            run("dbcheck", target, "--level", "all")
            require(run("dbbuild", "info", target, "--digest").out == digest, "the target is another database")
            shutil.rmtree(target)
        else:
            absent += 1
    print(f"absent {absent}, complete {complete}")
    require(absent > 0, "no kill came before the end")
    run("dbbuild", "terrain", RAINIER, "-o", target)
    no_leftovers(folder)
    run("dbcheck", target, "--against", RAINIER)


@case
def a_killed_overwrite_leaves_the_old_or_the_new_state(folder):
    print(f"seed {SEED}, {KILLS} kills")
    moments = random.Random(SEED + "overwrite")
    old_dem = small_dem(folder)
    target, other = folder / "area.dz", folder / "other.dz"
    run("dbbuild", "terrain", RAINIER, "-o", other)
    run("dbbuild", "terrain", old_dem, "-o", target)
    digests = {"old": run("dbbuild", "info", target, "--digest").out, "new": run("dbbuild", "info", other, "--digest").out}
    command = [program("dbbuild"), "terrain", RAINIER, "-o", target, "-q", "--overwrite"]
    whole = duration(command)
    found = {"old": 0, "new": 0}
    for moment in spread(moments, KILLS, 1.05 * whole):
        run("dbbuild", "terrain", old_dem, "-o", target, "--overwrite")
        killed_after(moment, command)
        run("dbcheck", target, "--level", "all")
        digest = run("dbbuild", "info", target, "--digest").out
        state = [name for name, value in digests.items() if value == digest]
        require(state, "the target is neither the old nor the new database")
        found[state[0]] += 1
    print(found)
    run("dbbuild", "terrain", RAINIER, "-o", target, "--overwrite")
    listed = {file["name"] for file in run("dbbuild", "info", target, "--json").json()["files"]}
    left = {file.name for file in target.iterdir()} - listed - {"area.json", "lock"}
    require(not left, f"the next run left {left}")


@case
def a_killed_run_leaves_the_old_database_or_the_new_one(folder):
    print(f"seed {SEED}, {KILLS} kills")
    moments = random.Random(SEED + "run")
    work = folder / "work"
    work.mkdir()
    small_dem(work)
    plan, target = work / "build.toml", work / "area.dz"
    plan.write_text('area = "area.dz"\n[terrain]\nsources = ["small.tif"]\n' +
                    "".join(f'[[color]]\nname = "{name}"\nsynthetic = "natural"\n' for name in ("a", "b", "c")))
    command = [program("dbbuild"), "run", plan, "-q", "--overwrite"]
    whole = duration(command)
    for exists in (False, True):
        found = {"old": 0, "new": 0}
        for moment in spread(moments, KILLS // 2, 1.05 * whole):
            shutil.rmtree(target)
            if exists:
                run("dbbuild", "terrain", work / "small.tif", "-o", target)
            killed_after(moment, command)
            maps = []
            if target.exists():
                run("dbcheck", target)
                maps = [entry["name"] for entry in run("dbbuild", "info", target, "--json").json()["color_maps"]]
            require(target.exists() >= exists and maps in ([], ["a", "b", "c"]), f"a state between the steps is seen: {maps}")
            found["new" if maps else "old"] += 1
            run("dbbuild", "run", plan, "--overwrite")
            left = {file.name for file in work.iterdir()} - {"small.tif", "small.asc", "small.prj", "build.toml", "area.dz"}
            require(not left, f"the next run left {left}")
        print(found)
        require(found["old"] > 0, "no kill came before the end")


def hills(folder):
    """A mesh that takes a while to simplify."""
    side, lines = 80, []
    for row in range(side):
        lines += [f"v {column} {row} {(column * row * 37 + 11 * column) % 17 / 8}" for column in range(side)]
    for row in range(side - 1):
        for column in range(1, side):
            corner = row * side + column
            lines += [f"f {corner} {corner + 1} {corner + side + 1}", f"f {corner} {corner + side + 1} {corner + side}"]
    mesh = folder / "hills.obj"
    mesh.write_text("\n".join(lines) + "\n")
    return mesh


def state_of(area):
    """The generation of what is published."""
    return run("dbbuild", "info", area, "--json").json()["generation"]


def killed_edit(folder, name, base, command):
    """Kills command(area) again and again, each time on a fresh copy of `base`."""
    print(f"seed {SEED}, {KILLS} kills of {name}")
    moments = random.Random(SEED + name)
    area = folder / f"{name}.dz"
    shutil.copytree(base, area)
    digest, old = run("dbbuild", "info", area, "--digest").out, state_of(area)
    whole = duration([program("dbbuild"), *command(area)])
    new = state_of(area)
    require(new > old, "the edit made no new state")
    found = {old: 0, new: 0}
    for moment in spread(moments, KILLS // 2, 1.3 * whole):
        shutil.rmtree(area)
        shutil.copytree(base, area)
        killed_after(moment, [program("dbbuild"), *command(area)])
        run("dbcheck", area)
        require(run("dbbuild", "info", area, "--digest").out == digest, "the terrain is another")
        state = state_of(area)
        require(state in found, f"state {state} is neither the old nor the new one")
        found[state] += 1
        if state == old:
            run("dbbuild", *command(area))
            run("dbcheck", area)
        run("dbbuild", "gc", area)
        listed = {file["name"] for file in run("dbbuild", "info", area, "--json").json()["files"]}
        left = {file.name for file in area.iterdir()} - listed - {"area.json", "lock"}
        require(not left, f"gc left {left}")
    print(found)
    require(found[old] > 0, "no kill came before the end")


@case
def a_killed_colour_map_leaves_the_old_or_the_new_state(folder):
    base = folder / "base.dz"
    run("dbbuild", "terrain", RAINIER, "-o", base)
    killed_edit(folder, "color", base, lambda area: ["color", area, "--name", "summer", "--synthetic", "natural", "-q"])


@case
def a_killed_model_or_placement_leaves_the_old_or_the_new_state(folder):
    base, mesh = build(folder, None, "base.dz"), hills(folder)
    killed_edit(folder, "model", base, lambda area: ["model", area, mesh, "--name", "hills", "-q"])
    run("dbbuild", "model", base, mesh, "--name", "hills")
    killed_edit(folder, "place", base, lambda area: ["place", area, "hills", "--at", "46.1,7.1", "-q"])


@case
def a_killed_view_leaves_no_picture_or_a_whole_one(folder):
    moments = random.Random(SEED + "view")
    area, picture = folder / "area.dz", folder / "view.png"
    run("dbbuild", "terrain", RAINIER, "-o", area)
    command = [program("dbview"), area, "-o", picture, "-q"]
    whole = duration(command)
    wanted = picture.read_bytes()
    for moment in spread(moments, KILLS, 1.05 * whole):
        picture.unlink(missing_ok=True)
        killed_after(moment, command)
        require(not picture.exists() or picture.read_bytes() == wanted, "half a picture")


if __name__ == "__main__":
    main()
