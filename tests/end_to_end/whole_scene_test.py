"""Terrain, colour maps, models and placements together: one build file, one database, pictures of it."""
import json
import math
import pathlib
import shutil

from harness import RAINIER, SAMPLES, TEST_DATA, case, main, require, run, strict_json

import numpy
from osgeo import gdal, osr

gdal.UseExceptions()
AREAS = ["crater_lake", "santa_barbara", "zion", "mount_hood", "rainier"]


def pixels(picture):
    return gdal.Open(str(picture)).ReadAsArray().astype(float)


def view(area, folder, name, *options):
    picture, depth = folder / f"{name}.png", folder / f"{name}.tif"
    run("dbview", area, "-o", picture, "--depth", depth, *options)
    file = gdal.Open(str(depth))
    return pixels(picture), file.ReadAsArray().astype(float), strict_json(file.GetMetadataItem("TIFFTAG_IMAGEDESCRIPTION"))


def geodetic(points, camera):
    """Latitude, longitude in degrees of Earth-centred points, by Bowring's iteration."""
    x, y, z = points
    axis, flattening = camera["semi_major_axis"], 1 / camera["inverse_flattening"]
    squared = flattening * (2 - flattening)
    distance = numpy.hypot(x, y)
    latitude = numpy.arctan2(z, distance * (1 - squared))
    for _ in range(6):
        radius = axis / numpy.sqrt(1 - squared * numpy.sin(latitude)**2)
        height = distance / numpy.cos(latitude) - radius
        latitude = numpy.arctan2(z, distance * (1 - squared * radius / (radius + height)))
    return numpy.degrees(latitude), numpy.degrees(numpy.arctan2(y, x))


def places(depth, camera):
    """Where on the Earth each pixel's surface is."""
    i, j = numpy.mgrid[0:depth.shape[0], 0:depth.shape[1]]
    ray = [camera["forward"][k] + camera["right"][k] * (j - camera["centre_j"]) / camera["pixels"] +
           camera["down"][k] * (i - camera["centre_i"]) / camera["pixels"] for k in range(3)]
    return geodetic([camera["eye"][k] + depth * ray[k] for k in range(3)], camera)


def copied(folder, name):
    """A sample's folder, as a user has it: data beside the build file."""
    for needed in {name, "legends", "models", "rainier"}:
        if (SAMPLES / needed).is_dir():
            shutil.copytree(SAMPLES / needed, folder / needed)
    shutil.copy(SAMPLES / "mt_rainier.tif", folder)
    return folder / name


@case
def every_sample_builds_with_one_run_and_is_sound(folder):
    for name in AREAS:
        work = copied(folder / name, name)
        report = run("dbbuild", "run", work / "build.toml", "--json").json()
        area = report["area"]
        require([step["command"] for step in report["steps"]][0] == "terrain", report)
        require(run("dbcheck", area, "--level", "all", "--json").json()["verdict"] == "valid", name)
        maps = [entry["name"] for entry in run("dbbuild", "info", area, "--json").json()["color_maps"]]
        pictures = []
        for color in [*maps, "none"]:
            run("dbview", area, "-o", work / f"{color}.png", "--color", color, "--size", "320x240")
            pictures.append(pixels(work / f"{color}.png"))
        for first in range(len(pictures)):
            for second in range(first):
                changed = numpy.abs(pictures[first] - pictures[second]).max(axis=0) > 8
                # By rule is what the synthetic map called natural is painted by.
                by_rule = {maps[second], (maps + ["none"])[first]} & {"natural", "summer"} and first == len(maps)
                require(by_rule or changed.mean() > 0.05, f"{name}: maps {second} and {first} look the same")


def flat_dem(path):
    """Gentle hills on 3 arc-second posts."""
    columns = rows = 121
    file = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 1, gdal.GDT_Int16)
    step = 3 / 3600
    file.SetGeoTransform([10 - step / 2, step, 0, 46.1 + step / 2, 0, -step])
    system = osr.SpatialReference()
    system.ImportFromEPSG(4326)
    file.SetProjection(system.ExportToWkt())
    j, i = numpy.mgrid[0:rows, 0:columns]
    file.GetRasterBand(1).WriteArray((800 + 60 * numpy.sin(i / 17) + 50 * numpy.cos(j / 13)).astype(numpy.int16))
    file = None


def image_with_disc(path, epsg, latitude, longitude, pixel, metres):
    """White paper in a reference system, and on it a red disc of a radius in metres on the ground."""
    geographic, system = osr.SpatialReference(), osr.SpatialReference()
    geographic.ImportFromEPSG(4326)
    system.ImportFromEPSG(epsg)
    for reference in (geographic, system):
        reference.SetAxisMappingStrategy(osr.OAMS_TRADITIONAL_GIS_ORDER)
    forward = osr.CoordinateTransformation(geographic, system)
    corners = [forward.TransformPoint(*corner)[:2] for corner in ((10, 46), (10.1, 46), (10, 46.1), (10.1, 46.1))]
    west, north = min(corner[0] for corner in corners), max(corner[1] for corner in corners)
    columns = int((max(corner[0] for corner in corners) - west) / pixel) + 1
    rows = int((north - min(corner[1] for corner in corners)) / pixel) + 1
    file = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 3, gdal.GDT_Byte)
    file.SetGeoTransform([west, pixel, 0, north, 0, -pixel])
    file.SetProjection(system.ExportToWkt())
    # Which pixel centres lie in the disc: a window around it, back to degrees, 4 x 4 points in a pixel.
    x, y = forward.TransformPoint(longitude, latitude)[:2]
    first_column, first_row = int((x - west) / pixel) - 12, int((north - y) / pixel) - 12
    cover = numpy.zeros((24, 24))
    backward = osr.CoordinateTransformation(system, geographic)
    for sub in range(16):
        row, column = numpy.mgrid[0:24, 0:24]
        xs = west + (first_column + column + (sub % 4 + 0.5) / 4) * pixel
        ys = north - (first_row + row + (sub // 4 + 0.5) / 4) * pixel
        found = numpy.array(backward.TransformPoints(list(zip(xs.ravel(), ys.ravel()))))
        east = (found[:, 0] - longitude) * 111320 * math.cos(math.radians(latitude))
        cover += (numpy.hypot(east, (found[:, 1] - latitude) * 111200) < metres).reshape(24, 24) / 16
    red = numpy.full((rows, columns), 255, numpy.uint8)
    others = red.copy()
    window = others[first_row:first_row + 24, first_column:first_column + 24]
    window[:] = numpy.round(255 * (1 - cover))
    for band, values in zip((1, 2, 3), (red, others, others)):
        file.GetRasterBand(band).WriteArray(values)
    file = None


@case
def a_feature_comes_back_at_its_place_through_depth(folder):
    flat_dem(folder / "dem.tif")
    area = folder / "area.dz"
    run("dbbuild", "terrain", folder / "dem.tif", "-o", area)
    latitude, longitude = 46.0537, 10.0461
    for name, epsg, pixel in (("wgs84", 4326, 1 / 10800), ("utm", 32632, 9.0), ("mercator", 3857, 13.0)):
        image = folder / f"{name}.tif"
        image_with_disc(image, epsg, latitude, longitude, pixel, 35)
        run("dbbuild", "color", area, "--name", name, "--image", image)
        for label, eye, look in (("above", f"{latitude},{longitude},4000", "0,-90"), ("aslant", f"{latitude - 0.02},{longitude - 0.01},2600", "19,-35")):
            picture, depth, camera = view(area, folder, f"{name}-{label}", "--eye", eye, "--look", look, "--fov", "12", "--size", "640x480", "--color", name)
            weight = numpy.clip(picture[0] - (picture[1] + picture[2]) / 2 - 20, 0, None)
            require(weight.sum() > 1000, f"{name} {label}: there is no disc in the picture")
            at = places(depth, camera)
            # A pixel seen aslant stands for more ground than one seen from above: weighted with its square metres.
            ground = numpy.abs(numpy.gradient(at[0])[0] * numpy.gradient(at[1])[1] - numpy.gradient(at[0])[1] * numpy.gradient(at[1])[0])
            weight = numpy.where(weight > 0, weight * ground, 0)
            found = [(weight * value)[weight > 0].sum() / weight.sum() for value in at]
            north = (found[0] - latitude) * 111200
            east = (found[1] - longitude) * 111320 * math.cos(math.radians(latitude))
            half_texel = 0.5 * 3 * 30.9 / 16  # the texel at or below any of the images' pixels is a sixteenth of a cell or more
            require(math.hypot(north, east) < half_texel, f"{name} {label}: {east:.2f} m east and {north:.2f} m north of its place")
            print(f"{name} {label}: {east:.2f} m east, {north:.2f} m north")


def changed(before, after):
    """Where something new stands: nearer than what was there."""
    return numpy.nan_to_num(before, posinf=1e9) - numpy.nan_to_num(after, posinf=1e9) > 0.01


def heights(depth, camera):
    """Metres above the ellipsoid of each pixel's surface, to a millimetre near the ground."""
    i, j = numpy.mgrid[0:depth.shape[0], 0:depth.shape[1]]
    x, y, z = (camera["eye"][k] + depth * (camera["forward"][k] + camera["right"][k] * (j - camera["centre_j"]) / camera["pixels"] +
                                           camera["down"][k] * (i - camera["centre_i"]) / camera["pixels"]) for k in range(3))
    latitude, _ = geodetic((x, y, z), camera)
    axis, flattening = camera["semi_major_axis"], 1 / camera["inverse_flattening"]
    radius = axis / numpy.sqrt(1 - flattening * (2 - flattening) * numpy.sin(numpy.radians(latitude))**2)
    return numpy.hypot(x, y) / numpy.cos(numpy.radians(latitude)) - radius


MESHES = {"house-3-0.glb": [], "house-4-2.glb": [], "tree-beech-1-0.glb": [], "tree-spruce-0-0.glb": [], "house-5-3.glb": [], "house1-1.glb": [],
          "tree-lime-2-0.glb": [], "WusonOBJ.obj": ["--up", "y"], "Wuson.ply": ["--up", "y"], "Spider_ascii.stl": [], "Spider_binary.stl": [],
          "2CylinderEngine.glb": ["--units", "cm"]}


def mesh_files():
    folders = [SAMPLES / "models"] + ([pathlib.Path(TEST_DATA) / "mesh"] if TEST_DATA else [])
    return {name: next(folder / name for folder in folders if (folder / name).exists()) for name in MESHES
            if any((folder / name).exists() for folder in folders)}


@case
def models_stand_at_their_places_right_way_up(folder):
    latitude, longitude, ground = 46.7862, -121.7352, None
    bare = folder / "bare.dz"
    run("dbbuild", "terrain", RAINIER, "-o", bare, "--bounds", "-121.8,46.75,-121.68,46.83", "--void", "fill")
    for name, file in mesh_files().items():
        area = folder / (name + ".dz")
        shutil.copytree(bare, area)
        made = run("dbbuild", "model", area, file, "--name", "thing", *MESHES[name], "--json").json()
        placed = run("dbbuild", "place", area, "thing", "--at", f"{latitude},{longitude}", "--json").json()["placements"][0]
        ground = placed["height"]
        size = max(made["size_metres"])
        # From above: its middle in plan is where it was put.
        far = ground + 40 * size
        look = ["--eye", f"{latitude},{longitude},{far}", "--look", "0,-90", "--fov", "4", "--size", "400x400", "--tolerance", "0"]
        _, depth_before, camera = view(bare, folder, name + "-before", *look, "--overwrite")
        _, depth_after, camera = view(area, folder, name + "-after", *look, "--overwrite")
        new = changed(depth_before, depth_after)
        require(new.sum() > 300, f"{name}: nothing stands there")
        at = [value[new] for value in places(depth_after, camera)]
        north = ((at[0].max() + at[0].min()) / 2 - latitude) * 111200
        east = ((at[1].max() + at[1].min()) / 2 - longitude) * 111320 * math.cos(math.radians(latitude))
        require(math.hypot(north, east) < min(1, 0.2 * size), f"{name}: {east:.2f} m east, {north:.2f} m north of its place")
        # From the south: it stands on the ground, as high as it is.
        look = ["--eye", f"{latitude - 12 * size / 111200},{longitude},{ground + size}", "--look", "0,-3", "--fov", "14", "--size", "400x400",
                "--tolerance", "0"]
        _, depth_before, camera = view(bare, folder, name + "-before", *look, "--overwrite")
        _, depth_after, camera = view(area, folder, name + "-after", *look, "--overwrite")
        new = changed(depth_before, depth_after)
        found = heights(depth_after, camera)[new]
        top = found.max() - ground
        require(abs(top - made["size_metres"][2]) < 0.05 * size + 0.01, f"{name}: its top is {top:.2f} m above ground, of {made['size_metres'][2]:.2f} m")
        # What the hillside hides of its foot is not seen.
        require(found.min() - ground < 0.25 * size, f"{name}: its foot is {found.min() - ground:.2f} m above ground")
        run("dbcheck", area, "--level", "all")


@case
def a_moved_part_moves_by_what_the_pose_says(folder):
    """A tower with a crane on it, turned by a quarter and lifted."""
    work = folder / "work"
    work.mkdir()
    def box(name, low, high):
        corners = [(x, y, z) for z in (low[2], high[2]) for x, y in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))]
        faces = [(1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]
        (work / name).write_text("".join("v %g %g %g\n" % c for c in corners) + "".join("f %d %d %d %d\n" % f for f in faces))
        return work / name
    area = folder / "area.dz"
    flat_dem(folder / "dem.tif")
    run("dbbuild", "terrain", folder / "dem.tif", "-o", area)
    run("dbbuild", "model", area, box("tower.obj", (-2, -2, 0), (2, 2, 30)), box("crane.obj", (-1, 0, 30), (1, 25, 32)), "--name", "tower", "--anchor", "origin")
    latitude, longitude = 46.05, 10.05
    ground = run("dbbuild", "place", area, "tower", "--at", f"{latitude},{longitude}", "--json").json()["placements"][0]["height"]
    names = [part["name"] for part in run("dbbuild", "info", area, "--json").json()["models"][0]["parts"]]
    crane = next(name for name in names if "crane" in name)
    pose = folder / "pose.json"
    pose.write_text(json.dumps({"poses": [{"model": "tower", "part": crane, "rotate": {"axis": [0, 0, 1], "degrees": -90}, "translate": [0, 0, 6]}]}))
    look = ["--eye", f"{latitude},{longitude},{ground + 500}", "--look", "0,-90", "--fov", "12", "--size", "500x500"]
    def tip(*options):
        _, depth, camera = view(area, folder, "tip", *look, *options, "--overwrite")
        up = heights(depth, camera) - ground
        crane_pixels = up > 31
        at = [value[crane_pixels] for value in places(depth, camera)]
        return ((at[1].max() - longitude) * 111320 * math.cos(math.radians(latitude)), (at[0].max() - latitude) * 111200, up[crane_pixels].mean())
    east, north, height = tip()
    require(abs(north - 25) < 0.5 and abs(east - 1) < 0.5 and abs(height - 32) < 0.1, f"unmoved: {east} {north} {height}")
    east, north, height = tip("--pose", pose)
    require(abs(east - 25) < 0.5 and abs(north - 1) < 0.5 and abs(height - 38) < 0.1, f"moved: {east} {north} {height}")


if __name__ == "__main__":
    main()
